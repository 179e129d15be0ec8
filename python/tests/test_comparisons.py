# SPDX-License-Identifier: Apache-2.0
"""Comparisons of pictures: their numbers and pictures are those of lfcompare."""
import json
import math

import numpy as np
import pytest

import conftest
import lfrendertools as lf


@pytest.fixture(scope="session")
def path_file(tmp_path_factory):
    """A path whose outermost elements are not covered by all LF images."""
    file = tmp_path_factory.mktemp("path") / "path.yaml"
    file.write_text(conftest.PATH.replace("field_of_view_deg: 40", "field_of_view_deg: 60"))
    return file


@pytest.fixture(scope="session")
def frames(run, capture, path_file, tmp_path_factory):
    """Returns the folders of three frames each: all rays, and those of the nearest LF pixels as PNG files."""
    folder = tmp_path_factory.mktemp("frames")
    run("lfrenderer", capture, path_file, "-o", folder / "exr", "--format", "exr-float")
    run("lfrenderer", capture, path_file, "-o", folder / "png", "--format", "png", "--estimator", "nearest")
    return folder


@pytest.fixture()
def report(programs, run):
    def of_program(reference, test, *words):
        return json.loads(run("lfcompare", reference, test, *words, "--json").stdout)["all"]
    return of_program


def assert_equal(found, expected):
    """Every number has the bits of the program."""
    for value, key in ((found.pixel_count, "pixels"), (found.undefined_count, "undefined"), (found.ssim, "ssim"),
                       (found.flip, "flip"), (found.psnr, "psnr_db"), (found.linear_psnr, "linear_psnr_db")):
        assert value == (math.inf if expected[key] is None else expected[key]), key


def test_files_arrays_and_frames_give_the_numbers_of_the_program(frames, report, field, path):
    exr, png = frames / "exr/frame_0002.exr", frames / "png/frame_0002.png"
    expected = report(exr, png)
    assert 20 < expected["psnr_db"] < 60
    frame = lf.render(field, path[1])
    for reference in (exr, str(exr), frame, frame.rgb, lf.read_image(exr)[..., :3], frame.rgb.astype(np.float64)):
        for test in (png, lf.read_image(png)):
            assert_equal(lf.compare(reference, test), expected)
    assert_equal(lf.compare(png, exr), report(png, exr))
    assert_equal(lf.compare(exr, exr), report(exr, exr))


def test_options_are_those_of_the_program(frames, report):
    exr, png = frames / "exr/frame_0001.exr", frames / "png/frame_0001.png"
    for words, options in ((["--border", 7], {"border": 7}), (["--coverage", 1], {"coverage": 1}),
                           (["--pixels-per-degree", 30], {"pixels_per_degree": 30})):
        expected = report(exr, png, *words)
        assert expected != report(exr, png)
        assert_equal(lf.compare(exr, png, **options), expected)
        assert_equal(lf.compare(exr, png, threads=3, **options), expected)


def test_coverage_of_frames_counts(frames, report, field, path):
    exr, png = frames / "exr/frame_0001.exr", frames / "png/frame_0001.png"
    assert_equal(lf.compare(lf.render(field, path[0]), png, coverage=1), report(exr, png, "--coverage", 1))


def test_pictures_of_differences_are_those_of_the_program(frames, run, tmp_path):
    exr, png = frames / "exr/frame_0003.exr", frames / "png/frame_0003.png"
    result = lf.compare(exr, png)
    for name, words, options in (("flip", [], {}), ("difference", ["--show", "difference"], {"show": "difference"}),
                                 ("gain", ["--show", "difference", "--gain", 3],
                                  {"show": "difference", "gain": 3})):
        run("lfcompare", exr, png, "-o", tmp_path / f"{name}.png", *words)
        np.testing.assert_array_equal(result.picture(**options), lf.read_image(tmp_path / f"{name}.png"))
    assert result.flip == pytest.approx(result.flip_map.mean(), rel=1e-6)


def test_forms_of_arrays(tmp_path):
    random = np.random.default_rng(3)
    grey = random.integers(0, 256, (20, 30), np.uint8)
    rgb = np.repeat(grey[..., None], 3, axis=2)
    opaque = np.dstack([rgb, np.full_like(grey, 255)])
    half = np.dstack([rgb, np.full_like(grey, 128)])
    sixteen = rgb.astype(np.uint16) * 257
    for same in (rgb, grey[..., None], opaque, sixteen, np.dstack([grey, np.full_like(grey, 255)]),
                 np.asfortranarray(rgb), np.flipud(np.flipud(rgb))):
        assert lf.compare(grey, same).psnr == math.inf
    assert lf.compare(rgb, half).psnr < 30
    light = rgb / 255.0
    assert lf.compare(light, np.dstack([light, random.random(grey.shape)])).linear_psnr == math.inf
    assert lf.compare(light, light.astype(np.float16)).linear_psnr > 60
    holes = light.copy()
    holes[3, 4, 1] = np.nan
    result = lf.compare(light, holes)
    assert (result.undefined_count, result.pixel_count, result.linear_psnr) == (1, 599, math.inf)
    assert repr(lf.compare(rgb, rgb)) == "<Comparison: PSNR inf dB, SSIM 1.0000, FLIP 0.0000>"


def test_wrong_arguments_are_named(frames, tmp_path):
    grey = np.zeros((20, 30), np.uint8)
    for error, words, given in (
            (lf.InputError, "test: has 30 x 10 pixels, expected 30 x 20", {"test": grey[:10]}),
            (lf.InputError, "frame_0001.png: has", {"test": frames / "png/frame_0001.png"}),
            (lf.InputError, "no pixel can be compared", {"border": 10}),
            (lf.InputError, "none.png", {"test": "none.png"}),
            (lf.InputError, tmp_path.name, {"test": tmp_path}),
            (lf.UsageError, "border=-1", {"border": -1}), (lf.UsageError, "coverage=2", {"coverage": 2}),
            (lf.UsageError, "pixels_per_degree=0", {"pixels_per_degree": 0}),
            (lf.UsageError, "threads", {"threads": -1}),
            (lf.UsageError, r"test: expected an array of shape .* found \(20,\)", {"test": grey[:, 0]}),
            (lf.UsageError, r"found \(20, 30, 5\)", {"test": np.zeros((20, 30, 5), np.uint8)}),
            (lf.UsageError, r"found \(0, 30\)", {"test": grey[:0]}),
            (TypeError, "test: expected a path, a Frame, or an array .* int64", {"test": grey.astype(np.int64)}),
            (TypeError, "found an array of object", {"test": None})):
        with pytest.raises(error, match=words):
            lf.compare(**({"reference": grey, "test": grey} | given))
    result = lf.compare(grey, grey)
    with pytest.raises(lf.UsageError, match="show='psnr'"):
        result.picture("psnr")
    with pytest.raises(lf.UsageError, match="gain=0"):
        result.picture("difference", 0)


def test_floats_that_look_like_values_of_a_display_are_asked_about():
    noise = np.random.default_rng(1)
    whole = noise.integers(0, 256, (24, 32, 3)).astype(np.float32)
    blurred = (whole + whole[::-1]) / 2 + np.float32(0.25)
    light = lf.compare(np.zeros((24, 32, 3), np.uint8), np.zeros((24, 32, 3), np.uint8))
    assert light.psnr == math.inf
    for values in (whole, blurred, whole.astype(np.float64), whole[..., 0]):
        grey = np.full(values.shape, 128, np.uint8)
        for pictures, name in (((grey, values), "test"), ((values, grey), "reference")):
            with pytest.raises(lf.UsageError) as told:
                lf.compare(*pictures)
            for words in (f"{name}: found floats up to 25", "linear light", f"{name}.round().astype(np.uint8)",
                          "any_range=True"):
                assert words in str(told.value)
            lf.compare(*pictures, any_range=True)
    # The remedy of the message.
    assert lf.compare(whole.round().astype(np.uint8), whole.astype(np.uint8)).psnr == math.inf


def test_bright_light_is_not_asked_about():
    light = np.random.default_rng(1).random((24, 32, 3), np.float32)
    for values in (light, 255 * light ** 8, 16 * light, 1000 * light, light - np.float32(0.1),
                   np.full_like(light, math.nan)):
        try:
            lf.compare(values, values)
        except lf.InputError:
            assert np.isnan(values).all()  # no pixel counts
