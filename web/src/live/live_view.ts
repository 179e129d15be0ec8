// SPDX-License-Identifier: Apache-2.0
// The live picture: a large picture of the current frame that is rendered anew whenever the camera changes.

import { develop } from "../data/growing_picture";
import type { FrameCamera } from "../data/frame_camera";
import type { LivePicture } from "../data/live_picture";
import { element } from "../element";
import type { State } from "../state";
import { colourEdges } from "./focus_peaking";
import type { LiveCamera } from "./live_camera";
import { LiveRequests } from "./live_requests";
import { statusOf } from "./live_status";
import { oneFramePath } from "./one_frame_path";
import type { PictureRequest, Pictures } from "./pictures";

const BUDGET_MS = 40; // time in which a quick picture is to be rendered
const WIDTHS: [number, number] = [16, 1280]; // smallest and largest width that the server renders
const EDGE_COLOUR: [number, number, number] = [70, 255, 140];

export class LiveView {
  readonly canvas = element("canvas", { "aria-label": "Live picture of this frame", role: "img" });
  // The picture with everything that lies on it; mouse and fingers work here.
  readonly box = element("div", { id: "live-picture" }, this.canvas);
  shown: LivePicture | null = null;
  peaks = false; // true: focus peaking
  recordedOnly = false; // true: virtual LF images are left out
  private readonly fault = element("p", { id: "live-fault", role: "status", hidden: true });
  private readonly status = element("div", { id: "live-status" });
  private readonly requests = new LiveRequests((isStill, isNewest) => this.ask(isStill, isNewest));
  private readonly listeners: (() => void)[] = [];
  private pictureFault = "";
  private shownCamera: FrameCamera | null = null; // of the picture that is shown
  private wholePath = ""; // path of the still picture with virtual LF images that is shown; "" if another is
  private version = 0; // number of pictures shown so far
  private wanted = ""; // path of the newest picture that was wanted

  constructor(
    private readonly root: HTMLElement,
    private readonly state: State,
    private readonly camera: LiveCamera,
    private readonly pictures: Pictures,
  ) {
    root.append(element("div", { id: "live-room" }, this.box, this.fault), this.status);
    camera.listen(() => this.change());
    state.on(["exposure"], () => this.draw());
    state.on(["live"], () => this.requests.loaded());
    state.on(["text"], () => this.tellFault());
    state.on(["text", "density", "use"], () => this.tellStatus());
    document.addEventListener("visibilitychange", () => this.startOrStop());
    let width = 0;
    new ResizeObserver(() => {
      if (this.width() === width) return;
      width = this.width();
      this.requests.change();
    }).observe(this.box);
  }

  // Calls the listener after each new picture.
  listen(listener: () => void): void {
    this.listeners.push(listener);
  }

  show(isShown: boolean): void {
    this.state.isLive = isShown;
    this.root.hidden = !isShown;
    this.startOrStop();
    if (!isShown) void this.state.askFrame(); // playing may have skipped it
  }

  setRecordedOnly(recordedOnly: boolean): void {
    this.recordedOnly = recordedOnly;
    this.requests.change();
  }

  draw(): void {
    const { shown } = this;
    if (!shown) return;
    this.paint(this.canvas, shown);
    this.canvas.dataset.version = String(this.version);
  }

  // Draws a picture with the exposure and the peaking of the view.
  paint(canvas: HTMLCanvasElement, { picture }: LivePicture): void {
    canvas.width = picture.width;
    canvas.height = picture.height;
    const image = develop(picture, this.state.exposure);
    if (this.peaks) colourEdges(image, EDGE_COLOUR);
    canvas.getContext("2d")!.putImageData(image, 0, 0);
  }

  private startOrStop(): void {
    if (this.state.isLive && !document.hidden) this.requests.start();
    else this.requests.stop();
  }

  private change(): void {
    const { width, height } = this.camera.camera;
    this.box.style.setProperty("--ratio", String(width / height));
    const path = this.path();
    if (path === this.wanted) return;
    this.wanted = path;
    this.requests.change();
  }

  private path(): string {
    return oneFramePath(this.camera.camera, this.state.path);
  }

  // Returns the width to be rendered: that of the picture on the screen, in steps so that few sizes occur.
  private width(): number {
    const pixels = this.box.clientWidth * Math.min(2, window.devicePixelRatio || 1);
    return Math.max(WIDTHS[0], Math.min(WIDTHS[1], 16 * Math.round(pixels / 16)));
  }

  // Returns a still picture of another camera, which is not shown; null if a newer request has superseded it.
  pictureOf(camera: FrameCamera): Promise<LivePicture | null> {
    return this.pictures.ask(this.requestOf(camera, null));
  }

  private requestOf(camera: FrameCamera, budget_ms: number | null): PictureRequest {
    return { camera, width: this.width(), budget_ms, recordedOnly: this.recordedOnly };
  }

  private async ask(isStill: boolean, isNewest: () => boolean): Promise<boolean> {
    const { state } = this;
    const { camera } = this.camera;
    const quick_ms = state.isPlaying ? Math.min(BUDGET_MS, 800 / state.path.fps) : BUDGET_MS;
    const budget_ms = isStill ? null : quick_ms;
    try {
      const picture = await this.pictures.ask(this.requestOf(camera, budget_ms));
      if (!isNewest()) return true;
      if (!picture) return false;
      this.shown = picture;
      this.pictureFault = "";
      ++this.version;
      Object.assign(this.canvas.dataset, { still: isStill, focus: camera.focusDistance, by: picture.by });
      this.draw();
      this.shownCamera = camera;
      this.wholePath = isStill && !this.recordedOnly ? oneFramePath(camera, state.path) : "";
      this.tellStatus();
      for (const listener of this.listeners) listener();
    } catch (error) {
      if (!isNewest()) return true;
      this.pictureFault = error instanceof Error ? error.message : String(error);
    }
    this.tellFault();
    return true;
  }

  private tellStatus(): void {
    const { shown, shownCamera, state } = this;
    if (!shown || !shownCamera) return;
    // An exported page has the LF images for small pictures only, which says nothing about the frame.
    const isWhole = state.scene.server && state.isShown && this.wholePath === oneFramePath(state.camera, state.path);
    this.status.replaceChildren(...statusOf(state, shownCamera, shown.facts, isWhole));
  }

  private tellFault(): void {
    const { invalid, unchecked } = this.state;
    let fault = this.pictureFault;
    if (invalid) fault = `The path has a fault; the picture is of the path before it. ${invalid}`;
    else if (unchecked) fault = `The last edit was not checked; the picture is of the path before it. ${unchecked}`;
    this.fault.textContent = fault;
    this.fault.hidden = fault === "";
  }
}
