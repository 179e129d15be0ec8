# SPDX-License-Identifier: Apache-2.0
"""Cameras that are in focus on a surface: their frames are those of lfrenderer, and copies keep the surface or say."""
import pickle

import numpy as np
import pytest

import lfrendertools as lf


def write_pfm(file, depths):
    height, width = depths.shape
    file.write_bytes(f"Pf\n{width} {height}\n-1\n".encode() + depths[::-1].astype("<f4").tobytes())


@pytest.fixture()
def depths():
    y, x = np.mgrid[0:80, 0:120]
    surface = (0.9 + 0.2 * np.sin(x / 20) * np.cos(y / 15)).astype(np.float32)
    surface[30:40, 50:60] = np.nan
    return surface


def test_frames_are_those_of_the_program(field, path, path_file, capture, depths, run, tmp_path):
    write_pfm(tmp_path / "z.pfm", depths)
    of_program = tmp_path / "path.yaml"
    of_program.write_text(path_file.read_text() + "focus: {surface: z.pfm, kind: depth}\n")
    run("lfrenderer", capture, of_program, "-o", tmp_path / "out", "--frames", 1)
    run("lffocus", "through", capture, of_program, "-o", tmp_path / "through.exr")
    camera = path[0].with_surface(depths, field)
    film = lf.Path([camera], fps=path.fps)
    lf.render(field, film).save(tmp_path / "frame.exr")
    assert (tmp_path / "frame.exr").read_bytes() == (tmp_path / "out/frame_0001.exr").read_bytes()
    lf.through(field, film).save(tmp_path / "seen.exr")
    assert (tmp_path / "seen.exr").read_bytes() == (tmp_path / "through.exr").read_bytes()
    assert not np.array_equal(lf.render(field, camera).rgb, lf.render(field, path[0]).rgb)


def test_the_surface_is_near_the_depths(path, depths):
    surface = path[0].with_surface(depths, blur=0.01).surface
    known = np.isfinite(depths)
    np.testing.assert_allclose(surface[known], depths[known], rtol=0.02)
    assert np.isfinite(surface).all() and path[0].surface is None
    coarse = path[0].with_surface(depths, blur=100).surface
    assert np.abs(coarse - depths)[known].max() > np.abs(surface - depths)[known].max()


def test_copies_keep_the_surface_or_say_why_not(path, depths):
    camera = path[0].with_surface(depths)
    assert camera != path[0] and hash(camera) != hash(path[0])
    assert camera.with_surface(None) == path[0]
    again = pickle.loads(pickle.dumps(camera))
    assert again == camera
    np.testing.assert_array_equal(again.surface, camera.surface)
    wider = camera.replace(aperture_diameter=0.06)
    np.testing.assert_array_equal(wider.surface, camera.surface)
    assert wider.aperture_diameter == 0.06
    for changes in ({"position": (0, 0, -2)}, {"resolution": (60, 40)}, {"field_of_view_deg": 20}):
        with pytest.raises(lf.UsageError, match=r"with_surface\(None\)"):
            camera.replace(**changes)


def test_wrong_depths_are_errors(path, depths):
    camera = path[0]
    with pytest.raises(lf.UsageError, match=r"shape is \(80, 119\), expected \(80, 120\)"):
        camera.with_surface(depths[:, :-1])
    with pytest.raises(lf.UsageError, match="no element has a depth"):
        camera.with_surface(np.full((80, 120), np.nan))
    with pytest.raises(lf.UsageError, match="blur=0"):
        camera.with_surface(depths, blur=0)


def test_what_knows_planes_only_says_so(field, path, path_file, depths, tmp_path):
    camera = path[0].with_surface(depths, field)
    with pytest.raises(lf.UsageError, match="focal surface"):
        lf.focus_stack(field, camera, [0.8, 1])
    with pytest.raises(lf.UsageError, match="shutter: a camera has a focal surface"):
        lf.Path([camera, camera], fps=25, shutter=(180, 4))
    with pytest.raises(lf.UsageError, match="focal surface"):
        lf.render(field, camera, mode="rebin", interpolation="cells")
    with pytest.raises(lf.UsageError, match=r"with_surface\(None\)"):
        lf.Path([camera], fps=25).save(tmp_path / "a.yaml")
    of_program = tmp_path / "path.yaml"
    of_program.write_text(path_file.read_text() + "focus: {surface: z.pfm, kind: depth}\n")
    write_pfm(tmp_path / "z.pfm", depths)
    with pytest.raises(lf.InputError, match="with_surface"):
        lf.Path.load(of_program, field.unit_m)
