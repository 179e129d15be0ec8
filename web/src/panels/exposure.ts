// SPDX-License-Identifier: Apache-2.0
// The setting of the exposure with which pictures of frames are shown. All panels share it.

import { element } from "../element";
import type { State } from "../state";
import { precise } from "../words";

export function exposureRow(state: State): HTMLElement {
  const slider = element("input", { type: "range", min: -6, max: 6, step: 0.25, "aria-label": "Exposure, stops" });
  const stops = element("span");
  const set = (exposure: number) => {
    state.exposure = exposure;
    state.emit("exposure");
  };
  const fill = () => {
    slider.value = String(state.exposure);
    stops.textContent = `${state.exposure > 0 ? "+" : ""}${precise(state.exposure, 3)} stops`;
  };
  slider.addEventListener("input", () => set(slider.valueAsNumber));
  state.on(["exposure"], fill);
  fill();
  const reset = element("button", { click: () => set(0) }, "Reset");
  return element("div", { class: "row" }, element("label", {}, "Exposure"), slider, stops, reset);
}
