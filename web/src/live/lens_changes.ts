// SPDX-License-Identifier: Apache-2.0
// Changes of the lens of a frame's camera, and how each is written into the path.

import { add, dot, unit, type FrameCamera } from "../data/frame_camera";
import type { PathDocument } from "../path/path_document";
import { setAtTime, setFocusDistance } from "../path/set_at_time";
import { isBreathing } from "./one_frame_path";

const DEGREES = 180 / Math.PI;

export function withFocusDistance(camera: FrameCamera, distance: number): FrameCamera {
  const focused = { ...camera, focusDistance: distance };
  focused.offset = dot(camera.normal, add(camera.centre, camera.forward, distance));
  if (isBreathing(camera)) {
    // The image distance b, by 1/f = 1/g + 1/b, sets the field of view.
    const { focalLength: f, width, sensorWidth } = camera;
    focused.fx = focused.fy = ((f * distance) / Math.max(distance - f, 1e-9 * f)) * (width / sensorWidth);
  }
  return focused;
}

export function writeFocusDistance(document: PathDocument, time: number, camera: FrameCamera): string {
  const instead = setFocusDistance(document, time, camera.focusDistance);
  return instead && "This focus distance replaces the previous definition of the focus.";
}

// Changes the opening.
//   perStop_deg  rotation of the blades that the path adds per stop
export function withRadius(camera: FrameCamera, radius: number, perStop_deg = 0): FrameCamera {
  const stops = radius > 0 && camera.radius > 0 ? 2 * Math.log2(camera.radius / radius) : 0;
  return { ...camera, radius, rotation: camera.rotation + (stops * perStop_deg) / DEGREES };
}

export function writeAperture(document: PathDocument, time: number, camera: FrameCamera): string {
  const diameter = 2 * camera.radius;
  if (!document.quantity("f_number").given) setAtTime(document, "aperture_diameter", time, diameter);
  else if (diameter > 0) setAtTime(document, "f_number", time, camera.focalLength / diameter);
  else {
    document.useAperture(0);
    return "A pinhole has no f-number: aperture_diameter replaces f_number in the whole film.";
  }
  return "";
}

// Returns the camera with its focus plane tilted by its tiltHorizontal and tiltVertical: a point x to the right of the
// optical axis and y above it is in the plane if its depth is the focus distance + x tan(horizontal) + y tan(vertical).
export function withTilt(camera: FrameCamera): FrameCamera {
  const sideways = add(camera.forward, camera.right, -Math.tan(camera.tiltHorizontal));
  const normal = unit(add(sideways, camera.up, -Math.tan(camera.tiltVertical)));
  return withFocusDistance({ ...camera, normal }, camera.focusDistance);
}

export function writeTilt(document: PathDocument, time: number, camera: FrameCamera): string {
  const { tiltHorizontal, tiltVertical } = camera;
  setAtTime(document, "focus_tilt", time, {
    horizontal: tiltHorizontal * DEGREES,
    vertical: tiltVertical * DEGREES,
  });
  return "";
}

export function writeBlades(document: PathDocument, _time: number, camera: FrameCamera): string {
  document.setConstant("blades", camera.blades);
  return "";
}

// Returns a function that writes the rotation of the blades.
//   widest  radius of the widest opening of all frames, from which blade_rotation_per_stop counts
export function rotationWriter(widest: number) {
  return (document: PathDocument, time: number, camera: FrameCamera): string => {
    const isTurned = camera.radius > 0 && widest > 0;
    const ofStops = isTurned ? rotationPerStop(document) * 2 * Math.log2(widest / camera.radius) : 0;
    setAtTime(document, "blade_rotation", time, camera.rotation * DEGREES - ofStops);
    return "";
  };
}

// Returns the rotation of the blades that the path adds per stop, degrees.
export function rotationPerStop(document: PathDocument): number {
  const perStop = document.constant("blade_rotation_per_stop");
  return typeof perStop === "number" ? perStop : 0;
}
