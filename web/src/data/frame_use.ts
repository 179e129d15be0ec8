// SPDX-License-Identifier: Apache-2.0
// Reads which LF cameras a frame uses, and why it does not use the others (CameraUse in lf/view/frame_use.h).

export const USES = ["used", "outside", "angle", "sees-none", "limit", "no-weight"] as const;
export const USED = 0;
// Kind of an LF camera that this frame does not use, but another frame of the film does.
export const IN_OTHER_FRAME = USES.length;

export interface FrameUse {
  frame: number;
  cameraDistance: number | null;
  ids: Uint32Array;
  shares: Float32Array;
  ofCameras: Uint8Array;
}

export function readFrameUse(frame: number, bytes: ArrayBuffer): FrameUse {
  const head = new Uint32Array(bytes, 0, 4);
  const distance = new Float32Array(bytes, 8, 1)[0];
  const [cameras, used] = head;
  return {
    frame,
    cameraDistance: Number.isNaN(distance) ? null : distance,
    ids: new Uint32Array(bytes, 16, used),
    shares: new Float32Array(bytes, 16 + 4 * used, used),
    ofCameras: new Uint8Array(bytes, 16 + 8 * used, cameras),
  };
}

export function countsOf(use: FrameUse): number[] {
  const counts = new Array<number>(USES.length).fill(0);
  for (const one of use.ofCameras) ++counts[one];
  return counts;
}
