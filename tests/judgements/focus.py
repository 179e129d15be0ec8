# SPDX-License-Identifier: Apache-2.0
"""Captures whose subject, and whose depths, are known: for the questions where to focus and how wide the lens may be.

A kind is a function of a random generator. It returns (cameras, quads, the depths between which the subject lies, a
function of the LF camera at which the path starts that returns them, or None if no depth can be found).
"""
import dataclasses
import re

import numpy as np

from judgements.captures import NOT_SURE, RIGHT, WRONG
from judgements.scenes import Capture, arc, capture_of, card, dome, grid, hits, survey, track, wall

TOLERANCE = 0.04  # of the focus distance
SUBJECT = 11  # Quad.seed of rectangles that are the subject


class Hidden(list):
    """Depths that no program needs to find: a sure focus must lie there, but an unsure one may be anywhere."""


def between(*depths):
    return [(min(depths) * (1 - TOLERANCE), max(depths) * (1 + TOLERANCE))]


def near(generator, value, share=0.15):
    return value * (1 + share * generator.uniform(-1, 1))


# Grids

def wall_alone(generator):
    depth = near(generator, 1.5)
    return grid(7, 0.02), [wall(depth)], between(depth)


def dense_wall(generator):
    depth = near(generator, 2)
    return grid(9, 0.006), [wall(depth)], between(depth)


def card_before_wall(generator):
    depth = near(generator, 1)
    return grid(7, 0.02), [card(0, 0, depth, 0.42 * depth, 0.4 * depth), wall(2.6)], between(depth)


def small_card_before_wall(generator):
    depth = near(generator, 1)
    return grid(7, 0.012), [card(0, 0, depth, 0.3 * depth, 0.3 * depth), wall(2.6)], between(depth)


def card_at_the_side(generator):
    """A large near card beside the middle, a wall farther away in the middle: both can be the subject."""
    depth = near(generator, 1)
    return grid(7, 0.015), [card(-0.27 * depth, 0, depth, 0.35 * depth, 0.6 * depth), wall(2)], \
        between(depth) + between(2)


def empty_middle(generator):
    """Two posts; nothing is seen between them."""
    depth = near(generator, 1.2)
    posts = [card(side * 0.3 * depth, 0, depth, 0.22 * depth, 0.6 * depth) for side in (-1, 1)]
    return grid(7, 0.02), posts, between(depth)


def empty_middle_before_wall(generator):
    depth = near(generator, 1.2)
    posts = [card(side * 0.3 * depth, 0, depth, 0.22 * depth, 0.6 * depth) for side in (-1, 1)]
    return grid(7, 0.015), [*posts, wall(4, contrast=0, grey=0.4)], between(depth)


def meeting_behind(generator):
    """The object is nearer than where the axes meet."""
    depth = near(generator, 1.3)
    return grid(7, 0.03, meeting=2.4), [card(0, 0, depth, 0.5 * depth, 0.45 * depth), wall(5)], between(depth)


def meeting_before(generator):
    """The object is farther than where the axes meet."""
    depth = near(generator, 2.2)
    return grid(7, 0.03, meeting=1.2), [wall(depth)], between(depth)


def many_depths(generator):
    """Cards at ten depths, of which the nearer ones are in the middle; the axes meet behind all but one."""
    depths = np.linspace(1.0, 1.5, 5) * near(generator, 1)
    cards = [card((k - 2) * 0.13 * depth, 0.02 * (k - 2), depth, 0.14 * depth, 0.5 * depth)
             for k, depth in enumerate(depths)]
    behind = [card(0, side * 0.3 * depth, depth, 0.9 * depth, 0.16 * depth) for side, depth in ((-1, 1.9), (1, 2.3))]
    return grid(7, 0.02, meeting=2.6), cards + behind, between(depths[0], depths[-1])


def slanted(generator):
    """A table that reaches from near to far; all of it is the subject, and the axes meet far behind."""
    depth = near(generator, 1.6)
    table = card(0, 0, depth, 2.2, 2.6)
    table.axes = ((1, 0, 0), (0, 0.5, -np.sqrt(0.75)))
    return grid(7, 0.02, meeting=4), [table], between(0.72 * depth, 1.5 * depth)


def far_wall(generator):
    depth = near(generator, 9)
    return grid(9, 0.03), [wall(depth)], between(depth)


def weak_texture(generator):
    depth = near(generator, 1.5)
    return grid(7, 0.02), [wall(depth, contrast=0.12)], between(depth)


def no_texture(generator):
    return grid(5, 0.02), [wall(near(generator, 1.5), contrast=0)], None


def only_grain(generator):
    return grid(5, 0.02), [wall(near(generator, 1.5), contrast=0.004)], None


def smooth_card_before_wall(generator):
    """The subject has little texture; the wall behind has more."""
    depth = near(generator, 1)
    return grid(7, 0.02), [card(0, 0, depth, 0.55 * depth, 0.5 * depth, contrast=0.2), wall(2.4)], between(depth)


def sparse_wall(generator):
    """Neighbours are 8 degrees apart."""
    depth = near(generator, 1)
    return grid(5, 0.14), [wall(depth)], between(depth)


def sparse_deep_scene(generator):
    """Objects at many depths, 6 degrees apart: neighbours do not agree everywhere."""
    cards = [card(generator.uniform(-0.5, 0.5) * d, generator.uniform(-0.35, 0.35) * d, d, 0.16 * d, 0.16 * d)
             for d in np.linspace(0.75, 2.5, 14)]
    return grid(5, 0.1), [card(0, 0, 0.9, 0.25, 0.25), *cards, wall(4)], between(0.75, 1.1)


def three_by_three(generator):
    depth = near(generator, 1.5)
    return grid(3, 0.02), [wall(depth)], between(depth)


def few_cards(generator):
    """Little to see: some small cards at other depths than where the axes meet, the nearer ones in the middle."""
    depths = generator.uniform(2.0, 2.3, 7)
    cards = [card(x * d, y * d, d, 0.11 * d, 0.11 * d) for d, (x, y) in
             zip(depths, [(0, 0), (-0.15, 0.1), (0.16, 0.07), (0.02, 0.17), (-0.12, -0.12), (0.13, -0.14), (0, -0.2)])]
    return grid(7, 0.03, meeting=3.84), cards, between(2.0, 2.3)


def cloud(generator):
    """Cards everywhere, from near to far; most of them stand before the wall."""
    cards = [card(generator.uniform(-0.5, 0.5) * d, generator.uniform(-0.35, 0.35) * d, d, 0.15 * d, 0.15 * d)
             for d in np.geomspace(0.9, 3, 24)]
    return grid(7, 0.015), [*cards, wall(5)], between(0.9, 3)


def fence_before_wall(generator):
    """Thin bars all over the picture: the bars, or the wall behind them, are the subject."""
    bars = [card(x, 0, 0.8, 0.035, 2) for x in np.arange(-0.4, 0.41, 0.1)]
    depth = near(generator, 2)
    return grid(7, 0.012), [*bars, wall(depth)], between(0.8) + between(depth)


def too_far(generator):
    """Nothing moves by a pixel from one LF camera to any other."""
    return grid(5, 0.02), [wall(near(generator, 80))], None


def wrong_poses(generator):
    """The images belong to other poses: no depth can be found."""
    cameras = grid(7, 0.05)
    order = generator.permutation(len(cameras))
    return Capture(cameras, drawn=[cameras[k] for k in order]), [wall(near(generator, 1.2))], None


def grainy(generator):
    depth = near(generator, 1.4)
    return Capture(grid(7, 0.02), grain=6), \
        [card(0, 0, depth, 0.6 * depth, 0.55 * depth, contrast=0.4), wall(3, contrast=0.4)], between(depth)


# Arcs and domes

def turntable(generator):
    """An object before nothing, where the axes meet."""
    radius = near(generator, 1.2)
    return arc(31, 40, radius), [card(0, 0, radius, 0.5 * radius, 0.45 * radius)], between(radius)


def arc_with_object_before_the_meeting(generator):
    return arc(31, 36, 2.0), [card(0, 0, near(generator, 1.3), 0.6, 0.5), wall(4)], between(1.3 * 0.85, 1.3 * 1.15)


def arc_with_object_behind_the_meeting(generator):
    depth = near(generator, 1.9)
    return arc(31, 36, 1.2), [card(0, 0, depth, 1.2, 1.0)], between(depth)


def sparse_turntable(generator):
    """Cameras are 9 degrees apart."""
    radius = near(generator, 1.2)
    return arc(9, 72, radius), [card(0, 0, radius, 0.5 * radius, 0.45 * radius)], between(radius)


def dense_dome(generator):
    radius = near(generator, 1.5)
    return dome(61, 24, radius), [card(0, 0, radius, 0.55 * radius, 0.45 * radius), wall(3.2)], between(radius)


def dome_around_more(generator):
    """The object is nearer than the middle of the dome."""
    depth = near(generator, 1.1)
    return dome(61, 24, 1.9), [card(0, 0, depth, 0.5 * depth, 0.4 * depth), wall(3.2)], between(depth)


# Tracks and surveys

def video_track(generator):
    depth = near(generator, 1.5)
    return track(41, 0.02, generator, sway=1), [card(0, 0, depth, 0.6 * depth, 0.5 * depth), wall(4)], between(depth)


def track_past_a_wall(generator):
    depth = near(generator, 2)
    return track(31, 0.04, generator, sway=2), [wall(depth)], between(depth)


def coarse_track(generator):
    depth = near(generator, 1.2)
    return track(15, 0.12, generator, sway=2), [card(0, 0, depth, 0.6 * depth, 0.5 * depth), wall(2.2)], between(depth)


def drone_survey(generator):
    height = near(generator, 40)
    houses = [card(x, y, height - 4, 6, 5) for x in (-16, 3, 19) for y in (-9, 8)]
    return survey(7, 9, 3.0), [wall(height), *houses], between(height, height - 4)


def flat_survey(generator):
    height = near(generator, 60)
    return survey(5, 9, 9.0), [wall(height)], between(height)


KINDS = [
    wall_alone, dense_wall, card_before_wall, small_card_before_wall, card_at_the_side, empty_middle,
    empty_middle_before_wall, meeting_behind, meeting_before, many_depths, slanted, far_wall, weak_texture, no_texture,
    only_grain, smooth_card_before_wall, sparse_wall, sparse_deep_scene, three_by_three, few_cards, cloud,
    fence_before_wall, too_far, wrong_poses, grainy, turntable,
    arc_with_object_before_the_meeting, arc_with_object_behind_the_meeting, sparse_turntable, dense_dome,
    dome_around_more, video_track, track_past_a_wall, coarse_track, drone_survey, flat_survey]


@dataclasses.dataclass
class Said:
    """The answer of lfexample."""
    start: int  # the LF camera at which the path starts
    focus: float
    aperture: float
    is_sure: bool
    candidates: list
    is_lens_sure: bool

    @classmethod
    def of(cls, path_yaml, stderr):
        def number(pattern, text):
            return float(re.search(pattern, text)[1])
        listed = re.search(r"best focus distances? found: ([^:]*?)\. To", stderr)
        return cls(int(number(r"starts at LF camera (\d+)", path_yaml)), number(r"focus at ([\d.e+-]+)", stderr),
                   number(r"aperture_diameter: (\S+)", path_yaml), "not sure what to focus on" not in stderr,
                   [float(one) for one in listed[1].split(", ")] if listed else [],
                   "not sure how wide" not in stderr)


def is_within(distance, depths):
    return any(low <= distance <= high for low, high in depths)


def is_sharp(said, depths, focal_px):
    """Returns true if the chosen lens blurs the nearest or farthest point of one of the subjects by less than a
    pixel: nearer together than that, depths cannot be told by pixels, and need not be."""
    return any(focal_px * said.aperture * abs(1 / said.focus - 1 / edge) < 1
               for low, high in depths for edge in (low / (1 - TOLERANCE), high / (1 + TOLERANCE)))


def judge_focus(said, depths, cameras):
    """A sure focus must lie on the subject. In doubt, a depth of the subject must be among the candidates, if there is
    one that can be found."""
    if depths is None:
        return WRONG if said.is_sure else RIGHT
    if said.is_sure:
        is_open = said.aperture > 0.005 * said.focus
        is_near = is_open and is_sharp(said, depths, capture_of(cameras).lens.focal_px)
        return RIGHT if is_within(said.focus, depths) or is_near else WRONG
    return NOT_SURE if isinstance(depths, Hidden) or any(is_within(one, depths) for one in said.candidates) else WRONG


def depths_seen(camera, quads, lens):
    """Returns the depths that a camera sees where there is texture, along its axis, at every fourth pixel."""
    position, rotation = camera
    rays = lens.rays(*np.meshgrid(np.arange(2, lens.width, 4) + 0.5, np.arange(2, lens.height, 4) + 0.5))
    nearest, number, _ = hits(position, rays @ np.asarray(rotation, float).T, quads)
    textured = [index for index, quad in enumerate(quads) if quad.contrast > 0.05]
    return nearest[np.isin(number, textured)]


def judge_aperture(said, cameras, quads):
    """Returns the verdict about the aperture, and the reason."""
    positions = np.array([position for position, _ in cameras])
    position, rotation = cameras[said.start]
    positions = np.unique(positions.round(9), axis=0)
    spacing = np.median([np.sort(np.linalg.norm(positions - one, axis=1))[1] for one in positions])
    # Each LF camera, seen from the focus, in the plane of the lens.
    focus = np.asarray(position) - said.focus * rotation[:, 2]
    offsets = (positions - focus) @ rotation
    in_lens = offsets[:, :2] * (said.focus / np.maximum(offsets[:, 2:], 1e-9))
    radii = np.sort(np.linalg.norm(in_lens, axis=1))
    count = np.count_nonzero(radii <= said.aperture / 2)
    may_open = len(radii) >= 6 and 2 * radii[5] < 0.24 * said.focus
    is_open = said.aperture > 0.5 * spacing or count >= 6
    if is_open and count < 6:
        return WRONG, f"a lens of {count} LF cameras"
    if is_open and said.aperture > 0.26 * said.focus:
        return WRONG, f"a lens {said.aperture / said.focus:.2f} as wide as the focus is far"
    lens = capture_of(cameras).lens
    depths = depths_seen(cameras[said.start], quads, lens)
    if len(depths) == 0:
        return (WRONG if is_open else RIGHT), "nothing to see"
    copies = np.quantile(lens.focal_px * spacing * np.abs(1 / depths - 1 / said.focus), 0.8)
    words = f"{'open' if is_open else 'closed'}, {count} LF cameras, copies {copies:.1f} px apart"
    if is_open:
        return (WRONG if copies > 20 else RIGHT), words
    if not (said.is_sure and said.is_lens_sure):
        return NOT_SURE, words
    return (WRONG if copies < 6 and may_open else RIGHT), words
