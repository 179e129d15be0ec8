// SPDX-License-Identifier: Apache-2.0
// Changes the lens and the camera by mouse, fingers and keys in the live picture. In the mode "focus", a drag changes
// the focus distance, the wheel or a pinch the aperture, and a click focuses there. In the mode "camera", or with Alt, a
// drag orbits round the point in focus, with Shift or another button it slides, and the wheel or a pinch dollies.

import type { FrameCamera } from "../data/frame_camera";
import { element } from "../element";
import { focusThere } from "../panels/picture_view";
import type { State } from "../state";
import { focusedThrough, orbited, slid } from "./camera_moves";
import { fixedFocusPoint, levelUp, writeCamera } from "./camera_writer";
import { rotationPerStop, withFocusDistance, withRadius, writeAperture, writeFocusDistance } from "./lens_changes";
import type { LiveCamera } from "./live_camera";
import { PicturePointer } from "./picture_pointer";

export type Mode = "focus" | "camera";

const REST_MS = 400; // pause after which turns of the wheel or keys are one finished change
const ORBIT = 0.6; // angle of an orbit for a drag over the width of the picture, radians
const ORBIT_KEY = Math.PI / 180; // angle for a press of a key
const STEP_KEY = 0.01; // slide or dolly for a press of a key, in focus distances
const NOTCH = 0.1; // a turn of the wheel by a notch changes the aperture by about a tenth

// Returns the factor between the nearest and the farthest depth of interest: a drag over the width of the picture
// changes the focus distance by it.
export function depthFactor(depths: readonly [number, number | null] | undefined): number {
  const [near, far] = depths ?? [0.75, 1.25];
  return Math.max(1.5, Math.min(10, (far ?? Infinity) / near));
}

export class LiveTools {
  mode: Mode = "focus";
  private start!: FrameCamera; // the camera at the begin of a drag or pinch, set there
  private readonly listeners: (() => void)[] = [];

  constructor(
    private readonly state: State,
    private readonly camera: LiveCamera,
    private readonly box: HTMLElement,
  ) {
    new PicturePointer(box, {
      begin: () => {
        camera.finish();
        this.start = camera.camera;
      },
      drag: (dx, dy, begin) => this.drag(dx, dy, begin),
      pinch: (factor) => this.pinch(factor),
      end: () => camera.finish(),
      cancel: () => camera.cancel(),
      wheel: (turn, event) => this.wheel(turn, event),
      click: (x, y, event) => this.click(x, y, event),
    });
    this.setMode("focus");
    let seen = "";
    camera.listen(() => {
      // Marks of clicks hold for one view only.
      const { centre, forward } = camera.camera;
      if (seen !== String([centre, forward])) this.removeMarks();
      seen = String([centre, forward]);
    });
  }

  listen(listener: () => void): void {
    this.listeners.push(listener);
  }

  setMode(mode: Mode): void {
    this.mode = mode;
    this.box.dataset.mode = mode;
    for (const listener of this.listeners) listener();
  }

  private movesCamera(event: MouseEvent): boolean {
    return event.altKey || (this.mode === "camera" && !event.ctrlKey);
  }

  private drag(dx: number, dy: number, begin: PointerEvent): void {
    const { start } = this;
    const isSecondary = begin.button !== 0;
    if (this.movesCamera(begin) || isSecondary) {
      if (begin.shiftKey || isSecondary) {
        // The focus plane follows the mouse.
        const scale = (start.focusDistance * start.width) / start.fx;
        this.showMoved("slide the camera", slid(start, -dx * scale, dy * scale), false);
      } else {
        const up = levelUp(this.state.document, start);
        this.showMoved("orbit", orbited(start, up, -dx * ORBIT, dy * ORBIT), true);
      }
    } else {
      const factor = depthFactor(this.state.scene.light_field.depths);
      this.showFocus(start, start.focusDistance * factor ** (dx - dy));
    }
  }

  private pinch(factor: number): void {
    const { start } = this;
    if (this.mode === "focus") this.showAperture(start, start.radius * factor);
    else this.dolly(start, 1 - 1 / factor);
  }

  private wheel(turn: number, event: WheelEvent): void {
    const { camera } = this.camera;
    if (this.movesCamera(event)) this.dolly(camera, -2 * STEP_KEY * turn, REST_MS);
    else this.showAperture(camera, this.opened(camera, Math.exp(-NOTCH * turn)), REST_MS);
  }

  // Returns the radius of the opening, enlarged by a factor. A pinhole opens to a small lens.
  private opened(camera: FrameCamera, factor: number): number {
    if (camera.radius > 0) return camera.radius * factor;
    return factor > 1 ? camera.focalLength / 128 : 0;
  }

  private click(x: number, y: number, event: PointerEvent): void {
    if (this.movesCamera(event)) return;
    if (!this.state.scene.server)
      return this.state.say("The exported page cannot measure distances: drag to focus nearer or farther.");
    if (!this.state.isShown) return; // the server does not know the path of this picture yet
    const { width, height } = this.camera.camera;
    const isOfPlane = event.shiftKey;
    if (!isOfPlane || this.box.querySelectorAll(".mark").length >= 3) this.removeMarks();
    this.box.append(element("div", { class: "mark", style: `left:${100 * x}%;top:${100 * y}%` }));
    void focusThere(this.state, { x: x * width, y: y * height }, isOfPlane);
  }

  private removeMarks(): void {
    for (const mark of this.box.querySelectorAll(".mark")) mark.remove();
  }

  // ------------------------------------------------------------------------------------ changes

  showFocus(camera: FrameCamera, distance: number, rest_ms = 0): void {
    this.camera.show("change focus distance", withFocusDistance(camera, distance), writeFocusDistance, rest_ms);
  }

  showAperture(camera: FrameCamera, radius: number, rest_ms = 0): void {
    const opened = withRadius(camera, radius, rotationPerStop(this.state.document));
    this.camera.show("change aperture", opened, writeAperture, rest_ms);
  }

  private showMoved(label: string, moved: FrameCamera, isTurned: boolean, rest_ms = 0): void {
    const point = fixedFocusPoint(this.state.document);
    const focused = point ? focusedThrough(moved, point) : moved;
    this.camera.show(
      label,
      focused,
      (document, time, camera) => writeCamera(document, time, camera, isTurned),
      rest_ms,
    );
  }

  // Moves the camera forward by a share of the focus distance.
  private dolly(camera: FrameCamera, share: number, rest_ms = 0): void {
    this.showMoved("dolly", slid(camera, 0, 0, share * camera.focusDistance), false, rest_ms);
  }

  // --------------------------------------------------------------------------------------- keys

  // Handles a key. Returns false if it has no meaning here.
  key(event: KeyboardEvent): boolean {
    const { camera } = this.camera;
    const step = Math.log(depthFactor(this.state.scene.light_field.depths)) / 100;
    const keys: Record<string, () => void> = {
      ",": () => this.showFocus(camera, camera.focusDistance * Math.exp(-step), REST_MS),
      ".": () => this.showFocus(camera, camera.focusDistance * Math.exp(step), REST_MS),
      "-": () => this.showAperture(camera, this.opened(camera, Math.exp(-NOTCH)), REST_MS),
      "+": () => this.showAperture(camera, this.opened(camera, Math.exp(NOTCH)), REST_MS),
      "=": () => this.showAperture(camera, this.opened(camera, Math.exp(NOTCH)), REST_MS),
      c: () => this.setMode(this.mode === "focus" ? "camera" : "focus"),
      ...(this.mode === "camera" ? this.cameraKeys(event.shiftKey) : {}),
    };
    const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    act?.();
    return act !== undefined;
  }

  private cameraKeys(slides: boolean): Record<string, () => void> {
    const { camera } = this.camera;
    const move = (right: number, upwards: number) => () => {
      const size = STEP_KEY * camera.focusDistance;
      if (slides) this.showMoved("slide the camera", slid(camera, right * size, upwards * size), false, REST_MS);
      else {
        const up = levelUp(this.state.document, camera);
        this.showMoved("orbit", orbited(camera, up, right * ORBIT_KEY, upwards * ORBIT_KEY), true, REST_MS);
      }
    };
    return {
      ArrowLeft: move(-1, 0),
      ArrowRight: move(1, 0),
      ArrowUp: move(0, 1),
      ArrowDown: move(0, -1),
      PageUp: () => this.dolly(camera, STEP_KEY, REST_MS),
      PageDown: () => this.dolly(camera, -STEP_KEY, REST_MS),
    };
  }
}
