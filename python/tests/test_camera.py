# SPDX-License-Identifier: Apache-2.0
"""Cameras and paths."""
import pickle
import warnings

import numpy as np
import pytest
from PIL import Image

import lfrendertools as lf


def camera(**changes):
    values = {"position": (0.1, -0.2, -1), "look_at": (0, 0, 1), "resolution": (120, 80), "focal_length_mm": 50,
              "f_number": 4, "focus_distance": 2.5, "blades": 7, "blade_rotation_deg": 10, "tilt_deg": (3, -5)}
    return lf.Camera(**{**values, **changes})


def test_properties():
    one = camera()
    assert one.resolution == (120, 80)
    assert np.allclose(one.position, (0.1, -0.2, -1))
    assert one.f_number == pytest.approx(4) and one.focal_length_mm == pytest.approx(50)
    assert one.aperture_diameter == pytest.approx(0.0125)
    assert one.K[0, 0] == pytest.approx(50 / 36 * 120)
    assert one.tilt_deg == pytest.approx((3, -5))
    forward = one.cam_from_world[2, :3]
    assert np.allclose(forward, np.array([-0.1, 0.2, 2]) / np.linalg.norm([-0.1, 0.2, 2]))
    normal, offset = one.focus_plane
    assert normal @ (one.position + 2.5 * forward) == pytest.approx(offset)


def test_the_three_ways_to_give_a_direction_agree():
    one = camera()
    matrix = one.cam_from_world[:, :3].T
    same = camera(look_at=None, world_from_cam=matrix)
    assert np.allclose(same.cam_from_world, one.cam_from_world, atol=1e-14)
    half_turn = np.diag([1.0, -1, -1])
    assert np.allclose(camera(look_at=None, quaternion=(0, 1, 0, 0)).cam_from_world[:, :3], half_turn)
    assert np.allclose(camera(look_at=None, world_from_cam=half_turn).cam_from_world[:, :3], half_turn)


@pytest.mark.parametrize("changes, words", [
    ({"look_at": None}, "look_at or quaternion or world_from_cam"), ({"f_number": None}, "f_number"),
    ({"focus_point": (0, 0, 1)}, "focus_distance and focus_point"), ({"blades": 2}, "blades"),
    ({"focus_distance": -1}, "focus_distance"), ({"position": (0, 0)}, "position"),
    ({"look_at": None, "world_from_cam": np.ones((3, 3))}, "rotation")])
def test_wrong_arguments(changes, words):
    with pytest.raises(ValueError, match=words) as error:
        camera(**changes)
    assert isinstance(error.value, lf.Error)


def test_replacing_and_comparing():
    one = camera()
    far = one.replace(focus_distance=5)
    assert far != one and far.focus_distance == 5 and np.allclose(far.K, one.K)
    assert far.replace(focus_distance=2.5).position == pytest.approx(one.position)
    assert one == camera() and hash(one) == hash(camera())
    assert one.replace(f_number=8).aperture_diameter == pytest.approx(one.aperture_diameter / 2)
    with pytest.raises(AttributeError):
        one.blades = 3


def test_what_does_not_change_keeps_its_bits(field):
    cameras = [camera(), camera(tilt_deg=(0, 0), up=(0.3, -1, 0)), field.camera(), camera(field_of_view_deg=33.3,
               focal_length_mm=None), camera(unit_m=0.0254, shift_mm=(1, 3), aperture_diameter_mm=7, f_number=None)]
    for one in cameras:
        assert one.replace(blades=one.blades) == one
        there = one.replace(focus_distance=1.25, blades=9)
        assert np.array_equal(there.cam_from_world, one.cam_from_world) and np.array_equal(there.K, one.K)
    breathing = camera(breathing=True, focus_distance=0.4)
    assert breathing.replace(f_number=8).f_number == pytest.approx(8)
    assert np.allclose(breathing.replace(f_number=8).K, breathing.K)


def test_the_time_of_a_camera_is_that_of_its_path(path):
    moved = lf.Path([path[1], path[1]], fps=12)
    path_file = lf.Path(path, fps=50)
    assert path[1] == moved[0] and hash(path[1]) == hash(moved[1]) and path_file[2] == path[2]
    still = lf.Path.parse("format: lfpath 1\nfps: 25\nframes: 2\nresolution: [60, 40]\n"
                          "camera: {field_of_view_deg: 40, position: [0, 0, 0], look_at: [0, 0, 1]}\n"
                          "lens: {aperture_diameter: 0.1, focus_distance: 1}\n")
    assert still[0] == still[1] and len({still[0], still[1]}) == 1


def test_frames_per_second_are_checked(path):
    path = lf.Path(path)
    path.fps = 12.5
    assert path.fps == 12.5
    for wrong in (-5, 0, float("nan")):
        with pytest.raises(lf.UsageError, match="fps"):
            path.fps = wrong
    with pytest.raises(TypeError, match="fps"):
        path.fps = "24"


def test_up_needs_a_point_to_look_at():
    with pytest.raises(lf.UsageError, match="up.*look_at"):
        camera(look_at=None, quaternion=(1, 0, 0, 0), up=(0, -1, 0))
    with pytest.raises(lf.UsageError, match="up.*look_at"):
        camera().replace(up=(1, 0, 0))
    turned = camera().replace(look_at=(0, 0, 1), up=(1, 0, 0))
    assert np.allclose(turned.cam_from_world, camera(up=(1, 0, 0)).cam_from_world, rtol=0, atol=1e-15)


def test_an_uncertain_focus_is_told(tmp_path):
    """Images without texture do not tell how far the subject is."""
    from PIL import Image
    field = lf.synth("chart", tmp_path / "field", count=9, size=(96, 64), samples=1, format="png")
    for name in field.names:
        Image.new("RGB", (96, 64), (90, 90, 90)).save(tmp_path / "field" / name)
    field = lf.open(tmp_path / "field")
    for action in (field.camera, field.path, lambda: field.camera(blades=5)):
        with pytest.warns(lf.UncertainFocusWarning, match="focus_distance="):
            action()
    with pytest.warns(lf.UncertainFocusWarning):
        pinhole = field.camera()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert field.camera(focus_distance=1).aperture_diameter > 2 * field.spacing > pinhole.aperture_diameter
        assert field.camera(focus_distance=1) == field.path("static", focus_distance=1)[0]


def test_pickles_are_equal():
    path = lf.Path([camera(), camera(focus_distance=3)], fps=12)
    assert pickle.loads(pickle.dumps(path)) == path
    assert pickle.loads(pickle.dumps(path[0])) == path[0]


def test_saved_paths_are_read_again(tmp_path, path):
    still = lf.Path([camera()] * 3)
    moving = lf.Path([camera(position=(0.1 * i, 0, -1), focus_distance=2 + 0.1 * i, f_number=4 + i,
                             tilt_deg=(i, -i), look_at=(0, 0.05 * i, 1)) for i in range(30)], fps=29.97)
    for number, one in enumerate((still, moving, path)):
        file = tmp_path / f"{number}.yaml"
        one.save(file)
        again = lf.Path.load(file)
        assert len(again) == len(one) and again.fps == one.fps
        for a, b in zip(again, one):
            assert np.array_equal(a.position, b.position) or np.allclose(a.position, b.position, rtol=0, atol=1e-15)
            assert a.focus_distance == b.focus_distance and a.aperture_diameter == pytest.approx(
                b.aperture_diameter, abs=1e-16)
            assert np.allclose(a.cam_from_world, b.cam_from_world, rtol=0, atol=1e-12)
            assert np.allclose(a.K, b.K, rtol=1e-12)
            assert a.blades == b.blades and a.tilt_deg == pytest.approx(b.tilt_deg, abs=1e-12)
    assert sorted(file.name for file in tmp_path.iterdir()) == ["0.yaml", "1.yaml", "2.yaml"]


@pytest.mark.parametrize("name, format", [("n.json", None), ("b.json", "instant-ngp")])
def test_json_keeps_every_bit(tmp_path, path, name, format):
    path.save(tmp_path / name, format)
    again = lf.Path.load(tmp_path / name)
    assert again == path
    assert ("instant" in (format or "")) == ('"path"' in (tmp_path / name).read_text())


def test_paths_of_other_programs_are_loaded(tmp_path):
    file = tmp_path / "nuke.chan"
    file.write_text("1 1 2 3 0 0 0 40\n2 1 2 4 0 0 0 40\n")
    nuke = lf.Path.load(file)
    assert len(nuke) == 2 and nuke[0].resolution == (1920, 1080)
    assert np.allclose(nuke[1].position, (1, 2, 4)) and nuke[0].aperture_diameter == 0
    nuke.save(tmp_path / "again.chan")
    assert np.allclose(np.loadtxt(tmp_path / "again.chan"), np.loadtxt(file), atol=1e-9)
    nuke.save(tmp_path / "scene", "usda")
    assert (tmp_path / "scene").read_text().startswith("#usda 1.0")
    nuke.save(tmp_path / "scene.txt")
    assert (tmp_path / "scene.txt").read_text().startswith("format: lfpath 1")
    with pytest.raises(lf.UsageError, match="found \"abc\""):
        nuke.save(tmp_path / "scene", "abc")


def test_paths_that_a_file_cannot_say(tmp_path):
    with pytest.raises(lf.UsageError, match="blades"):
        lf.Path([camera(), camera(blades=5)]).save(tmp_path / "path.yaml")
    with pytest.raises(lf.UsageError, match="resolution"):
        lf.Path([camera(), camera(resolution=(60, 40))])
    with pytest.raises(lf.OutputError):
        lf.Path([camera()]).save(tmp_path / "missing" / "path.yaml")


def test_a_saved_path_replaces_paths_alone(tmp_path):
    path = lf.Path([camera()])
    lf.synth("chart", tmp_path / "field", count=1, size=(16, 12), samples=1)
    calibration = tmp_path / "field/transforms.json"
    before = calibration.read_bytes()
    with pytest.raises(lf.UsageError, match="transforms.json: exists, and is not a camera path"):
        path.save(calibration)
    assert calibration.read_bytes() == before
    for name in ("path.yaml", "path.json", "path.usda"):
        path.save(tmp_path / name)
        path.save(tmp_path / name)


def test_path_files_have_their_errors(tmp_path):
    file = tmp_path / "path.yaml"
    file.write_text("format: lfpath 1\nfpss: 24\n")
    with pytest.raises(lf.InputError, match="path.yaml:2.*fps"):
        lf.Path.load(file)
    with pytest.raises(lf.InputError, match="missing.yaml"):
        lf.Path.load(tmp_path / "missing.yaml")


def test_cameras_of_a_light_field(field):
    one = field.camera()
    assert one.unit_m == field.unit_m and max(one.resolution) <= 160
    assert np.allclose(one.position, field.centres[24], atol=1e-9)
    assert 0.5 < one.focus_distance < 4
    assert field.camera(f_number=2, focal_length_mm=35).f_number == pytest.approx(2)
    assert field.camera(focus_distance=1.25) == one.replace(focus_distance=1.25)


def test_first_paths(field, capture, run, tmp_path):
    run("lfexample", capture, "-o", tmp_path / "path.yaml", "--camera", 24, "--focus", 1.1, "--move", "orbit")
    assert field.path("orbit", start=24, focus_distance=1.1) == lf.Path.load(tmp_path / "path.yaml", field.unit_m)
    with pytest.raises(lf.UsageError, match="focus-pull"):
        field.path("zoom")


def test_transmission(tmp_path):
    camera = lf.Camera((0, 0, -1), look_at=(0, 0, 0), resolution=(120, 80), focal_length_mm=50, f_number=4,
                       focus_distance=1)
    assert camera.transmission is None
    shares = np.rint(255 * np.random.default_rng(3).random((6, 6))) / 255
    stopped = camera.replace(transmission=shares)
    assert np.array_equal(stopped.transmission, shares) and stopped != camera
    assert camera.replace(transmission=shares[..., np.newaxis]) == stopped
    assert camera.replace(transmission=np.rint(shares * 255).astype(np.uint8)) == stopped
    assert pickle.loads(pickle.dumps(stopped)) == stopped and hash(stopped) != hash(camera)
    assert np.array_equal(stopped.replace(f_number=2).transmission, shares)
    assert stopped.replace(transmission=None) == camera
    lf.Path([stopped, stopped]).save(tmp_path / "path.yaml")
    assert np.array_equal(lf.Path.load(tmp_path / "path.yaml")[1].transmission, shares)
    with pytest.raises(lf.UsageError, match="transmission"):
        lf.Path([stopped, camera]).save(tmp_path / "two.yaml")
    for wrong in (np.zeros((2, 2)), np.ones(3), np.full((2, 2), 1.5), np.zeros((0, 2)), [[np.nan]]):
        with pytest.raises(lf.UsageError, match="transmission"):
            camera.replace(transmission=wrong)
    with pytest.raises(lf.InputError, match="nowhere.png"):
        camera.replace(transmission=tmp_path / "nowhere.png")


def test_transmission_as_text():
    camera = lf.Camera((0, 0, -1), look_at=(0, 0, 0), resolution=(120, 80), focal_length_mm=50, f_number=4,
                       focus_distance=1, transmission="00ff/ff80")
    np.testing.assert_array_equal(np.rint(camera.transmission * 255), [[0, 255], [255, 128]])
    with pytest.raises(lf.UsageError, match="transmission='heart' is no file, and as the text of a transmission: "):
        camera.replace(transmission="heart")


def test_transmission_of_a_picture(tmp_path):
    picture = np.zeros((40, 30, 4), np.uint8)
    picture[:20] = 255
    Image.fromarray(picture).save(tmp_path / "half.png")
    camera = lf.Camera((0, 0, -1), look_at=(0, 0, 0), resolution=(120, 80), focal_length_mm=50, f_number=4,
                       focus_distance=1, transmission=tmp_path / "half.png")
    assert camera.transmission.shape == (40, 40)
    assert camera.transmission[:20, 5:35].min() == 1 and camera.transmission.sum() == 20 * 30


def test_shift_and_shape_survive_files_and_pickle(tmp_path):
    camera = lf.Camera((0, 0, -1), look_at=(0, 0, 0), resolution=(120, 80), focal_length_mm=50, f_number=4,
                       focus_distance=1, shift_mm=(6, -3), blades=6, blade_roundness=0.3, ratio=1.8, hood=(0.1, 0.05))
    assert np.allclose(camera.shift_mm, (6, -3)) and camera.blade_roundness == 0.3 and camera.ratio == 1.8
    assert np.allclose(camera.K[:2, 2], (60 - 20, 40 - 10))
    assert pickle.loads(pickle.dumps(camera)) == camera
    moved = camera.replace(shift_mm=(0, 0))
    lf.Path([camera, moved]).save(tmp_path / "path.yaml")
    first, second = lf.Path.load(tmp_path / "path.yaml")
    assert np.allclose(first.shift_mm, (6, -3)) and np.allclose(second.shift_mm, 0)
    assert first.ratio == second.ratio == 1.8 and first.hood == second.hood == (0.1, 0.05)
    for wrong in ({"shift_mm": 3}, {"ratio": 0}, {"blade_roundness": 2}, {"hood": 3}, {"hood": (0.1, -1)}):
        with pytest.raises((TypeError, lf.UsageError), match=next(iter(wrong))):
            camera.replace(**wrong)
    with pytest.raises(lf.UsageError, match="ratio"):
        lf.Path([camera, camera.replace(ratio=1)]).save(tmp_path / "other.yaml")
