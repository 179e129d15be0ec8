# SPDX-License-Identifier: Apache-2.0
"""Frames of a path with a shutter."""
import pickle
import warnings

import numpy as np
import pytest

import lfrendertools as lf

TEXT = """format: lfpath 1
fps: {fps}
frames: {frames}
resolution: [120, 80]
{shutter}
camera:
  field_of_view_deg: 40
  position: [{x}, -0.15625, -0.796875]
  speed: [0.125, 0, 0]
  orientation: {{yaw: 0}}
lens:
  aperture_diameter: 0.03125
  focus_distance: {focus}
  focus_distance_speed: 1
"""


def moving(x=0.0, focus=0.75, fps=8, frames=2, shutter=""):
    return lf.Path.parse(TEXT.format(x=x, focus=focus, fps=fps, frames=frames, shutter=shutter))


def plate_of(field, path, frame=1, **options):
    with lf.Renderer(field, path, frames=(frame,), **options) as renderer:
        while renderer.step():
            pass
        return renderer.plate()


# Frame 2, at 1/8 s, is exposed at 1/8 s + (-3, -1, 1, 3)/128 s. All numbers are sums of few powers of two, so that the
# cameras of both paths have the same bits.
def test_a_frame_is_the_sum_of_the_plates_of_its_cameras(field):
    path = moving(shutter="shutter: {angle_deg: 180, samples: 4}")
    assert path.shutter == (180, 4)
    first = 13 / 128
    alone = moving(x=0.125 * first, focus=0.75 + first, fps=64, frames=4)
    for options in ({"lens_weights": "none"}, {"lens_weights": "none", "estimator": "nearest"}):
        plate = plate_of(field, path, 2, **options)
        parts = [plate_of(field, alone, frame, **options) for frame in (1, 2, 3, 4)]
        assert plate.counts.sum() > 0
        assert np.array_equal(plate.sums, sum(part.sums for part in parts))
        assert np.array_equal(plate.counts, sum(part.counts for part in parts))
        assert len({part.sums.tobytes() for part in parts}) == 4


@pytest.mark.parametrize("weights", ["auto", "none"])
def test_a_camera_at_rest_gives_the_frame_without_a_shutter(field, path, weights):
    rest = path[1]
    with_shutter = lf.Path([rest] * 3, path.fps, shutter=(180, 5))
    frame, plain = (lf.render(field, cameras, frames=(2,), lens_weights=weights)
                    for cameras in (with_shutter, lf.Path([rest] * 3, path.fps)))
    assert np.array_equal(frame.rgb, plain.rgb) and np.array_equal(frame.count, 5 * plain.count)
    assert frame.metadata["lf:shutter_samples"] == 5 and "lf:shutter_samples" not in plain.metadata


def test_a_path_keeps_its_shutter(field, path, tmp_path):
    cameras = [path[0], path[0].replace(focus_distance=1.2), path[0].replace(focus_distance=1.6)]
    blurred = lf.Path(cameras, path.fps, shutter=(270, 3))
    assert blurred.shutter == (270, 3) and lf.Path(cameras, path.fps).shutter is None
    assert lf.Path(cameras, path.fps, shutter=(270, 1)).shutter is None
    assert blurred != lf.Path(cameras, path.fps) and blurred == lf.Path(cameras, path.fps, (270, 3))
    assert pickle.loads(pickle.dumps(blurred)) == blurred
    assert "shutter 270" in repr(blurred)
    rgb = lf.render(field, blurred, frames=(2,)).rgb
    assert np.array_equal(lf.render(field, blurred[1:]).rgb, rgb)
    assert not np.array_equal(lf.render(field, lf.Path(cameras, path.fps), frames=(2,)).rgb, rgb)
    blurred.save(tmp_path / "path.yaml")
    read = lf.Path.load(tmp_path / "path.yaml")
    assert read.shutter == (270, 3)
    assert np.abs(lf.render(field, read, frames=(2,)).rgb - rgb).max() < 0.02
    needs = lf.select(field, blurred, 2)
    assert len(needs.ids) >= len(lf.select(field, lf.Path(cameras, path.fps), 2).ids)


def test_a_path_of_views_keeps_its_moments(path, tmp_path):
    cameras = [path[0], path[1]] * 3
    views = lf.Path(cameras, path.fps, views=2)
    assert views.views == 2 and lf.Path(cameras).views == 1 and views != lf.Path(cameras, path.fps)
    assert "2 views" in repr(views) and pickle.loads(pickle.dumps(views)) == views
    assert [views[part].views for part in (slice(2, 6), slice(1, 3), slice(0, 3), slice(None, None, 2))] == [2, 1, 1, 1]
    for name in "v.yaml", "v.json", "v.usda":
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            views.save(tmp_path / name)
        assert any("2 views of each moment" in str(warning.message) for warning in told) == (name != "v.yaml")
        if name != "v.usda":
            assert lf.Path.load(tmp_path / name).views == 2
    with pytest.raises(lf.UsageError, match="2 views of each moment"):
        views.save(tmp_path / "v.chan")
    for faults in {"views": 4}, {"views": 0}, {"views": 1.5}, {"views": 2, "shutter": (180, 4)}:
        with pytest.raises((lf.UsageError, TypeError)):
            lf.Path(cameras, path.fps, **faults)


def test_focus_stacks_and_ground_truth_are_exposed(field, path, tmp_path):
    cameras = [path[0], path[2]]
    blurred = lf.Path(cameras, path.fps, shutter=(360, 3))
    stack = lf.focus_stack(field, blurred, [0.8, 1.4], frame=1)
    assert stack.cameras.shutter == (360, 3)
    sharp = lf.focus_stack(field, lf.Path(cameras, path.fps), [0.8, 1.4], frame=1)
    assert np.array_equal(stack.rgb, sharp.rgb)  # only the focus of these cameras differs, which the stack replaces
    moving_path = moving(x=0.0, shutter="shutter: {angle_deg: 360, samples: 3}")
    lf.synth("still-life", tmp_path / "out", truth=moving_path, truth_samples=4, calibration_only=True)
    lf.synth("still-life", tmp_path / "plain", truth=moving(x=0.0), truth_samples=4, calibration_only=True)
    frames = [sorted((tmp_path / name / "truth").iterdir()) for name in ("out", "plain")]
    assert [len(files) for files in frames] == [2, 2]
    assert frames[0][1].read_bytes() != frames[1][1].read_bytes()


def test_a_shutter_may_be_a_mapping(path):
    cameras = path.cameras
    assert lf.Path(cameras, path.fps, shutter={"angle_deg": 270, "samples": 3}).shutter == (270, 3)
    for shutter, words in (({"angle": 270, "samples": 3}, "'angle'; expected angle_deg and samples"),
                           ({"angle_deg": 270}, "samples is missing"),
                           ({"angle_deg": 400, "samples": 3}, "angle_deg=400: expected a number from 0 to 360"),
                           ({"angle_deg": 90, "samples": 99}, "samples=99: expected a whole number from 1 to 64")):
        with pytest.raises(lf.UsageError, match=words):
            lf.Path(cameras, path.fps, shutter=shutter)


@pytest.mark.parametrize("shutter", [(361, 2), (-1, 2), (180, 65), (180, 0), (180, 2.5), (180,), 180, "180"])
def test_a_wrong_shutter_is_refused(path, shutter):
    with pytest.raises((lf.UsageError, TypeError), match="shutter"):
        lf.Path(path.cameras, path.fps, shutter=shutter)
