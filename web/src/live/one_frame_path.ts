// SPDX-License-Identifier: Apache-2.0
// Writes a path of one frame, which has a given camera. A live picture is requested with it, because it is parsed
// quickly even if the film has thousands of frames.

import type { FrameCamera } from "../data/frame_camera";
import type { PathHead, Vec3 } from "../data/scene";

const DEGREES = 180 / Math.PI;

// Returns the rotation from the camera's axes (right, down, forward) to the world's as a quaternion [w, x, y, z].
export function quaternionOf({ right, up, forward }: Pick<FrameCamera, "right" | "up" | "forward">): number[] {
  const down = up.map((x) => -x) as Vec3;
  const m = (row: number, column: number): number => [right, down, forward][column][row];
  // The largest of the four components is computed by a root, the others by divisions by it.
  const squares = [
    1 + m(0, 0) + m(1, 1) + m(2, 2),
    1 + m(0, 0) - m(1, 1) - m(2, 2),
    1 - m(0, 0) + m(1, 1) - m(2, 2),
    1 - m(0, 0) - m(1, 1) + m(2, 2),
  ];
  const largest = squares.indexOf(Math.max(...squares));
  const four = 2 * Math.sqrt(squares[largest]);
  const [a, b, c] = [m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)];
  const [d, e, f] = [m(1, 0) + m(0, 1), m(0, 2) + m(2, 0), m(2, 1) + m(1, 2)];
  const rows = [
    [squares[0], a, b, c],
    [a, squares[1], d, e],
    [b, d, squares[2], f],
    [c, e, f, squares[3]],
  ];
  return rows[largest].map((x) => x / four);
}

// Returns true if focusing changes the field of view: the image distance then differs from the focal length.
export function isBreathing({ fx, sensorWidth, width, focalLength }: FrameCamera): boolean {
  return Math.abs((fx * sensorWidth) / width - focalLength) > 1e-9 * focalLength;
}

// The properties of a path that its cameras do not have.
export type PathFacts = Pick<PathHead, "unit_m" | "transmission">;

export function oneFramePath(camera: FrameCamera, { unit_m, transmission }: PathFacts): string {
  const list = (numbers: readonly number[]): string => `[${numbers.join(", ")}]`;
  const perElement = camera.sensorWidth / camera.width;
  const hood =
    camera.hoodRadius > 0 ? `  hood_distance: ${camera.hoodDistance}\n  hood_diameter: ${2 * camera.hoodRadius}\n` : "";
  const ofTransmission = transmission ? `  transmission: "${transmission}"\n` : "";
  const shift = [(camera.width / 2 - camera.cx) * perElement, (camera.cy - camera.height / 2) * perElement];
  return `format: lfpath 1
fps: 1
frames: 1
unit_m: ${unit_m}
resolution: ${list([camera.width, camera.height])}
camera:
  sensor_width: ${camera.sensorWidth}
  focal_length: ${camera.focalLength}
  shift: {horizontal: ${shift[0]}, vertical: ${shift[1]}}
  position: ${list(camera.centre)}
  quaternion: ${list(quaternionOf(camera))}
lens:
  aperture_diameter: ${2 * camera.radius}
  focus_distance: ${camera.focusDistance}
  focus_tilt_deg: {horizontal: ${camera.tiltHorizontal * DEGREES}, vertical: ${camera.tiltVertical * DEGREES}}
  breathing: ${isBreathing(camera)}
  blades: ${camera.blades}
  blade_rotation_deg: ${camera.rotation * DEGREES}
  blade_roundness: ${camera.roundness}
  ratio: ${camera.ratio}
${hood}${ofTransmission}`;
}
