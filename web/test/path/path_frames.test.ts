// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { cameraAt } from "../live/test_camera";
import { PathFrames } from "../../src/path_frames";

const head = (frames: number, shownStep: number, firstFrame = 1) => ({
  id: "0",
  frames,
  first_frame: firstFrame,
  shown_step: shownStep,
  fps: 10,
  unit_m: 1,
  width: 16,
  height: 12,
  widest_radius: 0,
});

test("a short film has the cameras of all frames", () => {
  const frames = new PathFrames(
    head(3, 1),
    [0, 1, 3].map((x) => cameraAt([x, 0, 0])),
  );
  assert.deepEqual(
    [1, 2, 3].map((frame) => frames.camera(frame)!.centre[0]),
    [0, 1, 3],
  );
  assert.deepEqual(
    [1, 2, 3].map((frame) => frames.speed(frame)),
    [10, 20, 20],
  );
});

test("frames have the numbers of the path", () => {
  const frames = new PathFrames(
    head(7, 3, 1001),
    [0, 3, 6].map((x) => cameraAt([x, 0, 0])),
  );
  assert.deepEqual(
    [0, 1, 2].map((index) => frames.frameOf(index)),
    [1001, 1004, 1007],
  );
  assert.deepEqual(
    [1001, 1003, 1004, 1007].map((frame) => frames.indexOf(frame)),
    [0, 0, 1, 2],
  );
  assert.equal(frames.camera(1004)!.centre[0], 3);
  assert.equal(frames.camera(1002), null);
});

test("a long film has one frame of each step, the last, and blocks that are loaded", async () => {
  const shown = [1, 101, 201, 301, 390].map((frame) => cameraAt([frame, 0, 0]));
  const frames = new PathFrames(head(390, 100), shown);
  assert.deepEqual(
    [0, 3, 4].map((index) => frames.frameOf(index)),
    [1, 301, 390],
  );
  assert.deepEqual(
    [1, 100, 101, 389, 390].map((frame) => frames.indexOf(frame)),
    [0, 0, 1, 3, 4],
  );
  assert.equal(frames.camera(390)!.centre[0], 390);
  assert.equal(frames.camera(300), null);
  assert.equal(frames.speed(300), 10);

  const asked: string[] = [];
  globalThis.fetch = (async (name: string) => {
    asked.push(name);
    const numbers = new Float64Array(35 * (390 - 256));
    for (let i = 0; i < 390 - 256; ++i) numbers[35 * i] = 257 + i;
    return new Response(numbers.buffer);
  }) as typeof fetch;
  await frames.load(300);
  assert.deepEqual(asked, ["path/0/frames/1.bin"]);
  assert.equal(frames.camera(300)!.centre[0], 300);
  assert.equal(frames.camera(257)!.centre[0], 257);
  assert.equal(frames.camera(256), null);
  assert.equal(frames.speed(300), 10);
});
