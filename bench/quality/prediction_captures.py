# SPDX-License-Identifier: Apache-2.0
"""Groups of 4 x 4 LF images for prediction_gain.py, with calibrations, and the frames that are compared."""
import dataclasses
import json
import pathlib
import re

import cv2
import numpy as np

import densify_captures
import prediction_model as model
from quality import results

SIDE = 256  # of the parts of LF images that are coded, at most
GRID = 4
NOISE = 2.5  # standard deviation, in grey steps
MARGIN = 24  # of frames that is not compared, because not all LF images show it


@dataclasses.dataclass
class Capture:
    """A group of LF images, row by row.

    pictures       uint8 [height][width][3 or 4] (prediction_model.py)
    clean          the same without noise, or the same list
    intrinsics     K of each, [3][3]; pixel (0, 0) has its centre at (0.5, 0.5)
    rotations, translations   x_camera = R x_world + t; OpenCV's axes
    inverse_depths            the least and the most
    focus                     distances at which frames are focused
    """
    pictures: list
    clean: list
    intrinsics: list
    rotations: list
    translations: list
    inverse_depths: tuple
    focus: tuple

    def centres(self):
        return np.array([-r.T @ t for r, t in zip(self.rotations, self.translations)])

    def homography(self, target, reference):
        """Returns A, b: the pixel x of the target at the inverse depth d is at A x + d b in the reference.

        target  a number, or (K, R, t)
        """
        k, r, t = self.pose(target) if isinstance(target, int) else target
        k_r, r_r, t_r = self.pose(reference)
        turn = r_r @ r.T
        return k_r @ turn @ np.linalg.inv(k), k_r @ (t_r - turn @ t)

    def pose(self, number):
        return self.intrinsics[number], self.rotations[number], self.translations[number]

    def frames(self, pictures):
        """Returns frames of a camera in the middle, as display values 0 to 255: means in linear light."""
        pictures = [model.colours_of(picture) for picture in pictures]
        height, width = pictures[0].shape[:2]
        middle = int(np.argmin(np.linalg.norm(self.centres() - self.centres().mean(0), axis=1)))
        scale = width / self.pictures[0].shape[1]  # 2 for mosaics
        k, r, _ = self.pose(middle)
        pose = k, r, -r @ self.centres().mean(0)
        linear = [_LINEAR[picture] for picture in pictures]
        frames = []
        for distance in self.focus:
            total = 0
            for number, picture in enumerate(linear):
                a, b = self.homography(pose, number)
                total = total + warped(picture, a + np.outer(b, (0, 0, 1 / distance)), cv2.INTER_CUBIC, scale)
            mean = np.clip(total / len(linear), 0, 1)
            frames.append(255 * np.where(mean <= 0.0031308, 12.92 * mean, 1.055 * mean ** (1 / 2.4) - 0.055)
                          [MARGIN:-MARGIN, MARGIN:-MARGIN])
        return frames


_values = np.arange(256) / 255
_LINEAR = np.where(_values <= 0.04045, _values / 12.92, ((_values + 0.055) / 1.055) ** 2.4).astype(np.float32)


def warped(picture, homography, interpolation, scale=1):
    """Returns the picture as the target sees it; the homography leads from its pixels to those of the picture.

    scale  size of the picture divided by that of the calibration
    """
    half = np.float64([[1, 0, 0.5], [0, 1, 0.5], [0, 0, 1]])  # OpenCV's pixel (0, 0) has its centre at (0, 0)
    size = np.diag([scale, scale, 1.0])
    matrix = np.linalg.inv(half) @ size @ homography @ np.linalg.inv(size) @ half
    return cv2.warpPerspective(picture, matrix, picture.shape[1::-1], flags=interpolation | cv2.WARP_INVERSE_MAP,
                               borderMode=cv2.BORDER_REPLICATE)


def decibels(pairs):
    """Returns the PSNR of the pooled error of [(picture, picture)]."""
    error = np.mean([np.mean((np.float32(a) - np.float32(b)) ** 2) for a, b in pairs])
    return float(10 * np.log10(255 ** 2 / max(error, 1e-9)))


def read(file):
    picture = cv2.imread(str(file), cv2.IMREAD_COLOR)
    if picture is None:
        raise SystemExit(f"{file}: expected a picture")
    return np.ascontiguousarray(picture[..., ::-1])


def with_poses(field, frames, inverse_depths, focus, half=False, corner=None):
    """Returns the capture of frames of transforms.json, cut to SIDE.

    half    reduces the LF images to half their size before, by means of areas
    corner  (x, y) of the part that is coded; the middle unless given
    """
    pictures, intrinsics, rotations, translations = [], [], [], []
    for frame in frames:
        picture, value = read(frame["file_path"]), lambda key: frame.get(key, field.get(key))
        k = np.array([[value("fl_x"), 0, value("cx")], [0, value("fl_y"), value("cy")], [0, 0, 1]], float)
        if half:
            picture = cv2.resize(picture, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
            k[:2] /= 2
        height, width = (min(SIDE, n // 32 * 32) for n in picture.shape[:2])
        x, y = corner or ((picture.shape[1] - width) // 4 * 2, (picture.shape[0] - height) // 4 * 2)
        k[0, 2] -= x
        k[1, 2] -= y
        pose = np.array(frame["transform_matrix"]) @ np.diag([1.0, -1, -1, 1])  # from OpenGL's axes
        pictures.append(np.ascontiguousarray(picture[y:y + height, x:x + width]))
        intrinsics.append(k)
        rotations.append(pose[:3, :3].T)
        translations.append(-pose[:3, :3].T @ pose[:3, 3])
    return Capture(pictures, pictures, intrinsics, rotations, translations, inverse_depths, focus)


def synthetic(bin_folder, folder, scene, spacing_mm, inverse_depths, focus):
    name = folder / f"{scene}-{spacing_mm:g}"
    if not (name / "transforms.json").exists():
        results.call([bin_folder / "lfsynth", scene, "-o", name, "--count", GRID ** 2, "--size", "480x320", "--format",
                      "png", "--spacing", spacing_mm / 1000, "-q"])
    field = json.loads((name / "transforms.json").read_text())
    for frame in field["frames"]:
        frame["file_path"] = name / frame["file_path"]
    return with_poses(field, field["frames"], inverse_depths, focus)


def ground_truth(shared, name, rows, columns, inverse_depths, focus):
    folder = shared / "groundtruth/data" / name
    field = json.loads((folder / "transforms.json").read_text())
    at = {densify_captures.row_and_column(frame): frame | {"file_path": folder / frame["file_path"]}
          for frame in field["frames"]}
    return with_poses(field, [at[row, column] for row in rows for column in columns], inverse_depths, focus)


def shop(shared, rows, columns, half, corner=None):
    """Returns a group of blender-shop. Its names hold the positions in millimetres: row, column, -y and x."""
    at = {}
    for file in (shared / "data/blender-shop/images").glob("*.jpg"):
        row, column, up, right = re.search(r"_(\d+)_(\d+)_([-.\d]+)_([-.\d]+)_\d+_\d+$", file.stem).groups()
        pose = np.eye(4)
        pose[:2, 3] = float(right) / 1000, -float(up) / 1000
        at[int(row), int(column)] = {"file_path": file, "transform_matrix": pose}
    field = {"fl_x": 800, "fl_y": 800, "cx": 480, "cy": 320}
    return with_poses(field, [at[row, column] for row in rows for column in columns], (0, 1 / 3.6),
                      (6.3, 8.12, 13), half, corner)


def cards(shared, rows, columns):
    """Returns a group of stanford-cards. The disparity s in pixels for each column is 1000 / depth - 5."""
    field = densify_captures.cards_field(shared / "data/stanford-cards-9x9/images")
    at = {}
    for frame in field["frames"]:
        row, column = map(int, re.search(r"out_(\d+)_(\d+)", pathlib.Path(frame["file_path"]).stem).groups())
        at[row, column] = frame
    return with_poses(field, [at[row, column] for row in rows for column in columns], (0.002, 0.0085),
                      (1 / 0.00675, 1 / 0.006, 1 / 0.0035))


def noisy(capture):
    """Returns the capture with noise; frames are compared with those without."""
    dice = np.random.default_rng(1)
    pictures = [model.clipped(picture + dice.normal(0, NOISE, picture.shape)) for picture in capture.pictures]
    return dataclasses.replace(capture, pictures=pictures)


def mosaics(capture):
    """Returns the capture as mosaics (RGGB): four pictures of half the size."""
    pictures = [np.ascontiguousarray(np.stack([picture[i // 2::2, i % 2::2, (0, 1, 1, 2)[i]] for i in range(4)], -1))
                for picture in capture.pictures]
    intrinsics = [np.diag([0.5, 0.5, 1]) @ k for k in capture.intrinsics]
    return dataclasses.replace(capture, pictures=pictures, clean=pictures, intrinsics=intrinsics)


MIDDLE, WIDE, WIDEST = (8, 9, 10, 11), (6, 8, 10, 12), (1, 9, 17, 25)  # rows and columns
STILL_LIFE = ((0.3, 2.5), (0.58, 0.75, 2.3))
FOLIAGE = ((0.3, 2.5), (0.53, 1.0, 2.0))
CHART = ((0.3, 1.8), (0.7, 1.0, 1.4))
LIGHTS = ((0.3, 2.2), (0.6, 1.0, 2.0))
PLANAR = ((0.0, 8.0), (0.2, 0.3, 0.5))
BAND = ((0.0, 11.0), (0.22, 0.3, 0.4))

# Name: (True if parameters were chosen with this scene, function of (BIN, folder for lfsynth, SHARED)).
CAPTURES = {
    "still-life, 1.5 mm": (True, lambda b, f, s: synthetic(b, f, "still-life", 1.5, *STILL_LIFE)),
    "still-life, 3 mm": (True, lambda b, f, s: synthetic(b, f, "still-life", 3, *STILL_LIFE)),
    "still-life, 9 mm": (True, lambda b, f, s: synthetic(b, f, "still-life", 9, *STILL_LIFE)),
    "still-life, 18 mm": (True, lambda b, f, s: synthetic(b, f, "still-life", 18, *STILL_LIFE)),
    "planar, 0.5 mm": (True, lambda b, f, s: ground_truth(s, "planar", MIDDLE, MIDDLE, *PLANAR)),
    "planar, 1 mm": (True, lambda b, f, s: ground_truth(s, "planar", WIDE, WIDE, *PLANAR)),
    "shop at half size, 31 mm": (True, lambda b, f, s: shop(s, MIDDLE, MIDDLE, True)),
    "shop at half size, 62 mm": (True, lambda b, f, s: shop(s, WIDE, WIDE, True)),
    "shop at half size, 246 mm": (True, lambda b, f, s: shop(s, WIDEST, WIDEST, True)),
    "still-life, 3 mm, noisy": (True, lambda b, f, s: noisy(synthetic(b, f, "still-life", 3, *STILL_LIFE))),
    "still-life, 3 mm, mosaics": (True, lambda b, f, s: mosaics(synthetic(b, f, "still-life", 3, *STILL_LIFE))),
    "foliage, 5 mm": (False, lambda b, f, s: synthetic(b, f, "foliage", 5, *FOLIAGE)),
    "foliage, 20 mm": (False, lambda b, f, s: synthetic(b, f, "foliage", 20, *FOLIAGE)),
    "foliage, 40 mm": (False, lambda b, f, s: synthetic(b, f, "foliage", 40, *FOLIAGE)),
    "chart, 2.5 mm": (False, lambda b, f, s: synthetic(b, f, "chart", 2.5, *CHART)),
    "chart, 10 mm": (False, lambda b, f, s: synthetic(b, f, "chart", 10, *CHART)),
    "lights, 2.5 mm": (False, lambda b, f, s: synthetic(b, f, "lights", 2.5, *LIGHTS)),
    "lights, 10 mm": (False, lambda b, f, s: synthetic(b, f, "lights", 10, *LIGHTS)),
    "band, 1 mm": (False, lambda b, f, s: ground_truth(s, "band", (1, 2, 3, 4), (20, 21, 22, 23), *BAND)),
    "shop, 31 mm": (False, lambda b, f, s: shop(s, (18, 19, 20, 21), (4, 5, 6, 7), False, (100, 300))),
    "stanford-cards, 1 step": (False, lambda b, f, s: cards(s, (2, 4, 6, 8), (2, 4, 6, 8))),
    "stanford-cards, 2 steps": (False, lambda b, f, s: cards(s, (0, 4, 8, 12), (0, 4, 8, 12))),
    "foliage, 5 mm, noisy": (False, lambda b, f, s: noisy(synthetic(b, f, "foliage", 5, *FOLIAGE))),
    "foliage, 5 mm, mosaics": (False, lambda b, f, s: mosaics(synthetic(b, f, "foliage", 5, *FOLIAGE))),
}
