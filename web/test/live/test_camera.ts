// SPDX-License-Identifier: Apache-2.0
// Cameras of frames for the tests.
import { cross, type FrameCamera } from "../../src/data/frame_camera";

type Vector = [number, number, number];

// Returns a camera at `centre` that looks along the world's z axis, with y down.
export function cameraAt(centre: Vector, changes: Partial<FrameCamera> = {}): FrameCamera {
  const camera: FrameCamera = {
    centre,
    right: [1, 0, 0],
    up: [0, -1, 0],
    forward: [0, 0, 1],
    fx: 100,
    fy: 100,
    cx: 48,
    cy: 32,
    radius: 0.006,
    rotation: 0,
    blades: 0,
    ratio: 1,
    roundness: 0,
    normal: [0, 0, 1],
    offset: 0,
    time: 0,
    focalLength: 0.0375,
    sensorWidth: 0.036,
    focusDistance: 1,
    tiltHorizontal: 0,
    tiltVertical: 0,
    width: 96,
    height: 64,
    hoodDistance: 0,
    hoodRadius: 0,
    ...changes,
  };
  camera.offset = camera.centre[2] + camera.focusDistance;
  return camera;
}

export function assertNear(found: readonly number[], expected: readonly number[], tolerance = 1e-6): void {
  const isNear = found.length === expected.length && found.every((x, i) => Math.abs(x - expected[i]) <= tolerance);
  if (!isNear) throw new Error(`found ${found.join(", ")} instead of ${expected.join(", ")}`);
}

// Throws unless right, up and forward are orthonormal, and not a mirror image.
export function assertUpright({ right, up, forward }: FrameCamera): void {
  assertNear(cross(forward, up), right);
  assertNear([Math.hypot(...right), Math.hypot(...up)], [1, 1]);
}
