# SPDX-License-Identifier: Apache-2.0
"""Chains of light fields whose views lie in one file, in files that have to be put in order, or in a light field video:
lfimport writes their calibration, and every program reads it."""
import functools
import json
import shutil

from chain_world import FOCAL_PX, HEIGHT, SIDE, WIDTH, World, light_at, srgb_of
from matrix_world import once

import cv2
import h5py
import numpy as np

PITCH = 1 / 128  # positions are exact
ORDERS = {"grid": range(SIDE * SIDE),
          "serpentine": [row * SIDE + (SIDE - 1 - column if row % 2 else column)
                         for row in range(SIDE) for column in range(SIDE)]}


@functools.cache
def views_of_the_wall():
    """Returns sRGB values of 16 bits: [row][column][y][x][R, G, B]."""
    views = [srgb_of(light_at(index) / 3) * 65535 + 0.5 for index in range(SIDE * SIDE)]
    return np.stack(views).astype(np.uint16).reshape(SIDE, SIDE, HEIGHT, WIDTH, 3)


class ViewChains(World):
    """Writers are imported_NAME(flaws). The direct way is a folder of images with a calibration that NumPy wrote."""

    def write_png(self, file, picture):
        cv2.imwrite(str(file), np.ascontiguousarray(picture[..., ::-1]))
        return file

    @once
    def field_of_views(self, order):
        """Returns the light field of the direct way: cameras that look along z, x right, y down. The order of its LF
        images, "grid" or "serpentine", is that of the reader, because it decides ties of lens weights."""
        folder = self.new_folder("views")
        folder.mkdir()
        frames = []
        for index in ORDERS[order]:
            name = f"image_{index:02}.png"
            self.write_png(folder / name, views_of_the_wall().reshape(SIDE * SIDE, HEIGHT, WIDTH, 3)[index])
            x, y = (index % SIDE - SIDE // 2) * PITCH, (index // SIDE - SIDE // 2) * PITCH
            frames.append({"file_path": name, "transform_matrix": [
                [1, 0, 0, x], [0, -1, 0, y], [0, 0, -1, 0], [0, 0, 0, 1]]})
        text = {"fl_x": FOCAL_PX, "fl_y": FOCAL_PX, "cx": WIDTH / 2, "cy": HEIGHT / 2, "w": WIDTH, "h": HEIGHT,
                "frames": frames}
        (folder / "transforms.json").write_text(json.dumps(text))
        return folder

    @once
    def imported_time(self, flaws):
        """The LF images are those of one time of a light field video, whose other times are black."""
        still, folder = self.field_of_views("grid"), self.new_folder("filmed")
        shutil.copytree(still, folder)
        text = json.loads((still / "transforms.json").read_text())
        black = self.write_png(folder / "black.png", np.zeros((HEIGHT, WIDTH, 3), np.uint16)).name
        text["frames"] = [frame | {"time": time} | ({} if time == 1 else {"file_path": black})
                          for time in (0, 1, 2) for frame in text["frames"]]
        (folder / "transforms.json").write_text(json.dumps(text))
        return self.make("lfimport", folder, "--time", 1, to=self.new_folder("native"))

    def imported(self, given, *options):
        return self.make("lfimport", given, *options, "--pitch", PITCH, "--focal-px", FOCAL_PX,
                         to=self.new_folder("native"))

    def photographs(self, numbers):
        """Writes the views with names that state nothing but this order, and returns their folder."""
        folder = self.new_folder("photographs")
        folder.mkdir()
        views = views_of_the_wall().reshape(SIDE * SIDE, HEIGHT, WIDTH, 3)
        for number, index in enumerate(numbers):
            self.write_png(folder / f"photo {number}.png", views[index])
        return folder

    @once
    def imported_grid(self, flaws):
        return self.imported(self.photographs(ORDERS["grid"]), "--grid", f"{SIDE}x{SIDE}")

    @once
    def imported_serpentine(self, flaws):
        return self.imported(self.photographs(ORDERS["serpentine"]), "--grid", f"{SIDE}x{SIDE}", "--serpentine")

    @once
    def imported_mosaic(self, flaws):
        picture = views_of_the_wall().transpose(0, 2, 1, 3, 4).reshape(SIDE * HEIGHT, SIDE * WIDTH, 3)
        return self.imported(self.write_png(self.new_folder("mosaic.png"), picture), "--grid", f"{SIDE}x{SIDE}",
                             "--layout", "mosaic")

    @once
    def imported_lenslets(self, flaws):
        picture = views_of_the_wall().transpose(2, 0, 3, 1, 4).reshape(SIDE * HEIGHT, SIDE * WIDTH, 3)
        return self.imported(self.write_png(self.new_folder("lenslets.png"), picture), "--grid", f"{SIDE}x{SIDE}",
                             "--layout", "lenslets")

    @once
    def imported_array(self, flaws):
        file = self.new_folder("views.npy")
        np.save(file, views_of_the_wall())
        return self.imported(file)

    @once
    def imported_hdf5(self, flaws):
        path = self.new_folder("lf.h5")
        with h5py.File(path, "w") as file:
            file.create_dataset("LF", data=views_of_the_wall(), chunks=(2, 2, 16, 16, 3), compression="gzip")
        return self.imported(path)
