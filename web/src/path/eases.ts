// SPDX-License-Identifier: Apache-2.0
// Chooses how values move between keys when keys are added and deleted (doc/formats/path.md, "Ease in, ease out").

import type { PathDocument } from "./path_document";
import type { Interpolation, Quantity } from "./path_facts";
import type { PathValue } from "./path_quantities";

export const INTERPOLATIONS: readonly Interpolation[] = ["smooth", "ease", "ease_in", "ease_out", "linear", "step"];

const leaves = (word: Interpolation) => word === "ease" || word === "ease_in"; // from rest
const arrives = (word: Interpolation) => word === "ease" || word === "ease_out"; // at rest

// Sets the value of the key at this time, or adds a key:
//   at the end of the film     from the key before, the value eases from rest to rest
//   between two keys           the movement between these goes through the new key without a stop, and still begins and
//                              ends as it did
//   before all keys            the value eases to the key that was the first
export function setEasedKey(path: PathDocument, name: string, time: number, value: PathValue): void {
  path.edit(() => {
    const count = path.quantity(name).keyframes.length;
    path.setKeyframe(name, time, value);
    const { keyframes, baseIsKey } = path.quantity(name);
    if (keyframes.length === count) return; // a key was changed, or the value at time 0
    const index = keyframes.reduce(
      (best, key, i) => (distance(key, time) < distance(keyframes[best], time) ? i : best),
      0,
    );
    const isFirst = index === 0 && !baseIsKey;
    const next = keyframes[index + 1];
    if (!next) {
      if (!isFirst) path.setInterpolation(name, index, "ease");
    } else if (isFirst) {
      if (next.interpolation === "smooth") path.setInterpolation(name, index + 1, "ease");
    } else {
      const [before, after] = split(next.interpolation);
      path.setInterpolation(name, index, before);
      path.setInterpolation(name, index + 1, after);
    }
  });
}

function distance(key: { time: number }, time: number): number {
  return Math.abs(key.time - time);
}

// Returns the interpolations of a new key and of the key after it, which had the interpolation `word` before.
function split(word: Interpolation): [Interpolation, Interpolation] {
  if (word === "ease") return ["ease_in", "ease_out"];
  if (word === "ease_in") return ["ease_in", "smooth"];
  if (word === "ease_out") return ["smooth", "ease_out"];
  return [word, word];
}

// Deletes a key, as PathDocument.deleteKeyframe() does. A value that left the key before from rest still does, unless a
// line or a step leads to the key after; one that came to rest at the key after still does.
export function deleteKey(path: PathDocument, name: string, index: number): void {
  path.edit(() => {
    const { keyframes, baseIsKey } = path.quantity(name);
    const next = keyframes[index + 1];
    const hasBefore = index > 0 || (index === 0 && baseIsKey);
    path.deleteKeyframe(name, index);
    if (!hasBefore || !next || !leaves(keyframes[index].interpolation)) return;
    if (next.interpolation === "smooth") path.setInterpolation(name, index, "ease_in");
    if (next.interpolation === "ease_out") path.setInterpolation(name, index, "ease");
  });
}

export type Side = "corner" | "round" | "flat";

// Returns the shapes of the left and the right half of a key's mark: round if the value comes to rest at the key, or
// leaves it from rest; flat if it jumps; otherwise a corner.
export function sidesOf({ keyframes, baseIsKey }: Quantity, index: number): [Side, Side] {
  const own = keyframes[index]?.interpolation ?? "smooth";
  const next = keyframes[index + 1]?.interpolation ?? "smooth";
  const hasBefore = index > 0 || (index === 0 && baseIsKey);
  const left = !hasBefore ? "corner" : arrives(own) ? "round" : own === "step" ? "flat" : "corner";
  return [left, leaves(next) ? "round" : "corner"];
}
