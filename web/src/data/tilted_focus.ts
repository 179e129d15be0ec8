// SPDX-License-Identifier: Apache-2.0
// Finds the focus plane through three points of the scene.

import type { FrameCamera } from "./frame_camera";
import { add, dot } from "./frame_camera";
import type { Vec3 } from "./scene";

export interface TiltedFocus {
  distance: number; // from the lens along the optical axis, world units
  horizontal_deg: number;
  vertical_deg: number;
}

const MOST_TILT_DEG = 85;

// Returns the focus plane through three points. A point x to the right of the optical axis and y above it is in this
// plane if its depth is distance + x tan(horizontal) + y tan(vertical). Returns null if the points are on a line as
// seen along the axis, or if the plane is tilted by more than MOST_TILT_DEG or meets the axis behind the camera.
export function focusThrough(camera: FrameCamera, points: readonly Vec3[]): TiltedFocus | null {
  const [a, b, c] = points.map((point) => {
    const offset = add(point, camera.centre, -1);
    return [dot(camera.right, offset), dot(camera.up, offset), dot(camera.forward, offset)];
  });
  const u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
  const v = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
  const area = u[0] * v[1] - u[1] * v[0];
  const size = Math.max(Math.hypot(u[0], u[1]), Math.hypot(v[0], v[1]));
  if (!(Math.abs(area) > 1e-3 * size * size)) return null;
  const horizontal = (u[2] * v[1] - u[1] * v[2]) / area;
  const vertical = (u[0] * v[2] - u[2] * v[0]) / area;
  const distance = a[2] - a[0] * horizontal - a[1] * vertical;
  const degrees = (slope: number): number => (Math.atan(slope) * 180) / Math.PI;
  const tilted = {
    distance,
    horizontal_deg: degrees(horizontal),
    vertical_deg: degrees(vertical),
  };
  const isSteep = Math.max(Math.abs(tilted.horizontal_deg), Math.abs(tilted.vertical_deg)) > MOST_TILT_DEG;
  return distance > 0 && !isSteep ? tilted : null;
}
