# SPDX-License-Identifier: Apache-2.0
"""Epipolar pictures: their pixels are those of the LF images and of lffocus epi."""
import shutil

import numpy as np
import pytest

import lfrendertools as lf


def test_lines_are_those_of_the_lf_images(field):
    grid = field.grid()
    picture = lf.epi(field, row=31)
    assert (picture.rgb.shape, picture.lines) == ((7, 160, 3), "recorded")
    np.testing.assert_array_equal(picture.ids, grid.ids[3])
    np.testing.assert_allclose(np.diff(picture.positions), grid.pitch[0], rtol=1e-9)
    for line, i in zip(picture.rgb, picture.ids):
        np.testing.assert_array_equal(line, field.image(i)[31])
    column = lf.epi(field, column=40, through=int(grid.ids[0, 2]))
    np.testing.assert_array_equal(column.ids, grid.ids[:, 2])
    for line, i in zip(column.rgb, column.ids):
        np.testing.assert_allclose(line, field.image(i)[:, 40], atol=1e-6)


def test_points_at_the_focus_distance_do_not_move(field):
    """A point of the world is at the pixel that the slope of its depth gives."""
    picture = lf.epi(field, row=31, focus_distance=0.9)
    point = field.centres[picture.ids[3]] + picture.view_from_world.T @ [0.1, 0, 1.3]
    for position, i in zip(picture.positions, picture.ids):
        at = field.project(i, point)[0] + picture.focal_px * position / 0.9
        rate = -picture.focal_px * (1 / 1.3 - 1 / 0.9)
        assert at == pytest.approx(field.project(picture.ids[3], point)[0] + rate * position, abs=1e-6)


def test_the_program_makes_the_same_picture(field, capture, run, tmp_path):
    name = field.names[9]
    run("lffocus", "epi", capture, "--row", 60, "--through", name, "--focus-distance", 0.8, "--lines", "linear",
        "--count", 20, "-o", tmp_path / "epi.exr")
    picture = lf.epi(field, row=60, through=name, focus_distance=0.8, lines="linear", count=20)
    np.testing.assert_array_equal(lf.read_image(tmp_path / "epi.exr"), picture.rgb)
    assert np.isnan(picture.rgb).any() and len(picture.positions) == 20


def test_missing_lf_images_are_told(capture, tmp_path):
    shutil.copytree(capture, tmp_path / "field")
    field = lf.open(tmp_path / "field")
    (tmp_path / "field" / field.names[22]).unlink()
    with pytest.warns(lf.MissingImagesWarning):
        picture = lf.epi(field, row=5)
    assert np.isnan(picture.rgb[list(picture.ids).index(22)]).all()
    with pytest.raises(lf.InputError):
        lf.epi(field, row=5, strict=True)


def test_wrong_arguments_are_named(field):
    for words, given in (("expected one of them", {}), ("expected one of them", {"row": 1, "column": 1}),
                         ("row 120", {"row": 120}), ("lines=", {"row": 1, "lines": "cubic"}),
                         ("count cannot", {"row": 1, "lines": "recorded", "count": 4}),
                         ("through=49", {"row": 1, "through": 49}), ("no LF image", {"row": 1, "through": "x.png"}),
                         ("count=1", {"row": 1, "count": 1}), ("focus_distance=0", {"row": 1, "focus_distance": 0})):
        with pytest.raises(lf.UsageError, match=words):
            lf.epi(field, **given)
