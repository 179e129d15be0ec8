// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { dolly, focusPull, orbit } from "../../src/path/generators";
import { PathDocument } from "../../src/path/path_document";
import { assertOtherLinesKept, example, kExamples, kSmall, near, readByPrograms } from "./real_parser";

type Vector = number[];

const minus = (a: Vector, b: Vector): Vector => a.map((x, i) => x - b[i]);
const dot = (a: Vector, b: Vector): number => a.reduce((sum, x, i) => sum + x * b[i], 0);
const unit = (a: Vector): Vector => a.map((x) => x / Math.hypot(...a));

interface Orbit {
  centre: Vector;
  axis: Vector;
  startPosition: Vector;
  degrees: number;
  seconds: number;
  start?: number;
}

// Checks that the camera is on the circle in every frame, looks at the centre, and ends at the
// right position.
function checkOrbit(text: string, options: Orbit): PathDocument {
  const path = PathDocument.parse(text);
  orbit(path, options);
  const film = readByPrograms(path.text());
  const axis = unit(options.axis);
  const parts = (position: Vector): { height: number; radius: number; arm: Vector } => {
    const arm = minus(position, options.centre);
    const height = dot(arm, axis);
    return {
      height,
      radius: Math.hypot(
        ...minus(
          arm,
          axis.map((x) => x * height),
        ),
      ),
      arm,
    };
  };
  const first = parts(options.startPosition);
  for (const camera of film.cameras) {
    const { height, radius, arm } = parts(camera.position_w);
    near(radius, first.radius, 0.002 * first.radius);
    near(height, first.height, 0.002 * first.radius);
    near(dot(camera.forward, unit(arm)), -1, 1e-7);
  }
  // The expected position by Rodrigues' rotation of the start.
  const end = film.cameras[Math.round((options.seconds + (options.start ?? 0)) * film.fps)];
  const angle = (options.degrees * Math.PI) / 180;
  const k = axis,
    v = first.arm;
  const cross = [k[1] * v[2] - k[2] * v[1], k[2] * v[0] - k[0] * v[2], k[0] * v[1] - k[1] * v[0]];
  const expected = v.map(
    (x, i) =>
      options.centre[i] + x * Math.cos(angle) + cross[i] * Math.sin(angle) + k[i] * dot(k, v) * (1 - Math.cos(angle)),
  );
  for (let i = 0; i < 3; ++i) near(end.position_w[i], expected[i], 1e-4 * first.radius);
  return path;
}

test("an orbit keeps within 0.2 % of its radius, at an even speed", () => {
  const path = checkOrbit(kSmall, {
    centre: [0, 0, 0],
    axis: [0, -1, 0],
    startPosition: [0, -0.1, -0.4],
    degrees: 360,
    seconds: 4,
  });
  assert.equal(path.constant("frames"), 41);
  assertOtherLinesKept(kSmall, path.text(), [5, 8]);
  const { cameras } = readByPrograms(path.text());
  const steps = cameras.slice(1).map((camera, i) => Math.hypot(...minus(camera.position_w, cameras[i].position_w)));
  for (const step of steps) near(step, 2 * 0.4 * Math.sin(Math.PI / 40), 0.002 * 0.4);
});

test("orbits of all kinds are on their circles", () => {
  const shapes: Orbit[] = [
    { centre: [0.1, 0, 0.3], axis: [0, 2, 0], startPosition: [0.1, 0, -0.4], degrees: -30, seconds: 2 },
    { centre: [0, 0, 0], axis: [1, 0.5, 0], startPosition: [0.05, 0.1, -0.4], degrees: 170, seconds: 1.37 },
    { centre: [0, 0, 0], axis: [1, 0, 0], startPosition: [0, 0.01, -0.4], degrees: 360, seconds: 3 },
    { centre: [0, 0, 0], axis: [0, -1, 0], startPosition: [0, 0, -0.4], degrees: 5, seconds: 1 },
    { centre: [0, 0, 0], axis: [0, -1, 0], startPosition: [0, 0, -0.4], degrees: 90, seconds: 1, start: 0.5 },
    { centre: [4e5, 5e6, 20], axis: [0, 0, 1], startPosition: [4e5 + 3, 5e6, 22], degrees: 720, seconds: 5 },
  ];
  for (const shape of shapes) checkOrbit(kSmall, shape);
  // Focus points stay in front of a camera that looks at the centre from all sides.
  for (const name of kExamples) checkOrbit(example(name), shapes[0]);
  checkOrbit(example("slide").replace("follow: look_at ", "follow: direction "), shapes[0]);
  checkOrbit(
    kSmall
      .replace("  position:", "  position_mm:")
      .replace("-0.40", "-400")
      .replace("frames:", "unit_m: 0.01\nframes:"),
    shapes[1],
  );
});

test("an orbit goes round upright", () => {
  const path = PathDocument.parse(kSmall);
  orbit(path, { centre: [0, 0, 0], axis: [1, 0, 0], startPosition: [0, 0, -0.4], degrees: 180, seconds: 2 });
  for (const camera of readByPrograms(path.text()).cameras) near(camera.up[0], 1, 1e-9);
  const other = PathDocument.parse(kSmall);
  orbit(other, { centre: [0, 0, 0], axis: [0, 1, 0], startPosition: [0, 0, -0.4], degrees: 180, seconds: 2 });
  for (const camera of readByPrograms(other.text()).cameras) near(camera.up[1], -1, 1e-9);
});

test("an orbit on its axis or without an angle is refused, and changes nothing", () => {
  const path = PathDocument.parse(kSmall);
  const options = { centre: [0, 0, 0], axis: [0, 0, 1], startPosition: [0, 0, -0.4], degrees: 90, seconds: 1 };
  assert.throws(() => orbit(path, options), /beside its axis/);
  assert.throws(() => orbit(path, { ...options, axis: [0, 0, 0] }), /direction/);
  assert.throws(() => orbit(path, { ...options, axis: [0, 1, 0], degrees: 0 }), /angle/);
  assert.throws(() => orbit(path, { ...options, axis: [0, 1, 0], seconds: 0 }), /more than 0/);
  assert.equal(path.text(), kSmall);
});

test("a dolly goes straight, evenly, and the film is not cut", () => {
  for (const start of [0, 0.5]) {
    const path = PathDocument.parse(kSmall);
    const label = dolly(path, { from: [0, 0, -0.5], to: [0.1, 0, -0.3], seconds: 1, start });
    assert.match(label, /Dolly/);
    assert.equal(path.constant("frames"), 21);
    const { cameras } = readByPrograms(path.text());
    near(cameras[0].position_w[2], -0.5, 1e-12);
    near(cameras[5 + 10 * start].position_w[0], 0.05, 1e-9);
    near(cameras[5 + 10 * start].position_w[2], -0.4, 1e-9);
    near(cameras[20].position_w[0], 0.1, 1e-12);
  }
  const slide = PathDocument.parse(example("slide"));
  dolly(slide, { from: [0, 0, -0.5], to: [0.1, 0, -0.3], seconds: 4 });
  assert.equal(slide.constant("frames"), 121);
  near(readByPrograms(slide.text()).cameras[120].position_w[0], 0.1, 1e-12);
});

test("a focus pull rests, goes over and rests", () => {
  for (const name of kExamples) {
    const path = PathDocument.parse(example(name));
    focusPull(path, { from: 0.3, to: 0.6, seconds: 2, hold: 1 });
    const { fps, cameras } = readByPrograms(path.text());
    assert.ok(cameras.length >= 4 * fps + 1);
    const at = (time: number): number => cameras[Math.round(time * fps)].focus_distance_w;
    near(at(0), 0.3, 1e-9);
    near(at(1), 0.3, 1e-9);
    assert.ok(at(2) > 0.3 && at(2) < 0.6);
    near(at(3), 0.6, 1e-9);
    near(at(4), 0.6, 1e-9);
  }
  const path = PathDocument.parse(kSmall);
  focusPull(path, { from: 0.3, to: 0.6, seconds: 2 });
  assertOtherLinesKept(kSmall, path.text(), [16]);
  near(readByPrograms(path.text()).cameras[10].focus_distance_w, 0.45, 1e-9);
});
