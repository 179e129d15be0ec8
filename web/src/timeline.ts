// SPDX-License-Identifier: Apache-2.0
// The timeline of the film: plays and scrubs, and shows curves of quantities over the frames. Keys of the path are
// marks that can be dragged.

import { fNumber } from "./data/frame_camera";
import { byId, cssColour, element, fitCanvas } from "./element";
import { sidesOf, type Side } from "./path/eases";
import type { Quantity } from "./path/path_facts";
import type { State } from "./state";
import { millimetres, precise, seconds, shortNumber } from "./words";

interface Row {
  label: string;
  rank: number; // rows with the lowest ranks are shown if there is not room for all
  colour: string;
  quantities: string[]; // names of the quantities whose keys the row shows
  fromZero: boolean;
  values(): (number | null)[]; // one for each shown frame (PathFrames)
  text(): string; // describes the current frame
}

const LABELS = 118; // width of the labels to the left of the curves, CSS pixels
const MARGIN = 12;
const KEY = 5; // half the size of a key's mark, CSS pixels
const LEAST_HEIGHT = 30; // of a row, CSS pixels

interface Key {
  quantity: Quantity;
  index: number;
  time: number;
  sides: [Side, Side];
  x: number;
  y: number;
}

export class Timeline {
  private readonly canvas = byId<HTMLCanvasElement>("curves");
  // Holds the drawing of everything that does not change with the frame; drawMark() adds the rest.
  private readonly still = document.createElement("canvas");
  private readonly play = byId<HTMLButtonElement>("play");
  private readonly range = byId<HTMLInputElement>("scrub");
  private readonly clock = byId("clock");
  private readonly allRows: Row[];
  private rows: Row[] = []; // those for which there is room
  private keys: Key[] = [];
  private playing = 0;
  private dragged: { key: Key; time: number } | null = null;

  constructor(private readonly state: State) {
    this.allRows = this.makeRows();
    this.play.addEventListener("click", () => this.toggle());
    this.range.addEventListener("input", () => state.setFrame(Number(this.range.value)));
    byId("first").addEventListener("click", () => state.setFrame(state.path.first_frame));
    byId("last").addEventListener("click", () => state.setFrame(state.lastFrame));
    this.listenForScrubs();
    new ResizeObserver(() => this.drawAll()).observe(this.canvas);
    state.on(["path", "film", "theme", "text"], () => this.drawAll());
    state.on(["frame", "use"], () => this.drawMark());
  }

  private makeRows(): Row[] {
    const { state } = this;
    const unit = () => state.path.unit_m;
    const ofFilm = (counts: number[] | undefined) =>
      counts?.map((count, i) => (i < state.film!.done ? count : null)) ?? [];
    return [
      {
        label: "Camera's speed",
        rank: 2,
        colour: "--curve-0",
        quantities: ["position", "look_at", "orientation", "quaternion", "focal_length"],
        fromZero: true,
        values: () => state.cameras.map((_, i) => state.frames!.speed(state.frames!.frameOf(i))),
        text: () => `${precise(state.frames!.speed(state.frame), 3)} / s`,
      },
      {
        label: "Aperture",
        rank: 1,
        colour: "--curve-1",
        quantities: ["aperture_diameter", "f_number", "blade_rotation"],
        fromZero: true,
        values: () => state.cameras.map((camera) => 2 * camera.radius),
        text: () => {
          const { camera } = state;
          if (camera.radius === 0) return "pinhole";
          return `f/${precise(fNumber(camera), 3)}  ${millimetres(2 * camera.radius, unit())}`;
        },
      },
      {
        label: "Focus distance",
        rank: 0,
        colour: "--curve-2",
        quantities: ["focus_distance", "focus_point", "focus_tilt"],
        fromZero: false,
        values: () => state.cameras.map((camera) => camera.focusDistance),
        text: () => precise(state.camera.focusDistance, 4),
      },
      {
        label: "LF images",
        rank: 3,
        colour: "--curve-3",
        quantities: [],
        fromZero: true,
        values: () => ofFilm(state.film?.images),
        text: () =>
          state.use && state.use.frame === state.frame
            ? shortNumber(state.use.ids.length)
            : shortNumber(state.film?.images[state.frames!.indexOf(state.frame)] ?? 0),
      },
      {
        label: "Rays per element",
        rank: 4,
        colour: "--curve-4",
        quantities: [],
        fromZero: true,
        values: () =>
          ofFilm(state.film?.rays).map((rays) =>
            rays === null ? null : rays / (state.path.width * state.path.height),
          ),
        text: () => {
          const i = state.frames!.indexOf(state.frame);
          if (!state.film || i >= state.film.done) return "…";
          const rays = state.film.rays[i] / (state.path.width * state.path.height);
          return `about ${precise(rays, 3)}`;
        },
      },
    ];
  }

  // ----------------------------------------------------------------------------------- playing

  toggle(): void {
    if (this.playing) return this.stop();
    const { state } = this;
    if (state.frame === state.lastFrame) state.setFrame(state.path.first_frame);
    const begin = performance.now() - 1000 * state.time;
    const step = () => {
      const frame = state.path.first_frame + Math.floor(((performance.now() - begin) * state.path.fps) / 1000);
      state.setFrame(frame);
      if (frame >= state.lastFrame) return this.stop();
      this.playing = requestAnimationFrame(step);
    };
    this.playing = requestAnimationFrame(step);
    state.isPlaying = true;
    this.play.dataset.playing = "yes";
    this.play.setAttribute("aria-label", "Pause");
  }

  stop(): void {
    cancelAnimationFrame(this.playing);
    this.playing = 0;
    if (this.state.isPlaying && this.state.isLive) void this.state.askFrame();
    this.state.isPlaying = false;
    this.play.dataset.playing = "no";
    this.play.setAttribute("aria-label", "Play");
  }

  // -------------------------------------------------------------------------------- the pointer

  private width(): number {
    return Math.max(1, this.canvas.clientWidth - LABELS - MARGIN);
  }
  private xOf(time: number): number {
    const { path } = this.state;
    return LABELS + (path.frames > 1 ? (time * path.fps * this.width()) / (path.frames - 1) : 0);
  }
  private timeOf(x: number): number {
    const { path } = this.state;
    const frames = ((x - LABELS) / this.width()) * (path.frames - 1);
    return Math.max(0, Math.min(path.frames - 1, Math.round(frames))) / path.fps;
  }

  private listenForScrubs(): void {
    const { canvas, state } = this;
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.stop();
      const key = this.keyAt(event.offsetX, event.offsetY);
      this.dragged = key && { key, time: key.time };
      state.setFrame(state.frameAt(key?.time ?? this.timeOf(event.offsetX)));
    });
    canvas.addEventListener("pointermove", (event) => {
      canvas.style.cursor = this.keyAt(event.offsetX, event.offsetY) ? "ew-resize" : "crosshair";
      if (event.buttons === 0) return;
      const time = this.timeOf(event.offsetX);
      state.setFrame(state.frameAt(time));
      if (this.dragged) {
        this.dragged.time = time;
        this.drawMark();
      }
    });
    canvas.addEventListener("pointerup", () => {
      const dragged = this.dragged;
      this.dragged = null;
      if (!dragged || !state.scene.server) return;
      const { key, time } = dragged;
      if (Math.abs(time - key.time) * state.path.fps < 0.5) return;
      state.edit(`move a key of ${key.quantity.name}`, (document) =>
        document.moveKeyframe(key.quantity.name, key.index, round(time)),
      );
    });
  }

  private keyAt(x: number, y: number): Key | null {
    return this.keys.find((key) => Math.hypot(key.x - x, key.y - y) < 8) ?? null;
  }

  // ----------------------------------------------------------------------------------- drawing

  private rowHeight(): number {
    return this.canvas.clientHeight / this.rows.length;
  }

  private findKeys(): void {
    this.keys = [];
    const height = this.rowHeight();
    this.rows.forEach((row, i) => {
      for (const name of row.quantities) {
        let quantity: Quantity;
        try {
          quantity = this.state.document.quantity(name);
        } catch {
          continue; // the text is being edited and is not valid
        }
        const keys = quantity.keyframes.map((key, index) => ({ index, time: key.time }));
        if (quantity.baseIsKey) keys.unshift({ index: -1, time: 0 });
        for (const { index, time } of keys)
          this.keys.push({
            quantity,
            index,
            time,
            sides: sidesOf(quantity, index),
            x: this.xOf(time),
            y: (i + 1) * height - 8,
          });
      }
    });
  }

  private drawAll(): void {
    const { state, canvas } = this;
    if (state.cameras.length === 0) return;
    this.range.min = String(state.path.first_frame);
    this.range.max = String(state.lastFrame);
    const room = Math.floor(canvas.clientHeight / LEAST_HEIGHT);
    this.rows = this.allRows.filter((row) => row.rank < room);
    this.findKeys();
    fitCanvas(canvas);
    this.still.width = canvas.width;
    this.still.height = canvas.height;
    const ratio = canvas.width / Math.max(1, canvas.clientWidth);
    const context = this.still.getContext("2d")!;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
    context.font = "12px system-ui, sans-serif";
    const height = this.rowHeight();
    this.rows.forEach((row, i) => this.drawRow(context, row, i * height, height));
    this.drawMark();
  }

  private drawRow(context: CanvasRenderingContext2D, row: Row, top: number, height: number): void {
    context.fillStyle = cssColour("--line");
    context.fillRect(LABELS, top + height - 1, this.width(), 1);
    context.fillStyle = cssColour("--muted");
    context.fillText(row.label, 8, top + height / 2 - 3);
    const values = row.values();
    const known = values.filter((value): value is number => value !== null);
    if (known.length === 0) return;
    const most = known.reduce((a, b) => Math.max(a, b), -Infinity);
    const least = known.reduce((a, b) => Math.min(a, b), Infinity);
    const isLevel = most - least < 1e-9 * Math.abs(most);
    const base = row.fromZero || isLevel ? 0 : least - 0.15 * (most - least);
    const yOf = (value: number) => top + height - 4 - ((value - base) / (most - base || 1)) * (height - 10);
    context.strokeStyle = cssColour(row.colour);
    context.lineWidth = 1.5;
    context.beginPath();
    let isDown = false;
    const step = Math.max(1, Math.floor(values.length / (2 * this.width())));
    for (let i = 0; i < values.length; i += step) {
      const value = values[i];
      if (value === null) {
        isDown = false;
        continue;
      }
      const x = this.xOf((this.state.frames!.frameOf(i) - this.state.path.first_frame) / this.state.path.fps);
      if (isDown) context.lineTo(x, yOf(value));
      else context.moveTo(x, yOf(value));
      if (values.length === 1) context.lineTo(x + this.width(), yOf(value));
      isDown = true;
    }
    context.stroke();
    for (const key of this.keys)
      if (key.y > top && key.y < top + height) drawKey(context, key, key.x, cssColour(row.colour));
  }

  private drawMark(): void {
    const { state, canvas } = this;
    if (state.cameras.length === 0) return;
    const context = canvas.getContext("2d")!;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, canvas.width, canvas.height);
    context.drawImage(this.still, 0, 0);
    const ratio = canvas.width / Math.max(1, canvas.clientWidth);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const x = this.xOf(state.time);
    context.fillStyle = cssColour("--accent");
    context.fillRect(Math.round(x) - 0.5, 0, 1.5, canvas.clientHeight);
    context.font = "12px system-ui, sans-serif";
    const height = this.rowHeight();
    context.fillStyle = cssColour("--text");
    this.rows.forEach((row, i) => context.fillText(row.text(), 8, i * height + height / 2 + 12));
    if (this.dragged) drawKey(context, this.dragged.key, this.xOf(this.dragged.time), cssColour("--text"));
    this.range.value = String(state.frame);
    this.range.setAttribute(
      "aria-valuetext",
      `frame ${state.frame} of ${state.path.first_frame} to ${state.lastFrame}`,
    );
    this.clock.replaceChildren(
      element("b", {}, `${state.frame}`),
      ` / ${state.lastFrame}`,
      element("span", {}, seconds(state.time)),
    );
  }
}

function round(time: number): number {
  return Math.round(time * 1e6) / 1e6;
}

// Draws the mark of a key: a diamond, whose sides are round where the value is at rest, and flat where it jumps.
function drawKey(context: CanvasRenderingContext2D, { y, sides }: Key, x: number, colour: string): void {
  context.fillStyle = colour;
  context.beginPath();
  context.moveTo(x, y - KEY);
  drawSide(context, sides[1], x, y, 1);
  drawSide(context, sides[0], x, y, -1);
  context.fill();
}

// Continues the outline of a mark: from its top down the right side (sign 1), or from its bottom up the left one (-1).
function drawSide(context: CanvasRenderingContext2D, side: Side, x: number, y: number, sign: number): void {
  if (side === "round") {
    context.arc(x, y, KEY, (-sign * Math.PI) / 2, (sign * Math.PI) / 2);
    return;
  }
  if (side === "flat") {
    context.lineTo(x + sign * (KEY - 1), y - sign * KEY);
    context.lineTo(x + sign * (KEY - 1), y + sign * KEY);
  } else {
    context.lineTo(x + sign * KEY, y);
  }
  context.lineTo(x, y + sign * KEY);
}
