// SPDX-License-Identifier: Apache-2.0
// The panel that edits the path: the value and keys of each quantity at this frame, whole movements, and the text of
// the file.

import { add } from "../data/frame_camera";
import { element } from "../element";
import { deleteKey, INTERPOLATIONS, setEasedKey } from "../path/eases";
import { dolly, focusPull, orbit } from "../path/generators";
import type { Quantity } from "../path/path_facts";
import type { PathValue } from "../path/path_quantities";
import type { State } from "../state";
import { precise, seconds, vector } from "../words";

interface Field {
  label: string;
  // Names of alternative quantities. The first one that the file contains is shown; if it contains none, the first of
  // the list.
  names: string[];
  parts: string[]; // labels of a value's components; one for a number
  // Returns the value at the current frame, for quantities that can be read from the evaluated camera between two keys;
  // null if this one cannot.
  now?: (state: State, name: string) => PathValue | null;
}

const FIELDS: Field[] = [
  { label: "Position", names: ["position"], parts: ["x", "y", "z"], now: (s) => s.camera.centre },
  {
    label: "Looks at",
    names: ["look_at", "orientation", "quaternion"],
    parts: ["x", "y", "z"],
    now: (s, name) => (name === "look_at" ? add(s.camera.centre, s.camera.forward, s.camera.focusDistance) : null),
  },
  { label: "Roll", names: ["roll"], parts: ["degrees"] },
  {
    label: "Aperture",
    names: ["aperture_diameter", "f_number"],
    parts: ["diameter"],
    now: ({ camera }, name) => (name === "f_number" ? camera.focalLength / (2 * camera.radius) : 2 * camera.radius),
  },
  {
    label: "Focus distance",
    names: ["focus_distance", "focus_point"],
    parts: ["distance"],
    now: ({ camera }, name) =>
      name === "focus_point" ? add(camera.centre, camera.forward, camera.focusDistance) : camera.focusDistance,
  },
  {
    label: "Focus tilt",
    names: ["focus_tilt"],
    parts: ["horizontal", "vertical"],
    now: (s) => ({
      horizontal: (s.camera.tiltHorizontal * 180) / Math.PI,
      vertical: (s.camera.tiltVertical * 180) / Math.PI,
    }),
  },
  {
    label: "Focal length",
    names: ["focal_length", "field_of_view"],
    parts: ["length"],
    now: ({ camera }, name) => (name === "field_of_view" ? null : camera.focalLength),
  },
  { label: "Blade rotation", names: ["blade_rotation"], parts: ["degrees"] },
];

const PART_LABELS: Record<string, string> = { diameter: "", distance: "", length: "", degrees: "°" };

const NAMES: Record<string, string> = {
  orientation: "Orientation",
  quaternion: "Quaternion",
  f_number: "F-number",
  focus_point: "Focus point",
  field_of_view: "Field of view",
};

function partsOf(value: PathValue): [string, number][] {
  if (typeof value === "number") return [["", value]];
  if (Array.isArray(value)) return value.map((x, i) => ["xyzw"[i] ?? "", x]);
  return Object.entries(value);
}

function withPart(value: PathValue, index: number, x: number): PathValue {
  if (typeof value === "number") return x;
  if (Array.isArray(value)) return value.map((old, i) => (i === index ? x : old));
  const name = Object.keys(value)[index];
  return { ...value, [name]: x };
}

const EASES_HELP =
  "How the value gets here from the key before. ease: from rest to rest; ease in: leaves from rest, and goes on; " +
  "ease out: comes to rest; smooth: passes keys without a stop; linear: at constant speed; step: jumps here";

export function valueText(value: PathValue): string {
  if (typeof value === "number") return precise(value, 5);
  return Array.isArray(value) ? vector(value) : vector(Object.values(value));
}

export class EditPanel {
  private readonly fields = element("div");
  private readonly text = element("textarea", {
    spellcheck: "false",
    "aria-label": "The path file",
  });
  private readonly verdict = element("p", { role: "status", id: "verdict" });
  private readonly opened = new Set<string>();
  private typing = 0; // timer that calls takeText() after a pause in typing; 0: nothing was typed
  private filledWith = ""; // text of the document when the text area was last filled
  private isSettling = false; // true until the browser has moved the focus after a field was changed

  constructor(
    private readonly root: HTMLElement,
    private readonly state: State,
  ) {
    if (!state.scene.server) {
      root.append(
        element(
          "p",
          { class: "muted" },
          "These are exported files: the path can be looked at here, and edited where " + "lfvisualizer runs.",
        ),
      );
      return;
    }
    this.text.addEventListener("input", () => {
      clearTimeout(this.typing);
      this.typing = window.setTimeout(() => this.takeText(), 150);
    });
    this.text.addEventListener("blur", () => {
      this.takeText();
      state.history.seal();
    });
    state.on(["saving"], () => this.takeText());
    const file = element("details", {}, element("summary", {}, "The file"), this.text);
    root.append(this.fields, this.constants(), this.movements(), file, this.verdict);
    state.on(["path", "frame", "text"], () => this.draw());
  }

  shown(): void {
    this.draw();
  }

  // Sets the document to the text in the text area, if something was typed since the last call. A text area always has
  // line feeds as line ends; they are converted to the line ends of the file.
  private takeText(): void {
    if (this.typing === 0) return;
    clearTimeout(this.typing);
    this.typing = 0;
    const { state } = this;
    const lineEnd = state.document.text().includes("\r\n") ? "\r\n" : "\n";
    if (state.setText(this.text.value.replaceAll("\n", lineEnd))) this.filledWith = state.document.text();
  }

  private draw(): void {
    const { state } = this;
    if (this.root.hidden || !state.scene.server || state.cameras.length === 0) return;
    const { invalid, unchecked } = state;
    this.verdict.textContent = invalid ?? (unchecked ? `This edit was not checked: ${unchecked}` : "");
    this.verdict.className = invalid || unchecked ? "bad" : "muted";
    // The text area keeps text that is being typed, and typed text that is no YAML until the document changes.
    const text = state.document.text();
    if (this.typing === 0 && text !== this.filledWith) {
      this.text.value = text;
      this.filledWith = text;
    }
    if (this.isSettling) return;
    const focused = document.activeElement;
    const isTyped = focused instanceof HTMLInputElement && focused.value !== focused.defaultValue;
    if (isTyped && this.fields.contains(focused)) return; // a field in which the user types is not replaced
    this.redrawFields();
  }

  private redrawFields(): void {
    const focused = this.fields.contains(document.activeElement)
      ? document.activeElement?.getAttribute("aria-label")
      : null;
    this.fields.replaceChildren(
      element("h2", {}, `At frame ${this.state.frame}, ${seconds(this.state.time)}`),
      ...FIELDS.map((field) => this.field(field)),
    );
    if (!focused) return;
    const again = this.fields.querySelector<HTMLElement>(`[aria-label="${focused}"]`);
    again?.focus();
    if (again instanceof HTMLInputElement) again.select();
  }

  private quantityOf(field: Field): Quantity | null {
    const { document: path } = this.state;
    try {
      const given = field.names.map((name) => path.quantity(name)).find((one) => one.given);
      return given ?? path.quantity(field.names[0]);
    } catch (error) {
      this.verdict.textContent = String(error);
      return null;
    }
  }

  private keyNow(quantity: Quantity): number | null {
    const half = 0.5 / this.state.path.fps;
    const near = (time: number) => Math.abs(time - this.state.time) < half;
    if (quantity.baseIsKey && near(0)) return -1;
    const index = quantity.keyframes.findIndex((key) => near(key.time));
    return index < 0 ? null : index;
  }

  // Returns the value at this frame; null if the frame is between keys and the value there is not known.
  private valueNow(field: Field, quantity: Quantity): PathValue | null {
    const key = this.keyNow(quantity);
    if (key !== null) return key < 0 ? quantity.base! : quantity.keyframes[key].value;
    const { keyframes, base } = quantity;
    if (keyframes.length === 0 && base !== undefined) return base;
    const now = field.now?.(this.state, quantity.name) ?? null;
    if (now !== null) return now;
    const { time } = this.state;
    const last = keyframes.at(-1);
    if (last && time >= last.time) return last.value;
    if (keyframes.length > 0 && !quantity.baseIsKey && time <= keyframes[0].time) return keyframes[0].value;
    return keyframes.length === 0 ? (field.parts.length === 1 ? 0 : field.parts.map(() => 0)) : null;
  }

  private field(field: Field): HTMLElement {
    const { state } = this;
    const quantity = this.quantityOf(field);
    if (!quantity) return element("div");
    const known = this.valueNow(field, quantity);
    const value = known ?? quantity.keyframes[0].value;
    const key = this.keyNow(quantity);
    // The time of this frame, or of the key at this frame. It is stored now, because the timeline may have moved on
    // when the user has finished typing the value.
    const time = key === null ? state.time : key < 0 ? 0 : quantity.keyframes[key].time;
    const isMoving = quantity.hasAccelerations || known === null;
    const inputs = partsOf(value).map(([name, x], i) => {
      const label = PART_LABELS[field.parts[i]] ?? name;
      const input = element("input", {
        type: "number",
        step: "any",
        class: "vector",
        value: known === null ? "" : Number(x.toPrecision(6)),
        disabled: isMoving,
        "aria-label": `${field.label} ${name}`,
        "data-quantity": quantity.name,
        title: label,
      });
      input.addEventListener("change", () => {
        if (input.value === "" || !Number.isFinite(input.valueAsNumber)) return;
        const changed = withPart(value, i, input.valueAsNumber);
        // The fields are redrawn only after the browser has moved the focus.
        this.isSettling = true;
        setTimeout(() => {
          this.isSettling = false;
          this.redrawFields();
        });
        state.edit(`change ${field.label.toLowerCase()}`, (path) => {
          if (quantity.keyframes.length > 0 || quantity.baseIsKey) setEasedKey(path, quantity.name, time, changed);
          else path.setBase(quantity.name, changed);
        });
      });
      input.addEventListener("keydown", (event) => {
        if (event.key === "Enter") input.blur();
      });
      return input;
    });
    const addKey = element(
      "button",
      {
        disabled: isMoving || key !== null,
        "data-add-key": quantity.name,
        title: "A key of this value at this frame",
        click: () =>
          state.edit(`add a key of ${field.label.toLowerCase()}`, (path) =>
            setEasedKey(path, quantity.name, time, value),
          ),
      },
      "◆ Key",
    );
    const summary = element(
      "summary",
      {},
      NAMES[quantity.name] ?? field.label,
      key === null ? null : element("span", { class: "key-dot", title: "a key" }, "◆"),
      element("span", { class: "now" }, known === null ? "between keys" : valueText(value)),
    );
    const unit = quantity.unit === "degrees" ? "degrees" : quantity.unit === "length" ? "world units" : "";
    const details = element(
      "details",
      { open: this.opened.has(field.label) },
      summary,
      element("div", { class: "row" }, ...inputs, addKey),
      element("p", { class: "muted" }, `${quantity.name.replaceAll("_", " ")}${unit ? `, ${unit}` : ""}`),
      quantity.hasAccelerations ? this.movesOtherwise(quantity) : this.keyList(quantity),
    );
    details.addEventListener("toggle", () => {
      if (details.open) this.opened.add(field.label);
      else this.opened.delete(field.label);
    });
    return details;
  }

  private movesOtherwise(quantity: Quantity): HTMLElement {
    return element(
      "p",
      {},
      "Moves by speed and accelerations. ",
      element(
        "button",
        {
          click: () => this.state.edit(`stop ${quantity.name}`, (path) => path.removeMotion(quantity.name)),
        },
        "Use keys instead",
      ),
    );
  }

  private keyList(quantity: Quantity): HTMLElement {
    const { state } = this;
    const keys = quantity.keyframes.map((key, index) => ({ ...key, index }));
    if (quantity.baseIsKey) keys.unshift({ time: 0, value: quantity.base!, interpolation: "smooth", index: -1 });
    const now = this.keyNow(quantity);
    return element(
      "ul",
      { class: "keys" },
      ...keys.map((key) => {
        const kind = element(
          "select",
          {
            "aria-label": `How the value gets to ${seconds(key.time)}`,
            disabled: key === keys[0],
            title: key === keys[0] ? "No key is before this one" : EASES_HELP,
            change: () =>
              state.edit("change an interpolation", (path) =>
                path.setInterpolation(quantity.name, key.index, kind.value as typeof key.interpolation),
              ),
          },
          ...INTERPOLATIONS.map((name) =>
            element("option", { value: name, selected: name === key.interpolation }, name.replace("_", " ")),
          ),
        );
        return element(
          "li",
          { class: key.index === now ? "now" : "" },
          element("button", { click: () => state.setFrame(state.frameAt(key.time)) }, seconds(key.time)),
          element("span", { class: "value" }, valueText(key.value)),
          kind,
          element(
            "button",
            {
              "aria-label": `Delete the key at ${seconds(key.time)}`,
              click: () =>
                state.edit(`delete a key of ${quantity.name}`, (path) => deleteKey(path, quantity.name, key.index)),
            },
            "✕",
          ),
        );
      }),
    );
  }

  private constants(): HTMLElement {
    const { state } = this;
    const constant = (label: string, name: string, now: () => number, step = 1) => {
      const input = element("input", { type: "number", min: 0, step, "aria-label": label });
      const fill = () => (input.value = String(now()));
      input.addEventListener("change", () => {
        const wanted = input.valueAsNumber;
        if (!Number.isFinite(wanted) || !state.edit(`change ${name}`, (path) => path.setConstant(name, wanted))) fill();
      });
      state.on(["path"], fill);
      return [element("label", {}, label), input];
    };
    return element(
      "div",
      {},
      element("div", { class: "row" }, ...constant("Blades", "blades", () => state.camera.blades), "0: a disk"),
      element(
        "div",
        { class: "row" },
        ...constant("Roundness of blades", "blade_roundness", () => state.camera.roundness, 0.1),
        "0: straight, 1: a disk",
      ),
      element("div", { class: "row" }, ...constant("Height / width", "ratio", () => state.camera.ratio, 0.1)),
      element("div", { class: "row" }, ...constant("Frames", "frames", () => state.path.frames)),
    );
  }

  // ------------------------------------------------------------------------------ whole movements

  private number(label: string, value: () => number): HTMLInputElement {
    const input = element("input", { type: "number", step: "any", "aria-label": label });
    const fill = () => {
      if (input.dataset.touched !== "yes") input.value = String(Number(value().toPrecision(4)));
    };
    input.addEventListener("input", () => (input.dataset.touched = "yes"));
    this.state.on(["path", "frame"], fill);
    return input;
  }

  private apply(generate: (path: State["document"]) => string): void {
    const { state } = this;
    let label = "a movement";
    state.edit("a movement", (path) => {
      label = generate(path);
    });
    if (!state.message?.isError) state.say(label);
  }

  private movements(): HTMLElement {
    const { state } = this;
    const row = (label: string, ...inputs: (HTMLElement | string)[]) =>
      element("div", { class: "row" }, element("label", {}, label), ...inputs);
    const rest = () => Math.max(1, (state.lastFrame - state.frame) / state.path.fps);

    const angle = this.number("Degrees of the orbit", () => 20);
    const orbitSeconds = this.number("Seconds of the orbit", rest);
    const way = this.number("Way of the dolly, forward", () => 0.2 * state.camera.focusDistance);
    const dollySeconds = this.number("Seconds of the dolly", rest);
    const focus = this.number("Focus distance at the end", () => 1.5 * state.camera.focusDistance);
    const focusSeconds = this.number("Seconds of the focus pull", rest);

    const makeOrbit = () =>
      this.apply((path) => {
        const { camera } = state;
        return orbit(path, {
          centre: add(camera.centre, camera.forward, camera.focusDistance),
          axis: camera.up,
          startPosition: camera.centre,
          start: state.time,
          degrees: angle.valueAsNumber,
          seconds: orbitSeconds.valueAsNumber,
        });
      });
    const makeDolly = () =>
      this.apply((path) => {
        const { camera } = state;
        return dolly(path, {
          from: camera.centre,
          to: add(camera.centre, camera.forward, way.valueAsNumber),
          start: state.time,
          seconds: dollySeconds.valueAsNumber,
        });
      });
    const makePull = () =>
      this.apply((path) =>
        focusPull(path, {
          from: state.camera.focusDistance,
          to: focus.valueAsNumber,
          start: state.time,
          seconds: focusSeconds.valueAsNumber,
        }),
      );
    return element(
      "details",
      {},
      element("summary", {}, "Movements, from this frame's camera"),
      element(
        "p",
        { class: "muted" },
        "Each begins at this frame, and replaces the previous motion of the camera or focus in the whole film.",
      ),
      row("Orbit", angle, "° in", orbitSeconds, "s", element("button", { click: makeOrbit }, "Apply")),
      row("Dolly", way, "in", dollySeconds, "s", element("button", { click: makeDolly }, "Apply")),
      row("Focus to", focus, "in", focusSeconds, "s", element("button", { click: makePull }, "Apply")),
    );
  }
}
