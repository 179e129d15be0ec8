// SPDX-License-Identifier: Apache-2.0
// The layer of depths in the view in space: its controls, and focusing on its points.

import { focusDistanceAt, readDepthPoints } from "./data/depth_points";
import { add } from "./data/frame_camera";
import type { DepthFacts, Vec3 } from "./data/scene";
import { getBytes } from "./data/source";
import { element } from "./element";
import type { Live } from "./live/live";
import { withFocusDistance, writeFocusDistance } from "./live/lens_changes";
import { setFocusDistance } from "./path/set_at_time";
import type { State } from "./state";
import { DepthCloud, type DepthStyle } from "./view/depth_cloud";
import type { SpaceView } from "./view/space_view";
import { length, millimetres, shortNumber, vector } from "./words";

export class DepthLayer {
  private readonly style: DepthStyle = { least: 0, byDepth: false, size: 1 };
  private readonly shown = element("input", { type: "checkbox", checked: true, "data-depth": "shown" });
  private readonly boxes: HTMLInputElement[] = []; // of the files
  private readonly counts: HTMLElement[] = [];
  private clouds: DepthCloud[] = [];

  //   root  receives the controls
  constructor(
    private readonly root: HTMLElement,
    private readonly state: State,
    private readonly view: SpaceView,
    private readonly live: Live,
    private readonly facts: DepthFacts[],
  ) {
    this.addControls();
    state.on(["path", "frame"], () => this.setCamera());
  }

  // Loads the points of all files, and draws them.
  async load(): Promise<void> {
    try {
      for (let i = 0; i < this.facts.length; ++i) {
        const points = readDepthPoints(await getBytes(`depth/${i}.bin`));
        this.clouds.push(new DepthCloud(this.facts[i], points));
      }
    } catch (error) {
      this.clouds = [];
      this.state.fail(error);
    }
    this.view.setClouds(this.clouds);
    this.setCamera();
    this.update();
  }

  toggle(): void {
    this.shown.checked = !this.shown.checked;
    this.update();
  }

  // Focuses on the point in the middle of the view.
  focusOnMiddle(): void {
    const place = this.view.pointInMiddle();
    if (place) this.focusOn(place);
    else this.state.say("No point of the depths is in the middle of the view: turn the view, or come nearer.");
  }

  // Sets the focus distance of the frame so that the focus plane contains a point, and says where the point is. In an
  // exported page, only the live picture is focused.
  //   place  relative to the origin of the scene
  focusOn(place: Vec3): void {
    const { state } = this;
    const point = add(place, state.scene.light_field.origin);
    const distance = focusDistanceAt(state.camera, point);
    const where = `the point at ${vector(point)}`;
    this.view.markPoint(place);
    if (!(distance > 1.001 * state.camera.focalLength))
      return state.say(`The lens cannot focus on ${where}: it is behind the lens, or too near.`, true);
    const words = `${length(distance)} (${millimetres(distance, state.path.unit_m)}), ${where}`;
    if (!state.scene.server) {
      if (this.live.panel.isUsable) {
        this.live.camera.show("focus there", withFocusDistance(state.camera, distance), writeFocusDistance);
        this.live.camera.finish();
      }
      return state.say(`At ${words}`);
    }
    let instead = "";
    const isTaken = state.edit("focus there", (document) => {
      instead = setFocusDistance(document, state.time, distance);
    });
    if (isTaken) state.say(`Focused at ${words}${instead}`);
  }

  private addControls(): void {
    const { root } = this;
    root.hidden = false;
    const changed = () => this.update();
    this.shown.addEventListener("change", changed);
    root.append(element("label", { title: "Show the depths (D)" }, this.shown, element("strong", {}, "Depths")));
    for (const file of this.facts) {
      const box = element("input", { type: "checkbox", checked: true, "data-depth": "file" });
      box.addEventListener("change", changed);
      const count = element("b");
      this.boxes.push(box);
      this.counts.push(count);
      root.append(element("label", { title: titleOf(file) }, box, baseName(file.name), count));
    }
    const byDepth = element("input", { type: "checkbox", "data-depth": "colour" });
    byDepth.addEventListener("change", () => {
      this.style.byDepth = byDepth.checked;
      this.update();
    });
    root.append(
      element(
        "label",
        { title: "Near is yellow, far is blue; otherwise colours of the picture" },
        byDepth,
        "Coloured by distance",
      ),
    );
    if (this.facts.some((file) => file.has_confidence))
      root.append(this.slider("Least confidence", "least", 0, 1, (value) => (this.style.least = value)));
    root.append(this.slider("Size of points", "size", 0.5, 4, (value) => (this.style.size = value)));
  }

  private slider(
    label: string,
    name: "least" | "size",
    least: number,
    most: number,
    set: (value: number) => void,
  ): HTMLElement {
    const value = element("output", {}, String(this.style[name]));
    const input = element("input", {
      type: "range",
      min: least,
      max: most,
      step: 0.05,
      value: this.style[name],
      "aria-label": label,
      "data-depth": name,
    });
    input.addEventListener("input", () => {
      set(Number(input.value));
      value.textContent = input.value;
      this.update();
    });
    return element("label", { class: "slider" }, label, input, value);
  }

  private setCamera(): void {
    const { state } = this;
    const eye = add(state.camera.centre, state.scene.light_field.origin, -1);
    for (const cloud of this.clouds) cloud.setCamera(eye, state.camera.forward);
    this.view.draw();
  }

  private update(): void {
    this.clouds.forEach((cloud, i) => {
      cloud.setStyle(this.style);
      cloud.object.visible = this.shown.checked && this.boxes[i].checked;
      this.counts[i].textContent = shortNumber(cloud.shownCount());
    });
    this.view.draw();
  }
}

function baseName(name: string): string {
  return name.slice(name.lastIndexOf("/") + 1);
}

function titleOf(file: DepthFacts): string {
  const thinned = file.points < file.points_in_file ? ` of ${shortNumber(file.points_in_file)}, chosen at random` : "";
  const unknown = file.unknown > 0 ? `; ${shortNumber(file.unknown)} elements have no depth` : "";
  return `${file.name}: ${shortNumber(file.points)} points${thinned}${unknown}`;
}
