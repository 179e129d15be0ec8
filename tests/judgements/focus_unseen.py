# SPDX-License-Identifier: Apache-2.0
"""More captures whose subject is known, which were drawn when the thresholds were fixed. They are made like those of
focus.py."""
import numpy as np

from judgements.focus import Hidden, between, near
from judgements.scenes import (AHEAD, Capture, Lens, Quad, arc, box, card, grid, hand_held, lattice, looking, shaken,
                               spiral, survey, track, wall)

PORTRAIT = Lens(150, 200, 210)
WIDE = Lens(200, 150, 84)  # 100 degrees
LONG = Lens(200, 150, 1100)  # 10 degrees


def seen_from(camera, *points):
    """Returns the depths of points of the world along the axis of a camera."""
    position, rotation = camera
    return [float(np.subtract(position, point) @ np.asarray(rotation)[:, 2]) for point in points]


def floor(height, near_w, far_w, **keys):
    """A horizontal plane below the LF cameras, from one depth to another."""
    return Quad((0, -height, -(near_w + far_w) / 2), (far_w, (far_w - near_w) / 2), ((1, 0, 0), (0, 0, -1)), **keys)


# Scenes

def view_from_a_window(generator):
    """A frame near the LF cameras, and what is seen through it: both can be the subject."""
    far = near(generator, 3)
    bars = [card(x, 0, 0.8, 0.1, 2) for x in (-0.38, 0, 0.38)] + [card(0, y, 0.8, 2, 0.1) for y in (-0.28, 0.28)]
    return grid(7, 0.015), [*bars, wall(far)], between(0.8) + between(far)


def branches_before_the_subject(generator):
    """Twigs near the upper border; the subject stands in the middle."""
    depth = near(generator, 1.5)
    twigs = []
    for k in range(7):
        angle = generator.uniform(-0.6, 0.6)
        twigs.append(card(generator.uniform(-0.25, 0.25), generator.uniform(0.12, 0.2), generator.uniform(0.5, 0.6),
                          0.3, 0.012, axes=((np.cos(angle), np.sin(angle), 0), (-np.sin(angle), np.cos(angle), 0))))
    return grid(7, 0.015), [*twigs, card(0, -0.1, depth, 0.55 * depth, 0.5 * depth), wall(4)], between(depth)


def snow_before_the_subject(generator):
    """Flakes everywhere, near the LF cameras."""
    depth = near(generator, 1.5)
    flakes = [card(generator.uniform(-0.45, 0.45) * d, generator.uniform(-0.35, 0.35) * d, d, 0.02 * d, 0.02 * d)
              for d in generator.uniform(0.35, 0.7, 40)]
    return grid(7, 0.015), [*flakes, card(0, 0, depth, 0.6 * depth, 0.55 * depth), wall(4)], between(depth)


def table_top(generator):
    """A table seen obliquely from above, with a box on it."""
    cameras = [((x, y + 0.75, 0.0), looking((x, y + 0.75, 0.0), (x, y, -1.1))) for (x, y, _), _ in grid(7, 0.02)]
    things = box(0, 0.15, near(generator, 1.0), 0.4, 0.3, 0.3)
    return cameras, [floor(0, 0.2, 3), *things], lambda camera: between(
        *seen_from(camera, (0, 0.3, things[0].middle[2]), (0, 0, things[0].middle[2] - 0.6), (0, 0, -0.6)))


def few_patches(generator):
    """Six posters on a wall without texture."""
    depth = near(generator, 1.4)
    posters = [card(x * depth, y * depth, depth - 0.001, 0.12 * depth, 0.12 * depth)
               for x in (-0.3, 0.02, 0.31) for y in (-0.14, 0.16)]
    return grid(7, 0.02), [wall(depth, contrast=0), *posters], between(depth)


def checked_wall(generator):
    """A pattern that repeats itself every ten pixels."""
    depth = near(generator, 1.5)
    return grid(7, 0.06), [wall(depth, pattern="checks")], Hidden(between(depth))


def striped_wall(generator):
    depth = near(generator, 1.5)
    return grid(7, 0.04), [wall(depth, pattern="stripes")], Hidden(between(depth))


def card_before_checks(generator):
    depth = near(generator, 1.1)
    return grid(7, 0.02), [card(0, 0, depth, 0.55 * depth, 0.5 * depth), wall(2.5, pattern="checks")], between(depth)


def glossy_side(generator):
    """Highlights of a curved surface, at depths that differ along both axes, beside an object."""
    depth = near(generator, 1.2)
    shiny = card(-0.33 * depth, 0, depth, 0.22 * depth, 0.7 * depth, slides=0.8)
    return grid(7, 0.015), [shiny, card(0.12, 0, depth, 0.5 * depth, 0.5 * depth), wall(3)], between(depth)


def mirror_in_the_middle(generator):
    """A mirror on a wall shows things twice as far away as it is: both can be the subject."""
    depth = near(generator, 1.5)
    frame = [card(side * 0.37 * depth, 0, depth, 0.4 * depth, 2) for side in (-1, 1)]
    frame += [card(0, side * 0.34 * depth, depth, 2, 0.3 * depth) for side in (-1, 1)]
    return grid(7, 0.015), [*frame, wall(2 * depth + 0.4)], between(depth) + between(2 * depth + 0.4)


def leaves_in_wind(generator):
    """A tree moves behind an object that stands still."""
    depth = near(generator, 1.2)
    return grid(7, 0.02), [card(0, 0, depth, 0.6 * depth, 0.55 * depth), wall(2.6, flickers=True)], between(depth)


def only_water(generator):
    """Everything changes from photograph to photograph."""
    return grid(5, 0.02), [wall(near(generator, 1.5), flickers=True)], None


def white_statue(generator):
    """An object without texture before books: only its outlines tell its depth."""
    depth = near(generator, 1.1)
    return grid(7, 0.015), [card(0, 0, depth, 0.35 * depth, 0.5 * depth, contrast=0, grey=0.9), wall(1.8)], \
        between(depth) + between(1.8)


def figure_at_a_third(generator):
    """A person beside the middle, before a wall."""
    depth = near(generator, 1.2)
    return grid(7, 0.015), [card(0.16 * depth, -0.04, depth, 0.24 * depth, 0.6 * depth), wall(2.2)], between(depth)


def two_figures(generator):
    depths = near(generator, 1.0), near(generator, 1.6)
    cards = [card(side * 0.2 * depth, 0, depth, 0.3 * depth, 0.5 * depth) for side, depth in zip((-1, 1), depths)]
    return grid(7, 0.012), [*cards, wall(4)], between(depths[0]) + between(depths[1])


def figure_on_a_plain(generator):
    """A person on the ground, which reaches to the horizon."""
    depth = near(generator, 4)
    return grid(7, 0.05), [floor(0.8, 1, 30), card(0, 0, depth, 0.4 * depth, 0.4 * depth), wall(30)], between(depth)


def blurred_background(generator):
    """The wall is out of focus in all photographs."""
    depth = near(generator, 1.3)
    return grid(7, 0.02), [card(0, 0, depth, 0.4 * depth, 0.5 * depth), wall(3, cell=0.7)], between(depth)


def high_sensitivity(generator):
    """Much noise."""
    depth = near(generator, 1.3)
    return Capture(grid(7, 0.02), grain=12), [card(0, 0, depth, 0.6 * depth, 0.55 * depth), wall(3)], between(depth)


def automatic_exposure(generator):
    depth = near(generator, 1.3)
    cameras = grid(7, 0.02)
    return Capture(cameras, gains=generator.uniform(0.6, 1.1, len(cameras)).tolist()), \
        [card(0, 0, depth, 0.55 * depth, 0.5 * depth), wall(3)], between(depth)


def street_of_houses(generator):
    """A wall that runs away from the LF cameras; all of it is the subject."""
    turn = np.radians(near(generator, 60))
    front = Quad((0, 0, -2.2), (2.4, 2), ((np.cos(turn), 0, -np.sin(turn)), (0, 1, 0)))
    return grid(7, 0.02), [front], between(1.1, 4.3)


# Lenses

def telephoto(generator):
    depth = near(generator, 8)
    return Capture(grid(7, 0.03), LONG), [card(0, 0, depth, 0.1 * depth, 0.08 * depth), wall(20)], between(depth)


def wide_angle_room(generator):
    depth = near(generator, 1.2)
    sides = [Quad((side * 2, 0, -2), (2.5, 1.5), ((0, 0, -1), (0, 1, 0))) for side in (-1, 1)]
    things = [card(0, 0, depth, 1.0 * depth, 0.9 * depth), *sides, floor(1.2, 0.1, 4), wall(4)]
    return Capture(grid(7, 0.03), WIDE), things, between(depth)


def wide_angle_without_subject(generator):
    """A room that reaches from near to far: everything can be the subject."""
    back = near(generator, 4)
    sides = [Quad((side * 2, 0, -back / 2), (back / 2 + 1, 1.5), ((0, 0, -1), (0, 1, 0))) for side in (-1, 1)]
    return Capture(grid(7, 0.03), WIDE), [*sides, floor(1.2, 0.1, back), wall(back)], between(1.1, back)


def portrait(generator):
    depth = near(generator, 1.4)
    return Capture(grid(7, 0.02), PORTRAIT), [card(0, 0.1, depth, 0.35 * depth, 0.6 * depth), wall(3.5)], between(depth)


# Arrangements

def rows_of_nine(generator):
    depth = near(generator, 1.2)
    return lattice(3, 9, 0.02), [card(0, 0, depth, 0.5 * depth, 0.5 * depth), wall(2.6)], between(depth)


def slider(generator):
    """Fifteen LF cameras in one line."""
    depth = near(generator, 1.2)
    return lattice(1, 15, 0.02), [card(0, 0, depth, 0.5 * depth, 0.5 * depth), wall(2.6)], between(depth)


def loose_grid(generator):
    depth = near(generator, 1.3)
    return shaken(grid(7, 0.03, meeting=2.2), generator, 0.01, 2), \
        [card(0, 0, depth, 0.55 * depth, 0.5 * depth), wall(3)], between(depth)


def arc_of_five_degrees(generator):
    radius = near(generator, 1.4)
    return arc(15, 70, radius), box(0, 0, radius - 0.2, 0.55, 0.5, 0.4), lambda camera: \
        between(*seen_from(camera, (0.27, 0, -radius + 0.2), (-0.27, 0, -radius + 0.2)))


def arc_of_twelve_degrees(generator):
    radius = near(generator, 1.4)
    return arc(9, 96, radius), [*box(0, 0, radius - 0.2, 0.55, 0.5, 0.4), Quad((0, 0, -5), (9, 4))], lambda camera: \
        between(*seen_from(camera, (0.27, 0, -radius + 0.2), (-0.27, 0, -radius + 0.2)))


def spiral_dome(generator):
    radius = near(generator, 1.6)
    return spiral(60, 5, 45, radius), [*box(0, 0, radius - 0.2, 0.6, 0.5, 0.4), wall(5)], lambda camera: between(
        *seen_from(camera, *((x, y, -radius + 0.2) for x in (-0.3, 0.3) for y in (-0.25, 0.25)), (0, 0, -radius - 0.2)))


def gantry_rows(generator):
    """Three rows of eleven on a sphere."""
    radius = near(generator, 1.4)
    cameras = []
    for tilt in np.radians([-8, 0, 8]):
        for turn in np.radians(np.linspace(-25, 25, 11)):
            place = radius * np.array([np.sin(turn) * np.cos(tilt), np.sin(tilt), np.cos(turn) * np.cos(tilt) - 1])
            cameras.append((tuple(place), looking(place, (0, 0, -radius))))
    return cameras, box(0, 0, radius - 0.15, 0.5, 0.45, 0.3), lambda camera: between(
        *seen_from(camera, (0.25, 0.2, -radius + 0.15), (-0.25, -0.2, -radius + 0.15)))


def full_turn(generator):
    """A turntable of 36 steps; seen from above."""
    radius = near(generator, 1.5)
    cameras = []
    for turn in np.linspace(0, 2 * np.pi, 36, endpoint=False):
        place = (radius * np.sin(turn), 0.5, radius * np.cos(turn) - radius)
        cameras.append((place, looking(place, (0, 0, -radius))))
    things = [*box(0, 0, radius - 0.2, 0.5, 0.45, 0.4), card(0, 0, radius + 0.2, 0.5, 0.45)]
    return cameras, things, lambda camera: between(
        *seen_from(camera, *((x, y, -radius + z) for x in (-0.25, 0.25) for y in (-0.2, 0.22) for z in (-0.2, 0.2))))


def looking_outwards(generator):
    """A panorama from a circle: four walls of a room, from which the centre is as far as the path's LF camera says."""
    side = near(generator, 2)
    walls = [Quad((x * side, 0, z * side), (side, 1.5), ((z, 0, -x), (0, 1, 0)), cell=0.05)
             for x, z in ((1, 0), (-1, 0), (0, 1), (0, -1))]
    cameras = []
    for turn in np.linspace(0, 2 * np.pi, 30, endpoint=False):
        place = (0.3 * np.sin(turn), 0.0, -0.3 * np.cos(turn))
        cameras.append((place, looking(place, (2 * place[0], 0, 2 * place[2]))))
    return cameras, walls, lambda camera: between(side - 0.35, np.sqrt(2) * side - 0.25)


def drive_towards_a_wall(generator):
    """The camera moves along its axis."""
    cameras = [((0.01 * generator.standard_normal(), 0.01 * generator.standard_normal(), 0.5 - 0.04 * k), AHEAD)
               for k in range(25)]
    depth = near(generator, 2.2)
    return cameras, [wall(depth)], lambda camera: between(*seen_from(camera, (0, 0, -depth)))


def drive_along_a_corridor(generator):
    cameras = shaken([((0.0, 0.0, 0.6 - 0.05 * k), AHEAD) for k in range(25)], generator, 0.01, 1)
    sides = [Quad((side * 0.9, 0, -3), (4, 1), ((0, 0, -1), (0, 1, 0)), cell=0.05) for side in (-1, 1)]
    end = near(generator, 4)
    return cameras, [*sides, floor(0.8, -2, end, cell=0.05), wall(end)], lambda camera: between(
        1.5, *seen_from(camera, (0, 0, -end)))


def crosshatch_survey(generator):
    """A drone flies lines along both axes, and looks a little ahead."""
    height = near(generator, 50)
    tilted = [[1, 0, 0], [0, np.cos(0.3), np.sin(0.3)], [0, -np.sin(0.3), np.cos(0.3)]]
    cameras = []
    for turn in np.radians([0, 90]):
        heading = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
        cameras += [(tuple(heading @ place), heading @ tilted) for place, _ in survey(5, 9, 4.0)]
    houses = [house for x in (-18, 4, 22) for y in (-14, 9) for house in box(x, y, height - 5, 7, 6, 5)]
    return cameras, [wall(height), *houses], lambda camera: between(0.85 * height, 1.15 * height)


def cloud_of_portraits(generator):
    """Sixty photographs by hand, from anywhere before the subject."""
    depth = near(generator, 1.5)
    cameras = hand_held(60, generator, (0.25, 0.2, 0.1), (0, 0, -depth), 6)
    return Capture(cameras, PORTRAIT), [*box(0, 0, depth, 0.5, 0.7, 0.3), wall(4)], lambda camera: between(
        *seen_from(camera, *((x, y, -depth) for x in (-0.25, 0.25) for y in (-0.35, 0.35)), (0, 0, -depth - 0.3)))


def five_photographs(generator):
    depth = near(generator, 1.3)
    places = [(0, 0), (-0.05, 0), (0.05, 0), (0, -0.05), (0, 0.05)]
    return [((x, y, 0.0), AHEAD) for x, y in places], [card(0, 0, depth, 0.6 * depth, 0.5 * depth), wall(3)], \
        between(depth)


def six_photographs(generator):
    depth = near(generator, 1.3)
    return lattice(2, 3, 0.06, meeting=2), [card(0, 0, depth, 0.6 * depth, 0.5 * depth), wall(3)], between(depth)


def nine_photographs(generator):
    depth = near(generator, 1.3)
    return grid(3, 0.12, meeting=2), [card(0, 0, depth, 0.6 * depth, 0.55 * depth), wall(2.6)], between(depth)


def bursts(generator):
    """Each pose was photographed twice."""
    depth = near(generator, 1.3)
    return [camera for camera in grid(5, 0.02) for _ in range(2)], \
        [card(0, 0, depth, 0.55 * depth, 0.5 * depth), wall(3)], between(depth)


def huge_units(generator):
    """World units are millimetres."""
    depth = near(generator, 1300)
    return grid(7, 20), [card(0, 0, depth, 0.55 * depth, 0.5 * depth), Quad((0, 0, -2800), (5e3, 5e3))], between(depth)


def shaky_calibration(generator):
    """Directions are off by about half a pixel."""
    depth = near(generator, 1.3)
    cameras = grid(7, 0.02)
    return Capture(cameras, drawn=shaken(cameras, generator, 0, 0.13)), \
        [card(0, 0, depth, 0.55 * depth, 0.5 * depth), wall(3)], between(depth)


def nothing_in_common(generator):
    """Photographs of walls that do not overlap."""
    depth = near(generator, 1.5)
    cameras = lattice(1, 9, 3.0)
    return cameras, [card(x, 0, depth, 2.9, 8, seed=k) for k, ((x, _, _), _) in enumerate(cameras)], None


def long_track(generator):
    """A hand-held camera moves past objects at many depths; the nearest large ones are the subject."""
    row = [card(x, -0.1, generator.uniform(1.3, 1.7), 0.5, 0.6) for x in np.arange(-2.4, 2.5, 0.6)]
    return track(61, 0.03, generator, sway=1.5), [*row, wall(4)], between(1.3, 1.7)


KINDS = [
    view_from_a_window, branches_before_the_subject, snow_before_the_subject, table_top, few_patches, checked_wall,
    striped_wall, card_before_checks, glossy_side, mirror_in_the_middle, leaves_in_wind, only_water, white_statue,
    figure_at_a_third, two_figures, figure_on_a_plain, blurred_background, high_sensitivity, automatic_exposure,
    street_of_houses, telephoto, wide_angle_room, wide_angle_without_subject, portrait, rows_of_nine, slider,
    loose_grid, arc_of_five_degrees, arc_of_twelve_degrees, spiral_dome, gantry_rows, full_turn, looking_outwards,
    drive_towards_a_wall, drive_along_a_corridor, crosshatch_survey, cloud_of_portraits, five_photographs,
    six_photographs, nine_photographs, bursts, huge_units, shaky_calibration, nothing_in_common, long_track]
