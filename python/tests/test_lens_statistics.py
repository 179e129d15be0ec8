# SPDX-License-Identifier: Apache-2.0
"""Statistics over the lens: they are those of lffocus through, and files have the same bytes."""
import pickle
import shutil
import subprocess
import sys

import numpy as np
import pytest

import lfrendertools as lf

STATISTICS = [{"statistic": "median"}, {"statistic": "trimmed", "trim": 0.3}, {"statistic": "min"},
              {"statistic": "max"}, {"statistic": "mean"}, {"statistic": "trimmed", "order": "luminance"},
              {"filter": "nearest", "max_angle_deg": 10}, {"lf_pixels": "areas", "memory": "64M", "threads": 2}]


@pytest.mark.parametrize("options", STATISTICS, ids=lambda options: "-".join(map(str, options.values())))
def test_frames_are_those_of_the_program(options, field, path, capture, path_file, run, tmp_path):
    words = [word for name, value in options.items()
             for word in (f"--{name.removesuffix('_deg').replace('_', '-')}", value)]
    run("lffocus", "through", capture, path_file, "-o", tmp_path / "program.exr", "-o", tmp_path / "program.png",
        "--frame", 2, *words)
    frame = lf.through(field, path, frame=2, **options)
    for suffix in ("exr", "png"):
        frame.save(tmp_path / f"python.{suffix}")
        assert (tmp_path / f"python.{suffix}").read_bytes() == (tmp_path / f"program.{suffix}").read_bytes()
    run("lffocus", "through", capture, path_file, "-o", tmp_path / "float.exr", "--format", "exr-float", "--frame", 2,
        *words)
    np.testing.assert_array_equal(frame.rgb, lf.read_image(tmp_path / "float.exr")[..., :3])
    assert frame.number == 2 and frame.camera == path[1] and frame.image_count > 5
    assert frame.count.max() == frame.image_count


def test_the_default_is_the_median(field, path):
    median = lf.through(field, path)
    np.testing.assert_array_equal(median.rgb, lf.through(field, path[0], "median").rgb)
    assert median.metadata["lf:statistic"] == "median" and "lf:statistic_trim" not in median.metadata
    trimmed = lf.through(field, path, "trimmed")
    assert trimmed.metadata["lf:statistic_trim"] == 0.25 and not np.array_equal(trimmed.rgb, median.rgb)
    np.testing.assert_array_equal(lf.through(field, path, "trimmed", 0.25).rgb, trimmed.rgb)


def test_the_mean_is_a_frame_without_lens_weights(field, path):
    mean = lf.through(field, path, "mean")
    rendered = lf.render(field, path, lens_weights="none", fill=0)
    seen = rendered.count.min(-1) > 0
    np.testing.assert_array_equal(mean.rgb[seen], rendered.rgb[seen])
    np.testing.assert_array_equal(mean.count, rendered.count)


def test_frames_are_pickled_and_may_have_alpha(field, path, tmp_path):
    frame = lf.through(field, path, "trimmed", 0.1)
    again = pickle.loads(pickle.dumps(frame))
    assert again.metadata == frame.metadata and np.array_equal(again.rgb, frame.rgb)
    assert frame.opacity is None
    for number, picture in enumerate((frame, again)):
        picture.save(tmp_path / f"{number}.exr", alpha=True)
    assert (tmp_path / "0.exr").read_bytes() == (tmp_path / "1.exr").read_bytes()
    alpha = lf.read_image(tmp_path / "0.exr")[..., 3]
    np.testing.assert_array_equal(alpha[frame.count[..., 0] > 0], 1)


def test_opacity_is_kept(run, tmp_path):
    run("lfsynth", "foliage", "-o", tmp_path / "clear", "--size", "60x40", "--count", 9, "--spacing", 0.05, "--samples",
        1, "--alpha", "straight", "--format", "png")
    field = lf.open(tmp_path / "clear", background="none")
    frame = lf.through(field, lf.Camera(position=(0, 0, -1), look_at=(0, 0, 0), resolution=(60, 40), focal_length_mm=50,
                                        aperture_diameter=0.2, focus_distance=1, unit_m=field.unit_m))
    assert frame.opacity.shape == (40, 60) and 0 <= frame.opacity.min() and frame.opacity.max() == 1


def test_progress_is_told(field, path):
    told = []
    lf.through(field, path, progress=lambda done, total: told.append((done, total)))
    assert told[-1][0] == told[-1][1] > 5 and told == sorted(told)


def test_a_broken_lf_image_is_left_out(capture, path, field, tmp_path):
    shutil.copytree(capture, tmp_path / "broken")
    image = tmp_path / "broken" / field.names[lf.select(field, path, lens_weights="none").ids[0]]
    image.write_bytes(image.read_bytes()[:500])
    field = lf.open(tmp_path / "broken")
    with pytest.warns(lf.MissingImagesWarning, match=f"1 LF image was.*{image.name}"):
        frame = lf.through(field, path)
    assert frame.count.max() == frame.image_count
    with pytest.raises(lf.InputError, match=image.name):
        lf.through(field, path, strict=True)


@pytest.mark.parametrize("wrong, words", [
    ({"statistic": "mode"}, "statistic='mode': expected one of median, trimmed, min, max, mean"),
    ({"statistic": "trimmed", "trim": 0.5}, "trim=0.5: expected a share from 0 to below 0.5"),
    ({"statistic": "trimmed", "trim": float("nan")}, "trim=nan"),
    ({"trim": 0.1}, "trim=0.1 cannot be used with statistic='median'"),
    ({"order": "colour"}, "order='colour'"), ({"filter": "mosaic"}, "filter='mosaic'"),
    ({"lf_pixels": "dots"}, "lf_pixels='dots'"), ({"max_angle_deg": 0}, "max_angle_deg=0"), ({"frame": 4}, "frame=4"),
    ({"memory": "lots"}, "^memory"), ({"threads": -1}, "threads=-1")])
def test_wrong_arguments_are_refused(wrong, words, field, path):
    with pytest.raises(lf.UsageError, match=words) as error:
        lf.through(field, path, **wrong)
    assert "--" not in str(error.value)


def test_lenses_without_an_order_are_refused(field, path):
    with pytest.raises(lf.UsageError, match="shutter"):
        lf.through(field, lf.Path(list(path), path.fps, shutter={"angle_deg": 180, "samples": 4}))
    with pytest.raises(lf.OutputError, match='^memory="1 MiB" is too small'):
        lf.through(field, path, memory="1M")
    with pytest.raises(lf.InputError, match="no LF camera"):
        lf.through(field, path[0].replace(position=(5, 0, -1)))


# With the least memory, which the error names, the frame has many parts, so that it takes much longer than a second.
# Each thread needs memory of its own.
INTERRUPTED = """
import os, re, signal, sys, threading
import lfrendertools as lf
field = lf.open(sys.argv[1])
camera = lf.Path.load(sys.argv[2], field.unit_m)[0]
large = camera.replace(resolution=(6000, 4000))
try:
    lf.through(field, large, memory="2300M", threads=2)
except lf.OutputError as error:
    least = re.search("at least ([0-9]+) MiB", str(error))[1]
threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT)).start()
try:
    lf.through(field, large, memory=f"{least}M", threads=2)
    print("finished")
except KeyboardInterrupt:
    print("interrupted")
print("next:", lf.through(field, camera).image_count > 0)
"""


def test_ctrl_c_interrupts(capture, path_file):
    end = subprocess.run([sys.executable, "-c", INTERRUPTED, capture, path_file], capture_output=True, text=True,
                         timeout=120)
    assert end.stdout.splitlines() == ["interrupted", "next: True"], end.stderr
