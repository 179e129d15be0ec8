# SPDX-License-Identifier: Apache-2.0
"""Plates: which can be added, and how they are kept."""
import pickle

import numpy as np
import pytest

import lfrendertools as lf


def plate_of(field, path, frames=(1,), **options):
    with lf.Renderer(field, path, frames=frames, **options) as renderer:
        while renderer.step():
            pass
        return renderer.plate()


@pytest.fixture(scope="module")
def shards(capture, path_file, run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("shards")
    for shard in ("1/3", "2/3", "3/3"):
        run("lfrenderer", capture, path_file, "-o", folder, "--shard", shard, "--frames", "1")
    return [lf.Plate.load(file) for file in sorted(folder.rglob("*.plate"))]


def test_shards_add_up(field, path, shards):
    whole = plate_of(field, path)
    assert sum(shards) == whole == sum(reversed(shards)) and shards[0] != whole
    assert np.array_equal(sum(shards).develop().rgb, lf.render(field, path).rgb)
    assert np.array_equal(sum(shards).develop().effective, lf.render(field, path).effective)


@pytest.mark.parametrize("changes, words", [
    ({"frames": (2,)}, "frame"), ({"seed": 1}, "seed 0, the other with 1"),
    ({"filter": "bicubic"}, "filter .*, the other with bicubic"),
    ({"max_images": 9}, "no max_images, the other with max_images 9"), ({"fill": 7}, "fill")])
def test_plates_of_different_renders_do_not_add_up(changes, words, field, path, shards):
    with pytest.raises(lf.UsageError, match=words):
        shards[0] + plate_of(field, path, **{"frames": (1,), **changes})


def test_plates_of_different_light_fields_do_not_add_up(field, path, shards, run, tmp_path):
    run("lfsynth", "still-life", "-o", tmp_path / "field", "--count", 9, "--size", "160x120", "--spacing", "0.01",
        "--samples", 1, "--format", "png")
    with pytest.raises(lf.UsageError, match="light_field.images 49, the other with 9"):
        shards[0] + plate_of(lf.open(tmp_path / "field"), path)
    with pytest.raises(lf.UsageError, match="frame"):
        shards[0] + plate_of(field, lf.Path([path[0].replace(f_number=4)] * 3, path.fps))


def test_rays_do_not_count_twice(field, path, shards):
    whole = plate_of(field, path)
    for one, other in ((whole, whole), (shards[0], shards[0]), (shards[0] + shards[1], shards[1]), (whole, shards[2])):
        with pytest.raises(lf.UsageError, match="twice"):
            one + other


def test_kept_pixels_give_the_plate_of_all_pixels(field, path):
    kept, collected = plate_of(field, path, mode="rebin"), plate_of(field, path)
    assert np.array_equal(kept.sums, collected.sums) and np.array_equal(kept.counts, collected.counts)
    assert np.array_equal(kept.develop().rgb, lf.render(field, path, mode="rebin").rgb)
    with pytest.raises(lf.UsageError, match='"cells".*no plates.*interpolation="pixels"'):
        plate_of(field, path, mode="rebin", interpolation="cells")


def test_plates_are_kept_in_files_and_pickles(field, path, shards, tmp_path):
    for number, plate in enumerate((plate_of(field, path), *shards)):
        plate.save(tmp_path / f"{number}.plate")
        for again in (lf.Plate.load(tmp_path / f"{number}.plate"), pickle.loads(pickle.dumps(plate))):
            assert again == plate and repr(again) == repr(plate)
            assert np.array_equal(again.develop().rgb, plate.develop().rgb)
    again = [lf.Plate.load(tmp_path / f"{number}.plate") for number in range(4)]
    assert sum(again[1:]) == again[0] and repr(again[0]).startswith("<Plate of frame 1: 120 x 80 of ")
    two = pickle.loads(pickle.dumps(shards[0] + shards[1]))
    assert two + shards[2] == again[0]
    with pytest.raises(lf.UsageError, match="1, 2 of 3"):
        two.save(tmp_path / "two.plate")
    sum(shards).save(tmp_path / "sum.plate")
    assert lf.Plate.load(tmp_path / "sum.plate") == again[0]


def test_lfmerge_reads_saved_plates(field, path, run, tmp_path):
    plate_of(field, path).save(tmp_path / "one.plate")
    run("lfmerge", tmp_path / "one.plate", "-o", tmp_path / "frames", "--no-contact-sheet")
    lf.render(field, path).save(tmp_path / "frame.exr")
    assert (tmp_path / "frames/frame_0001.exr").read_bytes() == (tmp_path / "frame.exr").read_bytes()


# The lens is larger than the capture, so that rays of kept pixels complete the frame.
def test_plates_of_hybrids_are_completed(field, path, capture, run, tmp_path):
    wide = lf.Path([camera.replace(f_number=camera.f_number / 8) for camera in path], path.fps)
    wide.save(tmp_path / "wide.yaml")
    for shard in ("1/2", "2/2"):
        run("lfrenderer", capture, tmp_path / "wide.yaml", "-o", tmp_path / "out", "--shard", shard, "--mode", "hybrid",
            "--frames", "1")
    shards = [lf.Plate.load(file) for file in sorted((tmp_path / "out").rglob("*.plate"))]
    whole, frame = plate_of(field, wide, mode="hybrid"), lf.render(field, wide, mode="hybrid")
    assert frame.interpolated.max() > 0.1
    assert sum(shards) == whole and shards[0] != whole
    (tmp_path / "copies").mkdir()
    for number, plate in enumerate((whole, *shards)):
        plate.save(tmp_path / "copies" / f"{number}.plate")
        assert lf.Plate.load(tmp_path / "copies" / f"{number}.plate") == plate == pickle.loads(pickle.dumps(plate))
    for plate in (whole, sum(shards), pickle.loads(pickle.dumps(whole))):
        developed = plate.develop()
        assert np.array_equal(developed.rgb, frame.rgb)
        assert np.array_equal(developed.interpolated, frame.interpolated)
    run("lfmerge", tmp_path / "copies" / "0.plate", "-o", tmp_path / "frames", "--no-contact-sheet")
    frame.save(tmp_path / "frame.exr")
    assert (tmp_path / "frames/frame_0001.exr").read_bytes() == (tmp_path / "frame.exr").read_bytes()
    cells = plate_of(field, wide, mode="hybrid", interpolation="cells")
    assert cells != whole and cells.develop().interpolated is None
