// SPDX-License-Identifier: Apache-2.0
// A camera path (doc/formats/path.md) that a person can edit as text and with the mouse. An edit changes only the lines
// that it concerns; the rest of the file keeps its text and comments.
import {
  checkValue,
  constantSpec,
  kQuantities,
  quantitySpec,
  readValue,
  withoutUnit,
  writeTime,
  writeValue,
  zeroOf,
} from "./path_quantities";
import type { ConstantValue, PathValue, QuantitySpec, Unit } from "./path_quantities";
import { checkConstant, checkTime, newKey, sectionPath, speedKeys } from "./path_facts";
import type { Acceleration, Interpolation, Keyframe, Quantity } from "./path_facts";
import { YamlText } from "./yaml_text";

const kLeastKeyDistance_s = 1e-6;

export class PathDocument {
  // Lengths are written with at least this precision, in world units, even far from the origin.
  resolution_w: number;
  addsKeys = false; // true: setAtTime() also adds keys to quantities that have none

  private constructor(
    private readonly yaml: YamlText,
    private readonly lightFieldUnit: number,
  ) {
    this.resolution_w = 1e-4 / this.unitM();
  }

  // unit_m  metres per world unit of the light field; used if the file has no unit_m
  // Throws an Error with line and column if the text is no YAML. Does not check whether the path is valid: the parser
  // of the programs does that.
  static parse(text: string, unit_m = 1): PathDocument {
    return new PathDocument(new YamlText(text), unit_m);
  }

  text(): string {
    return this.yaml.text;
  }

  unitM(): number {
    const unit = this.yaml.value(["unit_m"]);
    return typeof unit === "number" && unit > 0 ? unit : this.lightFieldUnit;
  }

  // Returns the names of all quantities, in the order of the tables in doc/formats/path.md.
  static quantityNames(): string[] {
    return kQuantities.map((spec) => spec.name);
  }

  // Returns the quantity with this name (with or without a unit). Throws if its value in the file has a wrong form.
  quantity(name: string): Quantity {
    const spec = quantitySpec(name);
    const section = this.keyIn([spec.section], spec.keys);
    const list = this.keyIn(["keyframes"], spec.keys);
    const key = section ?? list ?? newKey(spec.keys, name);
    const base = section === undefined ? undefined : this.read(spec, [spec.section, section], section);
    const keyframes = list ? this.readKeyframes(spec, list) : [];
    const speedKey = this.keyIn([spec.section], speedKeys(spec));
    const speed = speedKey === undefined ? undefined : this.read(spec, [spec.section, speedKey], speedKey);
    const accelerations = this.readAccelerations(spec);
    const hasAccelerations = speed !== undefined || accelerations.length > 0;
    return {
      name: spec.name,
      key,
      section: spec.section,
      unit: spec.unit,
      shape: spec.shape,
      worldPerFile: this.scale(spec.unit, key),
      given: section !== undefined || list !== undefined || hasAccelerations,
      base,
      keyframes,
      baseIsKey: base !== undefined && keyframes.length > 0 && keyframes[0].time >= kLeastKeyDistance_s,
      speed,
      accelerations,
      hasAccelerations,
    };
  }

  constant(name: string): ConstantValue | undefined {
    const spec = constantSpec(name);
    const key = this.keyIn(sectionPath(spec), spec.keys);
    if (!key) return undefined;
    const value = this.yaml.value([...sectionPath(spec), key]) as ConstantValue;
    if (typeof value === "number") return value * this.scale(spec.unit, key);
    return name === "fps" && typeof value === "string" ? rateOf(value) : value;
  }

  // ------------------------------------------------------------------------------------ edits
  // If an edit fails, it throws an Error that can be shown to the user, and changes nothing.

  // Sets the value of the key at this time, or adds a key. Two times are taken to be the same if they differ by less
  // than a thousandth of a second and less than a tenth of a frame, so that a rounded time is found. At time 0, the
  // value in the section is set, if there is one. If `interpolation` is not given, an existing key keeps its
  // interpolation, and a new key is smooth.
  setKeyframe(name: string, time: number, value: PathValue, interpolation?: Interpolation): void {
    this.edit(() => {
      const spec = quantitySpec(name);
      checkTime(time);
      checkValue(value, spec);
      this.refuseContradiction(spec);
      this.refuseMotion(name);
      if (spec.name === "look_at") this.refuseKeptDirection();
      const { base, keyframes, given } = this.quantity(name);
      const index = keyframes.findIndex((key) => this.isSameTime(key.time, time));
      if (index >= 0) {
        this.changeKeyframe(spec, index, value, interpolation);
      } else if (base !== undefined && this.isSameTime(time, 0)) {
        this.writeBase(spec, name, value);
      } else {
        // A quantity that is 0 by default must keep this value at time 0. If the file does not give the quantity yet,
        // and this key is later, the value 0 is therefore written to the section of the quantity.
        if (!given && spec.zeroIfNotGiven && !this.isSameTime(time, 0)) this.writeBase(spec, name, zeroOf(spec.shape));
        this.insertKeyframe(spec, { time, value, interpolation: interpolation ?? "smooth" });
      }
    });
  }

  // Sets how the value gets to a key from the key before. Only this word of the text changes.
  setInterpolation(name: string, index: number, interpolation: Interpolation): void {
    this.edit(() => {
      const spec = quantitySpec(name);
      const list = this.keyIn(["keyframes"], spec.keys);
      if (!list || !this.quantity(name).keyframes[index])
        throw new Error(`${spec.name} has no keyframe ${index + 1} in the list of keyframes`);
      const item = ["keyframes", list, index];
      if (this.yaml.has([...item, "interpolation"])) this.yaml.replace([...item, "interpolation"], interpolation);
      else if (interpolation !== "smooth") this.yaml.add(item, "interpolation", interpolation);
    });
  }

  // Replaces all keys of the quantity, including the value in its section. There must be at least one key, and times
  // must ascend.
  setKeyframes(name: string, keyframes: readonly Keyframe[]): void {
    this.edit(() => {
      const spec = quantitySpec(name);
      if (keyframes.length === 0) throw new Error(`${spec.name}: expected keyframes`);
      this.refuseContradiction(spec);
      this.refuseMotion(name);
      if (spec.name === "look_at") this.refuseKeptDirection();
      keyframes.forEach((key, i) => {
        checkTime(key.time);
        checkValue(key.value, spec);
        if (i > 0 && key.time - keyframes[i - 1].time < kLeastKeyDistance_s)
          throw new Error(`${spec.name}: the key at ${key.time} s is not after the one before`);
      });
      const key = this.quantity(name).key;
      this.removeKey(["keyframes"], spec.keys);
      this.addKeyframeList(
        key,
        keyframes.map((keyframe) => this.writeKeyframe(spec, key, keyframe)),
      );
      this.removeKey([spec.section], spec.keys);
    });
  }

  // Moves a key to another time, which may be beyond other keys. Index -1 is the base (Quantity.base), if it is a key.
  // Returns the new index of the key. Throws if another key is at that time.
  moveKeyframe(name: string, index: number, time: number): number {
    let moved = index;
    this.edit(() => {
      const spec = quantitySpec(name);
      checkTime(time);
      const quantity = this.quantity(name);
      const key = this.keyframeAt(quantity, index);
      const others = quantity.keyframes.filter((_, i) => i !== index);
      const taken = [...others.map((other) => other.time), ...(quantity.baseIsKey && index >= 0 ? [0] : [])];
      if (taken.some((other) => Math.abs(other - time) < 2 * kLeastKeyDistance_s))
        throw new Error(`${spec.name} has a key at ${writeTime(time)} s already`);
      moved = others.filter((other) => other.time < time).length;
      const list = ["keyframes", this.keyIn(["keyframes"], spec.keys)!];
      if (index < 0) {
        if (time < kLeastKeyDistance_s) {
          moved = -1;
          return;
        }
        this.insertKeyframe(spec, { ...key, time });
        this.removeKey([spec.section], spec.keys);
        return;
      }
      this.yaml.replace([...list, index, "time"], writeTime(time));
      if (moved !== index) {
        const text = this.yaml.flowText([...list, index]);
        this.yaml.removeItem(list, index);
        this.yaml.insertItem(list, moved, text);
      }
      this.dropHiddenBase(spec, quantity);
    });
    return moved;
  }

  // Deletes a key; index -1 is the base (Quantity.base), if it is a key. If the only listed key is deleted, the
  // quantity keeps the value of the base if that was a key, otherwise the value of the deleted key.
  deleteKeyframe(name: string, index: number): void {
    this.edit(() => {
      const spec = quantitySpec(name);
      const quantity = this.quantity(name);
      const key = this.keyframeAt(quantity, index);
      if (index < 0) {
        this.removeKey([spec.section], spec.keys);
        return;
      }
      const list = this.keyIn(["keyframes"], spec.keys)!;
      this.yaml.removeItem(["keyframes", list], index);
      this.dropEmptyKeyframes();
      if (quantity.keyframes.length > 1) this.dropHiddenBase(spec, quantity);
      else if (!quantity.baseIsKey) this.writeBase(spec, list, key.value);
    });
  }

  // Sets the value at time 0: if there is a listed key at time 0, its value; otherwise the value in the section.
  setBase(name: string, value: PathValue): void {
    this.edit(() => {
      const spec = quantitySpec(name);
      checkValue(value, spec);
      this.refuseContradiction(spec);
      const { keyframes } = this.quantity(name);
      if (keyframes.length > 0 && keyframes[0].time < kLeastKeyDistance_s) this.changeKeyframe(spec, 0, value);
      else this.writeBase(spec, name, value);
    });
  }

  setConstant(name: string, value: ConstantValue): void {
    this.edit(() => {
      const spec = constantSpec(name);
      checkConstant(name, spec, value);
      const path = sectionPath(spec);
      const present = this.keyIn(path, spec.keys);
      if (
        !present &&
        withoutUnit(name) === "sensor_width" &&
        this.quantity("focal_length").given &&
        this.quantity("field_of_view").given
      )
        throw new Error(
          "The sensor's width follows from focal length and field of view: remove " + "one of these first",
        );
      const key = present ?? newKey(spec.keys, name);
      const text =
        typeof value === "number" || Array.isArray(value)
          ? writeValue(value, this.scale(spec.unit, key))
          : String(value);
      if (present) this.yaml.replace([...path, key], text);
      else this.yaml.add(path, key, text, path.length === 0 ? "fps" : undefined);
    });
  }

  // Removes a constant, so that its default holds.
  removeConstant(name: string): void {
    this.edit(() => {
      const spec = constantSpec(name);
      this.removeKey(sectionPath(spec), spec.keys);
    });
  }

  // Removes speed, accelerations and keys. The quantity then has the constant value `value`; if it is not given, the
  // value at time 0.
  removeMotion(name: string, value?: PathValue): void {
    this.edit(() => {
      const spec = quantitySpec(name);
      const quantity = this.quantity(name);
      const first = quantity.keyframes[0];
      const rest = value ?? (quantity.baseIsKey ? undefined : first?.value);
      this.forgetMotion(spec);
      if (rest !== undefined) {
        checkValue(rest, spec);
        this.writeBase(spec, quantity.key, rest);
      }
    });
  }

  // Each of the next functions chooses one of several quantities that define the focus, the lens or the direction, and
  // removes its rivals with their motion. If the path has this quantity already, the function only calls setBase().
  useFocusDistance(distance_w: number): void {
    this.use("focus_distance", distance_w);
  }
  useFocusPoint(point_w: number[]): void {
    this.use("focus_point", point_w);
  }
  useFocalLength(focalLength_w: number): void {
    this.use("focal_length", focalLength_w);
  }
  useFieldOfView(angle_deg: number): void {
    this.use("field_of_view", angle_deg);
  }
  useAperture(diameter_w: number): void {
    this.use("aperture_diameter", diameter_w);
  }
  useFNumber(fNumber: number): void {
    this.use("f_number", fNumber);
  }
  useLookAt(point_w: number[]): void {
    this.use("look_at", point_w);
  }
  useOrientation(angles_deg: Record<string, number>): void {
    this.use("orientation", angles_deg);
  }

  // Makes several edits as one edit: if one of them throws, nothing is changed.
  edit(edits: () => void): void {
    const before = this.yaml.text;
    try {
      edits();
    } catch (error) {
      this.yaml.set(before);
      throw error;
    }
  }

  // ----------------------------------------------------------------------------------- reading

  private keyIn(path: string[], keys: readonly string[]): string | undefined {
    const present = this.yaml.keys(path);
    return keys.find((key) => present.includes(key));
  }

  private scale(unit: Unit, key: string): number {
    return unit === "length" && key.endsWith("_mm") ? 1e-3 / this.unitM() : 1;
  }

  private read(spec: QuantitySpec, path: (string | number)[], key: string): PathValue {
    return readValue(this.yaml.value(path), path.join("."), spec.shape, this.scale(spec.unit, key));
  }

  private readKeyframes(spec: QuantitySpec, key: string): Keyframe[] {
    const label = `keyframes.${key}`;
    return this.items(["keyframes", key]).map((item) => ({
      time: readValue(item.time, `${label}.time`, "number", 1) as number,
      value: readValue(item.value, `${label}.value`, spec.shape, this.scale(spec.unit, key)),
      interpolation: (item.interpolation ?? "smooth") as Interpolation,
    }));
  }

  private readAccelerations(spec: QuantitySpec): Acceleration[] {
    return this.items(["accelerations"])
      .filter((item) => spec.keys.includes(String(item.quantity)))
      .map((item) => ({
        from: readValue(item.from, "accelerations.from", "number", 1) as number,
        to: readValue(item.to, "accelerations.to", "number", 1) as number,
        value: readValue(item.value, "accelerations.value", spec.shape, this.scale(spec.unit, String(item.quantity))),
      }));
  }

  private items(path: string[]): Record<string, unknown>[] {
    const list = this.yaml.value(path) ?? [];
    if (!Array.isArray(list)) throw new Error(`${path.join(".")}: expected a list`);
    return list.map((item: unknown) =>
      typeof item === "object" && item !== null ? (item as Record<string, unknown>) : {},
    );
  }

  private keyframeAt(quantity: Quantity, index: number): Keyframe {
    if (index === -1 && quantity.baseIsKey) return { time: 0, value: quantity.base!, interpolation: "smooth" };
    const key = quantity.keyframes[index];
    if (!key) throw new Error(`${quantity.name} has no keyframe ${index + 1}`);
    return key;
  }

  private isSameTime(a: number, b: number): boolean {
    const fps = this.constant("fps");
    const frame = typeof fps === "number" && fps > 0 ? 1 / fps : 1;
    return Math.abs(a - b) < Math.max(2 * kLeastKeyDistance_s, Math.min(1e-3, 0.1 * frame));
  }

  // ----------------------------------------------------------------------------------- refusing

  private refuseMotion(name: string): void {
    const { name: label, speed, accelerations, hasAccelerations } = this.quantity(name);
    if (!hasAccelerations) return;
    const by = [
      ...(speed !== undefined ? ["a speed"] : []),
      ...(accelerations.length > 0 ? ["accelerations"] : []),
    ].join(" and ");
    throw new Error(`${label} moves by ${by}; remove its motion before giving it keyframes`);
  }

  private refuseContradiction(spec: QuantitySpec): void {
    if (this.quantity(spec.name).given) return;
    if (spec.freeWithoutSensor && this.constant("sensor_width") === undefined) return;
    const rival = spec.rivals.map((name) => this.quantity(name)).find(({ given }) => given);
    if (rival) throw new Error(`The path has ${rival.key}, which says the same; switch to ${spec.name} ` + "first");
  }

  private refuseKeptDirection(): void {
    if (this.constant("follow") === "direction")
      throw new Error(
        "The camera keeps its direction ('follow: direction'), so look_at cannot " +
          "move; set follow to look_at first",
      );
  }

  // ----------------------------------------------------------------------------------- writing

  private write(spec: QuantitySpec, key: string, value: PathValue): string {
    return writeValue(value, this.scale(spec.unit, key), spec.unit === "length" ? this.resolution_w : 0);
  }

  private writeKeyframe(spec: QuantitySpec, key: string, keyframe: Keyframe): string {
    const word = keyframe.interpolation === "smooth" ? "" : `, interpolation: ${keyframe.interpolation}`;
    return `{time: ${writeTime(keyframe.time)}, value: ` + `${this.write(spec, key, keyframe.value)}${word}}`;
  }

  private writeBase(spec: QuantitySpec, name: string, value: PathValue, after?: string): void {
    const present = this.keyIn([spec.section], spec.keys);
    const key = present ?? this.keyIn(["keyframes"], spec.keys) ?? newKey(spec.keys, name);
    const text = this.write(spec, key, value);
    if (present) this.yaml.replace([spec.section, key], text);
    else this.yaml.add([spec.section], key, text, after);
  }

  private changeKeyframe(spec: QuantitySpec, index: number, value: PathValue, interpolation?: Interpolation): void {
    const list = this.keyIn(["keyframes"], spec.keys)!;
    const item = ["keyframes", list, index];
    this.yaml.replace([...item, "value"], this.write(spec, list, value));
    if (interpolation !== undefined) this.setInterpolation(spec.name, index, interpolation);
  }

  private insertKeyframe(spec: QuantitySpec, keyframe: Keyframe): void {
    const { key, keyframes } = this.quantity(spec.name);
    const list = this.keyIn(["keyframes"], spec.keys);
    const text = this.writeKeyframe(spec, list ?? key, keyframe);
    if (!list || keyframes.length === 0) {
      if (list) this.yaml.remove(["keyframes", list]);
      this.addKeyframeList(list ?? key, [text]);
      return;
    }
    const index = keyframes.filter((other) => other.time < keyframe.time).length;
    this.yaml.insertItem(["keyframes", list], index, text);
  }

  private addKeyframeList(key: string, items: string[]): void {
    if (!this.yaml.has(["keyframes"])) this.yaml.add([], "keyframes", "{}");
    this.yaml.add(["keyframes"], key, items);
  }

  private removeKey(path: string[], keys: readonly string[]): void {
    const key = this.keyIn(path, keys);
    if (key) this.yaml.remove([...path, key]);
    if (path[0] === "keyframes") this.dropEmptyKeyframes();
  }

  private dropEmptyKeyframes(): void {
    if (this.yaml.keys(["keyframes"]).length === 0) this.yaml.remove(["keyframes"]);
  }

  // Removes a base (Quantity.base) that had no effect because of a key at time 0. Without that key, the base would
  // become a key.
  //   before  the quantity before the edit that removed or moved the key
  private dropHiddenBase(spec: QuantitySpec, before: Quantity): void {
    if (before.base === undefined || before.baseIsKey) return;
    if (this.quantity(spec.name).baseIsKey) this.removeKey([spec.section], spec.keys);
  }

  private forgetMotion(spec: QuantitySpec): void {
    this.removeKey(["keyframes"], spec.keys);
    this.removeKey([spec.section], speedKeys(spec));
    const accelerations = this.items(["accelerations"]);
    for (let i = accelerations.length - 1; i >= 0; --i)
      if (spec.keys.includes(String(accelerations[i].quantity))) this.yaml.removeItem(["accelerations"], i);
  }

  private use(name: string, value: PathValue): void {
    this.edit(() => {
      const spec = quantitySpec(name);
      checkValue(value, spec);
      if (this.quantity(name).given) {
        this.setBase(name, value);
        return;
      }
      const others = spec.rivals.map(quantitySpec);
      const present = others.map((other) => this.keyIn([other.section], other.keys)).find((key) => key !== undefined);
      this.writeBase(spec, spec.name, value, present);
      for (const other of others) {
        this.forgetMotion(other);
        this.removeKey([other.section], other.keys);
      }
      if (spec.name === "orientation") for (const key of ["up", "follow"]) this.removeKey(["camera"], [key]);
    });
  }
}

// Returns the rate of a fraction such as 24000/1001; NaN if the text is none.
function rateOf(text: string): number {
  const parts = /^([0-9.]+)\/([0-9.]+)$/.exec(text);
  return parts ? Number(parts[1]) / Number(parts[2]) : NaN;
}
