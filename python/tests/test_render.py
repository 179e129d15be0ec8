# SPDX-License-Identifier: Apache-2.0
"""Frames: their bits, plates and errors, and how renders treat the process of the caller."""
import json
import logging
import os
import pickle
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest

import lfrendertools as lf

WAYS = {
    "default": {},
    "nearest": {"estimator": "nearest", "lens_weights": "none"},
    "hybrid": {"mode": "hybrid"},
    "rebin": {"mode": "rebin"},
    "few": {"max_images": 20, "seed": 7, "order": "area", "filter": "bicubic", "fill": 0},
    "noise": {"stop_when": "noise<=0.02"},
    "smooth": {"estimator": "nearest", "lens_weights": "none", "smooth_below": 12},
    "areas": {"lf_pixels": "areas"},
    "points": {"lf_pixels": "points"},
}


def words_of(options):
    """Returns these options as words for lfrenderer."""
    return [word for name, value in options.items()
            for word in ("--" + name.replace("_", "-"), "off" if name == "fill" and value == 0 else str(value))]


@pytest.mark.parametrize("way", WAYS)
def test_frames_have_the_bytes_of_lfrenderer(way, field, path, capture, path_file, run, tmp_path):
    run("lfrenderer", capture, path_file, "-o", tmp_path / "frames", *words_of(WAYS[way]))
    for number, frame in lf.film(field, path, **WAYS[way]):
        file = tmp_path / f"{number}.exr"
        frame.save(file)
        assert file.read_bytes() == (tmp_path / "frames" / f"frame_{number:04}.exr").read_bytes()
    assert number == 3
    if way != "rebin":  # its slabs depend on all frames of the path
        one = lf.render(field, path, frames=[2], **WAYS[way])
        one.save(tmp_path / "one.exr")
        assert (tmp_path / "one.exr").read_bytes() == (tmp_path / "frames" / "frame_0002.exr").read_bytes()


def test_a_transmission_has_the_bytes_of_lfrenderer(field, capture, path_file, run, tmp_path):
    text = path_file.read_text()
    shaped = tmp_path / "path.yaml"
    shaped.write_text(text.replace("lens:\n", "lens:\n  transmission: \"00ff/ff80\"\n"))
    assert shaped.read_text() != text
    run("lfrenderer", capture, shaped, "-o", tmp_path / "frames", "--frames", 1)
    lf.render(field, lf.Path.load(shaped), frames=[1]).save(tmp_path / "frame.exr")
    assert (tmp_path / "frame.exr").read_bytes() == (tmp_path / "frames/frame_0001.exr").read_bytes()


@pytest.mark.parametrize("way, other", [("smooth", "nearest"), ("areas", "points")])
def test_options_that_are_compared_with_the_program_change_the_frame(way, other, field, path):
    changed, plain = (lf.render(field, path, **WAYS[name]).rgb for name in (way, other))
    assert not np.array_equal(changed, plain)


def test_lf_cameras_that_look_elsewhere_are_left_out_by_max_angle_deg(path, capture, tmp_path):
    calibration = json.loads((capture / "transforms.json").read_text())
    cos, sin = np.cos(np.radians(5)), np.sin(np.radians(5))
    for frame in calibration["frames"][::3]:
        frame.pop("lf_translation", None)
        pose = np.array(frame["transform_matrix"])
        frame["transform_matrix"] = (pose @ [[cos, 0, sin, 0], [0, 1, 0, 0], [-sin, 0, cos, 0], [0, 0, 0, 1]]).tolist()
        frame["file_path"] = str(capture / frame["file_path"])
    (tmp_path / "images").symlink_to(capture / "images")
    (tmp_path / "transforms.json").write_text(json.dumps(calibration))
    turned = lf.open(tmp_path)
    counts = [lf.render(turned, path, max_angle_deg=angle).image_count for angle in (4, 10)]
    assert 0 < counts[0] < counts[1] == lf.render(turned, path).image_count


@pytest.mark.parametrize("way", ["nearest", "hybrid", "few"])
def test_saved_alpha_and_primaries_have_the_bytes_of_lfrenderer(way, field, path, capture, path_file, run, tmp_path):
    from PIL import Image
    options = {**WAYS[way], "fill": 0}
    frame = pickle.loads(pickle.dumps(lf.render(field, path, **options)))
    light = frame.rgb.copy()
    saves = [("exr", {"colour_space": "acescg", "alpha": True}), ("exr-float", {"colour_space": "rec2020"}),
             ("exr", {"alpha": True}), ("png16", {"alpha": True}), ("png", {"colour_space": "rec709"}),
             ("exr", {"channels": "rgba", "exr_compression": "zips"}), ("exr", {"channels": "rgb"})]
    for number, (format, more) in enumerate(saves):
        words = [word for name, value in more.items()
                 for word in (["--frame-alpha"] if name == "alpha" else [f"--{name.replace('_', '-')}", value])]
        run("lfrenderer", capture, path_file, "-o", tmp_path / str(number), "--frames", 1, "--format", format,
            *words_of(options), *words)
        file = tmp_path / f"frame_0001.{format[:3]}"
        frame.save(file, format, **more)
        assert file.read_bytes() == (tmp_path / str(number) / file.name).read_bytes(), (format, more)
        if format == "png16":
            Image.open(file).verify()
            with Image.open(file) as picture:
                assert picture.mode == "RGBA"
    # The frame itself has neither alpha nor other primaries.
    assert frame.opacity is None and np.array_equal(frame.rgb, light)


def test_saved_alpha_is_0_where_there_is_no_light(field, tmp_path):
    """Elements are finer than LF pixels, and those without a ray are not filled."""
    from PIL import Image
    options = {"estimator": "nearest", "max_images": 1, "fill": 0}
    path = lf.Path([field.camera(resolution=(480, 320), focus_distance=1)])
    frame = lf.render(field, path, **options)
    frame.save(tmp_path / "alpha.png", alpha=np.bool_(True))
    alpha = np.asarray(Image.open(tmp_path / "alpha.png"))[..., 3]
    assert np.array_equal(alpha, np.where(frame.count.max(axis=2) > 0, 255, 0))
    assert 0.02 < (alpha > 0).mean() < 0.98
    with lf.Renderer(field, path, frames=[1], **options) as renderer:
        while renderer.step():
            pass
        renderer.plate().develop().save(tmp_path / "plate.png", alpha=True)
    assert (tmp_path / "plate.png").read_bytes() == (tmp_path / "alpha.png").read_bytes()


def test_opacities_of_lf_images_are_kept_with_and_without_alpha(tmp_path):
    from PIL import Image
    lf.synth("chart", tmp_path / "field", count=9, size=(48, 32), samples=1, alpha="straight", format="png")
    field = lf.open(tmp_path / "field", background="none")
    frame = lf.render(field, field.camera(resolution=(48, 32), focus_distance=1))
    assert frame.opacity is not None and 0 < frame.opacity.mean() < 1
    for name, alpha in (("a.png", False), ("b.png", True)):
        frame.save(tmp_path / name, alpha=alpha)
        saved = np.asarray(Image.open(tmp_path / name))[..., 3]
        assert np.abs(saved / 255 - frame.opacity).max() < 0.003
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_wrong_alpha_and_primaries_are_refused(field, path, tmp_path):
    frame = lf.render(field, path)
    with pytest.raises(lf.UsageError, match="colour_space=\"acescg\".*format=\"png\".*EXR"):
        frame.save(tmp_path / "a.png", colour_space="acescg")
    with pytest.raises(lf.UsageError, match="colour_space=\"srgb\": expected rec709, rec2020 or acescg"):
        frame.save(tmp_path / "a.exr", colour_space="srgb")
    for word in ({"channels": "rgb"}, {"exr_compression": "zips"}):
        name, = word
        with pytest.raises(lf.UsageError, match=f"{name}=.*format=\"png16\".*EXR"):
            frame.save(tmp_path / "a.png", "png16", **word)
        with pytest.raises(lf.UsageError, match=f"{name}=\"best\": expected "):
            frame.save(tmp_path / "a.exr", **{name: "best"})
    with pytest.raises(lf.UsageError, match="channels=\"rgb\".*alpha=True.*channels=\"rgba\""):
        frame.save(tmp_path / "a.exr", channels="rgb", alpha=True)
    with pytest.raises(TypeError, match="colour_space=None: expected a string"):
        frame.save(tmp_path / "a.exr", colour_space=None)
    with pytest.raises(TypeError, match="alpha='yes': expected True or False"):
        frame.save(tmp_path / "a.exr", alpha="yes")
    assert not list(tmp_path.glob("*.exr")) and not list(tmp_path.glob("*.png"))


def test_a_camera_renders_like_its_file(field, run, capture, tmp_path):
    camera = field.camera(resolution=(80, 60), focus_distance=1.1, blades=6)
    lf.Path([camera]).save(tmp_path / "path.yaml")
    run("lfrenderer", capture, tmp_path / "path.yaml", "-o", tmp_path / "frames", "--format", "png")
    frame = lf.render(field, lf.Path.load(tmp_path / "path.yaml"))
    frame.save(tmp_path / "one.png")
    assert (tmp_path / "one.png").read_bytes() == (tmp_path / "frames" / "frame_0001.png").read_bytes()
    assert np.abs(lf.render(field, camera).rgb - frame.rgb).max() < 1e-3


def test_the_path_decides_the_time(field, path, capture, run, tmp_path):
    """Frames of a path made in Python are those that lfrenderer makes of its file."""
    cameras = [field.camera(resolution=(64, 48), focus_distance=0.8 + 0.2 * i) for i in range(3)]
    for number, made in enumerate((lf.Path(cameras, fps=25), lf.Path(cameras)[::-1], path[1:], lf.Path(path, fps=10))):
        made.save(tmp_path / f"{number}.yaml")
        run("lfrenderer", capture, tmp_path / f"{number}.yaml", "-o", tmp_path / f"{number}")
        for i, frame in lf.film(field, lf.Path.load(tmp_path / f"{number}.yaml")):
            frame.save(tmp_path / "frame.exr")
            expected = (tmp_path / f"{number}" / f"frame_{i:04}.exr").read_bytes()
            assert (tmp_path / "frame.exr").read_bytes() == expected
            assert frame.metadata["lf:time_s"] == (i - 1) / made.fps
        assert [frame.metadata["lf:time_s"] for _, frame in lf.film(field, made)] == [
            i / made.fps for i in range(len(made))]


def test_bits_do_not_depend_on_threads_or_passes(field, path):
    frames = [frame.rgb.copy() for _, frame in lf.film(field, path, threads=1)]
    for threads, memory in ((2, "8G"), (3, "31M")):
        for one, (_, other) in zip(frames, lf.film(field, path, threads=threads, memory=memory)):
            assert np.array_equal(one, other.rgb)


def test_arrays_of_a_frame(field, path):
    frame = lf.render(field, path)
    assert frame.coverage.mean() > 0.9 and frame.display().std() > 20
    assert frame.rgb.shape == (80, 120, 3) and frame.rgb.dtype == np.float32
    assert frame.count.shape == (80, 120, 3) and frame.count.dtype == np.uint32
    assert frame.coverage.shape == (80, 120) and frame.coverage.max() == 1
    assert frame.effective is not None and frame.effective.max() <= 49
    assert frame.opacity is None and frame.interpolated is None and frame.densified is None
    assert frame.trust is None
    assert frame.metadata["lf:frame"] == 1 or "Software" in frame.metadata
    assert frame.camera == path[0]
    kept = frame.rgb
    del frame
    assert np.isfinite(kept).all()


def test_changed_pixels_are_saved(field, path, tmp_path):
    from PIL import Image
    frame = lf.render(field, path)
    shown = frame.display()
    frame.save(tmp_path / "a.png")
    assert np.array_equal(np.asarray(Image.open(tmp_path / "a.png")), shown)
    frame.rgb[:] = 0.5
    frame.save(tmp_path / "b.png")
    assert (np.asarray(Image.open(tmp_path / "b.png")) == 188).all()
    for wrong in ({"path": "a.tiff"}, {"path": "a.exr", "format": "png"}, {"path": "a.png", "format": "exr-float"},
                  {"path": "a.png", "format": "gif"}, {"path": "a.tiff", "format": "png"}):
        with pytest.raises(lf.UsageError, match="ends in|expected exr"):
            frame.save(**{**wrong, "path": tmp_path / wrong["path"]})
    with pytest.raises(lf.OutputError):
        frame.save(tmp_path / "missing" / "a.png")


def test_notebooks_show_frames(field, path):
    import io
    from PIL import Image
    frame = lf.render(field, path)
    assert np.array_equal(np.asarray(Image.open(io.BytesIO(frame._repr_png_()))), frame.display())


def test_step_by_step(field, path):
    with lf.Renderer(field, path) as renderer:
        first = renderer.preview(0).image_count
        while renderer.step():
            pass
        assert first == 0 and renderer.progress[0] == renderer.progress[1] > 0
        assert np.array_equal(renderer.stop(1).rgb, lf.render(field, path, frames=[2]).rgb)
        with pytest.raises(IndexError):
            renderer.preview(1)
        assert not renderer.step()
        assert repr(renderer).startswith("<Renderer: 2 frames, ")
    assert repr(renderer) == "<Renderer, closed>"


def test_sizes_of_plates_must_agree(field, path):
    plates = []
    for camera in (path[0], path[0].replace(resolution=(60, 40))):
        with lf.Renderer(field, camera) as renderer:
            plates.append(renderer.plate())
    assert plates[0].sums.shape == (80, 120, 3)
    with pytest.raises(lf.UsageError, match="60 x 40"):
        plates[0] + plates[1]


@pytest.mark.parametrize("options, words", [
    ({"estimator": "best"}, "estimator=\"best\": expected one of auto, nearest, bilinear"),
    ({"colour": 1}, "unknown option colour"), ({"stop_when": "noise<0"}, "stop_when"),
    ({"max_images": -1}, "max_images=-1"), ({"memory": "lots"}, "memory"), ({"frames": [4]}, "frames 1 to 3"),
    ({"frames": "1-"}, "range such as"), ({"max_images": 0}, "max_images=0"), ({"fill": -1}, "fill=-1")])
def test_wrong_options(field, path, options, words):
    with pytest.raises(lf.UsageError, match=words) as error:
        lf.render(field, path, **options)
    assert error.value.exit_code == 2


def test_units_must_agree(field):
    with pytest.raises(lf.UsageError, match="unit_m"):
        lf.render(field, field.camera(unit_m=field.unit_m * 2))


def test_a_lens_that_sees_nothing(field):
    away = field.camera(world_from_cam=np.diag([1.0, -1, -1]))
    with pytest.raises(lf.InputError, match="no LF image"):
        lf.render(field, away)
    with pytest.warns(lf.BlackFrameWarning):
        assert [frame.rgb.max() for _, frame in lf.film(field, lf.Path([away]))] == [0]


def test_missing_images_are_told(run, tmp_path):
    run("lfsynth", "still-life", "-o", tmp_path / "field", "--count", 9, "--size", "64x48", "--spacing", "0.01",
        "--samples", 1)
    field = lf.open(tmp_path / "field")
    camera = field.camera(aperture_diameter=0.05)
    (tmp_path / "field" / field.names[4]).unlink()
    with pytest.warns(lf.MissingImagesWarning, match="1 LF image was.*0004"):
        frame = lf.render(field, camera)
    assert frame.image_count == 8
    with pytest.raises(lf.InputError, match="0004"):
        lf.render(field, camera, strict=True)


def test_an_exception_of_the_caller_ends_the_render(field, path):
    def refuse(done, total):
        raise RuntimeError("enough")
    with pytest.raises(RuntimeError, match="enough"):
        lf.render(field, path, progress=refuse)
    assert lf.render(field, path).image_count > 0


def test_messages_go_to_logging(run, tmp_path, caplog, capfd):
    run("lfsynth", "chart", "-o", tmp_path / "field", "--count", 4, "--size", "64x48", "--samples", 1)
    (tmp_path / "field/images").rename(tmp_path / "field/photographs")
    capfd.readouterr()
    with caplog.at_level(logging.INFO, "lfrendertools"):
        lf.open(tmp_path / "field")
    captured = capfd.readouterr()
    assert captured.err == "" and captured.out == ""
    assert any(record.name == "lfrendertools" and "photographs" in record.getMessage() for record in caplog.records)


# A render that takes long enough to be interrupted: many passes over many frames.
INTERRUPTED = """
import os, signal, sys, threading
import lfrendertools as lf
before = signal.getsignal(signal.SIGINT)
field = lf.open(sys.argv[1])
camera = field.camera(resolution=(1600, 1200), blades=9)
path = lf.Path([camera] * 40)
threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT)).start()
count = 0
try:
    for number, frame in lf.film(field, path):
        count = number
    print("finished")
except KeyboardInterrupt:
    print("interrupted before the end:", count < 40)
assert signal.getsignal(signal.SIGINT) is before
print("next:", lf.render(field, camera.replace(resolution=(80, 60))).image_count > 0)
"""


def test_ctrl_c_interrupts_and_the_next_call_works(capture):
    end = subprocess.run([sys.executable, "-c", INTERRUPTED, capture], capture_output=True, text=True)
    assert end.returncode == 0, end.stderr
    assert end.stdout.split("\n")[:2] == ["interrupted before the end: True", "next: True"]


def test_other_threads_go_on(field, path):
    camera = path[0].replace(resolution=(960, 640))
    counts, is_done = [0], threading.Event()

    def count():
        while not is_done.is_set():
            counts[0] += 1
    thread = threading.Thread(target=count)
    renderer = lf.Renderer(field, lf.Path([camera] * 4))
    thread.start()
    before = counts[0]
    renderer.step()
    after = counts[0]
    is_done.set()
    thread.join()
    assert after > before + 1000


def test_two_threads_render_at_once(field, path):
    expected = lf.render(field, path).rgb
    results = [None, None]

    def render(i):
        results[i] = lf.render(field, path).rgb
    threads = [threading.Thread(target=render, args=(i,)) for i in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(result, expected) for result in results)


@pytest.mark.parametrize("function", [lf.render, lf.through])
def test_a_forked_process_is_told_why_it_cannot_render(function, field, path):
    lf.render(field, path)
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            function(field, path)
            text = "rendered"
        except lf.UsageError as error:
            text = str(error)
        except BaseException as error:
            text = repr(error)
        os.write(write, text.encode())
        os._exit(0)
    os.close(write)
    with os.fdopen(read) as pipe:
        assert "forked" in pipe.read()
    os.waitpid(child, 0)
    assert lf.render(field, path).image_count > 0


def test_many_renders_do_not_grow(field, path):
    def resident_bytes():
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    camera = path[0].replace(resolution=(48, 32))
    for _ in range(40):
        lf.render(field, camera)
    before = resident_bytes()
    for _ in range(200):
        lf.render(field, camera)
    assert resident_bytes() - before < 8 << 20


def test_signals_of_the_host_stay(field, path):
    handlers = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGPIPE)]
    lf.render(field, path)
    assert handlers == [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGPIPE)]


def test_cameras_travel_between_processes(path):
    code = "import sys, pickle, lfrendertools; print(pickle.load(sys.stdin.buffer)[2].focus_distance)"
    end = subprocess.run([sys.executable, "-c", code], input=pickle.dumps(path), capture_output=True, check=True)
    assert float(end.stdout) == path[2].focus_distance


def test_a_broken_image_in_the_middle_is_no_obstacle(run, tmp_path):
    run("lfsynth", "still-life", "-o", tmp_path / "field", "--count", 9, "--size", "64x48", "--spacing", "0.01",
        "--samples", 1)
    field = lf.open(tmp_path / "field")
    (tmp_path / "field" / field.names[4]).unlink()
    assert np.abs(field.camera().position - field.centres[4]).max() > 0.009
