// SPDX-License-Identifier: Apache-2.0
// The LF images of an exported page: JPEG or PNG files within scripts, in sRGB.

import { getBytes } from "../../data/source";
import type { Vec3 } from "../../data/scene";
import type { LfImage } from "./lf_textures";
import { matrixOf } from "./ray_forms";

// Data of live.json.
export interface ExportedLive {
  refused: string; // why there are no live pictures; "" if there are some
  divisor: number; // factor by which LF images are shrunken
  images: { id: number; name: string; width: number; height: number; matrix: number[]; centre: Vec3 }[];
}

const LARGEST = 65535;

// Returns a table from display values to linear light.
function linearTable(): Uint16Array {
  return Uint16Array.from({ length: 256 }, (_, i) => {
    const display = i / 255;
    const linear = display <= 0.04045 ? display / 12.92 : ((display + 0.055) / 1.055) ** 2.4;
    return Math.round(LARGEST * linear);
  });
}

const LINEAR = linearTable();

// Converts pixels of a canvas, R, G, B and alpha, to LfImage.pixels. Transparent pixels are masked.
export function linearPixels(display: Uint8ClampedArray): Uint16Array {
  const pixels = new Uint16Array(display.length);
  for (let i = 0; i < display.length; i += 4) {
    if (display[i + 3] < 128) continue;
    for (let c = 0; c < 3; ++c) pixels[i + c] = LINEAR[display[i + c]];
    pixels[i + 3] = 1;
  }
  return pixels;
}

export async function loadExported(image: ExportedLive["images"][number]): Promise<LfImage> {
  const { width, height, matrix, centre, name } = image;
  const type = name.endsWith(".png") ? "image/png" : "image/jpeg";
  const bitmap = await createImageBitmap(new Blob([await getBytes(name)], { type }), {
    premultiplyAlpha: "none",
    colorSpaceConversion: "none",
  });
  const canvas = new OffscreenCanvas(width, height);
  const context = canvas.getContext("2d", { willReadFrequently: true })!;
  context.drawImage(bitmap, 0, 0);
  bitmap.close();
  const { data } = context.getImageData(0, 0, width, height);
  return { width, height, matrix: matrixOf(matrix), centre, pixels: linearPixels(data) };
}
