// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";

import { add, type FrameCamera } from "../../src/data/frame_camera";
import type { Vec3 } from "../../src/data/scene";
import { focusedThrough, orbited, slid } from "../../src/live/camera_moves";
import { levelUp, writeCamera } from "../../src/live/camera_writer";
import { oneFramePath } from "../../src/live/one_frame_path";
import { PathDocument } from "../../src/path/path_document";
import { readByPrograms } from "../path/real_parser";
import { assertNear, assertUpright, cameraAt } from "./test_camera";

const radians = (degrees: number): number => (degrees * Math.PI) / 180;
const pivotOf = (camera: FrameCamera): Vec3 => add(camera.centre, camera.forward, camera.focusDistance);

test("an orbit keeps the point in focus and its distance", () => {
  const before = cameraAt([0, 0, -1]);
  const after = orbited(before, [0, -1, 0], radians(20), radians(10));
  assertNear(pivotOf(after), pivotOf(before));
  assertUpright(after);
  assert.ok(after.centre[0] > 0.3, "to the right");
  assert.ok(after.centre[1] < -0.1, "upwards: y is down");
  assert.ok(after.right[1] === 0 || Math.abs(after.right[1]) < 1e-9, "the horizon stays level");
  assert.ok(Math.abs(after.offset - after.normal.reduce((sum, x, i) => sum + x * pivotOf(after)[i], 0)) < 1e-9);
});

test("an orbit stops before the camera looks straight down", () => {
  const after = orbited(cameraAt([0, 0, -1]), [0, -1, 0], 0, radians(200));
  assertUpright(after);
  assert.ok(after.centre[1] < -0.99 && after.centre[2] < 0);
});

test("a slide and a dolly do not turn the camera", () => {
  const before = orbited(cameraAt([0, 0, -1]), [0, -1, 0], radians(20), 0);
  const after = slid(before, 0.1, 0.2, 0.3);
  assertNear(after.forward, before.forward);
  const step = add(after.centre, before.centre, -1);
  const along = (axis: Vec3): number => axis.reduce((sum, x, i) => sum + x * step[i], 0);
  assertNear([along(before.right), along(before.up), along(before.forward)], [0.1, 0.2, 0.3]);
});

test("a tilted focus plane is set to go through a point", () => {
  const camera = cameraAt([0, 0, 0], { tiltHorizontal: radians(30), tiltVertical: radians(-10) });
  const { focusDistance } = focusedThrough(camera, [0.5, -0.25, 4]);
  assertNear([focusDistance + 0.5 * Math.tan(radians(30)) + 0.25 * Math.tan(radians(-10))], [4]);
});

// Returns the camera that the programs read from the path at its first frame.
function read(document: PathDocument): FrameCamera {
  const [camera] = readByPrograms(document.text()).cameras;
  const [forward, up] = [camera.forward as Vec3, camera.up as Vec3];
  const right: Vec3 = [
    forward[1] * up[2] - forward[2] * up[1],
    forward[2] * up[0] - forward[0] * up[2],
    forward[0] * up[1] - forward[1] * up[0],
  ];
  return cameraAt(camera.position_w as Vec3, { forward, up, right, focusDistance: camera.focus_distance_w });
}

const DIRECTIONS = {
  look_at: "look_at: [0.1, 0, 0.2]",
  "look_at and roll": "look_at: [0.1, 0, 0.2]\n  roll_deg: 15",
  "look_at and up": "look_at: [0.1, 0, 0.2]\n  up: [0.3, -1, 0.1]",
  orientation: "orientation: {yaw: 20, pitch: -10, roll: 5}",
  "orientation and roll": "orientation: {yaw: 20, pitch: -10, roll: 5}\n  roll_deg: 15",
  quaternion: "quaternion: [0.9238795, 0.2209424, 0.2209424, 0.2209424]",
};
for (const [name, direction] of Object.entries(DIRECTIONS))
  test(`a moved camera is written as it is seen: ${name}`, () => {
    const text = `format: lfpath 1
fps: 10
frames: 2
resolution: [96, 64]
camera:
  field_of_view_deg: 50
  position: [0, 0, -1]
  ${direction}
lens:
  aperture_diameter_mm: 12
  focus_distance: 1.1
`;
    const moves: [boolean, (camera: FrameCamera, up: Vec3) => FrameCamera][] = [
      [true, (camera, up) => orbited(camera, up, radians(12), radians(-7))],
      [false, (camera) => slid(camera, 0.05, -0.02)],
      [false, (camera) => slid(camera, 0, 0, 0.1)],
    ];
    for (const [isTurned, move] of moves) {
      const document = PathDocument.parse(text);
      const before = read(document);
      const moved = move(before, levelUp(document, before));
      writeCamera(document, 0, moved, isTurned);
      const after = read(document);
      for (const axis of ["centre", "forward", "up"] as const) assertNear(after[axis], moved[axis], 2e-5);
    }
  });

test("a dolly towards the point that the camera looks at leaves that point", () => {
  const text = "camera:\n  position: [0, 0, -1]\n  look_at: [0, 0, 0]\nlens:\n  focus_distance: 1\n";
  const document = PathDocument.parse(text);
  const also = writeCamera(document, 0, cameraAt([0, 0, -0.8]), false);
  assert.equal(document.text(), text.replace("-1]", "-0.8]"));
  assert.equal(also, "");
});

test("a change of the whole film is told if the position has keys", () => {
  const text = `camera:
  look_at: [0, 0, 0]
keyframes:
  position: [{time: 0, value: [0, 0, -1]}, {time: 1, value: [0, 0, -1]}]
`;
  const document = PathDocument.parse(text);
  assert.match(writeCamera(document, 1, cameraAt([0.1, 0, -1]), false), /look_at.*whole film/);
  assert.match(document.text(), /look_at: \[0.1, 0, 0\]/);
  const kept = PathDocument.parse(text.replace("look_at:", "follow: direction\n  look_at:"));
  assert.throws(() => writeCamera(kept, 1, cameraAt([0.1, 0, -1]), true), /keeps the direction/);
  assert.equal(writeCamera(kept, 1, cameraAt([0.1, 0, -1]), false), "");
});

test("the path of one frame has the camera of the frame", () => {
  const start = cameraAt([0.1, 0.2, -1e-7], {
    radius: 0.0123,
    blades: 5,
    ratio: 1.5,
    roundness: 0.25,
    cx: 40,
    hoodDistance: 0.2,
    hoodRadius: 0.03,
    rotation: 0.3,
    tiltHorizontal: radians(12),
    tiltVertical: radians(-3),
    focusDistance: 1.7,
  });
  for (const turn of [0, 1, 2, 3, 4]) {
    const camera = orbited(start, [0.2, -1, 0.4], turn * 1.3, turn * 0.25);
    const text = oneFramePath(camera, { unit_m: 0.01, transmission: "ff00/0000" });
    const [read] = readByPrograms(text).cameras;
    assertNear([read.transmission], [0.25], 1e-9);
    assertNear(read.position_w, camera.centre, 1e-9);
    assertNear(read.forward, camera.forward, 1e-9);
    assertNear(read.up, camera.up, 1e-9);
    assertNear([read.focus_distance_w, read.blades], [camera.focusDistance, 5], 1e-9);
    assertNear([read.ratio, read.blade_roundness], [1.5, 0.25], 1e-9);
    assertNear(read.hood_mm, [2, 0.6], 1e-9);
    // The plate is 0.36 mm and 96 elements wide.
    assertNear(read.shift_mm, [(8 / 96) * 0.36, 0], 1e-9);
    assertNear(read.focus_tilt_deg, [12, -3], 1e-9);
    assertNear([radians(Number(/blade_rotation_deg: (\S+)/.exec(text)?.[1]))], [0.3], 1e-9);
    assertNear([read.aperture_diameter_mm], [2 * camera.radius * 10], 1e-9);
    assertNear([read.focal_length_mm], [camera.focalLength * 10], 1e-9);
  }
});
