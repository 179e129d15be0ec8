# SPDX-License-Identifier: Apache-2.0
"""Wrong arguments: errors name the argument, and never the types of C++ or the options of programs."""
import os
import re
import shutil
import threading

import numpy as np
import pytest

import lfrendertools as lf

CAMERA = {"position": (0.1, -0.2, -1), "look_at": (0, 0, 1), "resolution": (120, 80), "focal_length_mm": 50,
          "f_number": 4, "focus_distance": 2.5}


def refuses(action, words, *kinds):
    """Asserts that the action raises an error of one of these kinds whose message has these words."""
    with pytest.raises(kinds or TypeError, match=words) as error:
        action()
    for foreign in ("incompatible", "lfrendertools._core", "--"):
        assert foreign not in str(error.value), error.value


@pytest.mark.parametrize("words", ["focal_px", "fov_deg", "plane_distance", "flip_x"])
def test_types_of_open(words, capture):
    refuses(lambda: lf.open(capture, **{words: "x"}), words)
    for name in ("image_scale", "background"):
        refuses(lambda: lf.open(capture, **{name: 3}), name)


def test_values_of_open(capture):
    for changes in ({"focal_px": -1}, {"focal_px": float("nan")}, {"fov_deg": -5}, {"image_alpha": "zz"},
                    {"pitch": (1, 2, 3)}, {"pitch": 1}, {"focal_px": 500}, {"image_scale": "x"}, {"flip_x": True}):
        refuses(lambda: lf.open(capture, **changes), next(iter(changes)), lf.UsageError)
    refuses(lambda: lf.open("a\0b"), "character 0", lf.UsageError)


def test_pairs_of_numpy_are_a_pitch(tmp_path, field, capture):
    from PIL import Image
    for row in range(2):
        for column in range(2):
            Image.new("RGB", (16, 12)).save(tmp_path / f"out_{row:02}_{column:02}.png")
    for pitch in ([1, 2], np.array([1, 2]), (np.float32(1), 2)):
        opened = lf.open(tmp_path, pitch=pitch, focal_px=np.int64(20), plane_distance=np.float32(5))
        assert opened.grid().pitch == pytest.approx((1, 2))


def test_a_grid_orders_images_of_any_names(tmp_path, capture):
    for place, file in enumerate(sorted(capture.rglob("*.png"))[:6]):
        shutil.copy(file, tmp_path / f"frame {place + 8}.png")
    words = {"grid": (3, 2), "pitch": 1, "focal_px": 100}
    assert lf.open(tmp_path, **words).centres.tolist() == [[x, y, 0] for y in (-0.5, 0.5) for x in (-1, 0, 1)]
    assert lf.open(tmp_path, serpentine=True, **words).centres[:, 0].tolist() == [-1, 0, 1, 1, 0, -1]
    with pytest.raises(lf.InputError, match="holds 6 images"):
        lf.open(tmp_path, **{**words, "grid": (4, 2)})
    for wrong in ((3,), (3, 2, 1), ("3", "2"), 6, (2.5, 2)):
        with pytest.raises(TypeError if wrong in (("3", "2"), 6, (2.5, 2)) else ValueError):
            lf.open(tmp_path, **{**words, "grid": wrong})
    with pytest.raises(lf.UsageError):
        lf.open(tmp_path, **{**words, "grid": (0, 6)})


def test_names_that_are_not_utf8(tmp_path, capture, path):
    folder = os.fsdecode(os.fsencode(tmp_path) + b"/\xff")
    refuses(lambda: lf.open(folder), "no such", lf.InputError)
    os.symlink(capture, folder)
    field = lf.open(folder)
    assert len(field) == 49 and lf.render(field, path).image_count > 0
    path.save(folder + ".yaml")
    assert len(lf.Path.load(folder + ".yaml", field.unit_m)) == 3
    lf.render(field, path).save(folder + ".png")
    assert os.path.getsize(folder + ".png") > 100
    assert all(isinstance(name, str) for name in field.names)
    refuses(lambda: lf.Plate.load(folder + ".plate"), "cannot be read", lf.InputError)
    assert lf.report(field)["images"] == 49 and lf.forecast(field, path)["frames"]
    assert len(lf.write_packages(field, path, os.path.join(tmp_path, "\udcfe"), 1)["packages"]) == 1
    lf.compress(field, folder + ".lfs")
    path.save(folder + ".yaml")
    lf.synth("chart", os.path.join(tmp_path, "\udcfd"), count=1, size=(16, 12), samples=1, truth=folder + ".yaml",
             truth_samples=1)
    assert len(os.listdir(tmp_path)) == 6


def test_numbers_of_lf_images(field):
    for action in (lambda i: field.project(i, [[0, 0, 1]]), lambda i: field.rays(i, [[1, 1]]), field.image,
                   lambda i: list(field.images([i])), lambda i: field.path("static", start=i, focus_distance=1)):
        for wrong in ("0", 1.5, [0]):
            refuses(lambda: action(wrong), "whole number")
        for wrong in (-1, 49, 10**30):
            refuses(lambda: action(wrong), "from 0 to 48", IndexError)
    assert np.array_equal(field.image(np.uint8(3)), field.image(3))
    assert field.rays(True, [[1, 1]])[0].shape == (1, 3)


def test_arrays_as_arguments(field):
    for wrong in ("abc", [["a", "b", "c"]], [[0, 0, 1], [0, 0]]):
        refuses(lambda: field.project(0, wrong), "points: expected an array of numbers")
    for wrong in ("0,0,1,1", 5, (0.5, 0, 1, 1)):
        refuses(lambda: field.image(0, wrong), "rect")
    for wrong in ((0, 0, 1), (0, 0, 2**40, 1)):
        refuses(lambda: field.image(0, wrong), "rect", lf.UsageError)
    refuses(lambda: field.image(0, masked="x"), "masked")
    refuses(lambda: field.array((2, 2, 2)), "views", lf.UsageError)
    refuses(lambda: field.array(out=5), "out")
    refuses(lambda: field.array((1, 2), out=np.empty((1, 2, 120, 160, 3), np.uint8)), "uint8", lf.UsageError)
    assert field.array(np.array([1, 2])).shape == (1, 2, 120, 160, 3)
    assert (field.grid() == field.grid()) is False


@pytest.mark.parametrize("name", [name for name in CAMERA] + ["tilt_deg", "blades", "unit_m", "breathing", "up"])
def test_text_is_no_value_of_a_camera(name):
    refuses(lambda: lf.Camera(**{**CAMERA, name: "xy"}), name)


def test_values_of_cameras():
    refuses(lambda: lf.Camera(**CAMERA, tilt_deg=(1,)), "tilt_deg", lf.UsageError)
    refuses(lambda: lf.Camera(**CAMERA, tilt_deg=(91, 0)), "^tilt_deg.horizontal: expected", lf.UsageError)
    refuses(lambda: lf.Camera(**{**CAMERA, "f_number": 0}), "^f_number: expected", lf.UsageError)
    numpy = lf.Camera(**{**CAMERA, "resolution": np.array([120, 80]), "focal_length_mm": np.array(50)},
                      breathing=np.bool_(False), blades=np.int64(5))
    assert numpy == lf.Camera(**CAMERA, blades=5)


def test_values_of_paths(tmp_path):
    camera = lf.Camera(**CAMERA)
    refuses(lambda: lf.Path([camera, 1]), "lf.Camera")
    for fps in (0, -1, float("nan"), 1e300):
        refuses(lambda: lf.Path([camera], fps), "fps", lf.UsageError)
    refuses(lambda: lf.Path([camera], "24"), "fps")
    for name in ("/", str(tmp_path / ("n" * 256))):
        refuses(lambda: lf.Path([camera]).save(name), name[-99:], lf.OutputError)
    refuses(lambda: lf.Path([camera]).save(""), "empty", lf.UsageError)
    refuses(lambda: lf.Path([camera]).save(str(tmp_path / "a\0b")), "character 0", lf.UsageError)
    refuses(lambda: lf.Path.load("a\0b"), "character 0", lf.UsageError)
    refuses(lambda: lf.Path.load("/dev/zero"), "device", lf.InputError)
    refuses(lambda: lf.Path.parse(5), "text")
    refuses(lambda: lf.Path.parse("\udcff"), "path:1", lf.InputError)


def test_replaced_cameras_are_saved_together(tmp_path):
    camera = lf.Camera(**CAMERA)
    lf.Path([camera, camera.replace(focus_distance=3), camera.replace(f_number=5)]).save(tmp_path / "path.yaml")
    assert [one.focus_distance for one in lf.Path.load(tmp_path / "path.yaml")] == [2.5, 3, 2.5]


def test_frames_of_a_path(field, path):
    numbers = [number for number, _ in lf.film(field, path, np.arange(1, 4), seed=np.int64(3), threads=np.int64(1))]
    assert numbers == [1, 2, 3]
    for wrong in ([1.5], ["1"], [float("nan")], 2, np.int64(2), np.arange(1.0, 3.0)):
        refuses(lambda: lf.render(field, path, frames=wrong), "frames")
    # This range would fill the memory if its numbers were made.
    for wrong in ("1-999999999", "999999999", "1-100000000000", "1-10x4"):
        refuses(lambda: lf.render(field, path, frames=wrong), "frames", lf.UsageError)


def test_what_is_rendered(field, path):
    refuses(lambda: lf.render("field", path), "lf.open")
    refuses(lambda: lf.render(field, [path[0]]), "lf.Path")
    for name, wrong in (("threads", -1), ("threads", 10**30), ("max_angle_deg", -1), ("max_angle_deg", float("nan"))):
        refuses(lambda: lf.render(field, path, **{name: wrong}), name, lf.UsageError)
    for name, wrong in (("threads", "no"), ("strict", "no"), ("strict", np.array([1, 2]))):
        refuses(lambda: lf.render(field, path, **{name: wrong}), name)
    refuses(lambda: lf.render(field, path, memory="1M"), '^memory="1 MiB" is too small', lf.OutputError)


@pytest.mark.parametrize("wrong", [3, None, 1.5, [1]])
def test_paths_of_files(wrong, field, path):
    frame = lf.render(field, path)
    for action, name in ((lambda: lf.open(wrong), "path"), (lambda: lf.Path.load(wrong), "path"),
                         (lambda: path.save(wrong), "path"), (lambda: frame.save(wrong), "path"),
                         (lambda: lf.Plate.load(wrong), "path"), (lambda: lf.read_image(wrong), "path"),
                         (lambda: lf.compress(field, wrong), "store"), (lambda: lf.synth("chart", wrong), "folder"),
                         (lambda: lf.write_packages(field, path, wrong), "folder")):
        refuses(action, f"^{name}=.*expected a path")
    if wrong is not None:
        refuses(lambda: lf.open(".", images=wrong), "^images=.*expected a path")
        refuses(lambda: lf.synth("chart", "x", truth=wrong), "^truth=.*expected a path")


def test_sequences(field, path, tmp_path):
    refuses(lambda: lf.Path(path[0]), "^cameras=<Camera.*expected lf.Camera objects")
    refuses(lambda: field.images(3), "^ids=3: expected numbers of LF images")
    for wrong in (0.1, "0.1", [[1]], ["a"]):
        refuses(lambda: lf.synth("chart", tmp_path, distortion=wrong), "^distortion=.*: expected 0 to 8 numbers")
    for wrong in (3, "ab", "a", None, [1, "b"]):
        if wrong is not None:
            refuses(lambda: lf.forecast(field, path, depths=wrong), "^depths=.*: expected 2 numbers")
    refuses(lambda: lf.forecast(field, path, depths=(1,)), r"^depths=\(1,\): expected 2 numbers, found 1",
            lf.UsageError)
    refuses(lambda: field.array((3.0, 3)), r"^views=\(3.0, 3\): expected 2 whole numbers")
    refuses(lambda: field.image(0, (0, 0, 1000.0, 1)), r"^rect=\(0, 0, 1000.0, 1\): expected 4 whole numbers")
    assert lf.display_values([0, 1, float("nan")]).tolist() == [0, 255, 0]
    refuses(lambda: lf.display_values("white"), "^light: expected an array of numbers")


@pytest.mark.parametrize("function", [lf.render, lf.forecast, lf.select, lf.film])
def test_options_of_films(function, field, path):
    for name, wrong in (("max_images", "3"), ("seed", 1.5), ("seed", None), ("guard", 2), ("fill", 1.5), ("order", 1),
                        ("max_angle_deg", "9"), ("mode", None), ("memory", 8), ("memory", 8e9)):
        if function is lf.select and name == "mode":
            continue
        refuses(lambda: function(field, path, **{name: wrong}), f"^{name}={wrong!r}: expected")
    for name, wrong in (("max_images", -1), ("max_images", 10**30), ("seed", -1), ("seed", 2**64), ("fill", 10**30),
                        ("smooth_below", -1), ("max_angle_deg", 500), ("max_angle_deg", float("nan"))):
        refuses(lambda: function(field, path, **{name: wrong}), f"^{name}={wrong!r}: expected", lf.UsageError)


def test_values_that_files_cannot_hold(field, tmp_path):
    refuses(lambda: field.path("static", focus_distance=1e300), "^focus_distance=1e.300: expected", lf.UsageError)
    for options in ({"spacing": 1e300}, {"distance": 1e300}, {"distortion": (float("nan"),)}, {"fisheye": (1e9,)},
                    {"seed": -1}, {"count": 10**30}):
        refuses(lambda: lf.synth("chart", tmp_path / "field", **options), next(iter(options)), lf.UsageError)
    assert not (tmp_path / "field").exists()


def test_the_frame_of_a_selection(field, path):
    for wrong in (0, 4, -1):
        refuses(lambda: lf.select(field, path, wrong), f"^frame={wrong}: expected a whole number from 1 to 3",
                lf.UsageError)
    refuses(lambda: lf.select(field, path, 1.5), "^frame=1.5")


def test_a_camera_needs_a_position(field):
    refuses(lambda: lf.Camera(**{**CAMERA, "position": None}), "^position=None: expected 3 numbers")
    refuses(lambda: field.camera(position=None), "^position=None: expected 3 numbers")


def test_a_truth_of_another_unit(tmp_path):
    camera = lf.Camera(**CAMERA, unit_m=0.01)
    refuses(lambda: lf.synth("chart", tmp_path / "field", truth=lf.Path([camera])), "^truth: .*unit_m=0.01",
            lf.UsageError)


def test_commands_of_programs_keep_their_options(tmp_path):
    from PIL import Image
    for row in range(2):
        Image.new("RGB", (16, 12)).save(tmp_path / f"out_{row:02}_00.png")
    with pytest.raises(lf.InputError) as error:
        lf.open(tmp_path)
    assert "--pitch 1 --focal-px 16" in str(error.value) and "plane_distance" in str(error.value)
    refuses(lambda: lf.open(tmp_path, pitch=0, focal_px=20), r"the pitch \(pitch=\) is 0, 0 world units", lf.UsageError)
    pose = '{"imagefile": "a.png", "M3x4": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]}'
    (tmp_path / "poses.json").write_text('{"images": [' + pose + ']}')
    refuses(lambda: lf.open(tmp_path / "poses.json"), r"\(fov_deg=;", lf.InputError)


def test_messages_of_the_library_name_arguments(field, path, tmp_path):
    for options, words in (
            ({"mode": "rebin", "interpolation": "cells", "max_images": 3}, 'mode="rebin" with '
             'interpolation="cells" cannot be used with max_images=, because all frames share the cells of all LF '
             'images: leave max_images= out, or use interpolation="pixels" or mode="collect" without '
             'interpolation='),
            ({"xi": 0.25}, 'xi=0.25 changes nothing in mode="collect": add mode="rebin" or mode="hybrid", or leave it '
             'out'),
            ({"mode": "rebin", "interpolation": "pixels", "average_others": True}, 'interpolation="pixels" cannot be '
             'used with average_others=True, which changes cells alone: leave average_others= out, or use '
             'interpolation="cells"'),
            ({"mode": "rebin", "smooth_below": 3}, 'mode="rebin" collects no rays, which "samples>=N" (stop_when=, '
             'require=) and smooth_below= would count: leave these options out, use "noise<=X", or use mode="hybrid"'),
            ({"mode": "rebin", "slab_forward": (0, 0, 0)}, "slab_forward=(0, 0, 0): expected a direction, with at "
             "least one number other than 0"),
            ({"mode": "rebin", "reparameterise": False, "lens_sets": 2}, "reparameterise=False cannot be used with "
             "lens_sets= above 1: leave one of them out")):
        refuses(lambda: lf.render(field, path[0], **options), "^" + re.escape(words) + "$", lf.UsageError)
    lf.compress(field, tmp_path / "a.lfs")
    refuses(lambda: lf.compress(field, tmp_path / "a.lfs"),
            r"a\.lfs: exists already: replace it with overwrite=True, or check it with verify=True$", lf.UsageError)
    refuses(lambda: lf.Plate.load(tmp_path / "a.lfs"), "a.lfs", lf.InputError)


def test_a_closed_renderer_says_so(field, path):
    with lf.Renderer(field, path) as renderer:
        refuses(lambda: renderer.preview("x"), "whole number")
        refuses(lambda: renderer.preview(-1), "from 0", IndexError)
        refuses(lambda: renderer.plate() + 5, "operand")
        refuses(lambda: renderer.plate().develop("x"), "threads")
    for action in (renderer.step, renderer.preview, renderer.plate, renderer.stop, lambda: renderer.progress):
        refuses(action, "closed", lf.UsageError)


def test_threads_share_a_renderer(field, path):
    renderer = lf.Renderer(field, path)
    thread = threading.Thread(target=renderer.step)
    thread.start()
    counts = [renderer.preview(i).image_count for i in range(3)]
    thread.join()
    whole = [lf.render(field, path, frames=[i]) for i in (1, 2, 3)]
    # One step reads all LF images. A frame has them either all or not at all.
    assert all(count in (0, frame.image_count) for count, frame in zip(counts, whole))
    assert all(np.array_equal(renderer.preview(i).rgb, frame.rgb) for i, frame in enumerate(whole))


def test_a_misspelt_argument_is_told_with_the_nearest(field, path):
    camera = field.camera(focus_distance=1)
    for call, told in (
            (lambda: lf.Camera((0, 0, 0), focal_lenght_mm=50), "Camera(): unknown argument focal_lenght_mm; did you "
                                                               "mean focal_length_mm?"),
            (lambda: lf.Camera((0, 0, 0), focal_length=50), "did you mean focal_length_mm?"),
            (lambda: camera.replace(focus_distanc=2), "did you mean focus_distance?"),
            (lambda: field.camera(fnumber=2), "did you mean f_number?"),
            (lambda: field.path("orbit", focus_dist=2), "LightField.path(): unknown argument focus_dist; did you mean "
                                                        "focus_distance?"),
            (lambda: lf.Path([camera], fsp=25), "Path(): unknown argument fsp; did you mean fps?"),
            (lambda: lf.Path.load("no.yaml", unitm=1), "Path.load(): unknown argument unitm; did you mean unit_m?"),
            (lambda: lf.open("no", recorded_fsp=25), "open(): unknown argument recorded_fsp; did you mean "
                                                     "recorded_fps?"),
            (lambda: lf.views(field, (2, 2), focus=1), "did you mean focus_distance?"),
            (lambda: lf.Camera((0, 0, 0), xyzzy=1), "Camera(): unknown argument xyzzy")):
        with pytest.raises(TypeError) as error:
            call()
        assert str(error.value).endswith(told), error.value
    with pytest.raises(lf.UsageError, match="unknown option max_imges; did you mean max_images[?]: expected"):
        lf.render(field, camera, max_imges=3)


def test_a_warning_names_the_line_of_the_caller(field, tmp_path):
    path = lf.Path([field.camera(focus_distance=1)])
    with pytest.warns(UserWarning, match="no place for") as told:
        path.save(tmp_path / "path.json")
    assert [warning.filename for warning in told] == [__file__]
