// SPDX-License-Identifier: Apache-2.0
// The panel that shows frames while they are rendered: the frames of a watched render, or a small preview of this
// frame.

import type { FrameCamera } from "../data/frame_camera";
import type { RenderFacts } from "../data/scene";
import { getBytes, post } from "../data/source";
import { develop, heatColour, heatMap, rayRange, readPicture, type GrowingPicture } from "../data/growing_picture";
import { element } from "../element";
import { PathDocument } from "../path/path_document";
import type { State } from "../state";
import { shortNumber } from "../words";
import { exposureRow } from "./exposure";
import { enlargeButton, focusThere, makePickable } from "./picture_view";

const PREVIEW_WIDTH = 384;

export class RenderPanel {
  private readonly canvas = element("canvas");
  private readonly box = element("div", { class: "picture" }, this.canvas);
  private readonly rays = element("button", { "aria-pressed": "false" }, "Rays per element");
  private readonly scale = element("div");
  private readonly status = element("p", { role: "status" });
  private readonly strip = element("div", { class: "strip" });
  private readonly about = element("div");
  private source: "preview" | "watch";
  private picture: GrowingPicture | null = null;
  private shownName = "";
  private wantedName = "";
  private fault = ""; // why the last unreadable picture could not be read; "" if all could be read
  private previewed: FrameCamera | null = null;
  private isLoading = false;
  private readonly sources = element("div", { class: "row group" });
  private usesVirtual = true; // false: previews of a densified light field leave virtual LF images out

  constructor(
    private readonly root: HTMLElement,
    private readonly state: State,
  ) {
    this.source = state.scene.watch ? "watch" : "preview";
    if (!state.scene.server) {
      root.append(element("p", { class: "muted" }, "These are exported files, without a render to watch."));
      return;
    }
    this.rays.addEventListener("click", () => {
      this.rays.setAttribute("aria-pressed", String(!this.showsRays()));
      this.drawPicture();
    });
    root.append(
      this.sources,
      this.about,
      this.box,
      this.status,
      exposureRow(state),
      element("div", { class: "row" }, this.rays, enlargeButton(this.box)),
      this.scale,
      this.strip,
    );
    makePickable(
      this.box,
      () => [this.state.camera.width, this.state.camera.height],
      (x, y, isOfPlane) => this.focusAt(x, y, isOfPlane),
    );
    state.on(["preview", "watch", "frame", "path"], () => this.update());
    state.on(["exposure"], () => this.drawPicture());
  }

  shown(): void {
    this.update();
  }

  // Focuses on a position in the picture, if the picture shows the same view as the current frame. For
  // a watched picture, compares only its size with that of the frame.
  private focusAt(x: number, y: number, isOfPlane: boolean): void {
    const { state, picture, previewed } = this;
    const { camera } = state;
    if (!picture) return;
    if (this.source === "preview" && !(previewed && seeAlike(previewed, camera)))
      return state.say("The preview is of another view than this frame's: render it again.");
    if (this.source === "watch" && (picture.fullWidth !== camera.width || picture.fullHeight !== camera.height))
      return state.say(
        `This picture is of another path: it has ${picture.fullWidth} × ` +
          `${picture.fullHeight} elements, and the frame ${camera.width} × ${camera.height}.`,
      );
    void focusThere(state, { x, y }, isOfPlane);
  }

  // Starts a preview: a render of this frame with a small plate, by the current text of the path.
  async start(): Promise<void> {
    const { state } = this;
    const document = PathDocument.parse(state.document.text(), state.scene.light_field.unit_m);
    const { width, height } = state.camera;
    const factor = Math.min(1, PREVIEW_WIDTH / Math.max(width, height));
    document.setConstant("resolution", [
      Math.max(1, Math.round(width * factor)),
      Math.max(1, Math.round(height * factor)),
    ]);
    if (this.source !== "preview") this.setSource("preview");
    this.previewed = state.camera;
    try {
      await post("preview", { text: document.text(), frame: state.frame, recorded: !this.usesVirtual });
    } catch (error) {
      state.fail(error);
    }
    this.update();
  }

  private showsRays(): boolean {
    return this.rays.getAttribute("aria-pressed") === "true";
  }

  private setSource(source: "preview" | "watch"): void {
    this.source = source;
    this.showNothing();
    this.update();
  }

  private update(): void {
    const { state } = this;
    if (this.root.hidden || !state.scene.server) return;
    this.drawSources();
    if (this.source === "watch") this.updateWatch();
    else this.updatePreview();
    this.box.hidden = this.picture === null;
  }

  private drawSources(): void {
    const { state } = this;
    const button = (name: "preview" | "watch", label: string) =>
      element("button", { "aria-pressed": String(this.source === name), click: () => this.setSource(name) }, label);
    this.sources.replaceChildren(
      ...(state.scene.watch ? [button("watch", "Watched render")] : []),
      button("preview", "Preview"),
    );
  }

  // Returns the switch between the two pictures of a densified light field; null for other light fields.
  private virtualSwitch(): HTMLElement | null {
    if (!this.state.scene.light_field.virtual_ranges) return null;
    const button = (usesVirtual: boolean, label: string, title: string) =>
      element(
        "button",
        {
          "aria-pressed": String(this.usesVirtual === usesVirtual),
          title,
          click: () => {
            this.usesVirtual = usesVirtual;
            void this.start();
          },
        },
        label,
      );
    return element(
      "div",
      { class: "row group" },
      button(true, "Densified", "with virtual LF images, where they make the blur smoother"),
      button(false, "Recorded alone", "without virtual LF images"),
    );
  }

  private updatePreview(): void {
    const { state } = this;
    const { preview } = state;
    const isBusy = preview?.state === "rendering";
    this.strip.replaceChildren();
    this.about.replaceChildren(
      element(
        "div",
        { class: "row" },
        element(
          "button",
          { class: "primary", id: "start-preview", click: () => void this.start() },
          `Render frame ${state.frame} small`,
        ),
        isBusy ? element("button", { click: () => void post("preview/stop", {}) }, "Stop") : null,
      ),
      this.virtualSwitch() ?? "",
    );
    if (!preview) {
      this.status.textContent = "Nothing is rendered yet. A preview uses the path as it is now, saved or not.";
      return;
    }
    const words = {
      rendering: `Frame ${preview.frame} is being rendered …`,
      finished: `Frame ${preview.frame}, finished${preview.message ? `: ${preview.message}` : ""}`,
      stopped: `Frame ${preview.frame}, stopped`,
      failed: preview.message,
    };
    this.status.textContent = words[preview.state];
    this.status.className = preview.message ? "bad" : "muted"; // a finished preview may lack LF images
    if (preview.changed) void this.load(`preview/${preview.frame}.bin`, preview.changed);
    else if (preview.state === "failed") this.showNothing();
  }

  private updateWatch(): void {
    const { state } = this;
    const watch = state.watch;
    this.about.replaceChildren(element("p", { class: "muted", style: "overflow-wrap:anywhere" }, state.scene.watch));
    if (!watch || watch.frames.length === 0) {
      this.showNothing();
      this.strip.replaceChildren();
      this.status.textContent = "No frames lie there yet. The first picture comes with lfrenderer's first checkpoint.";
      return;
    }
    this.drawStrip(watch);
    const frame = watch.frames.find((one) => one.frame === state.frame);
    if (!frame) {
      this.showNothing();
      this.status.textContent = `Frame ${state.frame} has no picture yet.`;
      return;
    }
    const age = Math.max(0, Math.round(Date.now() / 1000 - frame.changed_s));
    this.status.textContent = frame.finished
      ? `Frame ${frame.frame}, finished`
      : `Frame ${frame.frame} is being rendered; this picture is ${age < 2 ? "new" : `${age} s old`}`;
    this.status.className = "muted";
    void this.load(`watch/${frame.frame}.bin`, frame.changed);
  }

  private drawStrip(watch: RenderFacts): void {
    const { state } = this;
    const frames = watch.frames.filter((one) => one.frame >= state.path.first_frame && one.frame <= state.lastFrame);
    const finished = frames.filter((one) => one.finished).length;
    this.strip.replaceChildren(
      element(
        "span",
        { style: "flex-basis:100%" },
        `${finished} of ${state.path.frames} frames finished, ${frames.length - finished} begun`,
      ),
      ...frames.slice(0, 600).map((one) =>
        element(
          "button",
          {
            class: one.finished ? "" : "growing",
            "aria-pressed": String(one.frame === state.frame),
            title: one.finished ? "finished" : "begun",
            click: () => state.setFrame(one.frame),
          },
          String(one.frame),
        ),
      ),
    );
  }

  private showNothing(): void {
    this.picture = null;
    this.shownName = "";
    this.wantedName = "";
  }

  // Reads a picture and shows it, unless this version of it is already shown. Only one picture is read at a time. If
  // another picture is requested meanwhile, the one requested last is read afterwards.
  private async load(name: string, version: string): Promise<void> {
    const wanted = `${name}?${version}`;
    this.wantedName = wanted;
    if (wanted === this.shownName || this.isLoading) return;
    this.isLoading = true;
    try {
      const picture = readPicture(await getBytes(wanted));
      if (this.wantedName.startsWith(`${name}?`)) {
        this.picture = picture;
        if (this.fault && this.state.message?.text === this.fault) this.state.say("");
        this.fault = "";
        this.shownName = wanted;
        this.drawPicture();
      }
    } catch (error) {
      // If the server says "no such frame", the file was just being replaced, and an event about its next version
      // follows.
      if (!(error instanceof Error && /no such frame/.test(error.message))) {
        this.picture = null; // because the old picture may show another frame
        this.shownName = "";
        this.state.fail(error);
        this.fault = this.state.message?.text ?? "";
      }
    } finally {
      this.isLoading = false;
      if (this.wantedName !== wanted) this.update();
      else this.box.hidden = this.picture === null;
    }
  }

  private drawPicture(): void {
    const { picture, canvas } = this;
    if (!picture) return;
    canvas.width = picture.width;
    canvas.height = picture.height;
    this.box.style.setProperty("--ratio", String(picture.width / picture.height));
    canvas.dataset.version = this.shownName;
    const context = canvas.getContext("2d")!;
    this.rays.disabled = !picture.hasRays;
    if (this.showsRays() && picture.hasRays) {
      const range = rayRange(picture);
      context.putImageData(heatMap(picture, range.most), 0, 0);
      const colours = [0, 0.2, 0.4, 0.6, 0.8, 1].map((x) => `rgb(${heatColour(x).join(" ")})`);
      this.scale.replaceChildren(
        element("div", {
          class: "bar",
          style: `background:linear-gradient(90deg,${colours.join(",")})`,
        }),
        element(
          "p",
          { class: "muted" },
          `Rays of each element: least ${shortNumber(range.least)}, median ` +
            `${shortNumber(range.median)}, most ${shortNumber(range.most)}. Elements without rays are green.`,
        ),
      );
    } else {
      this.scale.replaceChildren();
      context.putImageData(develop(picture, this.state.exposure), 0, 0);
    }
  }
}

// Returns true if both cameras have the same position, direction and field of view, so that a position in a picture
// means the same ray for both. Focus and aperture may differ.
function seeAlike(a: FrameCamera, b: FrameCamera): boolean {
  const view = ({ centre, forward, up, fx, fy, cx, cy, width, height }: FrameCamera) => [
    ...centre,
    ...forward,
    ...up,
    fx,
    fy,
    cx,
    cy,
    width,
    height,
  ];
  const [ofA, ofB] = [view(a), view(b)];
  return ofA.every((x, i) => Math.abs(x - ofB[i]) <= 1e-9 * (1 + Math.abs(x)));
}
