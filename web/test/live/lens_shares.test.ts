// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";

import type { FrameCamera } from "../../src/data/frame_camera";
import type { Vec3 } from "../../src/data/scene";
import { bytesOfBase64 } from "../../src/data/script_files";
import { linearPixels } from "../../src/live/gl/exported_images";
import { fitting } from "../../src/live/gl/fitting";
import {
  focusPointAt,
  lensOf,
  lensPoint,
  passesHood,
  pointsOfOpening,
  sharesOf,
  spacingAround,
} from "../../src/live/gl/lens_shares";
import { plateOf, type LfCamera } from "../../src/live/gl/ray_forms";
import { assertNear, cameraAt } from "./test_camera";

const SPACING = 0.01;

// A grid of LF cameras, 21 x 21, in the plane z.
function grid(z = 0): Map<number, LfCamera> {
  const cameras = new Map<number, LfCamera>();
  for (let row = -10; row <= 10; ++row)
    for (let column = -10; column <= 10; ++column) {
      const centre: Vec3 = [SPACING * column, SPACING * row, z];
      const matrix: LfCamera["matrix"] = [
        [110, 0, 60],
        [0, 110, 40],
        [0, 0, 1],
      ];
      cameras.set(100 + cameras.size, { width: 120, height: 80, matrix, centre });
    }
  return cameras;
}

function lensAt(changes: Partial<FrameCamera>, z = 0) {
  const camera = cameraAt([0, 0, 0], changes);
  return { camera, ...lensOf(camera, plateOf(camera, 96), grid(z)) };
}

test("the points of an opening fill a disk and a polygon evenly", () => {
  const disk = pointsOfOpening(cameraAt([0, 0, 0], { radius: 2 }), 1000);
  assert.equal(disk.length, 1000);
  assert.ok(disk.every(([x, y]) => Math.hypot(x, y) <= 2));
  assert.ok(Math.abs(disk.filter(([x]) => x > 0).length - 500) < 10);
  const triangle = pointsOfOpening(cameraAt([0, 0, 0], { radius: 2, blades: 3 }), 1000);
  // Its area is 3 sqrt(3) / (4 pi) of that of the disk. A corner is straight up, and an edge at the bottom.
  assert.ok(Math.abs(triangle.length - 413) < 20, `${triangle.length}`);
  assert.ok(triangle.every(([, y]) => y > -1.001));
  assert.ok(triangle.some(([, y]) => y > 1.6));
  // A turn by 30 degrees from right towards up brings the upper corner to the left.
  const turned = pointsOfOpening(cameraAt([0, 0, 0], { radius: 2, blades: 3, rotation: Math.PI / 2 }), 1000);
  assert.ok(turned.every(([x]) => x < 1.001));
  assert.ok(turned.some(([x]) => x < -1.6));
});

test("squeezed and rounded openings have the areas and the sides of their shapes", () => {
  const upright = pointsOfOpening(cameraAt([0, 0, 0], { radius: 2, ratio: 2 }), 1000);
  assert.equal(upright.length, 1000);
  assert.ok(upright.every(([x, y]) => Math.hypot(2 * x, y) <= 2));
  assert.ok(upright.some(([, y]) => y > 1.9));
  const lying = pointsOfOpening(cameraAt([0, 0, 0], { radius: 2, ratio: 0.5 }), 1000);
  assert.ok(lying.every(([x, y]) => Math.hypot(x, 2 * y) <= 2));
  // The arcs of a rounded triangle lie between its edges and the circle.
  const counts = [0, 0.5, 1].map(
    (roundness) => pointsOfOpening(cameraAt([0, 0, 0], { radius: 2, blades: 3, roundness }), 1000).length,
  );
  assert.ok(counts[0] < 440 && counts[1] > 640 && counts[1] < 800 && counts[2] === 1000, counts.join(" "));
  const lowest = (roundness: number) =>
    Math.min(...pointsOfOpening(cameraAt([0, 0, 0], { radius: 2, blades: 3, roundness }), 4000).map(([, y]) => y));
  assert.ok(Math.abs(lowest(0.5) + 1.5) < 0.03, `${lowest(0.5)}`);
});

test("a hood cuts off the outer side of the lens towards the edges of the picture", () => {
  const camera = cameraAt([0, 0, 0], { radius: 0.05, hoodDistance: 0.5, hoodRadius: 0.05, focusDistance: 1 });
  // Towards a focus point 0.1 to the right, the ray from the lens point x is at x / 2 + 0.05 at the hood.
  const focus: [number, number, number] = [0.1, 0, 1];
  assert.ok(passesHood(camera, [-0.02, 0], focus));
  assert.ok(!passesHood(camera, [0.02, 0], focus));
  assert.ok(passesHood({ ...camera, hoodRadius: 0 }, [0.02, 0], focus));
  const { lens } = lensAt({ radius: 0.05, hoodDistance: 0.5, hoodRadius: 0.05 });
  assert.ok(lens.columns > 1 && lens.rows > 1);
});

test("the spacing of a grid is known", () => {
  const { spacing } = lensAt({ radius: 0.05 });
  assert.ok(Math.abs(spacing - SPACING) < 0.1 * SPACING, `${spacing}`);
  assert.equal(spacingAround([], 1), 0);
});

test("in a wide lens, weights of a grid are even inside, and nothing is beside it", () => {
  const { lens, uncoveredShare } = lensAt({ radius: 0.05 });
  assert.equal(lens.nodes.length, lens.images.length); // LF cameras in the lens plane have one weight each
  assert.ok(Math.abs(lens.images.length - 89) < 12, `${lens.images.length}`);
  assert.equal(uncoveredShare, 0);
  const inside = lens.images.findIndex(({ id }) => id === 100 + 220); // the LF camera in the lens centre
  assert.ok(lens.nodes[inside] > 0.7 * 255 * 256);
  assert.equal(Math.max(...lens.nodes), 255 * 256);
});

test("a pinhole shows the LF cameras around it, by their distance", () => {
  const { lens } = lensAt({ radius: 0 });
  const [first, ...others] = [...lens.nodes].sort((a, b) => b - a);
  assert.equal(first, 255 * 256);
  assert.ok(others.length >= 4 && others.every((weight) => weight < first), `${others}`);
});

test("a hole in the LF cameras is reported", () => {
  const { shares, uncovered } = sharesOf(
    [
      [0, 0],
      [1, 0],
      [9, 0],
    ],
    [
      [0.1, 0],
      [1.1, 0.2],
    ],
    1,
    0,
  );
  assertNear([...shares], [1 / 3, 1 / 3]);
  assertNear([uncovered], [1 / 3]);
});

test("LF cameras before the lens have other weights in other parts of the picture", () => {
  const { lens } = lensAt({ radius: 0.03 }, 0.1);
  assert.ok(lens.columns > 1 && lens.rows > 1);
  assert.equal(lens.nodes.length, lens.images.length * lens.columns * lens.rows);
});

test("lens points and focus points follow the ray model", () => {
  const camera = cameraAt([1, 2, 3], { focusDistance: 5 });
  const plate = plateOf(camera, 96);
  assertNear(focusPointAt(camera, plate, 48, 32)!, [1, 2, 8]);
  assertNear(focusPointAt(camera, plate, 58, 22)!, [1.5, 1.5, 8]);
  assertNear(lensPoint(camera, [1.4, 2, 4], [1, 2, 8]), [0.5, 0]);
  assertNear(lensPoint(camera, [1, 2.5, 3], [1, 2, 8]), [0, -0.5]);
  camera.normal = [0, 1, 0];
  camera.offset = 3;
  assert.ok(focusPointAt(camera, plate, 48, 40));
  assert.equal(focusPointAt(camera, plate, 48, 20), null);
});

test("pictures become coarser, then of fewer LF images, until there is time", () => {
  const plate = { width: 640, height: 400 };
  assert.deepEqual(fitting(100, plate, 1e9), { width: 640, images: 100 });
  assert.deepEqual(fitting(100, plate, 25 * 640 * 400), { width: 320, images: 100 });
  assert.deepEqual(fitting(100, plate, 50 * 160 * 100), { width: 160, images: 50 });
  assert.deepEqual(fitting(100, plate, 1), { width: 160, images: 12 });
  assert.deepEqual(fitting(0, plate, 1e5), { width: 640, images: 0 });
});

test("display values become linear light, and transparent pixels are masked", () => {
  const pixels = linearPixels(Uint8ClampedArray.of(0, 255, 188, 255, 9, 9, 9, 0));
  assert.deepEqual([...pixels.subarray(0, 2), pixels[3]], [0, 65535, 1]);
  assert.ok(Math.abs(pixels[2] / 65535 - 0.5029) < 1e-3);
  assert.deepEqual([...pixels.subarray(4)], [0, 0, 0, 0]);
});

test("exported bytes are read", () => {
  assert.deepEqual([...bytesOfBase64("AP8Qgw==")], [0, 255, 16, 131]);
  assert.deepEqual([...bytesOfBase64("")], []);
});
