// SPDX-License-Identifier: Apache-2.0
// The shape of the lens's opening (lf/camera/aperture.h), inscribed in a circle.

export interface Opening {
  radius: number; // of the circle, in world units
  blades: number; // 0: round
  rotation: number; // counter-clockwise for the photographer, radians; at 0, a corner is straight up
  ratio: number; // height divided by width
  roundness: number; // 0: straight blades; 1: they form the circle
}

// Returns by how much an anamorphic lens squeezes the opening along its width and its height.
export function squeezeOf({ ratio }: Opening): [number, number] {
  return [Math.min(1, 1 / ratio), Math.min(1, ratio)];
}

// Returns the distance from the centre to the rim of an opening of radius 1 that is not squeezed, in the direction of
// an angle from right towards up.
export function rimAt({ blades, rotation, roundness }: Opening, angle: number): number {
  if (blades < 3 || roundness === 1) return 1;
  const half = Math.PI / blades;
  const fromEdge = angle - Math.PI / 2 - rotation - half;
  const folded = fromEdge - 2 * half * Math.round(fromEdge / (2 * half));
  if (roundness === 0) return Math.cos(half) / Math.cos(folded);
  const { radius, centre } = arcOf(half, roundness);
  const across = centre * Math.sin(folded);
  return centre * Math.cos(folded) + Math.sqrt(radius * radius - across * across);
}

// Returns the arc of a rounded blade: its radius, and the place of its centre on the normal of the edge.
export function arcOf(half: number, roundness: number): { radius: number; centre: number } {
  const rise = roundness * (1 - Math.cos(half));
  const radius = (Math.sin(half) ** 2 + rise * rise) / (2 * rise);
  return { radius, centre: Math.cos(half) + rise - radius };
}

// Returns the shape in words.
export function shapeText({ blades, ratio, roundness }: Opening): string {
  const parts = [blades < 3 ? (ratio === 1 ? "a disk" : "an ellipse") : `${blades} blades`];
  if (blades >= 3 && roundness > 0) parts.push(`${Math.round(100 * roundness)} % round`);
  if (ratio !== 1) parts.push(`height / width ${Number(ratio.toPrecision(3))}`);
  return parts.join(", ");
}
