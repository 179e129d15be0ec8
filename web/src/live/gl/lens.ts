// SPDX-License-Identifier: Apache-2.0
// The lens of a picture: which LF images it takes, and the weights of their rays (lf/live/picture_lens.h).

import { readHead } from "../../data/head";
import type { Opening } from "../../data/opening";
import type { LiveFacts } from "../../data/live_picture";
import type { Plate } from "./ray_forms";

export interface LensImage {
  id: number;
  shift: [number, number]; // shift of the blocks of elements that have the same weight, in elements
  samples: number; // rays along each edge of an element
}

// The radius and shape of a lens are those of the opening through which rays must pass.
export interface Lens extends Opening {
  plate: Plate;
  images: LensImage[]; // LF images that have a weight somewhere
  // Weights in 1/256 at nodes on the plate, [image][row][column], between which they are interpolated.
  columns: number;
  rows: number;
  nodes: Uint16Array;
  hasFeather: boolean;
  pedestal: number;
  colours: number[]; // [3][3], from values of LF images less the pedestal to linear light
}

export interface LensAnswer {
  lens: Lens;
  facts: LiveFacts; // without the time of the picture
  refused: string; // why a picture cannot be rendered here; "" if it can
}

interface LensHead extends LiveFacts, Plate, Opening {
  refused: string;
  columns: number;
  rows: number;
  feather: boolean;
  pedestal: number;
  colours: number[];
  lf_images: [number, number, number, number][];
}

export function readLens(bytes: ArrayBuffer): LensAnswer {
  const [head, begin] = readHead<LensHead>(bytes);
  const { columns, rows, radius, blades, rotation, ratio, roundness, pedestal, colours } = head;
  const { width, height, fx, fy, cx, cy } = head;
  const images = head.lf_images.map(([id, x, y, samples]): LensImage => ({ id, shift: [x, y], samples }));
  return {
    lens: {
      plate: { width, height, fx, fy, cx, cy },
      images,
      columns,
      rows,
      nodes: new Uint16Array(bytes, begin, images.length * columns * rows),
      radius,
      blades,
      rotation,
      ratio,
      roundness,
      hasFeather: head.feather,
      pedestal,
      colours,
    },
    facts: { ...head, render_ms: 0 },
    refused: head.refused,
  };
}
