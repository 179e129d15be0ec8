#!/usr/bin/python3
"""Times whole renders, after the workloads of Table 5.1 of the thesis, at a size a laptop can hold.

usage: bench/workloads.py BUILD_DIR [--runs 5] [--size 480x320] [--count 289] [--threads 1,2]

Makes a light field with lfsynth in a temporary folder, then renders each workload `runs` times per
number of threads, in turn, so that a busy machine disturbs all alike. Prints one row each:
minimum, median and maximum seconds, tested rays per second of wall time, peak memory.
"""
import argparse
import json
import pathlib
import platform
import statistics
import subprocess
import tempfile

# The thesis's stack (nothing moves but the focus), short (a small move with a focus pull) and sharp
# (a small lens): frames, diameter in spacings of LF cameras, seconds moved.
PATH = """format: lfpath 1
fps: 30
frames: {frames}
resolution: [{width}, {height}]
{camera}lens:
  aperture_diameter: {aperture}
  focus_distance: {focus}
{movement}"""

WORKLOADS = {
    "stack": dict(frames=30, aperture=1.0, movement="focus"),
    "short": dict(frames=60, aperture=0.7, movement="both"),
    "sharp": dict(frames=30, aperture=0.3, movement="position"),
}


def example(build, field, folder):
    """camera block, aperture and focus of a path that lfexample finds"""
    path = folder / "example.yaml"
    subprocess.run([build / "bin/lfexample", field, "-o", path, "--move", "static", "-q"], check=True)
    text = path.read_text()
    camera = text[text.index("camera:"):text.index("lens:")]
    value = lambda key: float(text.split(key + ":")[1].split()[0])
    return camera, value("aperture_diameter"), value("focus_distance")


def path_for(workload, camera, aperture, focus, size):
    width, height = size
    movement = "accelerations: []\n"
    if workload["movement"] in ("focus", "both"):
        movement = (f"keyframes:\n  focus_distance: [{{time: 0, value: {0.5 * focus}}}, "
                    f"{{time: 1, value: {2 * focus}}}]\n")
    if workload["movement"] in ("position", "both"):
        camera += f"  speed: [{aperture / 4}, 0, 0]\n"
    return PATH.format(frames=workload["frames"], width=width, height=height, camera=camera,
                       aperture=aperture * workload["aperture"], focus=focus, movement=movement)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--size", default="480x320")
    parser.add_argument("--count", type=int, default=289)
    parser.add_argument("--threads", default="1,2")
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    size = tuple(map(int, arguments.size.split("x")))
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True)
    print(f"commit {commit.stdout.strip()}, {platform.processor() or platform.machine()}, "
          f"{arguments.count} LF images {arguments.size}, {arguments.runs} runs")
    print("| workload | frames | threads | min s | median s | max s | Mrays/s | peak MiB |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        field = folder / "field"
        subprocess.run([build / "bin/lfsynth", "still-life", "-o", field, "--count",
                        str(arguments.count), "--size", arguments.size, "-q"], check=True)
        camera, aperture, focus = example(build, field, folder)
        for name, workload in WORKLOADS.items():
            path = folder / f"{name}.yaml"
            path.write_text(path_for(workload, camera, aperture, focus, size))
            threads = [int(n) for n in arguments.threads.split(",")]
            seconds = {n: [] for n in threads}
            for _ in range(arguments.runs):
                for n in threads:
                    out = folder / "out"
                    subprocess.run([build / "bin/lfrenderer", field, path, "-o", out, "--threads",
                                    str(n), "-q", "--no-contact-sheet"], check=True)
                    report = json.loads((out / "report.json").read_text())
                    seconds[n].append(report["seconds"])
            for n in threads:
                median = statistics.median(seconds[n])
                print(f"| {name} | {workload['frames']} | {n} | {min(seconds[n]):.2f} | {median:.2f} "
                      f"| {max(seconds[n]):.2f} | {report['rays_tested'] / 1e6 / median:.0f} "
                      f"| {report['peak_memory_bytes'] >> 20} |", flush=True)


if __name__ == "__main__":
    main()
