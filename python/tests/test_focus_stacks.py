# SPDX-License-Identifier: Apache-2.0
"""Focus stacks: the pictures are those of lffocus stack and of single renders."""
import json

import numpy as np
import pytest

import lfrendertools as lf

DISTANCES = [0.7, 0.9, 1.5]


def test_pictures_are_those_of_single_renders(field, path):
    stack = lf.focus_stack(field, path, DISTANCES, frame=2)
    assert stack.rgb.shape == (3, 80, 120, 3) and stack.rgb.dtype == np.float32
    assert stack.coverage.shape == (3, 80, 120) and len(stack) == 3
    for distance, picture, camera in zip(DISTANCES, stack.rgb, stack.cameras):
        assert camera.focus_distance == distance
        np.testing.assert_array_equal(camera.K, path[1].K)
        single = lf.render(field, camera)
        np.testing.assert_array_equal(picture, single.rgb)
    assert not np.array_equal(stack.rgb[0], stack.rgb[1])


@pytest.mark.parametrize("options", [{}, {"mode": "rebin"}, {"estimator": "nearest", "lens_weights": "none"}])
def test_pictures_are_those_of_the_program(options, field, path, capture, path_file, run, tmp_path):
    words = [word for name, value in options.items() for word in ("--" + name.replace("_", "-"), value)]
    run("lffocus", "stack", capture, path_file, "-o", tmp_path / "stack", "--frame", 3, "--planes", 4, "--near", 0.6,
        "--far", 2, "--format", "exr-float", *words)
    stack = lf.focus_stack(field, path, frame=3, planes=4, near=0.6, far=2, **options)
    listed = json.loads((tmp_path / "stack/planes.json").read_text())["planes"]
    assert [plane["focus_distance_w"] for plane in listed] == stack.distances.tolist()
    for number, picture in enumerate(stack.rgb, 1):
        np.testing.assert_array_equal(lf.read_image(tmp_path / f"stack/frame_{number:04}.exr")[..., :3], picture)


def test_a_lens_that_breathes_does_so(field):
    values = dict(look_at=(0, 0, 1), resolution=(40, 30), focal_length_mm=50, f_number=2, breathing=True,
                  unit_m=field.unit_m)
    stack = lf.focus_stack(field, lf.Camera((0, -0.1, -0.8), focus_distance=1, **values), [0.7, 2])
    for camera in stack.cameras:
        assert camera == lf.Camera((0, -0.1, -0.8), focus_distance=camera.focus_distance, **values)
    with pytest.raises(lf.InputError, match="focal length"):
        lf.focus_stack(field, stack.cameras, [0.04])


def test_the_range_is_found(field, path, capture, path_file, run, tmp_path):
    run("lffocus", "stack", capture, path_file, "-o", tmp_path / "stack", "--planes", 2)
    listed = json.loads((tmp_path / "stack/planes.json").read_text())["planes"]
    stack = lf.focus_stack(field, path, planes=2)
    assert [plane["focus_distance_w"] for plane in listed] == stack.distances.tolist()
    assert lf.focus_stack(field, path, planes=2, near=0.1).distances.tolist() == [0.1, stack.distances[1]]


def test_wrong_arguments_are_named(field, path):
    for words, error, arguments in (
            ("frame=4", lf.UsageError, {"frame": 4}), ("planes=0", lf.UsageError, {"planes": 0}),
            ("near below far", lf.UsageError, {"near": 2, "far": 1}), ("near=0", lf.UsageError, {"near": 0}),
            ("distances=0.0", lf.UsageError, {"distances": [0.0]}), ("found 0", lf.UsageError, {"distances": []}),
            ("distances cannot be used", lf.UsageError, {"distances": [1], "near": 1}),
            ("distances=3", TypeError, {"distances": 3}),
            ("unknown option focus", lf.UsageError, {"focus": 3, "near": 1, "far": 2})):
        with pytest.raises(error, match=words):
            lf.focus_stack(field, path, **arguments)
