// SPDX-License-Identifier: Apache-2.0
// The legend: explains the colours of LF cameras, counts the LF cameras of each kind, and chooses the kinds that are
// shown.

import { countsOf, IN_OTHER_FRAME, USED } from "./data/frame_use";
import { element } from "./element";
import type { State } from "./state";
import { USE_STYLES } from "./view/palette";
import type { SpaceView } from "./view/space_view";
import { shortNumber } from "./words";

export class Legend {
  private readonly counts: HTMLElement[] = [];
  private readonly rows: HTMLElement[] = [];
  private readonly dots: HTMLElement[] = [];

  constructor(
    root: HTMLElement,
    private readonly state: State,
    view: SpaceView,
  ) {
    const order = [USED, IN_OTHER_FRAME, 1, 3, 2, 4, 5];
    for (const kind of order) {
      const style = USE_STYLES[kind];
      const box = element("input", { type: "checkbox", checked: true, "data-use": style.name });
      box.addEventListener("change", () => {
        view.points.show(kind, box.checked);
        view.draw();
      });
      this.dots[kind] = element("i");
      this.counts[kind] = element("b", {}, "0");
      this.rows[kind] = element("label", { title: style.help }, box, this.dots[kind], style.label, this.counts[kind]);
      root.append(this.rows[kind]);
    }
    const ranges = state.scene.light_field.virtual_ranges;
    if (ranges) root.append(virtualRow(ranges, view));
    state.on(["use", "film"], () => this.update());
    state.on(["theme"], () => this.colour());
    this.colour();
  }

  private colour(): void {
    USE_STYLES.forEach((style, kind) => {
      const colour = this.state.isDark ? style.dark : style.light;
      this.dots[kind].style.background = `rgb(${colour.join(" ")})`;
    });
  }

  private update(): void {
    const { use, framesOfCamera } = this.state;
    if (!use) return;
    const counts = countsOf(use);
    counts.push(0);
    if (framesOfCamera)
      use.ofCameras.forEach((kind, i) => {
        if (kind === USED || framesOfCamera[i] === 0) return;
        --counts[kind];
        ++counts[IN_OTHER_FRAME];
      });
    counts.forEach((count, kind) => {
      this.counts[kind].textContent = shortNumber(count);
      // The row of a kind that no LF camera has is hidden, except for the used kind.
      this.rows[kind].style.display = count > 0 || kind === USED ? "" : "none";
    });
  }
}

// Returns the row of the virtual LF cameras, which have the colours of the other rows, but are rings.
function virtualRow(ranges: [number, number][], view: SpaceView): HTMLElement {
  const box = element("input", { type: "checkbox", checked: true, "data-use": "virtual" });
  box.addEventListener("change", () => {
    view.points.showVirtual(box.checked);
    view.draw();
  });
  const count = ranges.reduce((sum, [begin, end]) => sum + end - begin, 0);
  return element(
    "label",
    { title: "its LF image is interpolated from recorded ones" },
    box,
    element("i", { class: "ring" }),
    "Virtual",
    element("b", {}, shortNumber(count)),
  );
}
