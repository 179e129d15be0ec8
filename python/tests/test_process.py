# SPDX-License-Identifier: Apache-2.0
"""The process of the caller: its end, its working directory, forks, and values for other processes."""
import os
import pickle
import shutil
import subprocess
import sys

import numpy as np
import pytest

import lfrendertools as lf

# A thread that is in a function of the package when Python ends.
DAEMON = """
import sys, threading, time
import lfrendertools as lf
field = lf.open(sys.argv[1])
camera = lf.Path.load(sys.argv[2], field.unit_m)[0]
begun = threading.Event()
def work():
    while True:
        begun.set()
        {work}
threading.Thread(target=work, daemon=True).start()
begun.wait()
time.sleep({seconds})
"""


@pytest.mark.parametrize("work", [
    "lf.open(sys.argv[1])", "field.image(0)", "list(field.images())", "lf.render(field, camera)",
    "list(lf.film(field, lf.Path([camera] * 3)))", "lf.Renderer(field, camera).step()", "field.path()",
    "lf.report(field, check='pixels')", "lf.report(field, progress=lambda *now: None)", "lf.forecast(field, camera)",
    "lf.select(field, camera)", "lf.compress(field, 'a.lfs', overwrite=True)", "lf.synth('lights', 'more', count=1)",
    "lf.through(field, camera)", "lf.write_packages(field, camera, 'packages', overwrite=True)",
    "lf.render(field, camera).save('frame.exr')"])
def test_python_ends_while_a_daemon_thread_works(work, capture, path_file, tmp_path):
    for seconds in (0, 0.1):
        code = DAEMON.format(work=work, seconds=seconds)
        end = subprocess.run([sys.executable, "-c", code, capture, path_file], cwd=tmp_path, capture_output=True,
                             text=True, timeout=60)
        assert end.returncode == 0 and "terminate" not in end.stderr, end.stderr


def test_functions_for_the_end_of_python_can_render(capture, path_file):
    code = """
import atexit, sys
atexit.register(lambda: print(lf.render(field, path).image_count))
import lfrendertools as lf
field = lf.open(sys.argv[1])
path = lf.Path.load(sys.argv[2], field.unit_m)
"""
    end = subprocess.run([sys.executable, "-c", code, capture, path_file], capture_output=True, text=True, timeout=60)
    assert end.returncode == 0 and int(end.stdout) > 0, end.stderr


def test_forked_processes_end_while_threads_of_the_parent_work(capture):
    code = """
import os, sys, threading
import lfrendertools as lf
field = lf.open(sys.argv[1])
def work():
    while True:
        lf.open(sys.argv[1])
threading.Thread(target=work, daemon=True).start()
for _ in range(20):
    child = os.fork()
    if child == 0:
        sys.exit(0 if field.image(0).shape == (120, 160, 3) else 1)
    assert os.waitpid(child, 0)[1] == 0
"""
    end = subprocess.run([sys.executable, "-c", code, capture], capture_output=True, text=True, timeout=60)
    assert (end.returncode, end.stderr) == (0, "")


def test_a_lack_of_memory_is_an_output_error(capture):
    code = """
import resource, sys
import lfrendertools as lf
field = lf.open(sys.argv[1])
camera = field.camera(focus_distance=1)
lf.render(field, camera)
resource.setrlimit(resource.RLIMIT_AS, (3 << 30, 3 << 30))
try:
    lf.render(field, camera.replace(resolution=(12000, 9000)), memory="100G")
except lf.OutputError as error:
    print(error)
"""
    end = subprocess.run([sys.executable, "-c", code, capture], capture_output=True, text=True, timeout=60)
    assert "memory" in end.stdout, end.stderr


def test_the_working_directory_may_change(capture, path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copytree(capture, "field")
    field = lf.open("field")
    lf.compress(field, "field.lfs", profile="lossless")
    store, by_images = lf.open("field.lfs"), lf.open("field/transforms.json", images="field/images")
    os.mkdir("other")
    os.chdir("other")
    assert field.source == str(tmp_path / "field") and str(tmp_path / "field.lfs") in repr(store)
    assert np.array_equal(store.image(3), field.image(3)) and np.array_equal(by_images.image(3), field.image(3))
    assert lf.report(field)["missing"] == 0
    facts = lf.write_packages(field, path, "packages", 1)
    assert facts["light_field"] == field.source and field.path("static", focus_distance=1)[0].resolution[0] > 0


def test_frames_are_pickled(field, path, tmp_path):
    for options in ({}, {"mode": "rebin"}, {"mode": "rebin", "interpolation": "cells"}, {"lens_weights": "none"}):
        frame = lf.render(field, path, frames=[2], **options)
        again = pickle.loads(pickle.dumps(frame))
        assert np.array_equal(again.rgb, frame.rgb) and again.metadata == frame.metadata and repr(again) == repr(frame)
        frame.save(tmp_path / "a.exr")
        again.save(tmp_path / "b.exr")
        assert (tmp_path / "a.exr").read_bytes() == (tmp_path / "b.exr").read_bytes()


def test_a_rebinned_frame_says_so(field, path):
    assert "of rebinned rays" in repr(lf.render(field, path, mode="rebin", interpolation="cells"))


def test_a_frame_of_kept_pixels_is_a_collected_one(field, path):
    kept, collected = lf.render(field, path, mode="rebin"), lf.render(field, path)
    assert np.array_equal(kept.rgb, collected.rgb) and repr(kept) == repr(collected)
