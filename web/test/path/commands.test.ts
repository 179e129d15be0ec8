// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { test } from "node:test";
import {
  filmCommands,
  lightFieldOptions,
  preprocessorCommand,
  quote,
  quoteFile,
  rendererCommand,
} from "../../src/path/commands";

const request = { lightField: "capture", pathFile: "path.yaml", output: "frames" };

test("defaults are left out", () => {
  assert.equal(rendererCommand(request), "lfrenderer capture path.yaml -o frames");
  assert.equal(
    rendererCommand({
      ...request,
      options: {
        memory: "8G",
        maxImages: 0,
        lensWeights: "auto",
        estimator: "auto",
        format: "exr",
        overwrite: false,
        mode: "collect",
        seed: 0,
        frames: "",
      },
    }),
    "lfrenderer capture path.yaml -o frames",
  );
  assert.equal(
    preprocessorCommand({ lightField: "capture", pathFile: "path.yaml", options: { maxAngle: 0, order: "shuffle" } }),
    "lfpreprocessor capture path.yaml --plan",
  );
});

test("options are written as the programs know them", () => {
  assert.equal(
    rendererCommand({
      ...request,
      options: {
        lensWeights: "hat",
        estimator: "nearest",
        maxImages: 200,
        format: "png16",
        video: "a b.mp4",
        stopWhen: "samples>=16",
        noContactSheet: true,
      },
    }),
    "lfrenderer capture path.yaml -o frames --max-images 200 --lens-weights hat " +
      "--estimator nearest --format png16 --video 'a b.mp4' --no-contact-sheet " +
      "--stop-when 'samples>=16'",
  );
  assert.equal(
    preprocessorCommand({
      ...request,
      output: "packages",
      options: {
        maxAngle: 30,
        packages: 4,
        depths: [0.3, 2],
      },
    }),
    "lfpreprocessor capture path.yaml -o packages --max-angle 30 --packages 4 " + "--depths 0.3 2",
  );
});

test("commands open the light field as the page does", () => {
  const words =
    "--focal-px 70 --fov-deg 40 --images -i --image-scale 0.5 --image-alpha straight --background 0.1,0.2,0.3".split(
      " ",
    );
  const options = lightFieldOptions(words);
  const opened = words.join(" ").replace("-i ", "./-i ");
  assert.equal(rendererCommand({ ...request, options }), `lfrenderer capture path.yaml -o frames ${opened}`);
  assert.deepEqual(filmCommands({ ...request, packageFolder: "packages", options }), [
    `lfpreprocessor capture path.yaml -o packages ${opened}`,
    "lfrenderer packages/package-*.lfp -o frames",
  ]);
});

test("packages decide about LF images, which lfrenderer films", () => {
  const options = { maxAngle: 20, maxImages: 50, seed: 3, lensWeights: "none" as const };
  assert.deepEqual(filmCommands({ ...request, packageFolder: "packages", options }), [
    "lfpreprocessor capture path.yaml -o packages --max-images 50 --max-angle 20 " + "--lens-weights none --seed 3",
    "lfrenderer packages/package-*.lfp -o frames --lens-weights none",
  ]);
  assert.deepEqual(filmCommands({ ...request, options }), [
    "lfrenderer capture path.yaml -o frames --max-images 50 --max-angle 20 " + "--lens-weights none --seed 3",
  ]);
  assert.deepEqual(filmCommands(request), ["lfrenderer capture path.yaml -o frames"]);
  assert.equal(
    filmCommands({ ...request, packageFolder: "my packages/" })[1],
    "lfrenderer 'my packages'/package-*.lfp -o frames",
  );
});

test("words reach the program as they are", () => {
  const names = [
    "plain",
    "with space",
    "it's",
    '"quoted"',
    "$HOME",
    "a\\b",
    "`x`",
    "*?",
    "~",
    "#a",
    "a;b&c|d",
    "!x",
    "=a",
    "",
    "ümlaut",
    "{a,b}",
    "(x)",
    "line\nbreak",
  ];
  const printed = execFileSync("sh", ["-c", `printf '%s\\0' ${names.map(quote).join(" ")}`], { encoding: "utf8" });
  assert.deepEqual(printed.split("\0").slice(0, -1), names);
  assert.equal(quoteFile("-o"), "./-o");
  assert.equal(quoteFile("[a]"), "'./[a]'");
  assert.equal(quoteFile("/tmp/it's"), "'/tmp/it'\\''s'");
});

test("the programs understand the options", () => {
  const folder = process.env.LF_BIN;
  assert.ok(folder, "LF_BIN is not set: it must name the folder of lfrenderer");
  const missing = { lightField: "-no such [field]", pathFile: "-p.yaml", output: "-out" };
  const commands = [
    rendererCommand({
      ...missing,
      options: {
        focalPx: 100,
        fovDeg: 40,
        images: "-i",
        overwrite: true,
        frames: "1-3",
        memory: "1G",
        maxImages: 3,
        maxAngle: 3,
        lensWeights: "area",
        estimator: "bilinear",
        format: "png",
        video: "-v.mp4",
        noContactSheet: true,
        dumpEvery: "1h",
        stopWhen: "samples>=2",
        require: "samples>=1",
        keepPlates: true,
        smoothBelow: 2,
        mode: "hybrid",
        filter: "bicubic",
        threads: 1,
        seed: 2,
        strict: true,
      },
    }),
    preprocessorCommand({
      ...missing,
      options: {
        focalPx: 100,
        fovDeg: 40,
        images: "-i",
        overwrite: true,
        frames: "1-3",
        memory: "1G",
        maxImages: 3,
        lensWeights: "area",
        estimator: "bilinear",
        packages: 2,
        balance: "frames",
        order: "area",
        maxAngle: 3,
        depths: [1, 2],
        threads: 1,
        seed: 2,
        strict: true,
      },
    }),
    preprocessorCommand({
      lightField: missing.lightField,
      pathFile: missing.pathFile,
      options: { framesPerPackage: 3 },
    }),
  ];
  for (const command of commands) {
    const run = spawnSync("sh", ["-c", command], {
      encoding: "utf8",
      cwd: "/",
      env: { ...process.env, PATH: `${folder}:${process.env.PATH}` },
    });
    assert.match(run.stderr, /(no such \[field\]|-p\.yaml): no such file or folder/, `${command}\n${run.stderr}`);
  }
});
