# SPDX-License-Identifier: Apache-2.0
"""Grids of views: views at LF cameras are LF images, all are those of lffocus views, in memory and in files."""
import numpy as np
import pytest

import lfrendertools as lf


def test_views_at_lf_cameras_are_their_lf_images(field):
    grid = lf.views(field, (7, 7))
    np.testing.assert_array_equal(grid.ids, field.grid().ids)
    assert (grid.array.shape, grid.array.dtype, grid.focus_distance) == ((7, 7, 120, 160, 3), np.float32, None)
    for row, column in ((0, 0), (3, 5)):
        i = grid.ids[row, column]
        np.testing.assert_array_equal(grid.array[row, column], field.image(i))
        np.testing.assert_allclose(grid.cam_from_world[row, column], field.cam_from_world[i], atol=1e-12)
        np.testing.assert_allclose(grid.K[row, column], field.K[i], atol=1e-9)


@pytest.mark.parametrize("values", ["linear", "srgb8", "srgb16"])
def test_views_are_those_of_the_program(values, field, capture, run, tmp_path):
    run("lffocus", "views", capture, "--grid", "5x3", "--focus-distance", 0.9, "--values", values, "-o",
        tmp_path / "views.npy")
    told = []
    grid = lf.views(field, (3, 5), focus_distance=0.9, values=values,
                    progress=lambda done, total: told.append((done, total)))
    expected = np.load(tmp_path / "views.npy")
    assert (grid.array.dtype, told[-1], grid.focus_distance) == (expected.dtype, (15, 15), 0.9)
    np.testing.assert_array_equal(grid.array, expected)
    assert (grid.ids < 0).sum() == 6 and "6 of them rendered" in repr(grid)


def test_a_rendered_view_is_a_frame(field):
    """A frame of a pinhole at the same place, with the same orientation and picture."""
    grid = lf.views(field, (7, 5), focus_distance=0.9)
    assert grid.ids[2, 1] == -1
    pose, k = grid.cam_from_world[2, 1], grid.K[2, 1]
    camera = lf.Camera(-pose[:, :3].T @ pose[:, 3], world_from_cam=pose[:, :3].T, resolution=(160, 120),
                       focal_length_mm=36 * k[0, 0] / 160, aperture_diameter=0, focus_distance=0.9, unit_m=field.unit_m)
    np.testing.assert_allclose(camera.K, k, atol=1e-6)
    differences = np.abs(lf.render(field, camera).rgb - grid.array[2, 1])
    # The view is on the line between two LF cameras: where the last bits of its pose decide which others are its
    # neighbours, single elements differ.
    assert np.quantile(differences, 0.99) < 1e-5 and differences.mean() < 1e-3


def test_files_and_arrays_hold_the_same_views(field, tmp_path):
    h5py = pytest.importorskip("h5py")
    grid = lf.views(field, (2, 3), focus_distance=0.9)
    out = np.lib.format.open_memmap(tmp_path / "out.npy", mode="w+", dtype=np.float32, shape=grid.array.shape)
    assert lf.views(field, (2, 3), focus_distance=0.9, out=out).array is out
    np.testing.assert_array_equal(out, grid.array)
    for name in ("views.npy", "views.h5"):
        (tmp_path / name).write_text("old")
        assert lf.views(field, (2, 3), focus_distance=0.9, file=tmp_path / name).array is None
    np.testing.assert_array_equal(np.load(tmp_path / "views.npy"), grid.array)
    with h5py.File(tmp_path / "views.h5") as written:
        np.testing.assert_array_equal(written["views"], grid.array)
        np.testing.assert_array_equal(written["K"], grid.K)
        assert written["ids"].shape == (2, 3)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out.npy", "views.h5", "views.npy"]


def test_an_exception_of_progress_leaves_no_file(field, tmp_path):
    def stop(done, total):
        raise RuntimeError("enough")
    with pytest.raises(RuntimeError, match="enough"):
        lf.views(field, (40, 40), focus_distance=0.9, file=tmp_path / "views.npy", progress=stop)
    assert not list(tmp_path.iterdir())


def test_wrong_arguments_are_named(field, tmp_path):
    for words, error, given in (
            ("grid=0", lf.UsageError, {"grid": (0, 3)}), ("expected 2 whole numbers", lf.UsageError, {"grid": (3,)}),
            ("values=", lf.UsageError, {"values": "u8"}), ("out=3", TypeError, {"out": 3}),
            ("float64", lf.UsageError, {"out": np.empty((2, 2))}),
            ("at most one", lf.UsageError, {"out": 3, "file": "a"}),
            ("ends in .npy or .h5", lf.UsageError, {"file": "views.mat"}),
            ("cannot be written", lf.OutputError, {"file": tmp_path / "no" / "a.npy"}),
            ("focus_distance=-1", lf.UsageError, {"focus_distance": -1})):
        with pytest.raises(error, match=words):
            lf.views(field, **{"grid": (2, 2), **given})


def test_too_many_views_tell_the_bytes(field, monkeypatch):
    def empty(*_):
        raise MemoryError
    monkeypatch.setattr(np, "empty", empty)
    with pytest.raises(MemoryError, match=r"7 x 6 views of 160 x 120 pixels need 9676800 bytes .*file="):
        lf.views(field, (7, 6))
