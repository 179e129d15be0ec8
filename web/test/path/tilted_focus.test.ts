// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";

import type { FrameCamera } from "../../src/data/frame_camera";
import { focusThrough } from "../../src/data/tilted_focus";

// A camera at (1, 2, 3) that looks along x; y is to its left, z up.
const camera = {
  centre: [1, 2, 3],
  right: [0, -1, 0],
  up: [0, 0, 1],
  forward: [1, 0, 0],
} as FrameCamera;

// Returns a point at x to the right, y above, and z before the camera.
const at = (x: number, y: number, z: number): [number, number, number] => [1 + z, 2 - x, 3 + y];

test("the focus plane through three points holds them", () => {
  const straight = focusThrough(camera, [at(0, 0, 5), at(1, 0, 5), at(0, 1, 5)])!;
  assert.deepEqual(straight, { distance: 5, horizontal_deg: 0, vertical_deg: 0 });
  const slope = Math.tan((30 * Math.PI) / 180);
  const depth = (x: number, y: number): number => 4 + slope * x - y;
  const points = [
    [1, 1],
    [-2, 0.5],
    [0.3, -1],
  ].map(([x, y]) => at(x, y, depth(x, y)));
  const tilted = focusThrough(camera, points)!;
  assert.ok(Math.abs(tilted.distance - 4) < 1e-12);
  assert.ok(Math.abs(tilted.horizontal_deg - 30) < 1e-9);
  assert.ok(Math.abs(tilted.vertical_deg + 45) < 1e-9);
});

test("what no lens can focus on has no plane", () => {
  assert.equal(focusThrough(camera, [at(0, 0, 5), at(1, 1, 5), at(2, 2, 6)]), null, "on a line");
  assert.equal(focusThrough(camera, [at(0, 0, 1), at(0.01, 0, 9), at(0, 1, 1)]), null, "too steep");
  assert.equal(focusThrough(camera, [at(0, 0, -1), at(1, 0, -1), at(0, 1, -1)]), null, "behind");
});
