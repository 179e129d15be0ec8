// SPDX-License-Identifier: Apache-2.0
// The geometry between the plate of a picture and one LF camera, as linear forms on the position on the plate
// (doc/ray.md, "Geometry"): they are computed here in double precision, and evaluated on the graphics card.

import { add, dot, type FrameCamera } from "../../data/frame_camera";
import type { Vec3 } from "../../data/scene";

export type Matrix = [Vec3, Vec3, Vec3]; // rows

export interface Plate {
  width: number; // in elements
  height: number;
  fx: number;
  fy: number;
  cx: number;
  cy: number;
}

export interface LfCamera {
  width: number; // of its LF image as the renderer has it, in pixels
  height: number;
  matrix: Matrix; // calibration matrix times rotation: from a direction in the world to a homogeneous position
  centre: Vec3;
}

// Linear forms on (x, y, 1), where x and y count from the middle of the plate, in elements.
export interface RayForms {
  pixel: Matrix; // homogeneous position in the LF image, whose sign is to be chosen so that the ray runs forward
  front: Vec3; // > 0: the focus point is in front of the lens
  forward: Vec3; // >= 0: from the LF camera to the focus point is forward for the frame
  // The ray meets the lens plane at (right / forward, up / forward), in radii of the opening.
  lensRight: Vec3;
  lensUp: Vec3;
}

const LEAST_RADIUS = 1e-12; // of an opening, in world units, so that a pinhole can be divided by it

// Returns the matrix of nine numbers, row by row.
export function matrixOf(m: readonly number[]): Matrix {
  return [
    [m[0], m[1], m[2]],
    [m[3], m[4], m[5]],
    [m[6], m[7], m[8]],
  ];
}

const scaled = (a: Vec3, by: number): Vec3 => [a[0] * by, a[1] * by, a[2] * by];
// Returns the row vector a times a matrix that is given by its columns.
const timesColumns = (a: Vec3, columns: Matrix): Vec3 => [dot(a, columns[0]), dot(a, columns[1]), dot(a, columns[2])];

// Returns the plate of a camera at another width, as the server makes it.
export function plateOf(camera: FrameCamera, width: number, mostSide = 1280): Plate {
  const factor = Math.min(width / camera.width, mostSide / camera.width, mostSide / camera.height);
  const size = (elements: number) => Math.max(1, Math.min(mostSide, Math.round(elements * factor)));
  return {
    width: size(camera.width),
    height: size(camera.height),
    fx: camera.fx * factor,
    fy: camera.fy * factor,
    cx: camera.cx * factor,
    cy: camera.cy * factor,
  };
}

// Returns the matrix that maps (x, y, 1) to the direction of the element's ray in the world, by its columns.
function directions(camera: FrameCamera, { width, height, fx, fy, cx, cy }: Plate): Matrix {
  const middle = add(add(camera.forward, camera.right, (0.5 * width - cx) / fx), camera.up, -(0.5 * height - cy) / fy);
  return [scaled(camera.right, 1 / fx), scaled(camera.up, -1 / fy), middle];
}

//   radius  of the opening, in world units
export function rayForms(camera: FrameCamera, plate: Plate, lf: LfCamera, radius: number): RayForms {
  const toWorld = directions(camera, plate);
  const offset = add(lf.centre, camera.centre, -1);
  const distance = camera.offset - dot(camera.normal, camera.centre);
  const sign = distance < 0 ? -1 : 1;
  // From the LF camera to the focus point, times a positive factor.
  const toFocus = toWorld.map((column) =>
    scaled(add(scaled(column, distance), offset, -dot(camera.normal, column)), sign),
  ) as Matrix;
  const forward = timesColumns(camera.forward, toFocus);
  const ahead = dot(camera.forward, offset);
  const opening = Math.max(radius, LEAST_RADIUS);
  const onLens = (axis: Vec3): Vec3 => {
    const beside = dot(axis, offset);
    const along = timesColumns(axis, toFocus);
    return forward.map((of, i) => (beside * of - ahead * along[i]) / opening) as Vec3;
  };
  return {
    pixel: lf.matrix.map((row) => timesColumns(row, toFocus)) as Matrix,
    front: timesColumns(scaled(camera.normal, sign), toWorld),
    forward,
    lensRight: onLens(camera.right),
    lensUp: onLens(camera.up),
  };
}

// Returns the position of a ray in the LF image, in pixels; null if there is none. x and y count from the upper left
// corner of the plate.
export function recordedAt(forms: RayForms, plate: Plate, x: number, y: number): [number, number] | null {
  const at: Vec3 = [x - 0.5 * plate.width, y - 0.5 * plate.height, 1];
  if (!(dot(forms.front, at) > 0)) return null;
  const side = dot(forms.forward, at) < 0 ? -1 : 1;
  const [px, py, pz] = forms.pixel.map((row) => side * dot(row, at));
  return pz > 0 ? [px / pz, py / pz] : null;
}

// Returns how many LF pixels wide an element in the middle of the plate is; 1 if it has no ray.
export function elementWidth(forms: RayForms, plate: Plate): number {
  const [x, y] = [0.5 * plate.width, 0.5 * plate.height];
  const [left, right, above, below] = [
    recordedAt(forms, plate, x - 0.5, y),
    recordedAt(forms, plate, x + 0.5, y),
    recordedAt(forms, plate, x, y - 0.5),
    recordedAt(forms, plate, x, y + 0.5),
  ];
  if (!left || !right || !above || !below) return 1;
  const [along, down] = [
    [right[0] - left[0], right[1] - left[1]],
    [below[0] - above[0], below[1] - above[1]],
  ];
  return Math.sqrt(Math.abs(along[0] * down[1] - along[1] * down[0]));
}

// Returns a rough upper bound of the number of LF pixels from one element to the next, which is measured at nine points
// of the plate; Infinity if one of them has no ray.
export function pixelsPerElement(forms: RayForms, plate: Plate): number {
  let most = 0;
  for (const v of [0, 0.5, 1])
    for (const u of [0, 0.5, 1]) {
      const [x, y] = [u * plate.width, v * plate.height];
      const here = recordedAt(forms, plate, x, y);
      for (const [dx, dy] of [
        [0.5, 0],
        [-0.5, 0],
        [0, 0.5],
        [0, -0.5],
      ]) {
        const beside = recordedAt(forms, plate, x + dx, y + dy);
        if (!here || !beside) return Infinity;
        most = Math.max(most, 2 * Math.hypot(beside[0] - here[0], beside[1] - here[1]));
      }
    }
  return most;
}
