// Facts that a path file states about quantities and constants, and the keys under which it states them.
import type { ConstantSpec, ConstantValue, PathValue, QuantitySpec, Section, Shape, Unit } from "./path_quantities";

export type Interpolation = "smooth" | "linear" | "step";

export interface Keyframe {
  time: number; // seconds
  value: PathValue;
  interpolation: Interpolation; // from the previous key to this one
}

export interface Acceleration {
  from: number; // seconds
  to: number;
  value: PathValue; // per second squared
}

// Facts that the file states about a quantity. Lengths are in world units, whatever the file uses.
export interface Quantity {
  name: string; // without unit: "focus_distance"
  key: string; // as in the file, or as it would be written: "focus_distance_mm"
  section: Section;
  unit: Unit;
  shape: Shape;
  worldPerFile: number; // factor from numbers beside `key` in the file to those here
  given: boolean; // the file states something about it
  base?: PathValue; // the value in its section, at time 0
  keyframes: Keyframe[]; // in the order of the file; without the base
  baseIsKey: boolean; // the base is a key at time 0 before the listed ones: index -1
  speed?: PathValue;
  accelerations: Acceleration[];
  hasAccelerations: boolean; // it has a speed or accelerations: keyframes need removeMotion() first
}

// Returns a key for a file without one: in the requested unit, or in the most common one.
export function newKey(keys: readonly string[], name: string): string {
  return name.endsWith("_mm") && keys.includes(name) ? name : keys[0];
}

// The speed of "position" is "speed", that of other quantities "<name>_speed".
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
