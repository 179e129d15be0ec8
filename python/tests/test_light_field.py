# SPDX-License-Identifier: Apache-2.0
"""Light fields as arrays."""
import json
import pathlib
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

import lfrendertools as lf


def test_arrays_are_read_only_views(field):
    assert len(field) == 49
    poses = field.cam_from_world
    assert poses.shape == (49, 3, 4) and poses.dtype == np.float64
    assert np.shares_memory(poses, field.cam_from_world)
    for array in (poses, field.gains, field.intrinsics_index, field.is_virtual, field.centres, field.K):
        assert not array.flags.writeable and len(array) == 49
        with pytest.raises(ValueError):
            array[0] = 0
    assert not field.is_virtual.any() and (field.gains == 1).all()


def test_arrays_keep_the_light_field_alive(capture):
    poses = lf.open(capture).cam_from_world
    assert np.array_equal(poses, lf.open(capture).cam_from_world)


def test_poses_are_those_of_the_calibration(field, capture):
    frames = json.loads((capture / "transforms.json").read_text())["frames"]
    for i in (0, 17, 48):
        # transforms.json holds world_from_cam with y up and z backwards (OpenGL).
        world_from_cam = np.array(frames[i]["transform_matrix"]) @ np.diag([1, -1, -1, 1])
        expected = np.linalg.inv(world_from_cam)[:3]
        assert np.allclose(field.cam_from_world[i], expected, atol=1e-12)
        assert np.allclose(field.centres[i], world_from_cam[:3, 3], atol=1e-12)
        assert field.names[i].endswith(pathlib.PurePath(frames[i]["file_path"]).name)


def test_projection_by_hand(field):
    points = np.random.default_rng(1).uniform(-0.2, 0.2, (20, 3)) + [0, 0, 1.5]
    for i in (0, 24):
        camera = field.cam_from_world[i] @ np.concatenate([points, np.ones((20, 1))], axis=1).T
        pixels = (field.K[i] @ camera)[:2] / camera[2]
        assert np.allclose(field.project(i, points), pixels.T, atol=1e-9)


@pytest.mark.parametrize("distortion", ["none", "barrel"])
def test_rays_meet_what_is_projected(run, tmp_path, distortion):
    words = [] if distortion == "none" else ["--distortion", "-0.2,0.05,0.001,-0.002"]
    run("lfsynth", "chart", "-o", tmp_path / "field", "--count", 4, "--size", "64x48", "--samples", 1, *words)
    field = lf.open(tmp_path / "field")
    pixels = np.random.default_rng(2).uniform([2, 2], [62, 46], (50, 2))
    origins, directions = field.rays(3, pixels)
    assert np.allclose(np.linalg.norm(directions, axis=1), 1)
    assert np.allclose(field.project(3, origins + 2.5 * directions), pixels, atol=1e-6)
    assert (field.intrinsics[0].distortion == "pinhole") == (distortion == "none")


def test_points_that_no_lens_sees_are_nan(field):
    assert np.isnan(field.project(0, [[0, 0, -1]])).all()


def test_images_are_linear_light(field, capture):
    stored = np.asarray(Image.open(capture / field.names[5])).astype(float)[..., :3] / 255
    linear = np.where(stored <= 0.04045, stored / 12.92, ((stored + 0.055) / 1.055) ** 2.4)
    picture = field.image(5)
    assert picture.dtype == np.float32 and picture.shape == (120, 160, 3)
    assert np.abs(picture - linear).max() <= 1 / 65535
    assert np.array_equal(field.image(5, rect=(30, 20, 70, 50)), picture[20:50, 30:70])
    for rect in ((0, 0, 161, 120), (5, 5, 5, 6), (-1, 0, 3, 3)):
        with pytest.raises(lf.UsageError, match="rect"):
            field.image(5, rect=rect)
    with pytest.raises(IndexError, match="from 0 to 48"):
        field.image(49)


def test_images_come_in_order(field):
    assert [i for i, _ in field.images()] == list(range(49))
    for i, picture in field.images([3, 1, 3], ahead=2):
        assert np.array_equal(picture, field.image(i))


def test_a_broken_image_is_an_error_that_names_it(run, tmp_path):
    run("lfsynth", "chart", "-o", tmp_path / "field", "--count", 4, "--size", "64x48", "--samples", 1)
    field = lf.open(tmp_path / "field")
    (tmp_path / "field" / field.names[2]).write_bytes(b"no picture")
    with pytest.raises(lf.InputError, match=pathlib.PurePath(field.names[2]).name) as error:
        field.image(2)
    assert error.value.exit_code == 3


def test_broken_images_are_left_out_with_a_warning(run, tmp_path):
    run("lfsynth", "chart", "-o", tmp_path / "field", "--count", 9, "--size", "32x24", "--samples", 1)
    field = lf.open(tmp_path / "field")
    whole = field.array()
    grid = field.grid()
    (tmp_path / "field" / field.names[2]).unlink()
    (tmp_path / "field" / field.names[7]).write_bytes(b"no picture")
    with pytest.warns(lf.MissingImagesWarning, match="2 LF images were left out.*0002"):
        found = [i for i, _ in field.images(ahead=3)]
    assert found == [0, 1, 3, 4, 5, 6, 8]
    with pytest.warns(lf.MissingImagesWarning, match="2 LF images"):
        array = field.array()
    for i in range(9):
        place = tuple(np.argwhere(grid.ids == i)[0])
        assert np.isnan(array[place]).all() if i in (2, 7) else np.array_equal(array[place], whole[place])
    for action in (lambda: list(field.images(strict=True)), lambda: field.array(strict=True)):
        with pytest.raises(lf.InputError, match="0002"):
            action()


def test_images_are_loaded_as_stored(field):
    for i, picture in field.images([4, 2], stored=True):
        assert picture.dtype == np.uint8 and np.array_equal(picture, field.image(i, stored=True))


def test_masked_pixels_have_the_value_that_is_asked_for(tmp_path):
    lf.synth("chart", tmp_path / "field", count=4, size=(48, 32), samples=1, alpha="straight", format="png")
    field = lf.open(tmp_path / "field", image_alpha="mask")
    (_, with_nan), (_, with_zero) = next(field.images()), next(field.images(masked=0))
    assert np.isnan(with_nan).any() and np.array_equal(np.nan_to_num(with_nan), with_zero)


def test_intrinsics_are_read_only(field):
    k = field.intrinsics[0]
    with pytest.raises(ValueError):
        k.K[0, 0] = 1
    assert isinstance(k.parameters, tuple) and len(k.parameters) == 12


def test_points_and_pixels_may_have_any_shape(field):
    points = np.random.default_rng(3).uniform(-0.2, 0.2, (4, 5, 3)) + [0, 0, 1.5]
    pixels = field.project(3, points)
    assert pixels.shape == (4, 5, 2) and np.array_equal(pixels[2], field.project(3, points[2]))
    assert np.array_equal(field.project(3, points[1, 1]), pixels[1, 1])
    origins, directions = field.rays(3, pixels)
    assert origins.shape == directions.shape == (4, 5, 3)
    assert field.project(3, []).shape == (0, 2) and field.rays(3, [])[1].shape == (0, 3)
    for wrong in ([1, 2], 5, np.ones((3, 2))):
        with pytest.raises(lf.UsageError, match="points: expected an array of shape"):
            field.project(3, wrong)


def test_a_grid_is_found(field):
    grid = field.grid()
    assert grid.shape == (7, 7)
    assert np.allclose(grid.pitch, 0.01)
    right, down = field.cam_from_world[0, 0, :3], field.cam_from_world[0, 1, :3]
    assert np.allclose(np.diff(field.centres[grid.ids] @ right, axis=1), 0.01)
    assert np.allclose(np.diff(field.centres[grid.ids] @ down, axis=0), 0.01)


def test_no_grid_where_there_is_none(run, tmp_path):
    run("lfsynth", "chart", "-o", tmp_path / "field", "--count", 30, "--size", "32x24", "--samples", 1,
        "--capture", "hemisphere")
    assert lf.open(tmp_path / "field").grid() is None


def test_arrays_of_a_grid(field, tmp_path):
    grid = field.grid()
    whole = field.array()
    assert whole.shape == (7, 7, 120, 160, 3)
    assert np.array_equal(whole[2, 5], field.image(int(grid.ids[2, 5])))
    file = np.memmap(tmp_path / "array", np.float32, "w+", shape=(3, 3, 60, 80, 3))
    some = field.array(views=(3, 3), reduce=2, out=file)
    assert some is file
    corner = field.image(int(grid.ids[6, 6])).reshape(60, 2, 80, 2, 3).mean(axis=(1, 3))
    assert np.allclose(file[2, 2], corner, atol=1e-6)
    with pytest.raises(lf.UsageError, match="expected"):
        field.array(out=np.empty((1, 2)))
    read_only = np.memmap(tmp_path / "array", np.float32, "r", shape=(3, 3, 60, 80, 3))
    with pytest.raises(lf.UsageError, match="cannot be written"):
        field.array(views=(3, 3), reduce=2, out=read_only)


def test_what_is_no_light_field(tmp_path):
    with pytest.raises(lf.InputError, match=str(tmp_path)) as error:
        lf.open(tmp_path)
    assert isinstance(error.value, ValueError) and isinstance(error.value, lf.Error)


def test_notebooks_show_the_rig(field):
    html = field._repr_html_()
    assert html.count("<circle") == 49 and "160 x 120" in html


def test_ctrl_c_interrupts_the_opening(tmp_path):
    code = """
import os, signal, threading, time
import lfrendertools as lf
lf.synth("still-life", "many", capture="hemisphere", count=150000, calibration_only=True)
lf.open("many")
def threads():
    return len(os.listdir("/proc/self/task"))
# Interrupts an opening. Returns True if it goes on in the background.
def is_left_behind():
    before, ended = threads(), threading.Event()
    def interrupt():
        while threads() < before + 2:  # this thread, and that of the opening
            if ended.is_set():
                return
            time.sleep(0.001)
        signal.raise_signal(signal.SIGINT)
    thread = threading.Thread(target=interrupt)
    thread.start()
    try:
        lf.open("many")
        ended.set()
        thread.join()
        return False
    except KeyboardInterrupt:
        ended.set()
        thread.join()
    goes_on = threads() > before
    while threads() > before:
        time.sleep(0.01)
    return goes_on
# On a busy machine an opening may end before its interruption is noticed.
print("it goes on in the background:", any(is_left_behind() for _ in range(30)))
print("next:", len(lf.open("many")) > 140000)
"""
    end = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert end.stdout == "it goes on in the background: True\nnext: True\n", (end.stdout, end.stderr)
