// SPDX-License-Identifier: Apache-2.0
// The panel that shows the LF image of the chosen LF camera, and the pixels of it that this frame may use.

import { USES } from "../data/frame_use";
import type { OverlapFacts } from "../data/scene";
import { getJson } from "../data/source";
import { element } from "../element";
import type { State } from "../state";
import { USE_STYLES } from "../view/palette";
import { percent, plural, precise, vector } from "../words";
import { enlargeButton, focusThere, makePickable } from "./picture_view";

const SVG = "http://www.w3.org/2000/svg";

export class ImagePanel {
  private readonly image = element("img", { alt: "" });
  private readonly drawing = document.createElementNS(SVG, "svg");
  private readonly picture = element("div", { class: "picture" });
  private readonly facts = element("div");
  private readonly about = element("div");
  private asked = 0;

  constructor(
    private readonly root: HTMLElement,
    private readonly state: State,
  ) {
    this.picture.append(this.image, this.drawing);
    const previous = element("button", { click: () => state.selectNext(-1) }, "‹ Previous");
    const next = element("button", { click: () => state.selectNext(1) }, "Next ›");
    root.append(this.about, this.picture, this.facts);
    root.append(element("div", { class: "row" }, previous, next, enlargeButton(this.picture)));
    this.image.addEventListener("error", () => {
      if (this.state.selected) this.image.alt = "This LF image cannot be read.";
    });
    if (state.scene.server)
      makePickable(
        this.picture,
        () => [state.selected!.width, state.selected!.height],
        (x, y, isOfPlane) => void focusThere(state, { camera: state.selected!.id, x, y }, isOfPlane),
      );
    state.on(["selected"], () => this.drawImage());
    state.on(["selected", "use"], () => void this.drawOverlap());
    this.drawImage();
  }

  shown(): void {
    void this.drawOverlap();
  }

  private drawImage(): void {
    const { selected } = this.state;
    this.picture.hidden = this.facts.hidden = selected === null;
    if (!selected) {
      this.about.replaceChildren(
        element("h2", {}, "No LF camera is chosen"),
        element(
          "p",
          { class: "muted" },
          "Click one of the points in space, or press ] for the first that this frame takes.",
        ),
      );
      return;
    }
    this.about.replaceChildren(
      element("h2", {}, `LF image ${selected.id}`),
      element("p", { class: "muted", style: "overflow-wrap:anywhere" }, selected.name),
    );
    this.image.alt = `LF image ${selected.name}`;
    this.image.src = `image/1280/${selected.id}.jpg`;
    this.picture.style.aspectRatio = `${selected.width} / ${selected.height}`;
    this.picture.style.setProperty("--ratio", String(selected.width / selected.height));
    this.picture.querySelector(".mark")?.remove();
    this.drawing.setAttribute("viewBox", `0 0 ${selected.width} ${selected.height}`);
    this.drawing.replaceChildren();
  }

  private async drawOverlap(): Promise<void> {
    const { selected, use, path, frame, scene } = this.state;
    const number = ++this.asked;
    if (!selected || this.root.hidden) return;
    const kind = use?.ofCameras[selected.id];
    const style = USE_STYLES[kind ?? 0];
    const rows = [
      element("dt", {}, "In this frame"),
      element("dd", {}, kind === undefined ? "…" : style.label),
      ...(selected.virtual
        ? [element("dt", {}, "Kind"), element("dd", {}, "Virtual: interpolated from recorded LF images")]
        : []),
      element("dt", {}, "Stands at"),
      element("dd", {}, vector(selected.centre)),
      element("dt", {}, "Size"),
      element("dd", {}, `${selected.width} × ${selected.height}`),
      element("dt", {}, "Focal length"),
      element("dd", {}, `${precise(selected.focal_px, 5)} px`),
    ];
    const frames = this.state.framesOfCamera?.[selected.id];
    const about = this.state.path.shown_step > 1 ? "about " : "";
    if (frames !== undefined)
      rows.push(element("dt", {}, "Taken by"), element("dd", {}, about + plural(frames, "frame")));
    const help =
      kind === undefined || USES[kind] === "used"
        ? null
        : element("p", { class: "muted" }, `Not taken: it ${style.help}.`);
    this.facts.replaceChildren(element("dl", { style: "margin-top:8px" }, ...rows));
    if (help) this.facts.append(help);
    if (!scene.server) return;
    try {
      const overlap = await getJson<OverlapFacts>(`path/${path.id}/overlap/${frame}/${selected.id}.json`);
      if (number === this.asked) this.drawShapes(overlap, selected.width, selected.height);
    } catch {
      // Shows no message, because the request of the frame's data fails for the same reason and shows the message.
      if (number === this.asked) this.drawing.replaceChildren();
    }
  }

  private drawShapes(overlap: OverlapFacts, width: number, height: number): void {
    const shapes: SVGElement[] = [];
    const thick = Math.max(width, height) / 250;
    const add = (name: string, attributes: Record<string, string | number>) => {
      const shape = document.createElementNS(SVG, name);
      for (const [key, value] of Object.entries(attributes)) shape.setAttribute(key, String(value));
      shapes.push(shape);
    };
    if (overlap.rect) {
      const [x0, y0, x1, y1] = overlap.rect;
      // Dims the pixels that are not read.
      add("path", {
        d: `M0 0H${width}V${height}H0ZM${x0} ${y0}V${y1}H${x1}V${y0}Z`,
        fill: "rgb(0 0 0 / 0.5)",
        "fill-rule": "evenodd",
      });
      add("rect", {
        x: x0,
        y: y0,
        width: x1 - x0,
        height: y1 - y0,
        fill: "none",
        stroke: "#ffaa32",
        "stroke-width": thick,
      });
      const share = ((x1 - x0) * (y1 - y0)) / (width * height);
      this.facts.append(
        element(
          "p",
          { class: "muted" },
          `The rectangle that is read: ${x1 - x0} × ${y1 - y0} pixels, ${percent(share)} of the image. ` +
            (overlap.outlines.length > 0
              ? "Its pixels within the outline see both the lens and the filmed region."
              : "It has no outline: the LF camera is beside the lens, and stands for the part of the lens that is " +
                "nearest to it, or its field of view is too wide for an outline."),
        ),
      );
    } else {
      add("path", { d: `M0 0H${width}V${height}H0Z`, fill: "rgb(0 0 0 / 0.5)" });
    }
    for (const outline of overlap.outlines)
      add("polygon", {
        points: outline.map(([x, y]) => `${x},${y}`).join(" "),
        fill: "rgb(127 227 255 / 0.16)",
        stroke: "#7fe3ff",
        "stroke-width": thick,
      });
    this.drawing.replaceChildren(...shapes);
  }
}
