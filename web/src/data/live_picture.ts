// SPDX-License-Identifier: Apache-2.0
// The answer to the request of a live picture: facts about the picture, and the picture.

import { readHead } from "./head";
import { readPicture, type GrowingPicture } from "./growing_picture";

export interface LiveFacts {
  images: number; // number of LF images in this picture
  takeable: number; // number of LF images in memory that the frame could take
  used: number; // number of LF images in this picture that a frame would use: the others have no weight
  resident: number; // number of LF images in memory
  needed: number; // number of LF images that the frame needs
  wanted: number; // number of those for which memory has room
  done: number; // number of those that are loaded or broken
  broken: number;
  first_broken: string; // why an LF image, or all, could not be loaded; "" if there is no failure
  memory_bytes: number; // limit of the memory for LF images (--live-memory); 0 in an exported page
  image_bytes: number; // memory of an LF image; 0 in an exported page
  divisor: number; // factor by which LF images are shrunken
  uncovered_share: number; // share of the lens that was not recorded
  camera_distance: number; // spacing of the LF images of this picture in the lens plane, world units; 0: not known
  render_ms: number;
}

export interface LivePicture {
  facts: LiveFacts;
  picture: GrowingPicture;
  by: "server" | "webgl"; // the renderer of the picture
}

export function readLivePicture(bytes: ArrayBuffer): LivePicture {
  const [facts, begin] = readHead<LiveFacts>(bytes);
  return { facts, picture: readPicture(bytes, begin), by: "server" };
}
