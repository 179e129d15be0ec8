// SPDX-License-Identifier: Apache-2.0
// Makes pictures coarser, and then of fewer LF images, until there is time for them.

const LEAST_WIDTH = 160; // elements; coarser pictures do not show what is in focus
const LEAST_IMAGES = 12;
const STEP = 16; // widths are multiples of this, so that few sizes occur

// Returns the width of the picture, in elements, and its number of LF images.
//   images  LF images that could be taken
//   rays    product of the numbers of elements and LF images for which there is time
export function fitting(
  images: number,
  { width, height }: { width: number; height: number },
  rays: number,
): { width: number; images: number } {
  const factor = Math.sqrt(rays / Math.max(1, images * width * height));
  if (factor >= 1) return { width, images };
  const coarse = Math.max(Math.min(width, LEAST_WIDTH), STEP * Math.floor((factor * width) / STEP));
  const elements = (coarse * coarse * height) / width;
  const taken = Math.max(LEAST_IMAGES, Math.floor(rays / elements));
  return { width: coarse, images: Math.min(images, taken) };
}
