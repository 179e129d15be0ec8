// SPDX-License-Identifier: Apache-2.0
// Tests how keys that are added and deleted change the movement between their neighbours.
import assert from "node:assert/strict";
import { test } from "node:test";

import { deleteKey, INTERPOLATIONS, setEasedKey, sidesOf } from "../../src/path/eases";
import { PathDocument } from "../../src/path/path_document";
import type { Interpolation } from "../../src/path/path_facts";
import { kSmall, near, readByPrograms } from "./real_parser";

const NAME = "focus_distance";
const words = (path: PathDocument): Interpolation[] => path.quantity(NAME).keyframes.map((key) => key.interpolation);
const withKeys = (keys: string): PathDocument =>
  PathDocument.parse(`${kSmall.replace(/ *focus_distance.*\n/, "")}keyframes:\n  focus_distance: [${keys}]  # kept\n`);
const focusOf = (path: PathDocument): number[] =>
  readByPrograms(path.text()).cameras.map((camera) => camera.focus_distance_w);

test("a key after all others eases from rest to rest", () => {
  const path = PathDocument.parse(kSmall);
  const from = path.quantity(NAME).base as number;
  setEasedKey(path, NAME, 1, from + 1);
  assert.deepEqual(words(path), ["ease"]);
  const shares = [0, 0.00856, 0.05792, 0.16308, 0.31744, 0.5];
  shares.forEach((share, i) => near(focusOf(path)[i], from + share, 1e-9));
  setEasedKey(path, NAME, 1.5, from);
  assert.deepEqual(words(path), ["ease", "ease"]);
  // A key that is there keeps its word.
  path.setInterpolation(NAME, 0, "linear");
  setEasedKey(path, NAME, 1, from + 2);
  setEasedKey(path, NAME, 0, from + 1);
  assert.deepEqual(words(path), ["linear", "ease"]);
  near(focusOf(path)[5], from + 1.5, 1e-9);
});

test("the first key of all says nothing, and one before all others makes these ease", () => {
  const path = withKeys("{time: 1, value: 0.5}");
  setEasedKey(path, NAME, 0, 0.3);
  assert.deepEqual(words(path), ["smooth", "ease"]);
  assert.match(path.text(), /\[\{time: 0, value: 0.3\}, \{time: 1, value: 0.5, interpolation: ease\}\] {2}# kept/);
  const line = withKeys("{time: 1, value: 0.50, interpolation: linear}");
  setEasedKey(line, NAME, 0, 0.3);
  assert.match(line.text(), /\{time: 0, value: 0.3\}, \{time: 1, value: 0.50, interpolation: linear\}/);
});

const SPLITS: [Interpolation, Interpolation, Interpolation][] = [
  ["ease", "ease_in", "ease_out"],
  ["ease_in", "ease_in", "smooth"],
  ["ease_out", "smooth", "ease_out"],
  ["smooth", "smooth", "smooth"],
  ["linear", "linear", "linear"],
  ["step", "step", "step"],
];

test("a key between two others is passed without a stop, and deleting it restores the movement", () => {
  assert.deepEqual(SPLITS.map(([word]) => word).sort(), [...INTERPOLATIONS].sort());
  for (const [word, before, after] of SPLITS) {
    const path = withKeys(`{time: 0, value: 0.3}, {time: 2, value: 0.50, interpolation: ${word}}`);
    const whole = focusOf(path);
    setEasedKey(path, NAME, 1, 0.4);
    assert.deepEqual(words(path), ["smooth", before, after], word);
    assert.match(path.text(), /value: 0.50/); // the number of the neighbour is not written anew
    const parts = focusOf(path);
    near(parts[10], 0.4, 1e-9);
    // Both ends are at rest as before: the first tenth of a second, and the last one.
    for (const [a, b] of [
      [0, 1],
      [19, 20],
    ]) {
      const isAtRest = Math.abs(whole[b] - whole[a]) < 0.001;
      if (word !== "step") assert.equal(Math.abs(parts[b] - parts[a]) < 0.002, isAtRest, `${word}, ${a}`);
    }
    if (word.startsWith("ease")) assert.ok(parts[11] - parts[9] > 0.01, `${word} stops: ${parts.join(" ")}`);
    deleteKey(path, NAME, 1);
    assert.deepEqual(words(path), ["smooth", word], word);
    assert.deepEqual(focusOf(path), whole);
  }
});

test("deleting a key at an end leaves the words of the others", () => {
  const text =
    "{time: 0, value: 0.3}, {time: 1, value: 0.4, interpolation: ease}, {time: 2, value: 0.5, interpolation: step}";
  const path = withKeys(text);
  deleteKey(path, NAME, 2);
  assert.deepEqual(words(path), ["smooth", "ease"]);
  deleteKey(path, NAME, 0);
  assert.deepEqual(words(path), ["ease"]);
  assert.throws(() => deleteKey(path, NAME, 3), /no keyframe/);
  assert.throws(() => path.setInterpolation(NAME, 3, "ease"), /no keyframe/);
});

test("the mark of a key is round where the value is at rest", () => {
  const path = withKeys(
    "{time: 0, value: 0.3, interpolation: ease}, {time: 1, value: 0.4, interpolation: ease_in}, " +
      "{time: 2, value: 0.5, interpolation: ease_out}, {time: 3, value: 0.5, interpolation: step}",
  );
  assert.deepEqual(
    [0, 1, 2, 3].map((i) => sidesOf(path.quantity(NAME), i)),
    [
      ["corner", "round"],
      ["corner", "corner"],
      ["round", "corner"],
      ["flat", "corner"],
    ],
  );
  const later = PathDocument.parse(kSmall);
  setEasedKey(later, NAME, 1, 0.9);
  assert.deepEqual(sidesOf(later.quantity(NAME), -1), ["corner", "round"]);
  assert.deepEqual(sidesOf(later.quantity(NAME), 0), ["round", "corner"]);
});
