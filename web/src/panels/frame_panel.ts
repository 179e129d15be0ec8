// SPDX-License-Identifier: Apache-2.0
// The panel that shows facts about this frame: its lens, the LF images that it needs, and how dense the LF cameras are.

import { fNumber } from "../data/frame_camera";
import { element } from "../element";
import type { State } from "../state";
import { shapeText } from "../data/opening";
import { length, millimetres, percent, precise, shortNumber, vector } from "../words";

type Rows = [string, string | Node][];

function list(rows: Rows): HTMLElement {
  return element("dl", {}, ...rows.flatMap(([term, value]) => [element("dt", {}, term), element("dd", {}, value)]));
}

export class FramePanel {
  constructor(
    private readonly root: HTMLElement,
    private readonly state: State,
  ) {
    state.on(["path", "frame", "use", "density", "film"], () => this.draw());
  }

  private draw(): void {
    if (this.root.hidden || this.state.cameras.length === 0) return;
    this.root.replaceChildren(
      element("h2", {}, `Frame ${this.state.frame}`),
      this.lens(),
      element("h2", {}, "What it takes"),
      this.needs(),
      element("h2", {}, "How densely LF cameras stand"),
      ...this.density(),
    );
  }

  shown(): void {
    this.draw();
  }

  private lens(): HTMLElement {
    const { camera, path } = this.state;
    const opening = 2 * camera.radius;
    const rows: Rows = [
      ["Position", vector(camera.centre)],
      ["Focal length", millimetres(camera.focalLength, path.unit_m)],
      [
        "Aperture",
        opening === 0 ? "0, a pinhole" : `${millimetres(opening, path.unit_m)}, f/${precise(fNumber(camera), 3)}`,
      ],
      ["Shape", shapeText(camera)],
      ["Focus distance", length(camera.focusDistance)],
    ];
    if (camera.tiltHorizontal !== 0 || camera.tiltVertical !== 0) {
      const degrees = (radians: number) => `${precise((radians * 180) / Math.PI, 3)}°`;
      rows.push(["Focus tilt", `${degrees(camera.tiltHorizontal)}, ${degrees(camera.tiltVertical)}`]);
    }
    const shift = (camera.sensorWidth / camera.width) * (camera.width / 2 - camera.cx);
    const rise = (camera.sensorWidth / camera.width) * (camera.cy - camera.height / 2);
    if (camera.hoodRadius > 0)
      rows.push([
        "Hood",
        `${millimetres(2 * camera.hoodRadius, path.unit_m)} wide, ${length(camera.hoodDistance)} in front`,
      ]);
    if (path.transmission) rows.push(["Transmission", "a picture in the opening"]);
    if (shift !== 0 || rise !== 0)
      rows.push(["Shift", `${millimetres(shift, path.unit_m)}, ${millimetres(rise, path.unit_m)}`]);
    const { cx, fx, width } = camera;
    const view = ((Math.atan(cx / fx) + Math.atan((width - cx) / fx)) * 180) / Math.PI;
    rows.push(["Horizontal field of view", `${precise(view, 3)}°`]);
    rows.push(["Plate", `${camera.width} × ${camera.height}`]);
    return list(rows);
  }

  private needs(): HTMLElement {
    const { use, frame, film, path, scene } = this.state;
    if (!use || use.frame !== frame) return element("p", { class: "muted" }, "being found …");
    const share = use.shares.reduce((sum, one) => sum + one, 0) / Math.max(1, use.shares.length);
    const rows: Rows = [
      ["LF images", `${use.ids.length.toLocaleString("en-US")} of ${shortNumber(use.ofCameras.length)}`],
      ["Pixels of each", use.ids.length > 0 ? `${percent(share)} on average` : "none"],
    ];
    const index = this.state.frames!.indexOf(frame);
    if (film && film.done > index)
      rows.push(
        ["Rays to be read", shortNumber(film.rays[index])],
        ["For each element", `about ${precise(film.rays[index] / (path.width * path.height), 3)}`],
      );
    const holder = scene.packages.find((one) => one.frames.includes(frame));
    if (holder && path.id === scene.path.id) rows.push(["Package", holder.name]);
    if (use.ids.length === 0)
      return element(
        "p",
        { class: "bad" },
        "No LF image has a ray for this frame: it is black. Is the camera where the light field was " +
          "captured, and does it look in a direction that was captured?",
      );
    return list(rows);
  }

  private density(): (HTMLElement | string)[] {
    const { density, camera, path } = this.state;
    if (!density) return [element("p", { class: "muted" }, "being found …")];
    const rows: Rows = [["LF cameras in the lens", shortNumber(density.cameras_in_lens)]];
    if (density.camera_distance) rows.push(["Camera spacing", millimetres(density.camera_distance, path.unit_m)]);
    const ends: [string, number | null, number | null][] = [
      ["Nearest", density.depths[0], density.near_displacement_px],
      ["Farthest", density.depths[1], density.far_displacement_px],
    ];
    for (const [label, depth, displacement] of ends)
      if (depth !== null && displacement !== null) rows.push([`${label}, at ${length(depth)}`, verdict(displacement)]);
    const words: HTMLElement[] = [list(rows)];
    words.push(
      element(
        "p",
        { class: "muted" },
        density.depths_known
          ? "How far apart two neighbouring LF cameras show the same point: up to about one " +
              "element looks like blur, more than four look like double edges."
          : "The light field does not state the depths of the scene. The depths shown are a quarter " +
              "nearer and farther than the focus distance.",
      ),
    );
    if (density.uncovered_share >= 0.1)
      words.push(
        element(
          "p",
          { class: "bad" },
          `${percent(density.uncovered_share)} of the lens is beyond the LF cameras: ` +
            "the bokeh (blur disks) are cut off there. " +
            (density.fitting_aperture > 0
              ? `The largest aperture that fits is ${millimetres(density.fitting_aperture, path.unit_m)}.`
              : "No aperture fits here: move the camera."),
        ),
      );
    if (density.least_aperture !== null && density.least_aperture > 2 * camera.radius)
      words.push(
        element(
          "p",
          { class: "bad" },
          `Some elements have no ray of their own below an aperture of ${millimetres(
            density.least_aperture,
            path.unit_m,
          )}: open the aperture.`,
        ),
      );
    return words;
  }
}

function verdict(displacement: number): HTMLElement {
  const name = displacement <= 1.5 ? "good" : displacement <= 4 ? "" : "bad";
  const text = precise(displacement, 2);
  return element("span", { class: name }, `${text} ${text === "1" ? "element" : "elements"}`);
}
