// SPDX-License-Identifier: Apache-2.0
// The cameras of the frames of a path. A short film has all of them at once. A long film has those of the shown frames:
// every shown_step-th frame, and the last. Others are loaded in blocks when they are needed (lf/view/shown_frames.h).

import { readFrames, type FrameCamera } from "./data/frame_camera";
import { lastFrame, type PathHead } from "./data/scene";
import { getBytes } from "./data/source";

const FRAMES_PER_BLOCK = 256; // as in tools/visualizer/page_answers.cc
const MOST_BLOCKS = 64;

export class PathFrames {
  private readonly blocks = new Map<number, FrameCamera[]>();

  //   shown  cameras of the shown frames
  constructor(
    private readonly head: PathHead,
    readonly shown: FrameCamera[],
  ) {}

  // Returns the number of the shown frame with this index (from 0).
  frameOf(index: number): number {
    return Math.min(this.head.first_frame + index * this.head.shown_step, lastFrame(this.head));
  }

  // Returns the index of the last shown frame that is not after a frame.
  indexOf(frame: number): number {
    if (frame >= lastFrame(this.head)) return this.shown.length - 1;
    return Math.floor((frame - this.head.first_frame) / this.head.shown_step);
  }

  // Returns the camera of a frame; null if it has to be loaded.
  camera(frame: number): FrameCamera | null {
    const index = this.indexOf(frame);
    if (this.frameOf(index) === frame) return this.shown[index];
    return this.blocks.get(this.blockOf(frame))?.[(frame - this.head.first_frame) % FRAMES_PER_BLOCK] ?? null;
  }

  // Loads the camera of a frame, and those around it.
  async load(frame: number): Promise<void> {
    const number = this.blockOf(frame);
    this.blocks.set(number, readFrames(await getBytes(`path/${this.head.id}/frames/${number}.bin`)));
    for (const old of this.blocks.keys()) if (this.blocks.size > MOST_BLOCKS) this.blocks.delete(old);
  }

  private blockOf(frame: number): number {
    return Math.floor((frame - this.head.first_frame) / FRAMES_PER_BLOCK);
  }

  // Returns the camera's speed from a frame to the next one whose camera is known, in world units per second; at the
  // last frame, the speed from the previous one.
  speed(frame: number): number {
    const index = Math.max(0, Math.min(this.indexOf(frame), this.shown.length - 2));
    let [a, b] = [this.frameOf(index), this.frameOf(Math.min(index + 1, this.shown.length - 1))];
    if (frame < lastFrame(this.head) && this.camera(frame) && this.camera(frame + 1)) [a, b] = [frame, frame + 1];
    const [from, to] = [this.camera(a)!.centre, this.camera(b)!.centre];
    const distance = Math.hypot(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
    return (distance * this.head.fps) / Math.max(1, b - a);
  }
}
