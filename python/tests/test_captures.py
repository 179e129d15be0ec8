# SPDX-License-Identifier: Apache-2.0
"""Whole captures: reports, packages, packed stores and synthetic light fields are those of the programs."""
import json
import shutil
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest

import lfrendertools as lf


def without_times(facts):
    """Returns the facts without those that differ from run to run."""
    if isinstance(facts, dict):
        return {key: without_times(value) for key, value in facts.items()
                if not key.endswith("_s") and key not in ("rate", "threads", "cpu_s_of")}
    return [without_times(value) for value in facts] if isinstance(facts, list) else facts


def test_report_is_that_of_lfimport(field, capture, run):
    for check in ("none", "headers", "pixels"):
        expected = json.loads(run("lfimport", capture, "--json", "--check", check, "--distance", 1.5).stdout)
        assert lf.report(field, check=check, distance=1.5) == expected
    assert expected["density"]["distance_w"] == 1.5 and expected["broken"] == 0


def test_report_counts_what_is_missing_or_broken(capture, tmp_path):
    folder = shutil.copytree(capture, tmp_path / "field")
    (folder / "images/0003.png").unlink()
    (folder / "images/0005.png").write_bytes(b"no picture")
    told = []
    facts = lf.report(lf.open(folder), progress=lambda done, total: told.append((done, total)))
    assert (facts["missing"], facts["broken"]) == (1, 1)
    assert {warning["kind"] for warning in facts["warnings"]} >= {"missing-images", "broken-images"}
    assert told[-1] == (49, 49)


@pytest.mark.parametrize("options", [{}, {"mode": "hybrid"}, {"mode": "rebin"}, {"lens_weights": "none"},
                                     {"estimator": "nearest", "order": "area"}, {"max_images": 9, "seed": 3}])
def test_packages_are_those_of_lfpreprocessor(options, field, path, capture, path_file, run, tmp_path):
    words = [word for name, value in options.items() for word in ("--" + name.replace("_", "-"), value)]
    expected = json.loads(run("lfpreprocessor", capture, path_file, "-o", tmp_path / "a", "--packages", 2, *words,
                              "--json").stdout)
    facts = lf.write_packages(field, path, tmp_path / "b", 2, **options)
    assert facts["output"] == str(tmp_path / "b")
    assert without_times(facts) == without_times({**expected, "output": facts["output"]})
    for folder in "ab":
        render = {key: value for key, value in options.items() if key not in ("order", "max_images", "seed")}
        run("lfrenderer", *sorted((tmp_path / folder).glob("*.lfp")), "-o", tmp_path / folder / "frames",
            *(word for name, value in render.items() for word in ("--" + name.replace("_", "-"), value)))
    for file in sorted((tmp_path / "a/frames").glob("*.exr")):
        assert file.read_bytes() == (tmp_path / "b/frames" / file.name).read_bytes()
    assert len(facts["packages"]) == 2


def test_forecast_writes_nothing(field, path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    told = []
    facts = lf.forecast(field, path, frames="2-3", depths=(0.5, 3), progress=lambda *now: told.append(now))
    assert [frame["frame"] for frame in facts["frames"]] == [2, 3] and facts["depths_from"] == "depths"
    assert facts["packages"][0]["rays"] == sum(frame["rays"] for frame in facts["frames"])
    assert told[-1] == (4, 4) and not list(tmp_path.iterdir())


def test_packages_replace_others_only_if_asked(field, path, tmp_path):
    lf.write_packages(field, path, tmp_path, frames_per_package=1)
    assert len(list(tmp_path.glob("*.lfp"))) == 3
    with pytest.raises(lf.UsageError, match="replace them with overwrite=True, or give another folder"):
        lf.write_packages(field, path, tmp_path)
    assert len(lf.write_packages(field, path, tmp_path, overwrite=True)["packages"]) == 1


def test_selection_is_what_the_forecast_counts(field, path):
    facts = lf.forecast(field, path)["frames"][1]
    selection = lf.select(field, path, 2)
    assert len(selection.ids) == facts["lf_images"] and int(selection.rays.sum()) == facts["rays"]
    assert len(np.unique(np.concatenate([selection.ids, selection.neighbours]))) == \
        len(selection.ids) + len(selection.neighbours)
    assert (selection.rects[:, 2:] > selection.rects[:, :2]).all()
    alone = lf.select(field, path[1])
    assert np.array_equal(alone.ids, selection.ids) and np.array_equal(alone.rects, selection.rects)
    # LF cameras inside of the lens, seen along its axis, are all selected.
    camera = path[1]
    offset = (field.centres - camera.position) @ camera.cam_from_world[:, :3].T
    inside = np.flatnonzero(np.hypot(offset[:, 0], offset[:, 1]) < 0.8 * camera.aperture_diameter / 2)
    assert len(inside) > 3 and set(inside) <= set(selection.ids.tolist())


def test_stores_are_those_of_lfcompressor(field, capture, run, tmp_path):
    run("lfcompressor", capture, "-o", tmp_path / "a.lfs", "--target-psnr", 40)
    facts = lf.compress(field, tmp_path / "b.lfs", target_psnr=40, verify=True)
    assert facts["verified"] == 49 and facts["psnr_db"] > 39.5
    ours, theirs = lf.open(tmp_path / "b.lfs"), lf.open(tmp_path / "a.lfs")
    assert all(np.array_equal(ours.image(i), theirs.image(i)) for i in (0, 24, 48))
    exact = lf.compress(field, tmp_path / "c.lfs", profile="lossless")
    assert exact["psnr_db"] == "exact"
    assert np.array_equal(lf.open(tmp_path / "c.lfs").image(7), field.image(7))
    with pytest.raises(lf.UsageError, match="stored values"):
        ours.image(0, stored=True)


def test_stores_of_groups_give_the_images_and_frames_of_the_files(field, path, tmp_path):
    facts = lf.compress(field, tmp_path / "a.lfs", profile="group-lossless", verify=True)
    assert facts["predicted"] > 30 and facts["psnr_db"] == "exact"
    store = lf.open(tmp_path / "a.lfs")
    assert all(np.array_equal(store.image(i), field.image(i)) for i in range(49))
    ours, theirs = (lf.render(lights, path, frames=[2]).rgb for lights in (store, field))
    assert np.array_equal(ours, theirs)
    told = []
    facts = lf.compress(field, tmp_path / "b.lfs", profile="auto", progress=lambda *now: told.append(now))
    assert "in groups" in facts["codec"] and facts["sample"]["bytes_in_groups"] < facts["sample"]["bytes_alone"]
    assert told[-1] == (49, 49) and (facts["sample"]["lf_images"],) * 2 in told


def test_mosaics_are_demosaicked_together(field, run, tmp_path):
    mosaics = lf.synth("still-life", tmp_path / "mosaics", count=25, size=(120, 80), spacing=0.003, jitter=0.4,
                       bayer=True)
    facts = lf.compress(mosaics, tmp_path / "a.lfs", profile="lossless", demosaic="joint")
    assert facts["demosaic"]["kept_db"] > facts["demosaic"]["single_db"] + 2 and facts["demosaic"]["joint_share"] > 0.5
    run("lfcompressor", tmp_path / "mosaics", "-o", tmp_path / "b.lfs", "--profile", "lossless", "--demosaic", "joint")
    ours, theirs = lf.open(tmp_path / "a.lfs"), lf.open(tmp_path / "b.lfs")
    assert all(np.array_equal(ours.image(i), theirs.image(i)) for i in (0, 12, 24))
    with pytest.raises(lf.UsageError, match="needs mosaics"):
        lf.compress(field, tmp_path / "c.lfs", demosaic="joint")
    with pytest.raises(lf.UsageError, match="demosaic"):
        lf.compress(mosaics, tmp_path / "c.lfs", demosaic="best")


def test_broken_images_are_left_out_of_stores_with_a_warning(capture, tmp_path):
    folder = shutil.copytree(capture, tmp_path / "field")
    (folder / "images/0005.png").write_bytes(b"no picture")
    with pytest.warns(lf.MissingImagesWarning, match="1 LF image is not in the store"):
        facts = lf.compress(lf.open(folder), tmp_path / "a.lfs")
    assert facts["lf_images_skipped"] == 1
    with pytest.raises(lf.InputError):
        lf.compress(lf.open(folder), tmp_path / "b.lfs", strict=True)


def test_densified_stores_are_those_of_lfdensify(capture, field, run, tmp_path):
    camera = field.camera(aperture_diameter=0.05, focus_distance=0.5)
    lf.Path([camera]).save(tmp_path / "path.yaml")
    run("lfdensify", capture, tmp_path / "path.yaml", "-o", tmp_path / "a.lfs", "--spacing", 0.5, "--most", 40,
        "--force", "--cache", "none", "--depths", 0.15, 0.6)
    told = []
    ours = lf.densify(field, tmp_path / "b.lfs", camera, spacing=0.5, most=40, force=True, cache="none",
                      depths=(0.15, 0.6), progress=lambda done, total: told.append((done, total)))
    theirs = lf.open(tmp_path / "a.lfs")
    assert len(ours) == len(theirs) > len(field) and ours.is_virtual.sum() == len(ours) - len(field)
    assert np.array_equal(ours.image(len(ours) - 1), theirs.image(len(theirs) - 1), equal_nan=True)
    assert told and told[-1][0] <= told[-1][1]
    with pytest.raises(lf.UsageError, match="overwrite=True"):
        lf.densify(field, tmp_path / "b.lfs", camera)
    with pytest.raises(lf.UsageError, match="depths"):
        lf.densify(field, tmp_path / "c.lfs", camera, depths=(3, 0.3))
    with pytest.raises(lf.UsageError, match="has virtual LF images"):
        lf.densify(ours, tmp_path / "c.lfs", camera)


def test_synthetic_fields_are_those_of_lfsynth(run, tmp_path, path_file, path):
    run("lfsynth", "chart", "-o", tmp_path / "a", "--count", 4, "--size", "48x32", "--samples", 1, "--jitter", 0.1,
        "--seed", 5, "--bayer", "--noise", 0.01, "--distortion", "0.1,0.02", "--truth", path_file, "--truth-samples", 4)
    told = []
    field = lf.synth("chart", tmp_path / "b", count=4, size=(48, 32), samples=1, jitter=0.1, seed=5, bayer=True,
                     noise=0.01, distortion=(0.1, 0.02), truth=path_file, truth_samples=4,
                     progress=lambda *now: told.append(now))
    files = sorted(file.relative_to(tmp_path / "a") for file in (tmp_path / "a").rglob("*.*"))
    assert len(files) == 4 + 3 + 1
    for file in files:
        assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes(), file
    assert len(field) == 4 and told
    lf.synth("chart", tmp_path / "c", count=1, size=(48, 32), samples=1, truth=path, truth_samples=1)
    assert lf.read_image(tmp_path / "c/truth/frame_0003.exr").shape == (80, 120, 4)
    with pytest.raises(lf.UsageError):
        lf.synth("chart", tmp_path / "d", format="png", bayer=True)


def test_older_synthetic_fields_are_replaced_whole(tmp_path):
    lf.synth("chart", tmp_path, count=9, size=(16, 12), samples=1)
    (tmp_path / "images/notes.txt").write_text("kept")
    with pytest.raises(lf.UsageError, match="exists already"):
        lf.synth("lights", tmp_path, count=4, size=(16, 12), samples=1)
    lf.synth("lights", tmp_path, count=4, size=(16, 12), samples=1, overwrite=True)
    assert sorted(file.name for file in (tmp_path / "images").iterdir()) == [
        "0000.exr", "0001.exr", "0002.exr", "0003.exr", "notes.txt"]
    lf.synth("lights", tmp_path, count=4, size=(16, 12), samples=1, format="png", overwrite=True)
    assert sorted(file.name for file in (tmp_path / "images").iterdir())[:2] == ["0000.png", "0001.png"]


def test_other_light_fields_are_not_hidden(tmp_path):
    (tmp_path / "images").mkdir()
    (tmp_path / "images/out_00_00.png").write_bytes(b"")
    (tmp_path / "sparse/0").mkdir(parents=True)
    for name in ("cameras.txt", "images.txt", "points3D.txt"):
        (tmp_path / "sparse/0" / name).write_text("")
    with pytest.raises(lf.UsageError, match="holds a light field"):
        lf.synth("chart", tmp_path, count=1, size=(16, 12), samples=1)
    assert not (tmp_path / "transforms.json").exists()
    assert len(lf.synth("chart", tmp_path, count=1, size=(16, 12), samples=1, overwrite=True)) == 1
    assert (tmp_path / "images/out_00_00.png").exists()


def test_files_are_read_as_stored(capture, field, tmp_path):
    from PIL import Image
    expected = np.asarray(Image.open(capture / field.names[5]))[..., :3]
    assert np.array_equal(field.image(5, stored=True), expected)
    assert np.array_equal(field.image(5, rect=(10, 20, 40, 30), stored=True), expected[20:30, 10:40])
    with pytest.raises(lf.UsageError, match="rect"):
        field.image(5, rect=(10, 20, 400, 30), stored=True)
    with pytest.raises(lf.InputError, match="nowhere.png"):
        lf.read_image(tmp_path / "nowhere.png")


def test_notebooks_show_pictures(field, capture, tmp_path):
    text = field._repr_html_()
    assert text.count("<circle") == 49 and text.count("data:image/png") == 8
    thumbnail = field._core.thumbnail(24, 80)
    assert thumbnail.shape == (60, 80, 3)
    assert np.abs(thumbnail - field.image(24).reshape(60, 2, 80, 2, 3).mean(axis=(1, 3))).max() < 1e-4
    folder = shutil.copytree(capture, tmp_path / "field")
    (folder / "images/0000.png").unlink()
    assert lf.open(folder)._repr_html_().count("data:image/png") == 7


def test_frames_are_shared_by_dlpack(field, path):
    frame = lf.render(field, path[0])
    assert np.shares_memory(np.from_dlpack(frame.rgb), frame.rgb)


def test_arrays_go_into_hdf5(field, tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "field.h5", "w") as file:
        views = file.create_dataset("views", (3, 3, 60, 80, 3), "f4", chunks=(1, 1, 60, 80, 3))
        field.array((3, 3), reduce=2, out=views)
        assert np.array_equal(views[...], field.array((3, 3), reduce=2))
        with pytest.raises(lf.UsageError, match="floats, found uint8"):
            field.array((3, 3), reduce=2, out=file.create_dataset("bytes", (3, 3, 60, 80, 3), "u1"))


def test_wrong_arguments(field, path, tmp_path):
    for call in (lambda: lf.report(field, check="some"), lambda: lf.forecast(field, path, depths=(3, 1)),
                 lambda: lf.forecast(field, path, mod="collect"), lambda: lf.write_packages(field, path, tmp_path, 0),
                 lambda: lf.write_packages(field, path, tmp_path, 2, frames_per_package=1),
                 lambda: lf.write_packages(field, path, tmp_path, balance="time"),
                 lambda: lf.compress(field, tmp_path / "x.bin"),
                 lambda: lf.compress(field, tmp_path / "x.lfs", levels=9),
                 lambda: lf.compress(field, tmp_path / "x.lfs", profile="lossless", threshold=3),
                 lambda: lf.synth("scene", tmp_path), lambda: lf.synth("chart", tmp_path, size=(0, 4)),
                 lambda: lf.synth("chart", tmp_path, fisheye=(1,), fov=1.0), lambda: lf.select(field, path, 9),
                 lambda: lf.film(field, path, estimator="best")):
        with pytest.raises(lf.UsageError) as error:
            call()
        assert "--" not in str(error.value)
    with pytest.raises(TypeError):
        lf.report("capture/")
    with pytest.raises(lf.UsageError, match="resume and overwrite"):
        lf.compress(field, tmp_path / "x.lfs", resume=True, overwrite=True)
    assert not list(tmp_path.iterdir())


def test_errors_of_progress_end_the_work(tmp_path):
    def tell(done, total):
        raise KeyError("mine")
    with pytest.raises(KeyError, match="mine"):
        lf.synth("still-life", tmp_path / "field", count=400, size=(480, 320), progress=tell)
    assert len(list((tmp_path / "field").rglob("*.exr"))) < 400


@pytest.mark.parametrize("work", ["lf.synth('still-life', 'more', count=4000, samples=16)",
                                  "lf.compress(field, 'a.lfs', overwrite=True)", "lf.report(field, check='pixels')",
                                  "field.path()", "lf.forecast(field, path)"])
def test_ctrl_c_interrupts(work, capture, path_file, tmp_path):
    code = f"""
import signal, threading
import lfrendertools as lf
field = lf.open({str(capture)!r})
path = lf.Path.load({str(path_file)!r})
threading.Timer(0.3, lambda: signal.raise_signal(signal.SIGINT)).start()
try:
    while True:
        {work}
except KeyboardInterrupt:
    print("interrupted", lf.report(field)["images"])
"""
    end = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert end.stdout == "interrupted 49\n", end.stderr


def test_other_threads_go_on(tmp_path):
    ticks = []
    ended = threading.Event()

    def count():
        while not ended.wait(0.001):
            ticks.append(1)
    thread = threading.Thread(target=count)
    thread.start()
    lf.synth("still-life", tmp_path / "field", count=16, size=(160, 120))
    ended.set()
    thread.join()
    assert len(ticks) > 5 and signal.getsignal(signal.SIGINT) is signal.default_int_handler
