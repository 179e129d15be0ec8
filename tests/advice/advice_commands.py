# SPDX-License-Identifier: Apache-2.0
"""Situations in which programs print commands, and what these commands promise."""
import dataclasses
import pathlib

import printed_commands


@dataclasses.dataclass
class Situation:
    keys: tuple  # FILE: WORDS of the messages
    call: str
    begins: str  # the printed command begins with these words
    before: str = ""
    code: int = 0  # exit code of the call
    mend: str = "true"  # run after the call, to mend what made it fail
    where: str = "."  # folder in which the call is made
    values: dict = dataclasses.field(default_factory=dict)  # of placeholders in the printed command
    # Command that must succeed after the printed one, which shows that the promise was kept.
    promise: str = "true"
    after: int = 0  # exit code of the printed command

    def follow(self, shell, folder: pathlib.Path):
        """Returns what failed, and how many commands were found."""
        if self.before:
            shell.must(self.before, folder)
        folder = folder / self.where
        ended = shell.run(self.call, folder)
        if ended.code != self.code:
            return [f"{self.call}\nended with {ended.code}, expected {self.code}:\n{ended.text}"], 0
        commands = ended.commands()
        if not any(command.startswith(self.begins) for command in commands):
            return [f"{self.call}\nprinted no command \"{self.begins}\":\n{ended.text}"], 0
        failures = []
        shell.must(self.mend, folder)
        for command in commands:
            line = printed_commands.fill(command, self.values)
            again = shell.run(line, folder)
            if again.code != self.after:
                failures.append(f"{self.call}\n{ended.text}\nprints: {line}\nwhich ended with {again.code}:\n"
                                f"{again.text}")
        kept = shell.run(self.promise, folder)
        if kept.code != 0:
            failures.append(f"{self.call}\nprints {commands}, but afterwards this fails: {self.promise}\n{kept.text}")
        return failures, len(commands)


def same_film(call, printed="frames-2", options=""):
    """Returns a command that succeeds if the printed command made the frames of another call, bit by bit."""
    return (f"{call} -o direct -q {options} && "
            f"for f in direct/frame_*; do cmp $f {printed}/$(basename $f) || exit 1; done")


FILM = "lfrenderer capture path.yaml"
NEXT = ("next_step: next: lfrenderer",)
PATH = {"PATH.yaml": "path.yaml"}
SLOW = " --back-end reference --threads 1 --dump-every 0.01s"
AGAIN = "lfpreprocessor capture path.yaml -o packages --packages 2 --overwrite -q"  # of the capture in this folder
ODD = "mkdir \"it's (1)\" && cp -r capture path.yaml \"it's (1)\" && "


def preprocessed(options, same):
    return Situation(NEXT, f"lfpreprocessor capture path.yaml -o new {options}", "lfrenderer new/",
                     promise=same_film(f"{FILM} {same}"))


SITUATIONS = [
    Situation(("pinhole_advice: To make a path with f/",), "lfrenderer capture pinhole.yaml -o new",
              "lfpath pinhole.yaml",
              promise="lfrenderer capture lens.yaml -o again > said 2>&1 && ! grep -q 'the aperture is 0' said"),
    # The next step.
    Situation(NEXT, "lfcompressor capture -o new.lfs --profile lossless", "lfrenderer new.lfs", values=PATH,
              promise=same_film(FILM)),
    Situation(NEXT, "lfcompressor packages/*.lfp -o new.lfs --profile lossless", "lfrenderer packages/package-*.lfp",
              promise=same_film(FILM)),
    Situation(NEXT, "lfcompressor packages/package-0001.lfp -o new.lfs --profile lossless",
              "lfrenderer packages/package-0001.lfp", promise=same_film(FILM + " --frames 2")),
    Situation(NEXT, "lfcompressor plain/*.lfp -o new.lfs --profile lossless", "lfrenderer plain/",
              promise=same_film(FILM + " --lens-weights none")),
    Situation(NEXT, "lfcompressor new/*.lfp -o new.lfs --profile lossless", "lfrenderer new/",
              before="lfpreprocessor capture path.yaml -o new --mode hybrid -q",
              promise=same_film(FILM + " --mode hybrid")),
    Situation(NEXT, "lfcompressor -o ./-new.lfs few/*.lfp --profile lossless", "lfrenderer few/",
              promise=same_film(FILM + " --max-images 4")),
    Situation(NEXT, "lfcompressor ./-p/*.lfp -o 'a b.lfs' --profile lossless --needed-pixels", "lfrenderer ./-p/",
              before=ODD + "cd \"it's (1)\" && lfpreprocessor capture path.yaml -o ./-p -q", where="it's (1)",
              promise="test -e frames/frame_0002.exr"),
    Situation(NEXT, "lfpreprocessor -o '[a] b' -- -c -p.yaml", "lfrenderer './[a] b/", where="it's (1)",
              before=ODD + "cd \"it's (1)\" && mv capture ./-c && mv path.yaml ./-p.yaml",
              promise="test -e frames/frame_0002.exr"),
    Situation(NEXT, "lfdensify -o 'a b.lfs' --force --most 40 --spacing 0.5 -- -c -p.yaml",
              "lfrenderer 'a b.lfs' ./-p.yaml", where="it's (1)",
              before=ODD + "cd \"it's (1)\" && mv capture ./-c && mv path.yaml ./-p.yaml",
              promise="test -e frames/frame_0002.exr"),
    preprocessed("", ""),
    preprocessed("--packages 2", ""),
    preprocessed("--mode rebin", "--mode rebin"),
    preprocessed("--mode hybrid --packages 2", "--mode hybrid"),
    preprocessed("--lens-weights none", "--lens-weights none"),
    preprocessed("--lens-weights hat --estimator nearest", "--lens-weights hat --estimator nearest"),
    preprocessed("--max-images 5 --seed 3 --order area", "--max-images 5 --seed 3 --order area"),
    preprocessed("--frames 2 --memory 1G", "--frames 2 --memory 1G"),
    Situation(NEXT, "lfpreprocessor capture path.yaml -o new --frames 2", "lfrenderer new/", promise=same_film(
        FILM + " --frames 2") + " && ! test -e frames-2/frame_0001.exr",
        before="lfpreprocessor capture path.yaml -o new --frames 1 -q"),
    Situation(NEXT, "lfpreprocessor capture path.yaml -o new --allow-missing 1", "lfrenderer new/",
              before="rm capture/image_07.png", promise=same_film(FILM + " --allow-missing 1")),
    Situation(NEXT, "lfdensify capture path.yaml -o new.lfs --force --most 40 --spacing 0.5",
              "lfrenderer new.lfs path.yaml", promise="test -e frames-2/frame_0002.exr"),
    Situation(NEXT, "lfdensify capture -o 'a new.lfs' --force --most 12", "lfrenderer 'a new.lfs' PATH.yaml",
              values=PATH, promise="test -e frames-2/frame_0002.exr"),
    Situation(NEXT, "lfdensify capture -o new.lfs --force --most 12 --resume", "lfrenderer new.lfs", values=PATH,
              before="lfdensify capture -o new.lfs --force --most 12 -q"),
    # Calls that are repeated with other options.
    Situation(("read_stanford: state the pitch and the focal length, and --plane-distance",), "lfimport cards",
              "lfimport cards --pitch 1 --focal-px 64 --plane-distance 100 -o cards", code=3, promise="lfimport cards"),
    Situation(("read_stanford: and --plane-distance if the ",), "lfimport cards --pitch 0.25 --unit-m 0.5 -o new",
              "lfimport cards --pitch 0.25 --unit-m 0.5 -o new --focal-px 64 --plane-distance 25", code=3,
              promise="lfimport new | grep '0.5 m'"),
    Situation(("read_stanford: and --plane-distance if the ",), "lfrenderer \"it's cards\" path.yaml -o new",
              "lfimport 'it'", code=3, before="mv cards \"it's cards\"", promise="lfimport \"it's cards\""),
    Situation(("lfimport: to write a calibration",), "lfimport capture --unit-m 0.5",
              "lfimport capture --unit-m 0.5 --exclude=missing -o complete", code=6, before="rm capture/image_07.png",
              promise="lfimport complete | grep 0.5"),
    Situation(("lfvisualizer: PATH is missing: give the camera path",), "lfvisualizer capture",
              "lfexample capture -o path-2.yaml", code=2, promise="lfvisualizer capture path-2.yaml --text"),
    Situation(("lfvisualizer: PATH is missing: give the camera path",),
              "lfvisualizer --reduce 2 --image-alpha mask -- -c", "lfexample ./-c --image-alpha mask -o path-2.yaml",
              code=2, where="it's (1)", before=ODD + "cd \"it's (1)\" && mv capture ./-c",
              promise="lfvisualizer ./-c path-2.yaml --text"),
    Situation(("unused_masks: To leave out the pixels",), "lfimport capture", "lfimport capture --masks ",
              before="mkdir capture/masks && cp capture/image_07.png capture/masks",
              promise="lfimport masked | grep '1 masks'"),
    Situation(("capture_warnings: To write a light field that merges them",), "lfimport brackets --unit-m 0.5",
              "lfimport brackets --unit-m 0.5 --mask-clipped -o merged", promise="lfimport merged | grep 0.5"),
    Situation(("render_arguments: to make it",),
              "lfrenderer sparse sparse.yaml -o new --densify --shard 1/2 --image-scale 1",
              "lfdensify sparse sparse.yaml -o dense.lfs --image-scale 1", code=2,
              promise="lfrenderer dense.lfs sparse.yaml -o new --shard 1/2"),
    Situation(("folded_poses: . Poses are wrong",), "lfdensify folded -o new.lfs --depths 0.35 20 --image-scale 1",
              "lfimport folded --image-scale 1 -o group_1 --exclude ", code=3,
              promise="lfimport group_1 | grep '8, 0 missing' && lfimport group_2 | grep '8, 0 missing'"),
    Situation(("folded_poses: To film what was left out instead: ",),
              "lfdensify folded sparse.yaml -o new.lfs --depths 0.35 20 --image-scale 1 --most 20",
              "lfimport folded --image-scale 1 -o group_", promise="lfimport group_? | grep '8, 0 missing'"),
    Situation(("import_report: . Repair the poses",), "lfimport mistaken --unit-m 0.5",
              "lfimport mistaken --unit-m 0.5 --repair mirror-y -o repaired",
              promise="lfimport repaired | grep 'images agree with the poses' && lfimport repaired | grep '0.5 m'"),
    Situation(("check_agreement: The report names the repair",), "lfexample mistaken -o new.yaml --image-scale 1",
              "lfimport mistaken --image-scale 1", promise="lfimport mistaken | grep 'lfimport mistaken --repair'"),
    # Interrupted films.
    Situation(("render_summary: ; continue with: ", "render_pass: --resume continues"),
              f"stop 'new/partial/*.plate' {FILM} -o new{SLOW}; false",
              "lfrenderer capture path.yaml -o new", code=1, promise=same_film(FILM + SLOW, "new")),
    Situation(("render_summary: ; continue with: ",),
              f"stop 'new/partial/*.plate' lfrenderer --overwrite -o new{SLOW} -- capture path.yaml; false",
              "lfrenderer -o new", code=1, promise=same_film(FILM + SLOW, "new")),
    # Jobs.
    Situation(("run_job: each; to see the progress",), "lfsubmit packages/*.lfp -o film", "lfsubmit --status",
              promise=same_film(FILM, "film")),
    Situation(("job_table: to continue: ",), "lfsubmit --status film", "lfsubmit --resume",
              before="lfsubmit packages/*.lfp -o film -q && rm film/frame_0001.exr",
              promise=same_film(FILM, "film")),
    Situation(("resume_job: or continue it",), "lfsubmit packages/*.lfp -o film", "lfsubmit --resume",
              before="lfsubmit packages/*.lfp -o film -q && rm film/frame_0001.exr", code=2,
              promise=same_film(FILM, "film")),
    Situation(("run_job: for example with deadline bundle",), "lfsubmit packages/*.lfp -o film --engine openjd",
              "lfsubmit --status"),
    Situation(("run_job: its first lines say how to submit",), "lfsubmit packages/*.lfp -o 'a film' --engine array",
              "lfsubmit --status"),
    Situation(("run_package: to check it again with other options",), "lfsubmit packages/*.lfp -o film", "lfsubmit --",
              before=AGAIN + " && rm capture/image_07.png", code=6, values={"OPTIONS": "--allow-missing 2"}),
    Situation(("run_package: not all packages are done",), "lfsubmit packages/*.lfp -o film --strict",
              "lfsubmit --resume", before=AGAIN + " && mv capture/image_12.png .", mend="mv image_12.png capture",
              code=3, promise=same_film(FILM, "film")),
    Situation(("resume_job: to continue",), "lfsubmit --cancel film", "lfsubmit --resume",
              before="lfsubmit packages/*.lfp -o film -q && rm film/frame_0001.exr && "
                     "sed -i 's/\"done\"/\"interrupted\"/' film/cluster/state/*.json || true",
              promise=same_film(FILM, "film")),
    # Helps.
    *[Situation((), f"{program} --nonsense", f"{program} --help", code=2) for program in printed_commands.PROGRAMS],
    Situation(("lfr: to list the commands",), "lfr nonsense", "lfr --help", code=2),
    Situation(("lffocus: for the help of one",), "lffocus nonsense", "lffocus stack --help", code=2),
]
