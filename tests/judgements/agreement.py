# SPDX-License-Identifier: Apache-2.0
"""Captures and mistakes in them with which no threshold of the agreement of images and poses was chosen, and a measure
of its own of whether a mistake matters: places of the drawn scene are followed through the recorded poses.

A capture is a function of a random generator that returns (cameras, quads, names of the files or None).
"""
import json
import pathlib

import cv2
import numpy as np

from judgements.captures import NOT_SURE, RIGHT, WRONG
from judgements.scenes import (AHEAD, Capture, Lens, Quad, arc, box, card, grid, hand_held, hits, lattice, looking,
                               shaken, spiral, survey, wall)
from pose_mistakes import MISTAKES, MORE_MISTAKES

LENS = Lens(320, 240, 300)
INTRINSICS = {"focal-in-mm", "focal-of-width", "all-normalised", "focal-half", "focal-twice",
              "principal-point-swapped", "opencv-axes-and-focal-half", "reduced-images-and-sizes"}
HARMLESS = {"none", "reduced-images", "turned-world", "scaled-world"}
COMBINED = {"inverse-and-names-ahead", "mirrored-opencv-axes", "opencv-axes-and-focal-half"}  # one may be undone first
# Places that images and poses explain by less than two pixels. If fewer than half of the places are explained, the
# answer may not be that images and poses agree. If it is that they do not agree, the repair must explain most of them.
EXPLAINED_PX, MOST = 2.0, 0.9


def room(generator, far, width=1.6):
    """Walls, a floor and boxes, from near to far."""
    sides = [Quad((side * width, 0, -far / 2), (far / 2 + 1, 2), ((0, 0, -1), (0, 1, 0)), cell=0.04)
             for side in (-1, 1)]
    floor = Quad((0, -1, -far / 2), (4, far / 2 + 1), ((1, 0, 0), (0, 0, -1)), cell=0.04)
    things = []
    for depth in np.linspace(0.35, 0.75, 4) * far:
        x, y = generator.uniform(-0.35, 0.35) * depth, generator.uniform(-0.5, 0.2)
        things += box(x, y, depth, 0.5, 0.5, 0.4, cell=0.03)
    return [*sides, floor, *things, wall(far)]


def drive(generator):
    """A camera moves along its axis through a room."""
    cameras = shaken([((0.0, 0.0, 0.7 - 0.06 * k), AHEAD) for k in range(24)], generator, 0.02, 2.5)
    return Capture(cameras, LENS), room(generator, 4.5), None


def spiral_around_things(generator):
    things = box(0, 0, 1.8, 0.7, 0.6, 0.6) + box(-0.7, -0.1, 1.6, 0.3, 0.4, 0.3) + box(0.6, 0.1, 2.3, 0.3, 0.5, 0.3)
    return Capture(spiral(36, 4, 40, 2.1), LENS), [*things, wall(4)], None


def portraits_by_hand(generator):
    cameras = hand_held(30, generator, (0.35, 0.3, 0.15), (0, 0, -2), 5)
    return Capture(cameras, Lens(240, 320, 300)), room(generator, 4), \
        [f"IMG_{4000 + 7 * k}.png" for k in generator.permutation(30)]


def wide_lens_with_distortion(generator):
    cameras = shaken(lattice(5, 5, 0.12), generator, 0.04, 4)
    return Capture(cameras, Lens(320, 240, 150, k1=-0.08)), room(generator, 3.5), None


def survey_from_above(generator):
    """Lines of a drone, whose gimbal holds the camera level but for two degrees."""
    houses = [side for x in (-14, 0, 12) for y in (-8, 7) for side in
              box(x + generator.uniform(-2, 2), y, 32, 6, 5, 8, cell=0.7)]
    return Capture(shaken(survey(5, 7, 4.0), generator, 0.3, 2), LENS), [wall(40), *houses], None


def nine_photographs(generator):
    return Capture(grid(3, 0.16, meeting=2), LENS), room(generator, 3.5), None


def little_texture(generator):
    """Walls with few pictures on them, on an arc."""
    things = [wall(3, contrast=0.04), *box(0.1, 0, 1.7, 0.5, 0.4, 0.3, contrast=0.12)]
    pictures = [card(x, y, 2.99 - 0.2 * abs(x), 0.25, 0.2, contrast=0.3) for x in (-0.8, -0.3, 0.5)
                for y in (-0.5, 0.6)]
    return Capture(arc(20, 40, 2), LENS), [*things, *pictures], None


def slider(generator):
    """Fifteen parallel cameras in one line."""
    return Capture(lattice(1, 15, 0.05), LENS), room(generator, 4), None


KINDS = [drive, spiral_around_things, portraits_by_hand, wide_lens_with_distortion, survey_from_above,
         nine_photographs, little_texture, slider]


# Captures of half D alone

def walk_by_hand(generator):
    """A hand-held camera walks along a room, and looks to the side."""
    cameras = []
    for k in range(28):
        place = (0.09 * (k - 14), 0.02 * generator.standard_normal(), 0.03 * generator.standard_normal())
        cameras.append((place, looking(place, (0.3 * place[0], -0.1, -2.5))))
    return Capture(shaken(cameras, generator, 0.01, 2), LENS), room(generator, 4, 2.4), None


def turntable_of_portraits(generator):
    """A full turn of 30 steps, from above, before nothing."""
    cameras = []
    for turn in np.linspace(0, 2 * np.pi, 30, endpoint=False):
        place = (1.8 * np.sin(turn), 0.7, 1.8 * np.cos(turn) - 1.8)
        cameras.append((place, looking(place, (0, 0, -1.8))))
    things = [*box(0, 0, 1.45, 0.6, 0.6, 0.7), card(0, 0, 2.15, 0.6, 0.6),
              *box(0.45, -0.15, 1.6, 0.2, 0.3, 0.25), *box(-0.4, -0.2, 1.75, 0.2, 0.2, 0.2),
              Quad((0, -0.31, -1.8), (1, 1), ((1, 0, 0), (0, 0, -1)), cell=0.04)]
    return Capture(cameras, Lens(240, 320, 420)), things, None


def dense_loose_grid(generator):
    return Capture(shaken(lattice(6, 6, 0.05, meeting=2.2), generator, 0.01, 1.5), LENS), room(generator, 3.5), None


LATER_KINDS = [walk_by_hand, turntable_of_portraits, dense_loose_grid]


def mistakes_for(index, count):
    """Returns `count` of the mistakes for the capture with this index, others for each; the capture without a mistake
    is the first."""
    names = [name for name in [*MISTAKES, *MORE_MISTAKES] if name != "none"]
    return ["none", *(names[(index * count + k) % len(names)] for k in range(count - 1))]


class Camera:
    """A frame of a transforms.json, read anew."""

    def __init__(self, field, frame):
        matrix = np.array(frame["transform_matrix"], float)
        self.position, self.rotation = matrix[:3, 3], matrix[:3, :3]

        def number(key, default):
            return float(frame.get(key, field.get(key, default)))
        w, h, fx = number("w", 0), number("h", 0), number("fl_x", 0)
        self.matrix = np.array([[fx, 0, number("cx", w / 2)], [0, number("fl_y", fx), number("cy", h / 2)], [0, 0, 1]])
        self.distortion = np.array([number(key, 0) for key in ("k1", "k2", "p1", "p2", "k3")])

    def ray(self, at):
        if self.distortion.any():
            x, y = cv2.undistortPoints(np.array([[at]], float), self.matrix, self.distortion)[0, 0]
        else:
            x, y = (at[0] - self.matrix[0, 2]) / self.matrix[0, 0], (at[1] - self.matrix[1, 2]) / self.matrix[1, 1]
        return self.rotation @ (x, -y, -1)

    def seen_at(self, point):
        """Returns the position in pixels of a point of the world; None behind the camera."""
        x, y, z = self.rotation.T @ (point - self.position)
        if z > -1e-9:
            return None
        if not self.distortion.any():
            return (self.matrix @ (x / -z, y / z, 1))[:2]
        at, _ = cv2.projectPoints(np.array([[[x, -y, -z]]]), np.zeros(3), np.zeros(3), self.matrix, self.distortion)
        return at[0, 0]


def cameras_of(folder):
    """Returns the cameras of a transforms.json by the names of their images."""
    field = json.loads((folder / "transforms.json").read_text())
    return {pathlib.Path(frame["file_path"]).name: Camera(field, frame) for frame in field["frames"]}


def tracks_of(source, quads, generator):
    """Returns places of the drawn scene as the images show them: lists of (name, pixel), with the LF image that they
    are followed from as the first."""
    cameras = cameras_of(source)
    names = sorted(cameras)
    tracks = []
    for name in names[::max(1, len(names) // 7)]:
        camera = cameras[name]
        far = sorted(names, key=lambda one: np.linalg.norm(cameras[one].position - camera.position))[1:7]
        for _ in range(15):
            w, h = 2 * camera.matrix[0, 2], 2 * camera.matrix[1, 2]
            at = generator.uniform(0.05, 0.95, 2) * (w, h)
            t, number, _ = hits(camera.position, camera.ray(at)[None], quads)
            if number[0] < 0 or quads[number[0]].contrast < 0.03:
                continue
            point = camera.position + t[0] * camera.ray(at)
            track = [(name, at)]
            for other in far:
                there = cameras[other].seen_at(point)
                if there is None or not (0 < there[0] < w and 0 < there[1] < h):
                    continue
                along, _, _ = hits(cameras[other].position, (point - cameras[other].position)[None], quads)
                if along[0] > 0.995 and np.linalg.norm(there - at) > 2:
                    track.append((other, there))
            if len(track) > 2:
                tracks.append(track)
    return tracks


def moved(mistake, at, size):
    """Returns where a position in an image lies after the mistake has changed the image."""
    (x, y), (w, h) = at, size
    return {"mirrored": (w - x, y), "mirrored-opencv-axes": (w - x, y), "upside-down": (x, h - y),
            "turned-by-180": (w - x, h - y), "turned-clockwise": (h - y, x), "turned-anticlockwise": (y, w - x),
            "reduced-images-and-sizes": (x / 2, y / 2)}.get(mistake, at)


def explained_share(folder, tracks, mistake, size):
    """Returns the share of the places that a transforms.json explains: three quarters of the LF images show them where
    one point of the world would be seen."""
    cameras = cameras_of(folder)
    good = all_of_them = 0
    for track in tracks:
        seen = [(cameras[name], np.array(moved(mistake, at, size))) for name, at in track if name in cameras]
        if len(seen) < 3 or track[0][0] not in cameras:
            continue
        all_of_them += 1
        first, at = seen[0]
        ray = first.ray(at)
        best = np.inf
        for other, there in seen[1:]:  # the point of the ray nearest to the ray of another LF image
            sight = other.ray(there)
            across = np.cross(ray, sight)
            if across @ across < 1e-18:
                continue
            along = np.cross(other.position - first.position, sight) @ across / (across @ across)
            point = first.position + along * ray
            errors = []
            for one, place in seen:
                found = one.seen_at(point)
                errors.append(np.inf if found is None else np.linalg.norm(found - place))
            best = min(best, np.sort(errors)[int(np.ceil(0.75 * len(errors))) - 1])
        good += best < EXPLAINED_PX
    return good / max(1, all_of_them)


def judge(report, mistake, share, repaired_share):
    """Returns the verdict about what lfimport --json says, and the reason.
        report          None if lfimport refuses the calibration
        share           of the places that the recorded poses explain
        repaired_share  the same after the printed repair; None if there is none"""
    if report is None:
        return (RIGHT if mistake == "camera-y-negated" else WRONG), "refused"
    agreement = report["agreement"]
    said = agreement["verdict"]
    words = f"{said}, explained {share:.2f}" + ("" if repaired_share is None else f", repaired {repaired_share:.2f}")
    if said == "not-sure":
        return NOT_SURE, words
    if said == "agree":
        if mistake in INTRINSICS and not agreement["tells_intrinsics"] or \
                "names" in mistake and not agreement["tells_order"]:
            return NOT_SURE, words
        return (WRONG if share < 0.5 else RIGHT), words
    undone = repaired_share >= max(MOST, share) or mistake in COMBINED and repaired_share > share + 0.2
    return (RIGHT if undone and mistake not in HARMLESS else WRONG), words
