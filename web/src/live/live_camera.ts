// SPDX-License-Identifier: Apache-2.0
// The camera of the live picture: that of the current frame, or a changed one while a person changes it with the mouse.
// The path changes only at the end of such a change, so that a drag is one undo step.

import type { FrameCamera } from "../data/frame_camera";
import type { PathDocument } from "../path/path_document";
import type { State } from "../state";

// Writes the changed camera into the path, at the time of the frame. Returns a text that tells what else has changed,
// or "". May throw.
export type Writer = (document: PathDocument, time: number, camera: FrameCamera) => string;

interface Change {
  label: string; // name of the undo step
  frame: number;
  time: number;
  write: Writer;
}

export class LiveCamera {
  private changed: FrameCamera | null = null;
  private change: Change | null = null; // null: nothing is being changed
  private timer = 0;
  private readonly listeners: (() => void)[] = [];

  // stopPlaying  is called when a change begins
  constructor(
    private readonly state: State,
    private readonly stopPlaying: () => void,
  ) {
    state.on(["frame"], () => {
      this.finish();
      this.changed = null;
      this.tell();
    });
    // After a change, the changed camera is shown until the server has evaluated the new path.
    const settle = () => {
      if (!this.change && (state.isShown || state.invalid !== null || state.unchecked !== null)) this.changed = null;
      this.tell();
    };
    state.on(["path"], settle);
    state.on(["text"], () => {
      if (this.changed) settle();
    });
  }

  // Calls the listener after each change of the camera.
  listen(listener: () => void): void {
    this.listeners.push(listener);
  }

  get camera(): FrameCamera {
    return this.changed ?? this.state.camera;
  }

  get isChanging(): boolean {
    return this.change !== null;
  }

  // Shows a changed camera. The first call begins a change, and finish() ends it. A change with another label ends the
  // previous one.
  //   rest_ms  if set, the change ends by itself after this time without another call
  show(label: string, camera: FrameCamera, write: Writer, rest_ms = 0): void {
    if (this.change && this.change.label !== label) this.finish();
    if (!this.change) this.stopPlaying();
    const { frame, time } = this.state;
    this.change ??= { label, frame, time, write };
    this.changed = camera;
    clearTimeout(this.timer);
    if (rest_ms > 0) this.timer = window.setTimeout(() => this.finish(), rest_ms);
    this.tell();
  }

  // Writes the change into the path.
  finish(): void {
    clearTimeout(this.timer);
    const { change, changed: camera, state } = this;
    this.change = null;
    if (!change || !camera) return;
    if (!state.scene.server) return this.tell(); // an exported path cannot be edited: the camera stays changed
    let also = "";
    const isTaken = state.edit(change.label, (document) => {
      document.edit(() => (also = change.write(document, change.time, camera)));
    });
    if (isTaken) {
      if (also) state.say(also);
    } else {
      this.changed = null;
    }
    this.tell();
  }

  // Forgets a change that has not been written yet.
  cancel(): void {
    clearTimeout(this.timer);
    this.change = null;
    this.changed = null;
    this.tell();
  }

  private tell(): void {
    for (const listener of this.listeners) listener();
  }
}
