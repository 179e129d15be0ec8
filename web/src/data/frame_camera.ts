// SPDX-License-Identifier: Apache-2.0
// The thin-lens camera of a frame, and the directions of its rays. Lengths are in world units, angles in radians; fx,
// fy, cx, cy, width and height are in elements.

import { rimAt, squeezeOf, type Opening } from "./opening";
import type { Vec3 } from "./scene";

const NUMBERS = 35;

export interface FrameCamera extends Opening {
  centre: Vec3;
  right: Vec3;
  up: Vec3;
  forward: Vec3;
  fx: number;
  fy: number;
  cx: number;
  cy: number;
  normal: Vec3;
  offset: number;
  time: number;
  focalLength: number;
  sensorWidth: number;
  focusDistance: number;
  tiltHorizontal: number;
  tiltVertical: number;
  width: number;
  height: number;
  // A round opening in front of the lens that cuts off oblique rays; radius 0: there is none.
  hoodDistance: number;
  hoodRadius: number;
}

export function readFrames(bytes: ArrayBuffer): FrameCamera[] {
  const numbers = new Float64Array(bytes);
  const frames: FrameCamera[] = [];
  for (let at = 0; at + NUMBERS <= numbers.length; at += NUMBERS) {
    const n = numbers.subarray(at, at + NUMBERS);
    const vector = (i: number): Vec3 => [n[i], n[i + 1], n[i + 2]];
    frames.push({
      centre: vector(0),
      right: vector(3),
      up: vector(6),
      forward: vector(9),
      fx: n[12],
      fy: n[13],
      cx: n[14],
      cy: n[15],
      radius: n[16],
      rotation: n[17],
      blades: n[18],
      normal: vector(19),
      offset: n[22],
      time: n[23],
      focalLength: n[24],
      sensorWidth: n[25],
      focusDistance: n[26],
      tiltHorizontal: n[27],
      tiltVertical: n[28],
      width: n[29],
      height: n[30],
      ratio: n[31],
      roundness: n[32],
      hoodDistance: n[33],
      hoodRadius: n[34],
    });
  }
  return frames;
}

export const add = (a: Vec3, b: Vec3, scale = 1): Vec3 => [
  a[0] + b[0] * scale,
  a[1] + b[1] * scale,
  a[2] + b[2] * scale,
];
export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

export const cross = (a: Vec3, b: Vec3): Vec3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

export function unit(a: Vec3): Vec3 {
  const size = Math.hypot(...a);
  return [a[0] / size, a[1] / size, a[2] / size];
}

// Returns the direction of an element's ray through the lens centre. Its component along the optical axis is 1.
export function elementDirection(camera: FrameCamera, x: number, y: number): Vec3 {
  const sideways = add(camera.forward, camera.right, (x - camera.cx) / camera.fx);
  return add(sideways, camera.up, -(y - camera.cy) / camera.fy);
}

// Returns the point on the focus plane that an element sees. Its depth is at most `mostDepths` focus distances.
// Elements beyond the horizon of a tilted focus plane get this depth.
export function focusPoint(camera: FrameCamera, x: number, y: number, mostDepths = 4): Vec3 {
  const direction = elementDirection(camera, x, y);
  const towards = dot(camera.normal, direction);
  const far = mostDepths * camera.focusDistance;
  let depth = (camera.offset - dot(camera.normal, camera.centre)) / towards;
  if (!(depth > 0) || depth > far) depth = far;
  return add(camera.centre, direction, depth);
}

// Returns the corners of the aperture (if it has curved edges, at least `curvePoints` points of its rim),
// counter-clockwise as seen from behind the lens. At rotation 0, the first corner is at the top.
export function lensRim(camera: FrameCamera, curvePoints = 48): Vec3[] {
  const corners = camera.blades >= 3 ? camera.blades : 1;
  const isStraight = camera.blades >= 3 && camera.roundness === 0;
  const count = isStraight ? corners : corners * Math.ceil(curvePoints / corners);
  const [width, height] = squeezeOf(camera);
  const rim: Vec3[] = [];
  for (let i = 0; i < count; ++i) {
    const angle = Math.PI / 2 + camera.rotation + (2 * Math.PI * i) / count;
    const radius = camera.radius * rimAt(camera, angle);
    const sideways = add(camera.centre, camera.right, width * radius * Math.cos(angle));
    rim.push(add(sideways, camera.up, height * radius * Math.sin(angle)));
  }
  return rim;
}

export function fNumber(camera: FrameCamera): number {
  return camera.focalLength / (2 * camera.radius);
}
