# SPDX-License-Identifier: Apache-2.0
"""Paths whose frames are numbered from another number than 1."""
import json

import numpy as np
import pytest

import lfrendertools as lf


def plates(field, **keys):
    camera = field.camera(resolution=(40, 30))
    return lf.Path([camera, camera.replace(focus_distance=2 * camera.focus_distance)], **keys)


def test_frames_are_named_by_the_numbers_of_the_path(field):
    path, one = plates(field, first_frame=1001), plates(field)
    frames = dict(lf.film(field, path))
    assert list(frames) == [1001, 1002]
    for number, frame in lf.film(field, one):
        assert np.array_equal(frames[1000 + number].rgb, frame.rgb)
        assert frames[1000 + number].number == 1000 + number
    assert [number for number, _ in lf.film(field, path, frames="1002")] == [1002]
    assert lf.render(field, path).number == 1001
    assert lf.render(field, path, frames=[1002]).number == 1002
    assert lf.through(field, path).number == 1001
    assert lf.through(field, path, frame=1002).number == 1002
    assert np.array_equal(lf.select(field, path, 1002).ids, lf.select(field, one, 2).ids)
    assert np.array_equal(lf.select(field, path).ids, lf.select(field, one, 1).ids)
    for wrong in ("1-2", [1], [1003]):
        with pytest.raises(lf.UsageError, match="1001 to 1002"):
            list(lf.film(field, path, frames=wrong))
    for call in (lf.through, lf.select, lf.depth_map, lf.focus_stack):
        with pytest.raises(lf.UsageError, match="1001"):
            call(field, path, frame=1)


def test_a_path_keeps_its_first_number(field, tmp_path):
    path = plates(field, first_frame=0, fps=10)
    path.save(tmp_path / "path.yaml")
    read = lf.Path.load(tmp_path / "path.yaml", field.unit_m)
    assert (read.first_frame, len(read)) == (0, 2)
    assert path[1:].first_frame == 0
    assert path != plates(field, fps=10)
    assert "from 0 on" in repr(path)
    for wrong in (-1, 99_999_999, 1.5):
        with pytest.raises((lf.UsageError, TypeError), match="first_frame"):
            plates(field, first_frame=wrong)


def test_packages_have_the_numbers(field, tmp_path):
    lf.write_packages(field, plates(field, first_frame=1001), tmp_path / "packages", frames="1002", overwrite=True)
    assert [file.name for file in (tmp_path / "packages").glob("*.lfp")] == ["package-0000-of-frames-1002.lfp"]


def test_synthetic_truth_has_the_numbers(tmp_path):
    camera = lf.Camera([0, 0, 0.8], look_at=[0, 0, 0], up=[0, 1, 0], resolution=(16, 12), aperture_diameter=0.01,
                       focus_distance=0.8, field_of_view_deg=40)
    lf.synth("chart", tmp_path / "chart", size=(16, 12), count=4, truth=lf.Path([camera], first_frame=86),
             truth_samples=1)
    assert [file.name for file in (tmp_path / "chart" / "truth").iterdir()] == ["frame_0086.exr"]
    assert json.loads((tmp_path / "chart" / "transforms.json").read_text())["frames"]
