// SPDX-License-Identifier: Apache-2.0
// Tells where the LF images of a picture are too far apart: a point off the focus plane then appears once for each LF
// camera, as double edges, instead of as a blur.

import type { FrameCamera } from "../data/frame_camera";

export const GENTLE = 1.5; // displacement from which double edges may be seen, elements
export const LOUD = 4; // displacement from which they are plain

export interface Displacement {
  depth: number; // distance from the lens along the optical axis
  elements: number; // displacement of a point at this depth between neighbouring LF images
}

// Returns the displacements at the nearest and the farthest depth.
//   spacing  of the LF images in the lens plane, world units
//   depths   those of the scene; if they are not known, a quarter before and behind the focus is assumed
export function displacements(
  camera: FrameCamera,
  spacing: number,
  depths: readonly [number, number | null] | undefined,
): Displacement[] {
  const { focusDistance } = camera;
  const [near, far] = depths ?? [0.75 * focusDistance, 1.25 * focusDistance];
  return [near, far ?? Infinity].map((depth) => ({
    depth,
    elements: spacing * camera.fx * Math.abs(1 / depth - 1 / focusDistance),
  }));
}

export type Level = "none" | "gentle" | "loud";

export function levelOf(elements: number): Level {
  return elements > LOUD ? "loud" : elements > GENTLE ? "gentle" : "none";
}
