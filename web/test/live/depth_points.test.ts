// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";

import { depthRange, focusDistanceAt, readDepthPoints } from "../../src/data/depth_points";
import { withTilt } from "../../src/live/lens_changes";
import { add, dot } from "../../src/data/frame_camera";
import type { Vec3 } from "../../src/data/scene";
import { cameraAt } from "./test_camera";

test("points are read as they are written, and incomplete ones are refused", () => {
  const bytes = new ArrayBuffer(4 + 2 * 16);
  new DataView(bytes).setUint32(0, 2, true);
  new Float32Array(bytes, 4, 6).set([1, 2, 3, 4, 5, 6]);
  new Uint8Array(bytes, 28, 8).set([10, 20, 30, 255, 40, 50, 60, 128]);
  const { places, tints } = readDepthPoints(bytes);
  assert.deepEqual([...places], [1, 2, 3, 4, 5, 6]);
  assert.deepEqual([...tints], [10, 20, 30, 255, 40, 50, 60, 128]);
  for (const size of [0, 3, 4, 20, 35]) assert.throws(() => readDepthPoints(bytes.slice(0, size)), /incomplete/);
});

test("the focus plane contains the point that is focused on, tilted or not", () => {
  const point: Vec3 = [0.4, -0.3, 2.5];
  for (const [tiltHorizontal, tiltVertical] of [
    [0, 0],
    [0.3, -0.2],
  ]) {
    const camera = cameraAt([0.1, 0.2, -0.5], { tiltHorizontal, tiltVertical });
    const focusDistance = focusDistanceAt(camera, point);
    const focused = withTilt({ ...camera, focusDistance });
    assert.ok(Math.abs(dot(focused.normal, point) - focused.offset) < 1e-12);
    if (tiltHorizontal === 0) assert.ok(Math.abs(focusDistance - 3) < 1e-12);
  }
  assert.ok(focusDistanceAt(cameraAt([0, 0, 0]), add([0, 0, 0], [0, 0, 1], -2)) < 0);
});

test("the range of depths leaves out points behind the camera and a few far ones", () => {
  const places = new Float32Array(3 * 1000);
  for (let i = 0; i < 1000; ++i) places[3 * i + 2] = i < 500 ? -i : i === 999 ? 1e6 : 2 + (i - 500) / 500;
  const [near, far] = depthRange(places, [0, 0, 0], [0, 0, 1]);
  assert.ok(near >= 2 && near < 2.1, String(near));
  assert.ok(far > 2.9 && far < 3, String(far));
  assert.deepEqual(depthRange(new Float32Array(3), [0, 0, 0], [0, 0, 1]), [1, 2]);
});
