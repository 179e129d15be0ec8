// SPDX-License-Identifier: Apache-2.0
// The panel of the live picture: what the mouse does in it, sliders of the lens, exposure, focus peaking, and the
// comparison of two settings.

import { lensRim, type FrameCamera } from "../data/frame_camera";
import { element } from "../element";
import { exposureRow } from "../panels/exposure";
import type { State } from "../state";
import { extentOf } from "../view/space_view";
import { length } from "../words";
import type { Comparison } from "./comparison";
import { rotationWriter, withTilt, writeBlades, writeAperture, writeFocusDistance, writeTilt } from "./lens_changes";
import type { LiveCamera } from "./live_camera";
import { apertureText } from "./live_status";
import { depthFactor, type LiveTools } from "./live_tools";
import type { LiveView } from "./live_view";

const SVG = "http://www.w3.org/2000/svg";
const OPENINGS = 1000; // factor between the largest and the smallest opening of the slider
const MOST_BLADES = 12;
const MOST_TILT = (75 * Math.PI) / 180; // largest tilt of the sliders
const STRAIGHT = (1.5 * Math.PI) / 180; // smaller tilts of the sliders become 0

interface Parts {
  state: State;
  camera: LiveCamera;
  view: LiveView;
  tools: LiveTools;
  comparison: Comparison;
  refused: string; // why an exported page has no live pictures; "" if there are live pictures
}

export class LensPanel {
  private readonly lens = document.createElementNS(SVG, "polygon");
  private readonly fills: (() => void)[] = [];
  private ends: [number, number] = [Infinity, 0]; // nearest and farthest distance of the focus slider

  constructor(
    private readonly root: HTMLElement,
    private readonly parts: Parts,
  ) {
    const { state, camera, tools, comparison } = parts;
    if (!this.isUsable) {
      const text = `These are exported files without live pictures: ${parts.refused}.`;
      root.append(element("p", { class: "muted" }, text));
      return;
    }
    root.append(
      this.switches(),
      this.help(),
      this.virtualImages(),
      this.backToA(),
      element(
        "div",
        { class: "row" },
        element("h2", {}, "Lens at this frame"),
        element("span", { class: "grow" }),
        this.keys(),
      ),
      element("div", { class: "lens" }, this.drawing(), element("div", {}, this.focus(), this.aperture())),
      this.blades(),
      this.rotation(),
      this.tilt("horizontal"),
      this.tilt("vertical"),
      element("h2", {}, "Picture"),
      exposureRow(state),
    );
    camera.listen(() => this.shown());
    tools.listen(() => this.shown());
    comparison.listen(() => this.shown());
  }

  get isUsable(): boolean {
    return this.parts.refused === "";
  }

  shown(): void {
    if (this.root.hidden || this.parts.state.cameras.length === 0) return;
    for (const fill of this.fills) fill();
  }

  togglePeaking(): void {
    const { view, comparison } = this.parts;
    view.peaks = !view.peaks;
    view.draw();
    comparison.draw();
    this.shown();
  }

  toggleComparison(): void {
    const { comparison } = this.parts;
    if (comparison.kept) comparison.end();
    else comparison.keep();
  }

  // ----------------------------------------------------------------------------------- switches

  private toggle(label: string, title: string, isOn: () => boolean, click: () => void): HTMLElement {
    const button = element("button", { title, click }, label);
    this.fills.push(() => button.setAttribute("aria-pressed", String(isOn())));
    return button;
  }

  private switches(): HTMLElement {
    const { tools, view, comparison } = this.parts;
    return element(
      "div",
      { class: "row" },
      element(
        "span",
        { class: "group", role: "group", "aria-label": "What a drag does" },
        this.toggle(
          "Focus",
          "A drag focuses (C)",
          () => tools.mode === "focus",
          () => tools.setMode("focus"),
        ),
        this.toggle(
          "Camera",
          "A drag moves the camera (C)",
          () => tools.mode === "camera",
          () => tools.setMode("camera"),
        ),
      ),
      element("span", { class: "grow" }),
      this.toggle(
        "A | B",
        "Keep this picture as A, and compare with it (A)",
        () => comparison.kept !== null,
        () => this.toggleComparison(),
      ),
      this.toggle(
        "Peaking",
        "Colour what is in focus (E)",
        () => view.peaks,
        () => this.togglePeaking(),
      ),
    );
  }

  private help(): HTMLElement {
    const text = element("p", { class: "muted" });
    const words = {
      focus: this.parts.state.scene.server
        ? "In the live picture, click: focus there. Drag: nearer or farther. Wheel or pinch: aperture. Shift-click " +
          "three places: tilt the focus plane."
        : "In the live picture, drag: focus nearer or farther. Wheel or pinch: aperture. Changes last until the next frame.",
      camera: "In the live picture, drag: orbit round the point in focus. Shift and drag: slide. Wheel: dolly.",
    };
    this.fills.push(() => (text.textContent = words[this.parts.tools.mode]));
    return text;
  }

  // ------------------------------------------------------------------------------------ sliders

  // Returns a slider that shows a changed camera while it is dragged, and writes the change when it is let go.
  private slider(
    label: string,
    attributes: Record<string, string | number>,
    place: (camera: FrameCamera) => number,
    change: (value: number, slider: HTMLInputElement) => void,
    text: (camera: FrameCamera) => string,
  ): HTMLElement {
    const { camera } = this.parts;
    const slider = element("input", { type: "range", "aria-label": label, step: "any", ...attributes });
    const words = element("output");
    slider.addEventListener("input", () => change(slider.valueAsNumber, slider));
    slider.addEventListener("change", () => camera.finish());
    this.fills.push(() => {
      slider.value = String(place(camera.camera));
      words.textContent = text(camera.camera);
      slider.setAttribute("aria-valuetext", words.textContent);
    });
    return element("div", { class: "slider" }, element("label", {}, label), words, slider);
  }

  private keys(): HTMLElement {
    const { state } = this.parts;
    const title =
      "Every change in the live picture adds a key at this frame. Otherwise, a quantity without keys changes in the " +
      "whole film. The number of blades and the exposure have no keys.";
    const click = () => {
      state.addsKeys = !state.addsKeys;
      this.shown();
    };
    return this.toggle("◆ Keys", title, () => state.addsKeys, click);
  }

  // Returns the ends of the focus slider: the nearest and the farthest focus of the film, with a margin by the depths
  // of the scene. The ends stay as long as the focus is between them, because otherwise its mark would not move.
  private focusEnds(): [number, number] {
    const { state, camera } = this.parts;
    const all = [camera.camera, ...state.cameras].map((one) => one.focusDistance);
    const [least, most] = [all.reduce((a, b) => Math.min(a, b)), all.reduce((a, b) => Math.max(a, b))];
    const [near, far] = this.ends;
    if (least >= near && most <= far) return this.ends;
    const factor = depthFactor(state.scene.light_field.depths);
    this.ends = [Math.min(near, least / factor), Math.max(far, most * factor)];
    return this.ends;
  }

  private focus(): HTMLElement {
    const { camera, tools } = this.parts;
    return this.slider(
      "Focus",
      { min: 0, max: 1 },
      ({ focusDistance }) => {
        const [near, far] = this.focusEnds();
        return Math.log(focusDistance / near) / Math.log(far / near);
      },
      (share) => {
        const [near, far] = this.focusEnds();
        tools.showFocus(camera.camera, near * (far / near) ** share);
      },
      ({ focusDistance }) => length(focusDistance),
    );
  }

  private aperture(): HTMLElement {
    const { state, camera, tools } = this.parts;
    const largest = extentOf(state.positions) / 2; // a larger lens collects nothing more
    return this.slider(
      "Aperture",
      { min: 0, max: 1 },
      ({ radius }) => (radius > 0 ? Math.max(0.01, 1 + Math.log(radius / largest) / Math.log(OPENINGS)) : 0),
      (share) => tools.showAperture(camera.camera, share < 0.005 ? 0 : largest * OPENINGS ** (share - 1)),
      (one) => apertureText(one, state.path.unit_m),
    );
  }

  private blades(): HTMLElement {
    const { camera } = this.parts;
    const select = element("select", { "aria-label": "Blades of the aperture" });
    select.addEventListener("change", () => {
      camera.show("change blades", { ...camera.camera, blades: Number(select.value) }, writeBlades);
      camera.finish();
    });
    this.fills.push(() => {
      const { blades } = camera.camera;
      const counts = new Set([0, ...Array.from({ length: MOST_BLADES - 2 }, (_, i) => i + 3), blades]);
      select.replaceChildren(
        ...[...counts].map((count) =>
          element("option", { value: count, selected: count === blades }, count === 0 ? "0, a disk" : String(count)),
        ),
      );
    });
    return element("div", { class: "row" }, element("label", {}, "Blades"), select);
  }

  private rotation(): HTMLElement {
    const { state, camera } = this.parts;
    const period = (one: FrameCamera) => (2 * Math.PI) / Math.max(1, one.blades);
    const within = (one: FrameCamera) => ((one.rotation % period(one)) + period(one)) % period(one);
    const row = this.slider(
      "Rotation",
      { min: 0, max: 1 },
      (one) => within(one) / period(one),
      (share) => {
        const one = camera.camera;
        const rotation = one.rotation - within(one) + share * 0.999 * period(one);
        camera.show("turn blades", { ...one, rotation }, rotationWriter(state.path.widest_radius));
      },
      (one) => `${Math.round((within(one) * 180) / Math.PI)}°`,
    );
    this.fills.push(() => (row.hidden = camera.camera.blades < 3));
    return row;
  }

  private tilt(direction: "horizontal" | "vertical"): HTMLElement {
    const { camera } = this.parts;
    const [label, of] =
      direction === "horizontal" ? (["Tilt ↔", "tiltHorizontal"] as const) : (["Tilt ↕", "tiltVertical"] as const);
    return this.slider(
      label,
      { min: -MOST_TILT, max: MOST_TILT },
      (one) => one[of],
      (angle) => {
        const near = Math.abs(angle) < STRAIGHT ? 0 : angle;
        camera.show("tilt the focus plane", withTilt({ ...camera.camera, [of]: near }), writeTilt);
      },
      (one) => `${Math.round((one[of] * 180) / Math.PI)}°`,
    );
  }

  // Draws the opening as seen from behind the lens.
  private drawing(): Element {
    const svg = document.createElementNS(SVG, "svg");
    svg.setAttribute("viewBox", "-1.1 -1.1 2.2 2.2");
    svg.setAttribute("aria-hidden", "true");
    const ring = document.createElementNS(SVG, "circle");
    ring.setAttribute("r", "1");
    svg.append(ring, this.lens);
    this.fills.push(() => {
      const { camera } = this.parts.camera;
      const unitLens: FrameCamera = { ...camera, centre: [0, 0, 0], right: [1, 0, 0], up: [0, -1, 0], radius: 0.96 };
      this.lens.setAttribute(
        "points",
        lensRim(unitLens)
          .map(([x, y]) => `${x},${y}`)
          .join(" "),
      );
    });
    return svg;
  }

  // Returns buttons that take or leave out virtual LF images, if there are some.
  private virtualImages(): HTMLElement | string {
    const { state, view } = this.parts;
    if (!state.scene.light_field.virtual_ranges?.length) return "";
    const button = (recorded: boolean, label: string, title: string) => {
      const click = () => {
        view.setRecordedOnly(recorded);
        this.shown();
      };
      return this.toggle(label, title, () => view.recordedOnly === recorded, click);
    };
    return element(
      "div",
      { class: "row" },
      button(false, "Densified", "with virtual LF images"),
      button(true, "Recorded alone", "without virtual LF images"),
    );
  }

  private backToA(): HTMLElement {
    const { camera, comparison } = this.parts;
    const goBack = () => {
      const { focusDistance, radius } = comparison.kept!.camera;
      camera.show("back to A", { ...camera.camera, focusDistance, radius }, (document, time, one) => {
        const also = [writeFocusDistance(document, time, one), writeAperture(document, time, one)];
        return also.filter((text) => text !== "").join(" ");
      });
      camera.finish();
    };
    const title = "Give this frame the focus distance and the aperture of A";
    const row = element("div", { class: "row" }, element("button", { title, click: goBack }, "Back to A"));
    this.fills.push(() => (row.hidden = comparison.kept === null));
    return row;
  }
}
