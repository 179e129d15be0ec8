# SPDX-License-Identifier: Apache-2.0
"""Depth maps: they are those of lffocus depth, and their points lie where the files say."""
import numpy as np
import pytest

import lfrendertools as lf

RANGE = {"near": 0.5, "far": 3}


@pytest.fixture
def found(field, path):
    return lf.depth_map(field, path, frame=2, **RANGE)


def test_maps_are_those_of_the_program(found, capture, path_file, run, tmp_path):
    run("lffocus", "depth", capture, path_file, "-o", tmp_path / "depth.exr", "-o", tmp_path / "points.ply", "--frame",
        2, "--near", 0.5, "--far", 3)
    written = lf.read_image(tmp_path / "depth.exr")
    height, width = found.depth.shape
    is_known = np.isfinite(found.depth)
    assert written.shape == (height, width, 5) and is_known.any() and not is_known.all()
    np.testing.assert_array_equal(np.where(is_known, found.depth, np.inf), written[..., 3])
    np.testing.assert_allclose(found.rgb, written[..., :3], rtol=1e-3, atol=1e-4)  # the file has half floats
    points = (tmp_path / "points.ply").read_bytes().split(b"end_header\n", 1)[1]
    record = np.dtype([("xyz", "<f4", 3), ("rgb", "u1", 3), ("confidence", "<f4")])
    np.testing.assert_allclose(found.points()[is_known], np.frombuffer(points, record)["xyz"], atol=1e-5)


def test_unknown_depths_are_nan_and_filled(found):
    is_known = np.isfinite(found.depth)
    assert np.isnan(found.points()[~is_known]).all()
    assert (found.filled > 0).all() and np.array_equal(found.filled[is_known], found.depth[is_known])
    assert (found.confidence[is_known] >= 0.5).all() and found.confidence.min() >= 0
    assert found.distances[0] < 0.5 and found.distances[-1] > 3 and found.image_count >= 12
    assert "known" in repr(found)


def test_less_confidence_knows_more(found, field, path):
    more = lf.depth_map(field, path, frame=2, confidence=0.1, threads=1, memory="3M", **RANGE)
    assert np.isfinite(more.depth).sum() > np.isfinite(found.depth).sum()
    np.testing.assert_array_equal(more.confidence, found.confidence)


def test_clean_maps_know_more_and_keep_what_was_right(found, field, path, capture, path_file, run, tmp_path):
    clean = lf.depth_map(field, path, frame=2, clean=True, **RANGE)
    is_known = np.isfinite(found.depth)
    assert np.isfinite(clean.depth).sum() > is_known.sum() and np.isfinite(clean.depth)[is_known].all()
    assert (clean.depth == found.depth)[is_known].mean() > 0.9
    run("lffocus", "depth", capture, path_file, "-o", tmp_path / "clean.exr", "--frame", 2, "--near", 0.5, "--far", 3,
        "--clean")
    np.testing.assert_array_equal(np.where(np.isfinite(clean.depth), clean.depth, np.inf),
                                  lf.read_image(tmp_path / "clean.exr")[..., 3])


def test_progress_is_told(field, path):
    told = []
    lf.depth_map(field, path, planes=4, progress=lambda done, total: told.append((done, total)), **RANGE)
    assert told[-1] == (120 * 80, 120 * 80) and told == sorted(told)


@pytest.mark.parametrize("wrong", [{"near": 2, "far": 1}, {"window": 4}, {"planes": 1}, {"views": 2},
                                   {"confidence": 1.5}, {"frame": 9}])
def test_wrong_arguments_are_refused(wrong, field, path):
    with pytest.raises(lf.UsageError):
        lf.depth_map(field, path, **{**RANGE, **wrong})
