// SPDX-License-Identifier: Apache-2.0
// Lens weights that the browser computes for exported pages. The server's weights (doc/lens-integral.md) are areas of
// cells. These weights are counts of points of the opening instead: each point counts for the nearest LF camera, or in
// narrow lenses for the few LF cameras around it (hat weights).

import { rimAt, squeezeOf, type Opening } from "../../data/opening";
import { add, dot, type FrameCamera } from "../../data/frame_camera";
import type { Vec3 } from "../../data/scene";
import type { Lens } from "./lens";
import { elementWidth, rayForms, type LfCamera, type Plate } from "./ray_forms";

type Vec2 = [number, number];

const WEIGHT_ONE = 256;
const MOST_WEIGHT = 255;
const STEP_OF_SPACING = 1 / 3; // largest movement of lens points from node to node
const MOST_NODES = 8; // largest number of nodes in a row or column
const AT_REST = 1e-6; // movement of lens points, in spacings, below which LF cameras are in the lens plane
const COUNTED = 12; // least number of LF cameras around the lens from which the spacing is measured
const POINTS_PER_CAMERA = 24; // number of points of the opening for each LF camera in it
const LEAST_POINTS = 64;
const MOST_POINTS = 40_000; // largest number of points at all nodes together, which take about 20 ms
const REACH = 1.5; // distance, in spacings, beyond which an LF camera does not stand for a point of the opening
const CELLS = 65536; // largest number of cells across in which points are sought
// Lens diameters, in spacings: up to the first one all weights are hat weights, from the second one on none are.
const HATS = { upTo: 1, until: 1.75 };
const FINER_AT_MOST = 1.25; // LF pixels along an element that need no more than one ray
const MOST_SAMPLES = 3;

export interface LensOfCameras {
  lens: Lens;
  spacing: number; // distance between LF cameras around the lens, in world units
  uncoveredShare: number; // share of the opening for which no LF camera stands
}

// Returns the point of the focus plane that a position on the plate sees; null beyond the horizon of a tilted plane.
export function focusPointAt(camera: FrameCamera, plate: Plate, x: number, y: number): Vec3 | null {
  const sideways = add(camera.forward, camera.right, (x - plate.cx) / plate.fx);
  const direction = add(sideways, camera.up, -(y - plate.cy) / plate.fy);
  const depth = (camera.offset - dot(camera.normal, camera.centre)) / dot(camera.normal, direction);
  return depth > 0 && Number.isFinite(depth) ? add(camera.centre, direction, depth) : null;
}

// Returns where the line through an LF camera and a point meets the lens plane: how far to the right of the lens centre
// and above it, in world units.
export function lensPoint(camera: FrameCamera, centre: Vec3, point: Vec3): Vec2 {
  const along = add(centre, point, -1);
  const toLens = add(camera.centre, point, -1);
  const t = dot(camera.forward, toLens) / dot(camera.forward, along);
  const offset = add(add(point, along, t), camera.centre, -1);
  return [dot(camera.right, offset), dot(camera.up, offset)];
}

// Returns at most `count` points that are spread evenly over the opening: the points of a spiral that are inside of its
// rim.
export function pointsOfOpening(opening: Opening, count: number): Vec2[] {
  const golden = Math.PI * (3 - Math.sqrt(5));
  const [width, height] = squeezeOf(opening).map((squeeze) => squeeze * opening.radius);
  const points: Vec2[] = [];
  for (let i = 0; i < count; ++i) {
    const size = Math.sqrt((i + 0.5) / count);
    const angle = i * golden;
    if (size <= rimAt(opening, angle)) points.push([width * size * Math.cos(angle), height * size * Math.sin(angle)]);
  }
  return points;
}

// Returns true if the hood lets the ray from a lens point to a focus point through.
export function passesHood(camera: FrameCamera, [right, up]: Vec2, focus: Vec3 | null): boolean {
  if (!(camera.hoodRadius > 0) || !focus) return true;
  const offset = add(focus, camera.centre, -1);
  const share = camera.hoodDistance / dot(camera.forward, offset);
  const at = (axis: Vec3, start: number) => start + (dot(axis, offset) - start) * share;
  return Math.hypot(at(camera.right, right), at(camera.up, up)) <= camera.hoodRadius;
}

// Returns the approximate distance between neighbouring points around the lens, by their density.
export function spacingAround(points: readonly Vec2[], radius: number): number {
  const distances = points.map(([x, y]) => Math.hypot(x, y)).sort((a, b) => a - b);
  if (distances.length === 0) return 0;
  const within = distances.filter((d) => d <= radius).length;
  const count = Math.min(distances.length, Math.max(within, COUNTED));
  return Math.max(radius, distances[count - 1]) * Math.sqrt(Math.PI / count);
}

// Returns the shares of the opening for which LF cameras stand, and the share for which none does.
//   of      points of the opening
//   points  lens points of the LF cameras
export function sharesOf(of: readonly Vec2[], points: readonly Vec2[], spacing: number, hatShare: number) {
  const shares = new Float64Array(points.length);
  const reach = REACH * spacing;
  const cells = new Map<number, number[]>();
  const cellOf = (at: number) => Math.floor(at / reach);
  const keyOf = (column: number, row: number) => column + CELLS * row;
  points.forEach(([x, y], i) => {
    if (!(Math.max(Math.abs(x), Math.abs(y)) < 0.5 * CELLS * reach)) return;
    const key = keyOf(cellOf(x), cellOf(y));
    const cell = cells.get(key);
    if (cell) cell.push(i);
    else cells.set(key, [i]);
  });
  let uncovered = 0;
  for (const [x, y] of of) {
    const near: [number, number][] = [];
    for (let row = cellOf(y) - 1; row <= cellOf(y) + 1; ++row)
      for (let column = cellOf(x) - 1; column <= cellOf(x) + 1; ++column)
        for (const i of cells.get(keyOf(column, row)) ?? []) {
          const distance = Math.hypot(points[i][0] - x, points[i][1] - y);
          if (distance < reach) near.push([i, distance]);
        }
    if (near.length === 0) {
      ++uncovered;
      continue;
    }
    const nearest = near.reduce((a, b) => (b[1] < a[1] ? b : a));
    shares[nearest[0]] += (1 - hatShare) / of.length;
    const hats = near.map(([i, distance]): [number, number] => [i, 1 - distance / reach]);
    const sum = hats.reduce((all, [, hat]) => all + hat, 0);
    for (const [i, hat] of hats) shares[i] += (hatShare * hat) / sum / of.length;
  }
  return { shares, uncovered: uncovered / of.length };
}

// Returns the share of hat weights in the lens weights. It falls smoothly from 1 to 0 while a lens opens.
function hatShareOf(radius: number, spacing: number): number {
  const t = (HATS.until - (2 * radius) / spacing) / (HATS.until - HATS.upTo);
  const s = Math.max(0, Math.min(1, t));
  return s * s * (3 - 2 * s);
}

// Returns the numbers of columns and rows of nodes. They grow with the movement of lens points from one edge of the
// plate to the other.
function gridOf(camera: FrameCamera, plate: Plate, centres: readonly Vec3[], spacing: number): [number, number] {
  const focus = (u: number, v: number) => focusPointAt(camera, plate, u * plate.width, v * plate.height);
  const moved = (centre: Vec3, a: Vec3 | null, b: Vec3 | null): number => {
    if (!a || !b) return spacing;
    const [p, q] = [lensPoint(camera, centre, a), lensPoint(camera, centre, b)];
    return Math.hypot(p[0] - q[0], p[1] - q[1]);
  };
  // The part of the lens that a hood leaves moves like the lens point of the hood's centre.
  const hood = add(camera.centre, camera.forward, camera.hoodDistance);
  const moving = camera.hoodRadius > 0 ? [...centres, hood] : centres;
  const count = (a: Vec3 | null, b: Vec3 | null): number => {
    const most = moving.reduce((all, centre) => Math.max(all, moved(centre, a, b)), 0);
    if (!(most > AT_REST * spacing)) return 1;
    return Math.min(MOST_NODES, Math.floor(2 + most / (STEP_OF_SPACING * spacing)));
  };
  return [count(focus(0, 0.5), focus(1, 0.5)), count(focus(0.5, 0), focus(0.5, 1))];
}

function nodePlace(index: number, count: number, size: number): number {
  return count === 1 ? 0.5 * size : (index * size) / (count - 1);
}

// Returns the lens of a picture of these LF cameras. Their images have values from 0 to 65535, in linear light.
export function lensOf(camera: FrameCamera, plate: Plate, cameras: ReadonlyMap<number, LfCamera>): LensOfCameras {
  const ids = [...cameras.keys()];
  const centres = ids.map((id) => cameras.get(id)!.centre);
  const pointsSeen = (x: number, y: number): Vec2[] | null => {
    const focus = focusPointAt(camera, plate, x, y);
    return focus && centres.map((centre) => lensPoint(camera, centre, focus));
  };
  const middle = pointsSeen(0.5 * plate.width, 0.5 * plate.height) ?? [];
  const spacing = spacingAround(middle, camera.radius);
  const inside = middle.filter(([x, y]) => Math.hypot(x, y) <= camera.radius).length;
  const hatShare = spacing > 0 ? hatShareOf(camera.radius, spacing) : 1;
  const [columns, rows] = spacing > 0 ? gridOf(camera, plate, centres, spacing) : [1, 1];
  const pointCount = Math.min(POINTS_PER_CAMERA * inside, MOST_POINTS / (columns * rows));
  const of = pointsOfOpening(camera, Math.max(LEAST_POINTS, Math.round(pointCount)));
  const perNode: Float64Array[] = [];
  let uncoveredShare = 1;
  for (let row = 0; row < rows; ++row)
    for (let column = 0; column < columns; ++column) {
      const [x, y] = [nodePlace(column, columns, plate.width), nodePlace(row, rows, plate.height)];
      const points = pointsSeen(x, y);
      const through = of.filter((point) => passesHood(camera, point, focusPointAt(camera, plate, x, y)));
      const found = points && spacing > 0 && through.length > 0 ? sharesOf(through, points, spacing, hatShare) : null;
      perNode.push(found?.shares ?? new Float64Array(ids.length));
      if (found) uncoveredShare = Math.min(uncoveredShare, found.uncovered);
    }
  const lens = weighted(camera, plate, cameras, perNode, [columns, rows]);
  lens.radius = camera.radius + 2 * REACH * spacing;
  return { lens, spacing, uncoveredShare };
}

// Returns a lens with weights in proportion to the shares; LF cameras without a share are left out.
function weighted(
  camera: FrameCamera,
  plate: Plate,
  cameras: ReadonlyMap<number, LfCamera>,
  perNode: readonly Float64Array[],
  [columns, rows]: [number, number],
): Lens {
  let largest = 0;
  for (const shares of perNode) for (const share of shares) largest = Math.max(largest, share);
  const scale = (MOST_WEIGHT * WEIGHT_ONE) / (largest || 1);
  const nodes: number[] = [];
  const images: Lens["images"] = [];
  [...cameras].forEach(([id, lf], i) => {
    if (!perNode.some((shares) => shares[i] > 0)) return;
    for (const shares of perNode) nodes.push(Math.round(shares[i] * scale));
    const width = elementWidth(rayForms(camera, plate, lf, 1), plate);
    const samples = width > FINER_AT_MOST ? Math.min(MOST_SAMPLES, Math.ceil(width - 1e-3)) : 1;
    images.push({ id, shift: [(5 * i) % 8, (3 * i) % 8], samples });
  });
  const colours = [1, 0, 0, 0, 1, 0, 0, 0, 1].map((x) => x / 65535);
  const disk: Opening = { radius: 0, blades: 0, rotation: 0, ratio: 1, roundness: 0 };
  return {
    plate,
    images,
    columns,
    rows,
    nodes: new Uint16Array(nodes),
    ...disk,
    hasFeather: true,
    pedestal: 0,
    colours,
  };
}
