#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Renders photographs as Bayer mosaics, compares the frames with those of the whole photographs, and prints a table of
doc/quality.md.

usage: photographs.py LFRENDERER DATA [--only CAPTURE] [--fields DIR] [--name NAME] [--write doc/quality.md]
       photographs.py --again JSON [--write doc/quality.md]

DATA      folder with blender-shop and stanford-cards-9x9
--fields  keep the light fields here, and use what is there

The photographs are reduced to half their size, by means of 2 x 2 pixels in linear light: each pixel then shows three
colours that were measured, or rendered, and not interpolated between pixels. The sensor of mosaic_sensor.py records
them as RGGB mosaics and as RGB images, without noise and with it. There is no true picture of a lens. The figures are
the PSNR, in linear light, against the frame that the default makes of the RGB images without noise; "-" is this frame
itself.
"""
import argparse
import pathlib
import sys
import tempfile

import cv2
import numpy as np

import densify_captures as captures
import lens_weights
import mosaic_sensor
import quality
from lens_weights import COLLECT
from mosaic_sensor import NOISE
from mosaics import WAYS
from quality import results

DIAMETERS = (1, 3, 6)  # camera distances
RGB_WAYS = {"RGB": "", "RGB, bicubic": f"{COLLECT} bilinear --filter bicubic --lens-weights auto"}


class Capture:
    """A light field of RGB images, what its rows are for, and frames of it.

    field       calibration, with absolute paths, of the photographs
    distance    between LF cameras
    focuses     {name: distance to the focus plane}
    size        width and height of the frames, whose elements are as large as LF pixels
    """

    def __init__(self, purpose, field, distance, focuses, size):
        self.purpose, self.field, self.distance, self.focuses, self.size = purpose, field, distance, focuses, size


def shop(programs, data, folder):
    out = folder / "shop"
    if not (out / "transforms.json").exists():
        results.call([programs / "lfimport", data / "blender-shop/images", "-o", out, "-q"])
    field = quality.read_field(out / "transforms.json")
    field["frames"] = captures.square(field["frames"], range(9, 18))  # the middle 9 x 9
    return Capture(mosaic_sensor.CHOOSING, field, 0.8 / 26, {"counter": 8.12, "in front of all": 3}, (384, 256))


def cards(programs, data, folder):
    return Capture(mosaic_sensor.REPORTING, captures.cards_field(data / "stanford-cards-9x9/images"), 2,
                   {"standing cards": 286, "in front of all": 120}, (288, 288))


CAPTURES = {"shop": shop, "cards": cards}


def light_of(file):
    """Returns the linear light of a photograph of 8 bits, at half its size."""
    light = quality.linear(np.arange(256) / 255)
    return quality.halved(light[cv2.imread(file)[..., ::-1]])


def cases_of(name, renderer, data, folder):
    capture = CAPTURES[name](renderer.parent, data, folder)
    field = quality.at_half_size(capture.field)
    of_noise = lambda noise, is_mosaic: mosaic_sensor.write(
        folder / f"{name}-{'mosaic' if is_mosaic else 'rgb'}-{noise}", field, light_of, noise, is_mosaic)
    truths = {}
    for noise in (0, NOISE):
        mosaics, rgb = of_noise(noise, True), of_noise(noise, False)
        for distances in DIAMETERS:
            for focus, depth in capture.focuses.items():
                if noise == 0:
                    path = captures.middle_path(field, folder / f"{name}_{distances}_{depth}.yaml", capture.size,
                                                field["fl_x"], distances * capture.distance, depth)
                    truths[distances, focus] = path, lens_weights.first_frame(renderer, rgb, path, "")[0]
                yield mosaic_sensor.Case((name, mosaic_sensor.percent(noise), distances, focus), capture.purpose,
                                         *truths[distances, focus], mosaics, rgb)


def table_of(renderer, data, folder, only):
    table = lens_weights.Table("capture", "noise", "diameter, in camera distances", "focus", "for", *RGB_WAYS, *WAYS,
                               "joint")
    for name in CAPTURES:
        if only not in name:
            continue
        for case in cases_of(name, renderer, data, folder):
            renders = [(field, words) for field, ways in ((case.rgb, RGB_WAYS), (case.mosaics, WAYS))
                       for words in ways.values()]
            renders.append((quality.joint_store(renderer, case.mosaics), ""))
            frames = [lens_weights.first_frame(renderer, field, case.path, words)[0] for field, words in renders]
            table.add(*case.cells, case.purpose, *("-" if np.array_equal(frame, case.truth) else
                                                   f"{lens_weights.psnr(case.truth, frame):.2f}" for frame in frames))
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("renderer", type=pathlib.Path, nargs="?")
    parser.add_argument("data", type=pathlib.Path, nargs="?")
    parser.add_argument("--only", default="", help="captures whose names have it")
    parser.add_argument("--fields", type=pathlib.Path, metavar="DIR")
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        lens_weights.publish_again(arguments)
        return 0
    if not arguments.data:
        parser.error("LFRENDERER DATA or --again is needed")
    record = results.context()
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.fields or pathlib.Path(temporary)
        table_of(arguments.renderer.resolve(), arguments.data, folder, arguments.only).publish(
            arguments, "photographs.py", record)
    return 0


if __name__ == "__main__":
    sys.exit(main())
