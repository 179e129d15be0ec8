# SPDX-License-Identifier: Apache-2.0
"""Chains of depths, videos and jobs."""
import base64
import json
import subprocess

import numpy as np

from chain_frames import read_picture
from chain_world import write_pfm
from exr_file import channels_of
from matrix_world import once

RATE = 25


class ResultChains:
    # Depths of frame 1, which see_depths_NAME(file, flaws) reads. The direct way takes the same depths from a PFM file
    # of NumPy.

    def depths_of(self, flaws, name, *options):
        return self.make("lffocus depth", self.field(flaws), self.path("plain", flaws), *self.planes(flaws), "--fill",
                         "--confidence", 0, *options, to=self.new_folder(name))

    @once
    def depths_exr(self, flaws):
        return self.depths_of(flaws, "depth.exr")

    @once
    def depths_pfm(self, flaws):
        return self.depths_of(flaws, "depth.pfm")

    @once
    def depths_ply(self, flaws):
        return self.depths_of(flaws, "depth.ply")

    @once
    def depths_png(self, flaws):
        return self.depths_of(flaws, "depth.png")

    @once
    def depths_frame(self, flaws):
        """Returns a frame with the depths of its focus plane."""
        out = self.new_folder("frames")
        self.run("lfrenderer", self.field(flaws), self.path("plain", flaws), "-o", out, "--z", "--format", "exr-float",
                 "--frames", 1, "--no-contact-sheet")
        return out / "frame_0001.exr"

    @once
    def depths_truth(self, flaws):
        out = self.new_folder("truth")
        self.run("lfsynth", "chart", "-o", out, "--count", 9, "--size", "48x32", "--calibration-only", "--truth",
                 self.path("plain", "synth"), "--truth-samples", 1)
        return out / "truth" / "frame_0001.exr"

    def film_on(self, surface, flaws):
        path = self.new_folder("surface.yaml")
        path.write_text(self.path("plain", flaws).read_text() + f"\nfocus: {{surface: {surface}, kind: depth}}\n")
        return self.film(self.field(flaws), path, options=("--frames", 1))

    def see_depths_film(self, file, flaws):
        return self.film_on(file, flaws)

    def direct_film_on(self, file, flaws):
        """Films the depths of a file of another format, which is written anew."""
        source = file if file.suffix == ".exr" else self.depths_exr(flaws)
        again = self.new_folder("again.pfm")
        write_pfm(again, channels_of(source)["Z"])
        return self.film_on(again, flaws)

    def see_depths_page(self, file, flaws):
        """Sees how many points the page shows."""
        out = self.new_folder("page")
        self.run("lfvisualizer", self.field(flaws), self.path("plain", flaws), "--depth", file, "--export", out)
        points = base64.b64decode((out / "depth" / "0.bin.js").read_bytes().split(b'"')[3])
        return {"points": int.from_bytes(points[:4], "little")}

    def direct_points(self, file, flaws):
        source = file if file.suffix == ".exr" else self.depths_exr(flaws)
        return {"points": int(np.sum(np.isfinite(channels_of(source)["Z"])))}

    # Videos, which ffmpeg reads. The direct way is the pictures that they are made of.

    def video(self, call, *words, rest=()):
        out = self.new_folder("out")
        self.run(call, *words, "-o", out, "--video", out.parent / "film.mp4", rest=rest)
        return out.parent / "film.mp4", tuple(sorted(out.glob("frame_*.exr")))

    @once
    def video_film(self, flaws):
        return self.video("lfrenderer", self.field(flaws), self.path("plain", flaws), "--no-contact-sheet")

    @once
    def video_merged(self, flaws):
        return self.video("lfmerge", self.plates_kept(flaws), "--no-contact-sheet")

    @once
    def video_job(self, flaws):
        return self.video("lfsubmit", *sorted(self.packages_of(flaws).glob("*.lfp")), "--jobs", 1,
                          rest=("--", "--allow-missing", 2))

    @once
    def video_through(self, flaws):
        return self.video("lffocus through", self.field(flaws), self.path("plain", flaws))

    @once
    def video_stack(self, flaws):
        return self.video("lffocus stack", self.field(flaws), self.path("plain", flaws), *self.planes(flaws))

    @once
    def video_rack(self, flaws):
        rack = self.make("lffocus stack", self.field(flaws), self.path("plain", flaws), *self.planes(flaws),
                         to=self.new_folder("rack.mp4"))
        return rack, self.pictures_stack(flaws)

    @once
    def video_quilt(self, flaws):
        out = self.new_folder("film.mp4")
        self.run("lfquilt", *self.pictures_exr(flaws), "-o", out, "--views", "2x1")
        found, = out.parent.glob("film_qs*.mp4")
        return found, self.pictures_quilt_exr(flaws)

    def see_video(self, made, flaws):
        """Sees the number and size of the pictures, their rate, and their sRGB values between 0 and 1."""
        del flaws
        video, _ = made
        told = json.loads(subprocess.run(
            ["ffprobe", "-v", "error", "-show_streams", "-of", "json", video], capture_output=True, check=True).stdout)
        stream, = told["streams"]
        width, height = stream["width"], stream["height"]
        raw = subprocess.run(["ffmpeg", "-v", "error", "-i", video, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                             capture_output=True, check=True).stdout
        pictures = np.frombuffer(raw, np.uint8).reshape(-1, height, width, 3) / 255
        seen = {f"picture {number}.{'RGB'[channel]}": picture[..., channel]
                for number, picture in enumerate(pictures) for channel in range(3)}
        top, bottom = map(int, stream["r_frame_rate"].split("/"))
        return {**seen, "pictures": len(pictures), "rate": top / bottom}

    def direct_video(self, made):
        seen = {}
        for number, file in enumerate(made[1]):
            light = np.clip(np.nan_to_num(read_picture(file)[0].astype(float)), 0, 1)
            values = np.where(light > 0.0031308, 1.055 * light ** (1 / 2.4) - 0.055, 12.92 * light)
            seen.update({f"picture {number}.{'BGR'[channel]}": values[..., channel] for channel in range(3)})
        return {**seen, "pictures": len(made[1]), "rate": RATE}

    # Jobs, which other calls of lfsubmit look at.

    def job_of(self, flaws):
        return self.submitted(self.packages_of(flaws))

    def see_job_status(self, job, flaws):
        del flaws
        status = json.loads(self.run("lfsubmit", "--status", job, "--json")[0])
        return {key: status[key] for key in ("state", "frames", "frames_done")}

    def see_job_resumed(self, job, flaws):
        del flaws
        (job / "frame_0002.exr").unlink()
        self.run("lfsubmit", "--resume", job)
        return {"frames": len(list(job.glob("frame_*.exr")))}
