// SPDX-License-Identifier: Apache-2.0
// The picture of a frame, finished or still being rendered: linear light and ray counts as half floats. It is shown
// with a chosen exposure, or as a map of its ray counts.

export interface GrowingPicture {
  width: number;
  height: number;
  fullWidth: number; // width of the frame, of which this may be a smaller picture
  fullHeight: number;
  hasRays: boolean;
  halves: Uint16Array; // R, G, B and ray count of each element, as half floats
}

export function readPicture(bytes: ArrayBuffer, begin = 0): GrowingPicture {
  const head = new Uint32Array(bytes, begin, 8);
  return {
    width: head[0],
    height: head[1],
    fullWidth: head[2],
    fullHeight: head[3],
    hasRays: head[4] === 1,
    halves: new Uint16Array(bytes, begin + 32),
  };
}

export function fromHalf(half: number): number {
  const sign = half & 0x8000 ? -1 : 1;
  const exponent = (half >> 10) & 31;
  const fraction = half & 1023;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return exponent === 0 ? sign * fraction * 2 ** -24 : sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
}

function displayValue(linear: number): number {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 255;
  return Math.round(255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055));
}

// Returns a table of the display values, from 0 to 255, of all half floats, brightened by `stops`. With it, a picture
// of a megapixel is developed in some milliseconds.
function displayTable(stops: number): Uint8ClampedArray {
  const table = new Uint8ClampedArray(65536);
  const factor = 2 ** stops;
  for (let half = 0; half < 65536; ++half) table[half] = displayValue(fromHalf(half) * factor);
  return table;
}

let exposureTable = displayTable(0);
let exposureStops = 0;

export function develop(picture: GrowingPicture, stops: number): ImageData {
  if (stops !== exposureStops) {
    exposureTable = displayTable(stops);
    exposureStops = stops;
  }
  const image = new ImageData(picture.width, picture.height);
  const { halves } = picture;
  for (let i = 0; i < image.data.length; i += 4) {
    image.data[i] = exposureTable[halves[i]];
    image.data[i + 1] = exposureTable[halves[i + 1]];
    image.data[i + 2] = exposureTable[halves[i + 2]];
    image.data[i + 3] = 255;
  }
  return image;
}

// Colours from dark violet over red to pale yellow (similar to magma). Their order is visible with any colour vision,
// because they become steadily brighter.
const HEAT: [number, number, number][] = [
  [4, 3, 14],
  [59, 15, 112],
  [140, 41, 129],
  [222, 73, 104],
  [254, 159, 109],
  [252, 253, 191],
];

export function heatColour(share: number): [number, number, number] {
  const place = Math.min(1, Math.max(0, share)) * (HEAT.length - 1);
  const i = Math.min(HEAT.length - 2, Math.floor(place));
  const t = place - i;
  return [0, 1, 2].map((c) => Math.round(HEAT[i][c] * (1 - t) + HEAT[i + 1][c] * t)) as [number, number, number];
}

export interface RayRange {
  least: number;
  median: number;
  most: number;
}

export function rayRange(picture: GrowingPicture): RayRange {
  const counts: number[] = [];
  for (let i = 3; i < picture.halves.length; i += 4) counts.push(fromHalf(picture.halves[i]));
  counts.sort((a, b) => a - b);
  return {
    least: counts[0] ?? 0,
    median: counts[counts.length >> 1] ?? 0,
    most: counts[counts.length - 1] ?? 0,
  };
}

// Returns a map of the ray counts, from 0 to `most`. Elements without a ray are bright green, so that they are noticed.
export function heatMap(picture: GrowingPicture, most: number): ImageData {
  const image = new ImageData(picture.width, picture.height);
  const table = new Map<number, [number, number, number]>();
  for (let i = 0; i < image.data.length; i += 4) {
    const half = picture.halves[i + 3];
    let colour = table.get(half);
    if (!colour) {
      const rays = fromHalf(half);
      colour = rays > 0 ? heatColour(rays / Math.max(most, 1e-6)) : [60, 230, 90];
      table.set(half, colour);
    }
    image.data[i] = colour[0];
    image.data[i + 1] = colour[1];
    image.data[i + 2] = colour[2];
    image.data[i + 3] = 255;
  }
  return image;
}
