// SPDX-License-Identifier: Apache-2.0
// The sources of live pictures: the server, or WebGL in the browser.

import type { FrameCamera } from "../data/frame_camera";
import { readLivePicture, type LivePicture } from "../data/live_picture";
import { postForBytes } from "../data/source";
import { oneFramePath, type PathFacts } from "./one_frame_path";

export interface PictureRequest {
  camera: FrameCamera;
  width: number; // of the picture, in elements
  budget_ms: number | null; // time for a quick picture; null: a still picture, of all LF images that are loaded
  recordedOnly: boolean; // true: without virtual LF images
}

export interface Pictures {
  // Returns a picture; null if there is none now, for example because a newer request has superseded it.
  ask(request: PictureRequest): Promise<LivePicture | null>;
}

// Returns the body of a request to the server, without its budget.
export function bodyOf({ camera, width, recordedOnly }: PictureRequest, path: PathFacts): object {
  return { text: oneFramePath(camera, path), frame: 1, width, recorded: recordedOnly };
}

export class ServerPictures implements Pictures {
  constructor(private readonly path: () => PathFacts) {}

  async ask(request: PictureRequest): Promise<LivePicture | null> {
    const { budget_ms } = request;
    const body = { ...bodyOf(request, this.path()), ...(budget_ms === null ? {} : { budget_ms }) };
    const answer = await postForBytes<unknown>("live", body);
    return answer instanceof ArrayBuffer ? readLivePicture(answer) : null;
  }
}
