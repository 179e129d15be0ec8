// SPDX-License-Identifier: Apache-2.0
// Types of what a path file contains about quantities and constants, and functions that return their keys in the file.
import type { ConstantSpec, ConstantValue, PathValue, QuantitySpec, Section, Shape, Unit } from "./path_quantities";

export type Interpolation = "smooth" | "ease" | "ease_in" | "ease_out" | "linear" | "step";

export interface Keyframe {
  time: number; // time of the key, seconds
  value: PathValue;
  interpolation: Interpolation; // how the value changes from the previous key to this one
}

export interface Acceleration {
  from: number; // time at which the acceleration begins, seconds
  to: number;
  value: PathValue; // in units of the quantity per second squared
}

// All that the file contains about a quantity. Lengths are in world units, even if the file has millimetres.
export interface Quantity {
  name: string; // without unit, such as "focus_distance"
  key: string; // as in the file, or as a new entry would be written, such as "focus_distance_mm"
  section: Section;
  unit: Unit;
  shape: Shape;
  worldPerFile: number; // a number of `key` in the file times this factor is in world units; 1 if it is no length
  given: boolean; // true if the file contains a value, keys, a speed or accelerations
  base?: PathValue; // the value in its section, which holds at time 0; undefined: none
  keyframes: Keyframe[]; // the keys listed in the file, in its order
  baseIsKey: boolean; // true if the base is a key at time 0, before the listed keys; its index is -1
  speed?: PathValue;
  accelerations: Acceleration[];
  hasAccelerations: boolean; // true if it has a speed or accelerations; keys can be added only after removeMotion()
}

// Returns the key of a new entry: `name` if it is a key with the unit mm, otherwise the most common key.
export function newKey(keys: readonly string[], name: string): string {
  return name.endsWith("_mm") && keys.includes(name) ? name : keys[0];
}

// Returns the keys of a quantity's speed: "speed" for "position", "<name>_speed" for other quantities, with the endings
// of their units.
export function speedKeys(spec: QuantitySpec): string[] {
  const speed = spec.name === "position" ? "speed" : `${spec.name}_speed`;
  return spec.keys.map((key) => speed + key.slice(spec.name.length));
}

export function sectionPath(spec: ConstantSpec): string[] {
  return spec.section ? [spec.section] : [];
}

export function checkTime(time: number): void {
  if (!(time >= 0 && time <= 1e9)) throw new Error(`A key's time is 0 s or later, not ${time}`);
}

export function checkConstant(name: string, spec: ConstantSpec, value: ConstantValue): void {
  const fits = {
    number: typeof value === "number" && Number.isFinite(value),
    integer: typeof value === "number" && Number.isInteger(value),
    numbers: Array.isArray(value) && value.length === spec.count && value.every(Number.isFinite),
    word: typeof value === "string" && /^[a-z_]+$/.test(value),
    boolean: typeof value === "boolean",
  }[spec.kind];
  const expected =
    spec.kind === "numbers" ? `${spec.count} numbers` : spec.kind === "integer" ? "a whole number" : `a ${spec.kind}`;
  if (!fits) throw new Error(`${name}: expected ${expected}, found ${JSON.stringify(value)}`);
}
