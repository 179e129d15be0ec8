// SPDX-License-Identifier: Apache-2.0
// Describes the contents of a path file (doc/formats/path.md): quantities, which may change over time, and constants.
// Reads, checks and writes their values.

export type Section = "camera" | "lens";
export type Unit = "length" | "degrees" | "none";
export type Shape = "number" | "point" | "tilt" | "angles" | "quaternion";

// A value by its shape: a number, [x, y, z], [w, x, y, z], {horizontal, vertical} or {yaw, pitch, roll}. Lengths are in
// world units, angles in degrees.
export type PathValue = number | number[] | Record<string, number>;

export interface QuantitySpec {
  name: string; // without the unit at its end
  keys: string[]; // possible keys in a file; the first is used for a new entry
  section: Section;
  unit: Unit;
  shape: Shape;
  above?: number; // every component must be above this
  below?: number;
  least?: number; // every component must be at least this
  zeroIfNotGiven?: boolean;
  rivals: string[]; // names of alternatives: a file may contain only one of them or this quantity
  freeWithoutSensor?: boolean; // rivals are allowed if the file has no sensor_width
}

interface SpecOptions {
  shape?: Shape;
  above?: number;
  below?: number;
  least?: number;
  zeroIfNotGiven?: boolean;
  rivals?: string[];
  freeWithoutSensor?: boolean;
}

function length(section: Section, name: string, millimetres: boolean, options: SpecOptions): QuantitySpec {
  const keys = millimetres ? [`${name}_mm`, name] : [name, `${name}_mm`];
  return { name, keys, section, unit: "length", shape: "number", rivals: [], ...options };
}

function degrees(section: Section, name: string, options: SpecOptions): QuantitySpec {
  return { name, keys: [`${name}_deg`], section, unit: "degrees", shape: "number", rivals: [], ...options };
}

function plain(section: Section, name: string, options: SpecOptions): QuantitySpec {
  return { name, keys: [name], section, unit: "none", shape: "number", rivals: [], ...options };
}

// All quantities, in the order of doc/formats/path.md.
export const kQuantities: readonly QuantitySpec[] = [
  length("camera", "position", false, { shape: "point" }),
  length("camera", "look_at", false, { shape: "point", rivals: ["orientation", "quaternion"] }),
  plain("camera", "orientation", { shape: "angles", rivals: ["look_at", "quaternion"] }),
  plain("camera", "quaternion", { shape: "quaternion", rivals: ["look_at", "orientation"] }),
  degrees("camera", "roll", { zeroIfNotGiven: true }),
  length("camera", "focal_length", true, { above: 0, rivals: ["field_of_view"], freeWithoutSensor: true }),
  degrees("camera", "field_of_view", { above: 0, below: 180, rivals: ["focal_length"], freeWithoutSensor: true }),
  length("camera", "shift", true, { shape: "tilt", zeroIfNotGiven: true }),
  length("lens", "aperture_diameter", true, { least: 0, rivals: ["f_number"] }),
  plain("lens", "f_number", { above: 0, rivals: ["aperture_diameter"] }),
  length("lens", "focus_distance", false, { above: 0, rivals: ["focus_point"] }),
  length("lens", "focus_point", false, { shape: "point", rivals: ["focus_distance"] }),
  degrees("lens", "focus_tilt", { shape: "tilt", above: -90, below: 90, zeroIfNotGiven: true }),
  degrees("lens", "blade_rotation", { zeroIfNotGiven: true }),
];

export interface ConstantSpec {
  keys: string[];
  section?: Section; // unset: the root of the file
  unit: Unit;
  kind: "number" | "integer" | "numbers" | "word" | "boolean";
  count?: number; // number of components, if kind is "numbers"
}

export type ConstantValue = number | number[] | string | boolean;

export const kConstants: Readonly<Record<string, ConstantSpec>> = {
  fps: { keys: ["fps"], unit: "none", kind: "number" },
  frames: { keys: ["frames"], unit: "none", kind: "integer" },
  resolution: { keys: ["resolution"], unit: "none", kind: "numbers", count: 2 },
  unit_m: { keys: ["unit_m"], unit: "none", kind: "number" },
  sensor_width: { keys: ["sensor_width_mm", "sensor_width"], section: "camera", unit: "length", kind: "number" },
  up: { keys: ["up"], section: "camera", unit: "none", kind: "numbers", count: 3 },
  follow: { keys: ["follow"], section: "camera", unit: "none", kind: "word" },
  breathing: { keys: ["breathing"], section: "lens", unit: "none", kind: "boolean" },
  blades: { keys: ["blades"], section: "lens", unit: "none", kind: "integer" },
  blade_roundness: { keys: ["blade_roundness"], section: "lens", unit: "none", kind: "number" },
  ratio: { keys: ["ratio"], section: "lens", unit: "none", kind: "number" },
  hood_distance: { keys: ["hood_distance", "hood_distance_mm"], section: "lens", unit: "length", kind: "number" },
  hood_diameter: { keys: ["hood_diameter_mm", "hood_diameter"], section: "lens", unit: "length", kind: "number" },
  blade_rotation_per_stop: { keys: ["blade_rotation_per_stop_deg"], section: "lens", unit: "none", kind: "number" },
};

export function withoutUnit(name: string): string {
  return name.replace(/_(mm|deg)$/, "");
}

export function quantitySpec(name: string): QuantitySpec {
  const spec = kQuantities.find((candidate) => candidate.name === withoutUnit(name));
  if (!spec) throw new Error(`A path has no quantity '${name}'`);
  return spec;
}

export function constantSpec(name: string): ConstantSpec {
  const spec = kConstants[withoutUnit(name)];
  if (!spec) throw new Error(`A path has no constant '${name}'`);
  return spec;
}

// Returns the names of a value's components: an empty list for a number, indices for a list.
export function componentNames(shape: Shape): string[] {
  switch (shape) {
    case "number":
      return [];
    case "point":
      return ["0", "1", "2"];
    case "quaternion":
      return ["0", "1", "2", "3"];
    case "tilt":
      return ["horizontal", "vertical"];
    case "angles":
      return ["yaw", "pitch", "roll"];
  }
}

export function zeroOf(shape: Shape): PathValue {
  const names = componentNames(shape);
  if (names.length === 0) return 0;
  if (shape === "point" || shape === "quaternion") return names.map(() => 0);
  return Object.fromEntries(names.map((name) => [name, 0]));
}

// Returns a value of a file with every number multiplied by `scale`. Throws if it has another shape; the message begins
// with `label`. Missing components of tilts and angles are 0.
export function readValue(raw: unknown, label: string, shape: Shape, scale: number): PathValue {
  const number = (x: unknown): number => {
    if (typeof x !== "number" || !Number.isFinite(x))
      throw new Error(`${label}: expected a number, found ${JSON.stringify(x) ?? "nothing"}`);
    return x * scale;
  };
  if (shape === "number") return number(raw);
  const names = componentNames(shape);
  if (shape === "point" || shape === "quaternion") {
    if (!Array.isArray(raw) || raw.length !== names.length)
      throw new Error(`${label}: expected ${names.length} numbers in brackets`);
    return raw.map(number);
  }
  if (typeof raw !== "object" || raw === null || Array.isArray(raw))
    throw new Error(`${label}: expected {${names.join(", ")}}`);
  const given = raw as Record<string, unknown>;
  return Object.fromEntries(names.map((name) => [name, number(given[name] ?? 0)]));
}

// Throws an Error, with a message for people, if the programs would refuse the value.
export function checkValue(value: PathValue, spec: QuantitySpec): void {
  const read = readValue(value, spec.name, spec.shape, 1);
  const components = typeof read === "number" ? [read] : Object.values(read);
  for (const x of components) {
    const wrong =
      spec.above !== undefined && x <= spec.above
        ? `above ${spec.above}`
        : spec.below !== undefined && x >= spec.below
          ? `below ${spec.below}`
          : spec.least !== undefined && x < spec.least
            ? `${spec.least} or more`
            : Math.abs(x) > 1e9
              ? "within 1e9"
              : undefined;
    if (wrong) throw new Error(`${spec.name}: ${writeNumber(x)} must be ${wrong}`);
  }
  if (spec.shape === "quaternion" && Math.abs(Math.hypot(...components) - 1) > 0.01)
    throw new Error("quaternion: a rotation [w, x, y, z] has length 1");
}

// Returns a number with six significant digits, or with up to 15 if the resolution needs them.
export function writeNumber(x: number, resolution = 0): string {
  const digits = resolution > 0 && x !== 0 ? Math.ceil(Math.log10(Math.abs(x) / resolution)) : 0;
  const rounded = Number(x.toPrecision(Math.min(15, Math.max(6, digits))));
  return rounded === 0 ? "0" : String(rounded); // not "-0"
}

// Returns a time rounded to a microsecond, the least distance between two keys.
export function writeTime(time: number): string {
  return String(Number(time.toFixed(6)));
}

// Returns a value as YAML, every number divided by `scale`; lists and maps are in brackets.
export function writeValue(value: PathValue, scale = 1, resolution = 0): string {
  const number = (x: number, largest: number): string =>
    // Writes 0 for the rounding errors of sines and cosines of right angles.
    Math.abs(x) < 1e-9 * largest ? "0" : writeNumber(x / scale, resolution / scale);
  if (typeof value === "number") return number(value, 0);
  const components = Object.values(value);
  const largest = Math.max(...components.map(Math.abs));
  const written = components.map((x) => number(x, largest));
  if (Array.isArray(value)) return `[${written.join(", ")}]`;
  return `{${Object.keys(value)
    .map((name, i) => `${name}: ${written[i]}`)
    .join(", ")}}`;
}
