// SPDX-License-Identifier: Apache-2.0
// The points of a depth file (depth/N.bin, doc/formats/page_data.md), and focusing on them.

import { add, dot, type FrameCamera } from "./frame_camera";
import type { Vec3 } from "./scene";

export interface DepthPoints {
  places: Float32Array; // x, y, z, relative to the origin of the scene
  tints: Uint8Array; // R, G, B (sRGB) and the confidence; 255 stands for 1
}

// Throws if the bytes are not those of points.
export function readDepthPoints(bytes: ArrayBuffer): DepthPoints {
  const count = bytes.byteLength >= 4 ? new DataView(bytes).getUint32(0, true) : -1;
  if (bytes.byteLength !== 4 + 16 * count) throw new Error("The points of a depth file are incomplete.");
  return { places: new Float32Array(bytes, 4, 3 * count), tints: new Uint8Array(bytes, 4 + 12 * count, 4 * count) };
}

// Returns the focus distance at which the focus plane, tilted as it is, contains a point of the world. It is not
// positive if the plane would be behind the lens.
export function focusDistanceAt(camera: FrameCamera, point: Vec3): number {
  const offset = add(point, camera.centre, -1);
  const sideways = dot(camera.right, offset) * Math.tan(camera.tiltHorizontal);
  return dot(camera.forward, offset) - sideways - dot(camera.up, offset) * Math.tan(camera.tiltVertical);
}

// Returns the depths, along the optical axis, between which nearly all points are that are in front of the camera.
//   eye  the centre of the camera, relative to the origin of the scene
export function depthRange(places: Float32Array, eye: Vec3, forward: Vec3): [number, number] {
  const most = 4000; // points that are looked at
  const step = 3 * Math.max(1, Math.floor(places.length / 3 / most));
  const depths: number[] = [];
  for (let i = 0; i + 2 < places.length; i += step) {
    const depth = dot(forward, [places[i] - eye[0], places[i + 1] - eye[1], places[i + 2] - eye[2]]);
    if (depth > 0) depths.push(depth);
  }
  if (depths.length === 0) return [1, 2];
  depths.sort((a, b) => a - b);
  const near = depths[Math.floor(0.02 * (depths.length - 1))];
  const far = depths[Math.ceil(0.98 * (depths.length - 1))];
  return [near, Math.max(far, 1.001 * near)];
}
