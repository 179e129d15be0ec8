// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";

import { dot } from "../../src/data/frame_camera";
import type { Vec3 } from "../../src/data/scene";
import { pixelsPerElement, plateOf, rayForms, recordedAt, type LfCamera } from "../../src/live/gl/ray_forms";
import { isSoftware } from "../../src/live/gl/software";
import { wishOf } from "../../src/live/gl/wish";
import { assertNear, cameraAt } from "./test_camera";

// An LF camera that looks along the world's z axis, with y down.
function lfCamera(centre: Vec3): LfCamera {
  return {
    width: 120,
    height: 80,
    matrix: [
      [110, 0, 60],
      [0, 110, 40],
      [0, 0, 1],
    ],
    centre,
  };
}

test("an LF camera in the lens centre records elements where a pinhole does", () => {
  const camera = cameraAt([1, 2, 3], { focusDistance: 5 });
  const plate = plateOf(camera, 96);
  const forms = rayForms(camera, plate, lfCamera([1, 2, 3]), 0.1);
  assertNear(recordedAt(forms, plate, 48, 32)!, [60, 40]);
  assertNear(recordedAt(forms, plate, 58, 32)!, [71, 40]);
  assertNear(recordedAt(forms, plate, 48, 22)!, [60, 29]);
  assert.ok(Math.abs(pixelsPerElement(forms, plate) - 1.1) < 1e-6);
});

test("an LF camera beside the lens sees the focus plane with a parallax", () => {
  const camera = cameraAt([0, 0, 0], { focusDistance: 4 });
  const plate = plateOf(camera, 96);
  const forms = rayForms(camera, plate, lfCamera([0.2, 0, 0]), 0.1);
  assertNear(recordedAt(forms, plate, 48, 32)!, [60 - (110 * 0.2) / 4, 40]);
  // The point where its rays meet the lens plane is the LF camera, in radii of the opening.
  for (const at of [
    [0, 0, 1],
    [30, -20, 1],
  ] as Vec3[]) {
    assertNear([dot(forms.lensRight, at) / dot(forms.forward, at)], [2]);
    assertNear([dot(forms.lensUp, at) / dot(forms.forward, at)], [0]);
  }
});

test("an LF camera behind the lens looks through the lens where its rays pass", () => {
  const camera = cameraAt([0, 0, 0], { focusDistance: 4 });
  const plate = plateOf(camera, 96);
  const forms = rayForms(camera, plate, lfCamera([0, 0.5, -1]), 1);
  // From (0, 0.5, -1) to the focus point (0, 0, 4), the lens plane is met at y = 0.4, which is below the axis.
  const at: Vec3 = [0, 0, 1];
  assertNear([dot(forms.lensUp, at) / dot(forms.forward, at)], [-0.4]);
  assertNear(recordedAt(forms, plate, 48, 32)!, [60, 40 - (110 * 0.5) / 5]);
});

test("an LF camera beyond the focus plane records the line backwards", () => {
  const camera = cameraAt([0, 0, 0], { focusDistance: 4 });
  const plate = plateOf(camera, 96);
  const forms = rayForms(camera, plate, lfCamera([0, 0.5, 5]), 1);
  // The ray runs forward from (0, 0, 4) to (0, 0.5, 5).
  assertNear(recordedAt(forms, plate, 48, 32)!, [60, 40 + 110 * 0.5]);
});

test("elements beyond the horizon of a tilted focus plane have no ray", () => {
  const camera = cameraAt([0, 0, 0]);
  camera.normal = [0, Math.SQRT1_2, Math.SQRT1_2];
  camera.offset = 0.05;
  const plate = plateOf({ ...camera, fy: 20 }, 96);
  const forms = rayForms(camera, plate, lfCamera([0, 0, 0]), 1);
  assert.ok(recordedAt(forms, plate, 48, 33));
  assert.equal(recordedAt(forms, plate, 48, 11), null);
  assert.equal(pixelsPerElement(forms, plate), Infinity);
});

test("a plate keeps the picture at another width", () => {
  const plate = plateOf(cameraAt([0, 0, 0]), 48);
  assert.deepEqual(plate, { width: 48, height: 32, fx: 50, fy: 50, cx: 24, cy: 16 });
  assert.equal(plateOf(cameraAt([0, 0, 0], { width: 10, height: 4000 }), 96).height, 1280);
});

test("software is told from graphics cards", () => {
  for (const name of [
    "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero) (0x0000C0DE)), SwiftShader driver)",
    "llvmpipe (LLVM 15.0.7, 256 bits)",
    "ANGLE (Microsoft, Microsoft Basic Render Driver Direct3D11 vs_5_0 ps_5_0)",
    "Apple Software Renderer",
  ])
    assert.ok(isSoftware(name), name);
  for (const name of ["ANGLE (NVIDIA, NVIDIA GeForce RTX 3060 Direct3D11)", "Mali-G78", "Apple M1", ""])
    assert.ok(!isSoftware(name), name);
});

test("the address of the page may say who renders", () => {
  assert.equal(wishOf("?live=webgl"), "webgl");
  assert.equal(wishOf("?a=1&live=server"), "server");
  assert.equal(wishOf("?live=other"), "auto");
  assert.equal(wishOf(""), "auto");
});
