# SPDX-License-Identifier: Apache-2.0
"""Chains of the Python package: what it writes, and what it reads."""
import contextlib
import warnings

import numpy as np

from chain_frames import read_picture
from chain_world import Refused, seen_frames
from matrix_world import once

# Ends that THINGS gets if the package is there.
WRITERS = {
    "light field": {"lf.compress()": "light_python_store"},
    "path": {"lf.Path.save() .yaml": "path_python_yaml", "lf.Path.save() .json": "path_python_json"},
    "packages": {"lf.write_packages()": "packages_python"},
    "plates": {"lf.Plate.save()": "plates_python"},
    "pictures": {"lf.Frame.save() .exr": "pictures_python_exr", "lf.Frame.save() .png": "pictures_python_png"},
}
READERS = {
    "light field": {"lf.open()": "see_python_film"},
    "path": {"lf.Path.load()": "see_path_python_film"},
    "plates": {"lf.Plate.load()": "see_plates_python"},
    "pictures": {"lf.read_image()": "see_pictures_python"},
}


def python_package():
    import lfrendertools  # beside the programs of a build, if it was built
    return lfrendertools


@contextlib.contextmanager
def refusing():
    """Raises Refused for an error of the package, as for one of a program. LF images that are left out are accepted."""
    lf = python_package()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            yield lf
        except lf.Error as error:
            raise Refused("lfrendertools", error.exit_code, f"error: {error}") from error


class PythonChains:
    def python_film(self, field, path, to, *options):
        """Writes the frames of a film."""
        with refusing() as lf:
            opened = lf.open(field)
            loaded = lf.Path.load(path, unit_m=opened.unit_m)
            to.mkdir()
            for number, frame in lf.film(opened, loaded, threads=1):
                frame.save(to / f"frame_{number:04}{options[0]}", *options[1:])
        return to

    def see_python_film(self, light_field, flaws):
        return seen_frames(self.python_film(light_field, self.path("plain", flaws), self.new_folder("film"), ".exr",
                                            "exr-float"))

    @once
    def light_python_store(self, flaws):
        store = self.new_folder("a.lfs")
        with refusing() as lf:
            lf.compress(lf.open(self.field(flaws)), store, profile="lossless", threads=1)
        return store

    def saved(self, flaws, name):
        file = self.new_folder(name)
        with refusing() as lf:
            lf.Path.load(self.original_path(flaws), unit_m=1).save(file)
        return file

    @once
    def path_python_yaml(self, flaws):
        return self.saved(flaws, "a.yaml")

    @once
    def path_python_json(self, flaws):
        return self.saved(flaws, "a.json")

    def see_path_python_film(self, path, flaws):
        del flaws
        return seen_frames(self.python_film(self.field("masks"), path, self.new_folder("film"), ".exr", "exr-float"))

    @once
    def packages_python(self, flaws):
        folder = self.new_folder("packages")
        with refusing() as lf:
            field = lf.open(self.field(flaws))
            path = lf.Path.load(self.path("plain", flaws), unit_m=field.unit_m)
            lf.write_packages(field, path, folder, 2, threads=1)
        return folder

    @once
    def plates_python(self, flaws):
        folder = self.new_folder("plates")
        folder.mkdir()
        with refusing() as lf:
            field = lf.open(self.field(flaws))
            path = lf.Path.load(self.path("plain", flaws), unit_m=field.unit_m)
            with lf.Renderer(field, path, threads=1) as renderer:
                while renderer.step():
                    pass
                for number in range(len(path)):
                    renderer.plate(number).save(folder / f"frame_{number + 1:04}.plate")
        return folder

    def see_plates_python(self, plates, flaws):
        """Sees the frames of the sums of the plates of each frame."""
        del flaws
        out = self.new_folder("developed")
        out.mkdir()
        with refusing() as lf:
            sums = {}
            for file in sorted(plates.rglob("frame_*.plate")):
                plate = lf.Plate.load(file)
                sums[file.stem[:10]] = sums[file.stem[:10]] + plate if file.stem[:10] in sums else plate
            for name, plate in sums.items():
                plate.develop(threads=1).save(out / f"{name}.exr", "exr-float")
        return seen_frames(out)

    @once
    def pictures_python_exr(self, flaws):
        out = self.python_film(self.field(flaws), self.stereo_path(flaws), self.new_folder("film"), ".exr")
        return tuple(sorted(out.glob("frame_*.exr")))

    @once
    def pictures_python_png(self, flaws):
        out = self.python_film(self.field(flaws), self.stereo_path(flaws), self.new_folder("film"), ".png", "png16")
        return tuple(sorted(out.glob("frame_*.png")))

    def see_pictures_python(self, files, flaws):
        """Sees the colours of pictures, and alpha, which lf.read_image() returns before other channels."""
        del flaws
        with refusing() as lf:
            return {file.stem: as_colours(lf.read_image(file), read_picture(file)[0].shape[2]) for file in files}

    def direct_python(self, files):
        pictures = {file.stem: read_picture(file)[0] for file in files}
        return {name: picture[..., [2, 1, 0, 3][:picture.shape[2]]] for name, picture in pictures.items()}


def as_colours(picture, channels):
    return np.repeat(picture, 3, 2) if picture.shape[2] == 1 else picture[..., :channels]
