// SPDX-License-Identifier: Apache-2.0
// Writes whole movements into a path. A movement replaces the previous motion of its quantity, and makes the film
// longer if necessary. Each exported function returns the name of the edit.
import type { PathDocument } from "./path_document";
import type { Keyframe } from "./path_facts";

type Vector = readonly [number, number, number] | readonly number[];

export interface OrbitOptions {
  centre: Vector; // world units; a point of the axis, at which the camera looks
  // The axis of the orbit, of any length. The camera's `up` is set to this direction or to the opposite one, whichever
  // is nearer to it.
  axis: Vector;
  startPosition: Vector; // position of the camera at the start; must not be on the axis
  degrees: number; // angle of the orbit, right-handed around the axis
  seconds: number;
  start?: number; // time at which the orbit begins, seconds; default: 0
}

export interface DollyOptions {
  from: Vector;
  to: Vector;
  seconds: number;
  start?: number;
}

export interface FocusPullOptions {
  from: number; // first focus distance, world units
  to: number;
  seconds: number; // duration of the pull, without `hold`
  hold?: number; // time without movement before and after the pull, seconds
  start?: number; // time of the pull's beginning, seconds; default: `hold`
}

// Largest angle between keys. With it, the Catmull-Rom curve through the keys deviates from the circle by at most
// 0.13 % of the radius (2/27 angle^2, with the angle in radians). The deviation is largest in the first and the last
// segment, because the curve starts and ends in the direction of the chord there.
const kOrbitStep_deg = 7.5;
const kResolution = 1e-5; // precision with which positions are written, as a share of the movement's size

export function orbit(path: PathDocument, options: OrbitOptions): string {
  const { degrees, seconds, start = 0 } = options;
  checkDuration(seconds, start);
  if (!Number.isFinite(degrees) || degrees === 0) throw new Error("An orbit needs an angle other than 0");
  const axis = normalised(options.axis, "The axis of an orbit");
  const arm = subtract(options.startPosition, options.centre);
  const height = dot(arm, axis);
  const radial = subtract(arm, scaled(axis, height));
  const radius = Math.hypot(...radial);
  if (!(radius > 1e-9 * Math.hypot(...arm))) throw new Error("An orbit starts beside its axis, not on it");
  const hub = add(options.centre, scaled(axis, height));
  const sideways = cross(axis, radial);
  const count = Math.max(2, Math.ceil(Math.abs(degrees) / kOrbitStep_deg - 1e-9));
  const keyframes: Keyframe[] = [];
  for (let i = 0; i <= count; ++i) {
    const angle = (((degrees * i) / count) * Math.PI) / 180;
    const value = add(hub, add(scaled(radial, Math.cos(angle)), scaled(sideways, Math.sin(angle))));
    keyframes.push({ time: start + (seconds * i) / count, value, interpolation: "smooth" });
  }
  path.edit(() => {
    refine(path, radius);
    path.removeMotion("position");
    path.setKeyframes("position", keyframes);
    path.useLookAt([...options.centre]);
    path.removeMotion("look_at", [...options.centre]);
    if (path.constant("follow") === "direction") path.removeConstant("follow");
    standUpright(path, axis);
    coverSeconds(path, start + seconds);
  });
  return `Orbit of ${round(degrees)}° in ${round(seconds)} s`;
}

// Moves the camera along a straight line, at constant speed.
export function dolly(path: PathDocument, options: DollyOptions): string {
  const { from, to, seconds, start = 0 } = options;
  checkDuration(seconds, start);
  path.edit(() => {
    refine(path, Math.hypot(...subtract(to, from)));
    path.removeMotion("position", [...from]);
    if (start > 0) path.setKeyframe("position", start, [...from]);
    path.setKeyframe("position", start + seconds, [...to], start > 0 ? "linear" : undefined);
    coverSeconds(path, start + seconds);
  });
  return `Dolly in ${round(seconds)} s`;
}

// Moves the focus from rest to rest.
export function focusPull(path: PathDocument, options: FocusPullOptions): string {
  const { from, to, seconds, hold = 0, start = hold } = options;
  checkDuration(seconds, start);
  path.edit(() => {
    path.useFocusDistance(from);
    path.removeMotion("focus_distance", from);
    if (start > 0) path.setKeyframe("focus_distance", start, from);
    path.setKeyframe("focus_distance", start + seconds, to, "ease");
    coverSeconds(path, start + seconds + hold);
  });
  return `Focus pull in ${round(seconds)} s`;
}

function refine(path: PathDocument, size_w: number): void {
  if (size_w > 0) path.resolution_w = Math.min(path.resolution_w, kResolution * size_w);
}

// Makes the film long enough for a movement that ends at `seconds`, but never shorter. The frame with index i, from 0,
// is at i / fps.
function coverSeconds(path: PathDocument, seconds: number): void {
  const fps = path.constant("fps");
  const frames = path.constant("frames");
  if (typeof fps !== "number" || !(fps > 0)) throw new Error("The path has no frames per second");
  const needed = Math.ceil(seconds * fps - 1e-6) + 1;
  if (typeof frames !== "number" || frames < needed) path.setConstant("frames", needed);
}

// Sets `up` to the direction of the axis, or to the opposite direction if that is nearer to the previous `up`. Does
// nothing if `up` is already along the axis.
function standUpright(path: PathDocument, axis: Vector): void {
  const given = path.constant("up");
  const up = Array.isArray(given) && Math.hypot(...given) > 0 ? given : [0, -1, 0];
  const cosine = dot(axis, up) / Math.hypot(...up);
  if (Math.abs(cosine) > 1 - 1e-9) return;
  path.setConstant("up", scaled(axis, cosine < 0 ? -1 : 1));
}

function checkDuration(seconds: number, start: number): void {
  if (!(seconds > 0 && seconds < 1e9)) throw new Error(`A movement takes more than 0 seconds, not ${seconds}`);
  if (!(start >= 0 && start < 1e9)) throw new Error(`A film starts at 0 s, not at ${start} s`);
}

function round(x: number): number {
  return Number(x.toPrecision(4));
}

function add(a: Vector, b: Vector): number[] {
  return [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
}

function subtract(a: Vector, b: Vector): number[] {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

function scaled(a: Vector, factor: number): number[] {
  return [a[0] * factor, a[1] * factor, a[2] * factor];
}

function dot(a: Vector, b: Vector): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function cross(a: Vector, b: Vector): number[] {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function normalised(a: Vector, what: string): number[] {
  const length = Math.hypot(...a);
  if (!(length > 0)) throw new Error(`${what} has a direction, not [0, 0, 0]`);
  return scaled(a, 1 / length);
}
