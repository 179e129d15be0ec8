// SPDX-License-Identifier: Apache-2.0
// Moves the camera of a frame: orbits round a point, slides sideways, dollies along the optical axis.

import { add, cross, dot, unit, type FrameCamera } from "../data/frame_camera";
import type { Vec3 } from "../data/scene";
import { withFocusDistance } from "./lens_changes";

// Returns the vector, turned right-handed about an axis of length 1 (Rodrigues' formula).
function turned(vector: Vec3, axis: Vec3, angle: number): Vec3 {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const sideways = add([0, 0, 0], cross(axis, vector), s);
  return add(add(sideways, vector, c), axis, dot(axis, vector) * (1 - c));
}

function turnedCamera(camera: FrameCamera, pivot: Vec3, axis: Vec3, angle: number): FrameCamera {
  const turn = (vector: Vec3): Vec3 => turned(vector, axis, angle);
  const moved = {
    ...camera,
    centre: add(pivot, turn(add(camera.centre, pivot, -1))),
    right: turn(camera.right),
    up: turn(camera.up),
    forward: turn(camera.forward),
    normal: turn(camera.normal),
  };
  return withFocusDistance(moved, camera.focusDistance);
}

// Steepest angle between the optical axis and the plane that is level by `up`.
const MOST_PITCH = (85 * Math.PI) / 180;

// Turns the camera round the point in focus on the optical axis.
//   up       the direction that stays up in the picture
//   right    angle by which the camera moves to its right, radians
//   upwards  angle by which it moves upwards; is limited, so that the camera never looks along `up`
export function orbited(camera: FrameCamera, up: Vec3, right: number, upwards: number): FrameCamera {
  const pivot = add(camera.centre, camera.forward, camera.focusDistance);
  const axis = unit(up);
  const pitch = Math.asin(Math.max(-1, Math.min(1, dot(camera.forward, axis))));
  const wanted = Math.max(-MOST_PITCH, Math.min(MOST_PITCH, pitch - upwards));
  const level = cross(camera.forward, axis);
  const sideways = Math.hypot(...level) > 1e-6 ? unit(level) : camera.right;
  // right, up and backward are right-handed. A turn about `sideways` by a positive angle raises the direction.
  const raised = turnedCamera(camera, pivot, sideways, wanted - pitch);
  return turnedCamera(raised, pivot, axis, right);
}

// Moves the camera by lengths in world units, without turning it.
export function slid(camera: FrameCamera, right: number, upwards: number, forward = 0): FrameCamera {
  const step = add(add([0, 0, 0], camera.right, right), camera.up, upwards);
  const centre = add(add(camera.centre, step), camera.forward, forward);
  return withFocusDistance({ ...camera, centre }, camera.focusDistance);
}

// Sets the focus distance so that the focus plane, which may be tilted, goes through a point.
export function focusedThrough(camera: FrameCamera, point: Vec3): FrameCamera {
  const offset = add(point, camera.centre, -1);
  const distance =
    dot(offset, camera.forward) -
    dot(offset, camera.right) * Math.tan(camera.tiltHorizontal) -
    dot(offset, camera.up) * Math.tan(camera.tiltVertical);
  return withFocusDistance(camera, distance);
}
