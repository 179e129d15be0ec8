#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Renders scenes of lfsynth that were recorded as Bayer mosaics, compares them with true thin-lens pictures, and prints
a table of doc/quality.md.

usage: mosaics.py LFRENDERER [--only SCENE] [--scenes DIR] [--name NAME] [--write doc/quality.md]
       mosaics.py --again JSON [--write doc/quality.md]

The light fields have 225 cameras, jittered by 0.4 of their distance, whose pixels show areas. They are recorded as RGGB
mosaics and as RGB images by the same sensor (mosaic_sensor.py), without noise and with it. lfsynth, beside LFRENDERER,
makes them. Figures are the PSNR in linear light.
"""
import argparse
import json
import pathlib
import sys
import tempfile

import lens_weights
import mosaic_sensor
import quality
from lens_weights import COLLECT
from mosaic_sensor import NOISE
from quality import results

# Scenes, and what their rows are for.
SCENES = {"still-life": mosaic_sensor.CHOOSING, "chart": mosaic_sensor.REPORTING, "lights": mosaic_sensor.REPORTING,
          "foliage": mosaic_sensor.REPORTING}
# (lens diameter in camera distances, size of the frame: 0.8 makes elements as large as LF pixels), without and with
# noise
LENSES = ((1, 0.8), (3, 0.8), (8, 0.4), (8, 0.8), (8, 1.6))
LENSES_WITH_NOISE = ((1, 0.8), (3, 0.8), (8, 0.8))
WAYS = {"nearest": f"{COLLECT} nearest --lens-weights auto",
        "demosaicked": f"{COLLECT} bilinear --filter bicubic --lens-weights auto", "default": ""}


class Scenes(lens_weights.SyntheticScenes):
    """Light fields of lfsynth, as sensors record them; each is made once."""

    def mosaics(self, scene, noise):
        folder = self.folder / (f"{scene}-mosaic" + (f"-{noise}" if noise else ""))
        if not (folder / "transforms.json").exists():
            self.photograph(scene, folder, "--bayer", *(["--noise", noise] if noise else []))
        return folder / "transforms.json"

    def rgb(self, scene, noise):
        calibration = self.calibration(scene)
        if not noise:
            return calibration
        field = json.loads(calibration.read_text())
        return mosaic_sensor.write(self.folder / f"{scene}-{noise}", field,
                                   lambda file: lens_weights.linear_exr(calibration.parent / file), noise, False,
                                   field["lf_max_radiance"])


def cases_of(scenes, scene):
    for noise, lenses in ((0, LENSES), (NOISE, LENSES_WITH_NOISE)):
        for distances, scale in lenses:
            path, truth = scenes.truth(scene, distances * lens_weights.SYNTHETIC_SPACING, scale)
            yield mosaic_sensor.Case((scene, mosaic_sensor.percent(noise), distances, f"{scale / 0.8:g}"),
                                     SCENES[scene], path, truth, scenes.mosaics(scene, noise), scenes.rgb(scene, noise))


def table_of(renderer, scenes, only):
    table = lens_weights.Table("scene", "noise", "diameter, in camera distances", "elements per LF pixel", "for", "RGB",
                               *WAYS, "joint")
    for scene in SCENES:
        if only not in scene:
            continue
        for case in cases_of(scenes, scene):
            decibels = lambda calibration, options: lens_weights.text(lens_weights.decibels(
                renderer, case.truth, calibration, case.path, options))
            table.add(*case.cells, case.purpose, decibels(case.rgb, ""),
                      *(decibels(case.mosaics, options) for options in WAYS.values()),
                      decibels(quality.joint_store(renderer, case.mosaics), ""))
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("renderer", type=pathlib.Path, nargs="?")
    parser.add_argument("--only", default="", help="scenes whose names have it")
    parser.add_argument("--scenes", type=pathlib.Path,
                        help="keep the scenes of lfsynth here, and use what is there")
    results.add_options(parser)
    arguments = parser.parse_args()
    if arguments.again:
        lens_weights.publish_again(arguments)
        return 0
    if not arguments.renderer:
        parser.error("LFRENDERER or --again is needed")
    record = results.context()
    with tempfile.TemporaryDirectory() as temporary:
        scenes = Scenes(arguments.renderer, arguments.scenes or pathlib.Path(temporary))
        table_of(arguments.renderer, scenes, arguments.only).publish(arguments, "mosaics.py", record)
    return 0


if __name__ == "__main__":
    sys.exit(main())
