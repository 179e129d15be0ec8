#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Opens the exports of other programs, and compares the LF cameras with the formulas of these programs.

usage: exports_test.py EXTENSION LFIMPORT    EXTENSION: the compiled module of the Python package
"""
import dataclasses
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import write_exports
import write_scans
from write_exports import random_views

lf = IMPORT = None
MOST_PX = 1e-6  # by which a projected point may be off


class ExportsTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.root = pathlib.Path(temporary.name)
        self.count = 0

    def folder(self):
        self.count += 1
        folder = self.root / str(self.count)
        folder.mkdir()
        return folder

    def check(self, write, views=None, opened=".", most_px=MOST_PX, reach=0.42, said=None, **options):
        """Writes an export, opens it, and compares positions of points in both directions. Returns the light field."""
        views = views or random_views()
        folder = self.folder()
        project = write(folder, views, **options)
        field = lf.open(folder / opened, **(said or {}))
        stems = [pathlib.PurePath(name).stem for name in field.names]
        self.assertEqual(sorted(stems), sorted(view.name for view in views))
        for number, view in enumerate(views):
            i = stems.index(view.name)
            points = write_exports.points_before(view, reach=reach)
            expected = project(number, points)
            self.assertLessEqual(np.abs(field.project(i, points) - expected).max(), most_px, options)
            origins, directions = field.rays(i, expected)
            self.assertLessEqual(np.abs(origins - view.centre).max(), 1e-9)
            towards = points - view.centre
            towards /= np.linalg.norm(towards, axis=1, keepdims=True)
            self.assertLessEqual(np.abs(directions - towards).max(), most_px / 100, options)
            intrinsics = field.intrinsics[field.intrinsics_index[i]]
            self.assertEqual(field.image(i).shape[:2], (intrinsics.height, intrinsics.width))
        self.check_native(field, folder / opened, said or {})
        return field

    def check_native(self, field, opened, said):
        """Compares a light field with the transforms.json that lfimport makes of its export."""
        words = [word for key, value in said.items() for word in ("--" + key.replace("_", "-"), str(value))]
        native = self.root / f"native{self.count}"
        subprocess.run([IMPORT, opened, "-o", native, "-q", *words], check=True, capture_output=True, timeout=60)
        again = lf.open(native)
        self.assertEqual([pathlib.PurePath(name).name for name in again.names],
                         [pathlib.PurePath(name).name for name in field.names])
        self.assertLessEqual(np.abs(again.cam_from_world - field.cam_from_world).max(), 1e-12)
        self.assertLessEqual(np.abs(again.K - field.K).max(), 1e-9)
        for i in range(len(field)):
            one, two = (f.intrinsics[f.intrinsics_index[i]] for f in (field, again))
            self.assertEqual((one.distortion, one.parameters), (two.distortion, two.parameters))

    def error(self, folder):
        with self.assertRaises(lf.InputError) as caught:
            lf.open(folder)
        return str(caught.exception)

    def test_opensfm(self):
        write = write_exports.write_opensfm
        sizes = [(160, 120), (120, 160), (160, 120), (100, 100)]
        self.check(write, random_views(sizes=sizes))
        self.check(write, model="perspective", k1=-0.1, k2=0.02)
        self.check(write, model="simple_radial", k1=-0.08)
        self.check(write, model="radial", k1=-0.1, k2=0.02)
        self.check(write, model="brown", k1=-0.1, k2=0.02, k3=-0.003, p1=0.002, p2=-0.001)
        self.check(write, model="fisheye", k1=-0.02, k2=0.004, reach=1)
        self.check(write, model="fisheye_opencv", k1=-0.02, k2=0.004, k3=0.001, k4=-0.0005, reach=1)
        self.check(write, model="fisheye62", k1=-0.02, k2=0.004, k3=0.001, k4=-0.0005, p1=0.002, p2=-0.001, reach=1)
        self.check(write, model="fisheye624", k1=-0.02, k2=0.004, p1=0.002, p2=-0.001, s0=0.003, s2=-0.002, reach=1)
        self.check(write, model="fisheye62", k1=-0.02, k5=0.0004, k6=-0.0001, reach=1)
        self.assertIn("fisheye62", self.wrong(write, model="fisheye62", k5=0.0004, p1=0.01))
        self.assertIn('lens model "spherical"', self.wrong(write, model="spherical"))

    def wrong(self, write, **options):
        folder = self.folder()
        write(folder, random_views(), **options)
        return self.error(folder)

    def test_opensfm_images_lie_beside_the_folder_of_opendronemap(self):
        folder = self.folder()
        (folder / "opensfm").mkdir()
        views = random_views()
        project = write_exports.write_opensfm(folder / "opensfm", views, images="../images")
        field = lf.open(folder)
        points = write_exports.points_before(views[2])
        self.assertLessEqual(np.abs(field.project(2, points) - project(2, points)).max(), MOST_PX)
        self.assertEqual(field.image(2).shape[:2], (120, 160))

    def test_meshroom(self):
        write = write_exports.write_meshroom
        for version in ((1, 0, 0), (1, 2, 0), (1, 2, 1), (1, 2, 2), (1, 2, 4), (1, 2, 5), (1, 2, 8), (1, 2, 11)):
            self.check(write, version=version, distortion="radialk3", lens=(-0.1, 0.02, -0.003))
        self.check(write, random_views(size=(120, 160)))
        self.check(write, name="sfm.json")
        self.check(write, in_rig=True)
        self.check(write, distortion="radialk1", lens=[-0.1])
        self.check(write, distortion="radialk3pt", lens=(-0.1, 0.02, -0.003))
        self.check(write, distortion="brown", lens=(-0.1, 0.02, -0.003, 0.002, -0.001))
        self.check(write, distortion="fisheye", lens=(-0.02, 0.004, 0.001, -0.0005))
        self.check(write, distortion="fisheye1", lens=[0.9])
        self.check(write, version=(1, 2, 4), distortion="fisheye", lens=(-0.02, 0.004, 0.001, -0.0005))

    def test_meshroom_scenes_are_found_in_the_cache(self):
        folder = self.folder()
        inner = folder / "MeshroomCache" / "StructureFromMotion" / "0a1b2c"
        inner.mkdir(parents=True)
        views = random_views()
        project = write_exports.write_meshroom(inner, views)
        field = lf.open(folder)
        points = write_exports.points_before(views[1])
        self.assertLessEqual(np.abs(field.project(1, points) - project(1, points)).max(), MOST_PX)

    def test_openmvg(self):
        write = write_exports.write_openmvg
        self.check(write)
        self.check(write, model="pinhole_radial_k1", lens=[-0.1])
        self.check(write, model="pinhole_radial_k3", lens=(-0.1, 0.02, -0.003))
        self.check(write, model="pinhole_brown_t2", lens=(-0.1, 0.02, -0.003, 0.002, -0.001))
        self.check(write, model="fisheye", lens=(-0.02, 0.004, 0.001, -0.0005))
        self.assertIn('lens model "spherical"', self.wrong(write, model="spherical"))

    def test_bundler(self):
        write = write_exports.write_bundler
        sizes = [(160, 120), (120, 160), (160, 121), (99, 100)]
        self.check(write, random_views(sizes=sizes), k1=-0.1, k2=0.02)
        self.check(write, name="scan.out", list_name="scan.list.txt")

    def test_nvm(self):
        write = write_exports.write_nvm
        sizes = [(160, 120), (120, 160), (160, 121), (99, 100)]
        self.check(write, random_views(sizes=sizes))
        self.check(write, header="NVM_V3_R9T")
        self.check(write, fixed=(151.0, 81.5, 148.0, 58.25))
        # The inverse of the distortion is approximated.
        self.check(write, r=0.06, most_px=1e-5)
        self.check(write, r=-0.06, most_px=1e-5)
        self.assertIn("the radial distortion -0.8 of VisualSFM is too large", self.wrong(write, r=-0.8))

    def test_splat_cameras(self):
        self.check(write_exports.write_splat_cameras)

    def test_mvsnet(self):
        field = self.check(write_exports.write_mvsnet)
        self.assertEqual(field.depth_range, (1.5, 9.5))
        self.check(write_exports.write_mvsnet, opened="cams")
        self.check(write_exports.write_mvsnet, opened="cams/view1_cam.txt", extension=".png")
        self.check(write_exports.write_mvsnet, scale=0.25)

    def test_nerfies(self):
        field = self.check(write_exports.write_nerfies, k1=-0.1, k2=0.02, k3=-0.003, p1=0.002, p2=-0.001)
        self.assertEqual(field.depth_range, (1.5, 8.0))
        self.check(write_exports.write_nerfies, opened="camera/view2.json")
        self.check(write_exports.write_nerfies, scale=2)

    def test_metashape(self):
        write = write_scans.write_metashape
        lens = {"b1": 1.5, "b2": -0.75, "k1": -0.1, "k2": 0.02, "k3": -0.003, "p1": 0.002, "p2": -0.001}
        self.check(write)
        self.check(write, lens=lens)
        self.check(write, lens={**lens, "k4": 0.004}, placed_by="component", extension=".png")
        self.check(write, lens=lens, rig=True)
        self.check(write, lens=lens, rig=True, placed_by=None)
        self.check(write, lens={"k1": 0.05, "k2": -0.01, "b1": 1.5}, fisheye=True, reach=1)
        self.check(write, lens={"k1": 0.05, "k2": -0.01, "p1": 0.002, "p2": -0.001}, fisheye=True, reach=1)

    def test_reality_csv(self):
        sizes = [(160, 120), (120, 160), (160, 120), (100, 100)]
        for write in (write_scans.write_reality_csv, write_scans.write_reality_opencv):
            self.check(write, random_views(sizes=sizes))
            self.check(write, random_views(sizes=sizes), k1=-0.1, k2=0.02, k3=-0.003, t1=0.002, t2=-0.001)
            self.check(write, k1=-0.1, k2=0.02, k3=-0.003, k4=0.004, t1=0.002, t2=-0.001)
        self.check(write_scans.write_reality_csv, yaw="yaw", k1=-0.1, k2=0.02)

    def test_reality_angles_of_other_conventions_are_off_by_pixels(self):
        views = random_views()
        field = self.check(write_scans.write_reality_csv, views)
        matrix = write_scans.reality_matrix
        conventions = {
            "yaw counter-clockwise": lambda y, p, r: matrix(-y, p, r),
            "pitch downwards": lambda y, p, r: matrix(y, -p, r),
            "roll to the left": lambda y, p, r: matrix(y, p, -r),
            "pitch and roll exchanged": lambda y, p, r: matrix(y, r, p),
            "pitch of the view, not of the aircraft": lambda y, p, r: matrix(y, p + 90, r),
            "world from camera": lambda y, p, r: matrix(y, p, r).T,
            "the camera's upper side towards the tail": lambda y, p, r: np.diag([-1, -1, 1]) @ matrix(y, p, r),
        }
        for name, convention in conventions.items():
            off = []
            for i, view in enumerate(views):
                points = write_exports.points_before(view)
                rotation = convention(*write_scans.reality_angles(view.rotation))
                there = write_scans.reality_pixels((points - view.centre) @ rotation.T, view.size, {})
                off.append(np.abs(field.project(i, points) - there).max())
            self.assertGreater(max(off), 5, name)

    def test_reality_xmp(self):
        write = write_scans.write_reality_xmp
        sizes = [(160, 120), (120, 160), (160, 120), (100, 100)]
        self.check(write, random_views(sizes=sizes), k1=-0.1, k2=0.02, k3=-0.003)
        self.check(write, model="perspective")
        self.check(write, opened="images/view1.xmp", as_elements=True, model="brown4t2", k1=-0.1, k2=0.02, k3=-0.003,
                   k4=0.004, t1=0.002, t2=-0.001)
        self.assertIn("division", self.wrong(write, model="division", k1=-0.1))

    def test_record3d(self):
        write = write_scans.write_record3d
        views = [dataclasses.replace(view, name=str(number)) for number, view in enumerate(random_views())]
        self.check(write, views)
        self.check(write, views, each=False, images="rgb", name="metadata.json")
        self.check(write, views, opened="metadata.json", images="images", name="metadata.json")

    def test_polycam(self):
        self.check(write_scans.write_polycam)
        self.check(write_scans.write_polycam, opened="keyframes", kind="")

    def test_google_models(self):
        self.check(write_scans.write_google_models)
        self.check(write_scans.write_google_models, fisheye=True, reach=1)

    def test_kapture(self):
        write = write_scans.write_kapture
        self.check(write, model="PINHOLE")
        self.check(write, opened="sensors", k1=-0.1, k2=0.02, p1=0.002, p2=-0.001)
        self.check(write, opened="sensors/records_camera.txt", rig=True, k1=-0.1, p1=0.002)

    def test_nsvf(self):
        self.check(write_exports.write_nsvf)
        self.check(write_exports.write_nsvf, matrix=True)
        self.check(write_exports.write_nsvf, opened="pose/2.txt")

    def test_tum(self):
        self.check(write_exports.write_tum, said={"focal_px": 150})
        self.assertIn("does not state the focal length of the camera: give it in pixels (focal_px",
                      self.wrong(write_exports.write_tum))


if __name__ == "__main__":
    sys.path.insert(0, str(pathlib.Path(sys.argv[1]).resolve().parents[1]))
    import lfrendertools as lf
    IMPORT = pathlib.Path(sys.argv[2])
    sys.exit(unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2))
