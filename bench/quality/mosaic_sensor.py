# SPDX-License-Identifier: Apache-2.0
"""Writes light fields as a camera's sensor records them, as RGGB mosaics or with all three colours in each pixel, for
mosaics.py and photographs.py.

The sensor is that of `lfsynth --bayer`. Its values of R, G and B are light divided by WHITE_BALANCE, and are stored
with 16 bits above BLACK_LEVEL. The standard deviation of their noise is NOISE * sqrt(value + ELECTRONICS): a hundredth
of white at white. A mosaic has the noise of the picture that it is taken from.
"""
import json
import pathlib

import cv2
import numpy as np

NOISE = 0.01
ELECTRONICS = 0.01
BLACK_LEVEL = 512
WHITE_BALANCE = (2, 1, 1.5)
LARGEST = 65535
CHOOSING, REPORTING = "choosing", "reporting"  # what the rows of a table are for (doc/quality.md)


class Case:
    """A row of a table: its first cells, what it is for, the camera path, the true picture, and the calibrations of the
    mosaics and of the RGB images, with their noise."""

    def __init__(self, cells, purpose, path, truth, mosaics, rgb):
        self.cells, self.purpose, self.path, self.truth, self.mosaics, self.rgb = (
            cells, purpose, path, truth, mosaics, rgb)


def percent(noise):
    """Returns the noise as tables show it."""
    return f"{100 * noise:g} %" if noise else "none"


def rggb(picture):
    """Returns the mosaic of a picture [height][width][3]."""
    mosaic = picture[..., 1].copy()
    mosaic[0::2, 0::2] = picture[0::2, 0::2, 0]
    mosaic[1::2, 1::2] = picture[1::2, 1::2, 2]
    return mosaic


def recorded(light, per_radiance, noise, number):
    """Returns the stored values of linear light [height][width][3]. The noise depends on the number of the LF image."""
    values = light / WHITE_BALANCE
    if noise > 0:
        dice = np.random.default_rng(number)
        values = values + noise * np.sqrt(values + ELECTRONICS) * dice.standard_normal(values.shape)
    return np.clip(np.rint(BLACK_LEVEL + per_radiance * values), 0, LARGEST).astype(np.uint16)


def write(folder, field, light_of, noise, is_mosaic, max_radiance=1):
    """Writes a light field whose LF images show the light that light_of(file_path) returns, from 0 to max_radiance.
    Returns its calibration; a folder that has one is left as it is."""
    calibration = folder / "transforms.json"
    if calibration.exists():
        return calibration
    folder.mkdir(parents=True, exist_ok=True)
    per_radiance = int((LARGEST - BLACK_LEVEL) / max_radiance)
    frames = []
    for number, frame in enumerate(field["frames"]):
        picture = recorded(light_of(frame["file_path"]), per_radiance, noise, number)
        name = f"{number:04}.png"
        cv2.imwrite(str(folder / name), rggb(picture) if is_mosaic else picture[..., ::-1],
                    [cv2.IMWRITE_PNG_COMPRESSION, 1])
        frames.append(dict(frame, file_path=name))
    described = dict(field, frames=frames, lf_transfer="linear", lf_black_level=BLACK_LEVEL,
                     lf_white_level=BLACK_LEVEL + per_radiance, lf_white_balance=WHITE_BALANCE,
                     lf_max_radiance=max_radiance)
    if is_mosaic:
        described["lf_bayer"] = "RGGB"
    part = pathlib.Path(f"{calibration}.part")
    part.write_text(json.dumps(described))
    part.replace(calibration)
    return calibration
