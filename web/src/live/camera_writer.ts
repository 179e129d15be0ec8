// SPDX-License-Identifier: Apache-2.0
// Writes a moved camera into the path: its position, and its direction in the way in which the path defines it.

import { add, cross, dot, unit, type FrameCamera } from "../data/frame_camera";
import type { Vec3 } from "../data/scene";
import type { PathDocument } from "../path/path_document";
import type { PathValue } from "../path/path_quantities";
import { setAtTime } from "../path/set_at_time";
import { quaternionOf } from "./one_frame_path";

const DEGREES = 180 / Math.PI;

function givenValue(document: PathDocument, name: string): { base?: PathValue; hasKeys: boolean } | null {
  const { given, base, keyframes } = document.quantity(name);
  return given ? { base, hasKeys: keyframes.length > 0 } : null;
}

// Returns the direction that stays up in the picture during an orbit.
export function levelUp(document: PathDocument, camera: FrameCamera): Vec3 {
  if (document.quantity("quaternion").given) return camera.up;
  const up = document.constant("up");
  return Array.isArray(up) && Math.hypot(...up) > 0 ? unit(up as Vec3) : [0, -1, 0];
}

// Returns the value of the quantity focus_point if the path has one that is the same in the whole film; else null.
export function fixedFocusPoint(document: PathDocument): Vec3 | null {
  const point = givenValue(document, "focus_point");
  return point && !point.hasKeys && Array.isArray(point.base) ? (point.base as Vec3) : null;
}

// Writes the position and the direction of the camera at a time.
//   isTurned  true if the direction has changed
// Returns a text that tells what has changed in the whole film although only this frame was meant, or "". Throws if the
// path defines the direction in a way in which it cannot be changed at this frame.
export function writeCamera(document: PathDocument, time: number, camera: FrameCamera, isTurned: boolean): string {
  const position = document.quantity("position");
  const keepsDirection = document.constant("follow") === "direction";
  if (isTurned && keepsDirection && time > 0)
    throw new Error("This camera keeps the direction of the first frame (follow: direction): turn it there");
  setAtTime(document, "position", time, camera.centre);
  const changed = keepsDirection && !isTurned ? "" : writeDirection(document, time, camera);
  if (position.hasAccelerations) return "This position replaces the movement by speed and accelerations.";
  if (!changed || position.keyframes.length === 0 || document.quantity(changed).keyframes.length > 0) return "";
  return `The position changed at this frame, but ${changed}, which has no keys, in the whole film.`;
}

// Returns the name of the quantity that was written; "" if the direction was right already.
function writeDirection(document: PathDocument, time: number, camera: FrameCamera): string {
  if (givenValue(document, "quaternion")) {
    setAtTime(document, "quaternion", time, quaternionOf(camera));
    return "quaternion";
  }
  const orientation = givenValue(document, "orientation");
  if (orientation) {
    const written = orientationOf(camera, rollAt(document, time));
    if (!orientation.hasKeys && isSame(orientation.base, written)) return "";
    setAtTime(document, "orientation", time, written);
    return "orientation";
  }
  return writeLookAt(document, time, camera);
}

function writeLookAt(document: PathDocument, time: number, camera: FrameCamera): string {
  const { base, keyframes } = document.quantity("look_at");
  const known = keyframes.length === 0 && Array.isArray(base) ? (base as Vec3) : null;
  let distance = camera.focusDistance;
  if (known) {
    const offset = add(known, camera.centre, -1);
    const ahead = dot(offset, camera.forward);
    const beside = Math.hypot(...cross(offset, camera.forward));
    if (ahead > 0 && beside < 1e-7 * ahead) return "";
    if (ahead > 0) distance = ahead;
  }
  setAtTime(document, "look_at", time, add(camera.centre, camera.forward, distance));
  return "look_at";
}

// Returns {yaw, pitch, roll} in degrees of a camera that is turned by `roll` degrees in addition:
// R_y(yaw) R_x(pitch) R_z(roll), with the axes right, down, forward.
export function orientationOf(camera: FrameCamera, roll = 0): Record<"yaw" | "pitch" | "roll", number> {
  const [x, y, z] = camera.forward;
  const yaw = Math.atan2(x, z);
  const pitch = Math.asin(Math.max(-1, Math.min(1, -y)));
  const level: Vec3 = [Math.cos(yaw), 0, -Math.sin(yaw)];
  const down = cross(camera.forward, level);
  const all = Math.atan2(dot(camera.right, down), dot(camera.right, level));
  return { yaw: yaw * DEGREES, pitch: pitch * DEGREES, roll: all * DEGREES - roll };
}

function isSame(base: PathValue | undefined, angles: Record<string, number>): boolean {
  if (typeof base !== "object" || Array.isArray(base)) return false;
  return Object.entries(angles).every(([name, angle]) => Math.abs((base[name] ?? 0) - angle) < 1e-7);
}

// Returns the quantity roll at a time, degrees.
function rollAt(document: PathDocument, time: number): number {
  const { base, keyframes, hasAccelerations } = document.quantity("roll");
  if (keyframes.length === 0 && !hasAccelerations) return typeof base === "number" ? base : 0;
  const key = keyframes.find((one) => Math.abs(one.time - time) < 1e-6);
  if (!key) throw new Error("The roll of this camera moves: go to one of its keys, or remove its motion first");
  return key.value as number;
}
