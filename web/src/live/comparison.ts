// SPDX-License-Identifier: Apache-2.0
// Compares two settings: the picture that was kept as A lies on the left part of the live picture, B. The line between
// them can be dragged.

import type { FrameCamera } from "../data/frame_camera";
import type { LivePicture } from "../data/live_picture";
import { element } from "../element";
import type { State } from "../state";
import { length } from "../words";
import { withFocusDistance } from "./lens_changes";
import type { LiveCamera } from "./live_camera";
import { apertureText } from "./live_status";
import type { LiveView } from "./live_view";

const KEY_STEP = 0.02; // share of the picture's width by which an arrow key moves the line

export interface Kept {
  frame: number;
  camera: FrameCamera;
  shown: LivePicture;
}

export class Comparison {
  kept: Kept | null = null;
  private readonly canvas = element("canvas", { id: "live-a", "aria-label": "Picture A", role: "img" });
  private readonly labels = [element("span", { class: "live-side" }), element("span", { class: "live-side" })];
  private readonly line = element("div", {
    id: "live-line",
    role: "slider",
    tabindex: 0,
    "aria-label": "Line between picture A and picture B",
    "aria-valuemin": 0,
    "aria-valuemax": 100,
  });
  private isAsking = false; // true while a picture A is requested
  private share = 0.5; // share of the width that A covers
  private readonly listeners: (() => void)[] = [];

  constructor(
    private readonly state: State,
    private readonly view: LiveView,
    private readonly camera: LiveCamera,
  ) {
    view.box.append(this.canvas, this.line, ...this.labels);
    for (const label of this.labels) label.append(element("b"), element("span"));
    this.labels[0].dataset.side = "A";
    this.labels[1].dataset.side = "B";
    this.line.addEventListener("pointerdown", (event) => {
      event.stopPropagation();
      this.line.setPointerCapture(event.pointerId);
    });
    this.line.addEventListener("pointermove", (event) => {
      if (!this.line.hasPointerCapture(event.pointerId)) return;
      event.stopPropagation();
      const box = view.box.getBoundingClientRect();
      this.place((event.clientX - box.left) / box.width);
    });
    this.line.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -KEY_STEP, ArrowRight: KEY_STEP }[event.key];
      if (step === undefined) return;
      event.preventDefault();
      event.stopPropagation();
      this.place(this.share + step);
    });
    view.listen(() => this.renew());
    state.on(["exposure"], () => this.draw());
    this.draw();
  }

  listen(listener: () => void): void {
    this.listeners.push(listener);
  }

  // Keeps the shown picture and its camera as A. Keeps nothing if there is no picture yet.
  keep(): void {
    const { shown } = this.view;
    if (shown) this.set({ frame: this.state.frame, camera: this.camera.camera, shown });
  }

  end(): void {
    this.set(null);
  }

  // Is called when a new picture B has come. If its camera is that of A, it is also the new picture A. Otherwise, a new
  // picture A is requested if B is a still picture, and shows another frame or has more LF images.
  private renew(): void {
    const { kept, view, state } = this;
    if (kept && view.shown && kept.camera === this.camera.camera) kept.shown = view.shown;
    this.draw();
    if (!kept || !view.shown || view.canvas.dataset.still !== "true") return;
    if (kept.frame !== state.frame || kept.shown.facts.images < view.shown.facts.images) void this.follow(kept);
  }

  // Requests and shows the picture A: this frame with the lens of A.
  private async follow(kept: Kept): Promise<void> {
    if (this.isAsking) return;
    this.isAsking = true;
    const { frame } = this.state;
    const { radius, rotation, blades, ratio, roundness, focusDistance, tiltHorizontal, tiltVertical } = kept.camera;
    const { hoodDistance, hoodRadius } = kept.camera;
    const lens = {
      radius,
      rotation,
      blades,
      ratio,
      roundness,
      tiltHorizontal,
      tiltVertical,
      hoodDistance,
      hoodRadius,
    };
    const camera =
      frame === kept.frame ? kept.camera : { ...withFocusDistance(this.state.camera, focusDistance), ...lens };
    try {
      const shown = await this.view.pictureOf(camera);
      if (shown && this.kept === kept && frame === this.state.frame) this.set({ frame, camera, shown });
    } catch {
      // The old picture A stays. The view says why pictures fail.
    } finally {
      this.isAsking = false;
    }
  }

  private set(kept: Kept | null): void {
    this.kept = kept;
    this.draw();
    for (const listener of this.listeners) listener();
  }

  private place(share: number): void {
    this.share = Math.max(0, Math.min(1, share));
    this.draw();
  }

  draw(): void {
    const { kept, canvas, line, labels } = this;
    for (const part of [canvas, line, ...labels]) part.hidden = kept === null;
    if (!kept) return;
    this.view.paint(canvas, kept.shown);
    const percent = 100 * this.share;
    canvas.style.clipPath = `inset(0 ${100 - percent}% 0 0)`;
    line.style.left = `${percent}%`;
    line.setAttribute("aria-valuenow", String(Math.round(percent)));
    this.describe(labels[0], "A", kept.camera);
    this.describe(labels[1], "B", this.camera.camera);
  }

  private describe(label: HTMLElement, name: string, camera: FrameCamera): void {
    label.children[0].textContent = name;
    label.children[1].textContent = `${apertureText(camera, this.state.path.unit_m)}, focus ${length(camera.focusDistance)}`;
  }
}
