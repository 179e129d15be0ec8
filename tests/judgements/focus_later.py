# SPDX-License-Identifier: Apache-2.0
"""More captures whose subject is known, which were drawn for half D alone. They are made like those of focus.py."""
import numpy as np

from judgements.focus import between, near
from judgements.focus_unseen import crosshatch_survey, seen_from
from judgements.scenes import AHEAD, Capture, arc, card, grid, lattice, looking, shaken, wall


def inaccurate_crosshatch(generator):
    """Crossing lines of a drone, whose positions never repeat exactly."""
    cameras, quads, depths = crosshatch_survey(generator)
    return shaken(cameras, generator, 0.4, 1), quads, depths


def vertical_line(generator):
    depth = near(generator, 1.2)
    return lattice(15, 1, 0.02), [card(0, 0, depth, 0.5 * depth, 0.45 * depth), wall(2.6)], between(depth)


def ring_of_cameras(generator):
    """A circle that looks ahead; nothing stands in its middle."""
    depth = near(generator, 1.3)
    turns = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    return [((0.1 * np.cos(turn), 0.1 * np.sin(turn), 0.0), AHEAD) for turn in turns], \
        [card(0, 0, depth, 0.6 * depth, 0.5 * depth), wall(3)], between(depth)


def uneven_grid(generator):
    """Columns are three times as far apart as rows."""
    depth = near(generator, 1.3)
    cameras = [((3 * x, y, z), rotation) for (x, y, z), rotation in grid(7, 0.012)]
    return cameras, [card(0, 0, depth, 0.55 * depth, 0.5 * depth), wall(2.8)], between(depth)


def grid_with_gaps(generator):
    depth = near(generator, 1.3)
    cameras = grid(7, 0.02)
    kept = sorted(generator.permutation(len(cameras))[:28].tolist())
    return [cameras[k] for k in kept], [card(0, 0, depth, 0.55 * depth, 0.5 * depth), wall(2.8)], between(depth)


def hexagons(generator):
    depth = near(generator, 1.3)
    return [((x + 0.01 * (round(y / 0.02) % 2), 0.866 * y, z), rotation) for (x, y, z), rotation in grid(7, 0.02)], \
        [card(0, 0, depth, 0.55 * depth, 0.5 * depth), wall(2.8)], between(depth)


def close_up(generator):
    """A small thing very near, before an unsharp room."""
    depth = near(generator, 0.3)
    return grid(9, 0.002), [card(0, 0, depth, 0.6 * depth, 0.5 * depth), wall(2, cell=0.5)], between(depth)


def stairs(generator):
    """Steps from near to far; all of them are the subject."""
    steps = [card(0, (k - 2) * 0.17 * d, d, 1.2 * d, 0.18 * d) for k, d in enumerate(np.linspace(1.1, 1.9, 5))]
    return grid(7, 0.02), [*steps, wall(4)], between(1.1, 1.9)


def crowd(generator):
    """People everywhere; those in front are the subject, or all of them."""
    people = [card(generator.uniform(-0.45, 0.45) * d, -0.08 * d, d, 0.16 * d, 0.45 * d)
              for d in np.linspace(1.2, 3, 16)]
    return grid(7, 0.02), [*people, wall(6)], between(1.2, 3)


def relief(generator):
    """A picture hangs hardly before its wall."""
    depth = near(generator, 1.5)
    picture = card(0, 0, 0.94 * depth, 0.5 * depth, 0.5 * depth)
    return grid(7, 0.02), [picture, wall(depth)], between(0.94 * depth, depth)


def dim_light(generator):
    """Weak texture and noise."""
    depth = near(generator, 1.3)
    return Capture(grid(7, 0.02), grain=3), \
        [card(0, 0, depth, 0.6 * depth, 0.55 * depth, contrast=0.2), wall(3, contrast=0.2)], between(depth)


def subject_in_a_corner(generator):
    """All but a corner is empty."""
    depth = near(generator, 1.3)
    return grid(7, 0.02), [card(-0.27 * depth, -0.19 * depth, depth, 0.36 * depth, 0.3 * depth),
                           wall(3, contrast=0)], between(depth)


def walk_around_a_corner(generator):
    """A hand-held camera walks to the right, then ahead, and always looks at the object."""
    depth = near(generator, 1.8)
    places = [(0.03 * (k - 20), 0.0, 0.3) for k in range(20)] + [(0.0, 0.0, 0.3 - 0.03 * k) for k in range(20)]
    cameras = shaken([(place, looking(place, (0, 0, -depth))) for place in places], generator, 0.006, 1)
    return cameras, [card(0, 0, depth, 0.6 * depth, 0.5 * depth), wall(4)], lambda camera: between(
        *seen_from(camera, *((x, y, -depth) for x in (-0.3 * depth, 0.3 * depth) for y in (-0.3, 0.3))))


def seven_on_an_arc(generator):
    radius = near(generator, 1.3)
    return arc(7, 12, radius), [card(0, 0, radius, 0.55 * radius, 0.5 * radius), wall(3)], between(radius)


def swarm_of_leaves(generator):
    """Many small leaves at all depths before the sky."""
    leaves = [card(generator.uniform(-0.5, 0.5) * d, generator.uniform(-0.37, 0.37) * d, d, 0.1 * d, 0.1 * d)
              for d in generator.uniform(1.2, 2.0, 60)]
    return grid(7, 0.02), [*leaves, wall(30, contrast=0, grey=0.8)], between(1.2, 2.0)


KINDS = [
    inaccurate_crosshatch, vertical_line, ring_of_cameras, uneven_grid, grid_with_gaps, hexagons, close_up, stairs,
    crowd, relief, dim_light, subject_in_a_corner, walk_around_a_corner, seven_on_an_arc, swarm_of_leaves]
