// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";

import { colourEdges } from "../../src/live/focus_peaking";

// A picture with a sharp edge and one that is eight elements wide.
function picture(): ImageData {
  const [width, height] = [64, 8];
  const data = new Uint8ClampedArray(4 * width * height);
  for (let i = 0; i < width * height; ++i) {
    const x = i % width;
    data.fill(x < 16 ? 20 : x < 40 ? 220 : Math.max(20, 220 - 25 * (x - 40)), 4 * i, 4 * i + 3);
    data[4 * i + 3] = 255;
  }
  return { width, height, data } as ImageData;
}

test("focus peaking colours the sharp edge only", () => {
  const image = picture();
  colourEdges(image, [0, 255, 0]);
  const green = (x: number): number => {
    const [r, g, b] = image.data.subarray(4 * (4 * image.width + x));
    return g - (r + b) / 2;
  };
  assert.ok(green(15) > 150 && green(16) > 150);
  for (const x of [5, 30, 44, 46, 60]) assert.ok(green(x) < 10, `${x}: ${green(x)}`);
});
