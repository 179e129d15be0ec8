// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";

import { displacements, levelOf } from "../../src/live/double_edges";
import { cameraAt } from "./test_camera";

test("displacements are those that the density of a frame has", () => {
  // spacing * fx * |1/depth - 1/focus|
  const camera = cameraAt([0, 0, 0], { fx: 400, focusDistance: 2 });
  const [near, far] = displacements(camera, 0.05, [1, 4]);
  assert.deepEqual(
    [near, far],
    [
      { depth: 1, elements: 10 },
      { depth: 4, elements: 5 },
    ],
  );
  const assumed = displacements(camera, 0.05, undefined);
  assert.deepEqual(
    assumed.map((one) => one.depth),
    [1.5, 2.5],
  );
  assert.equal(displacements(camera, 0.05, [1, null])[1].elements, 10);
  assert.deepEqual([1.5, 1.6, 4, 4.1].map(levelOf), ["none", "gentle", "gentle", "loud"]);
});
