// SPDX-License-Identifier: Apache-2.0
// Formats numbers and positions for people.

export function shortNumber(value: number): string {
  if (!Number.isFinite(value)) return "∞";
  const size = Math.abs(value);
  for (const [unit, name] of [
    [1e9, " G"],
    [1e6, " M"],
    [1e4, " k"],
  ] as [number, string][])
    if (size >= unit) return `${precise(value / (unit === 1e4 ? 1e3 : unit), 3)}${name}`;
  return Number.isInteger(value) ? value.toLocaleString("en-US") : precise(value, 3);
}

export function precise(value: number, digits: number): string {
  if (!Number.isFinite(value)) return "∞";
  const text = value.toPrecision(digits);
  const plain = text.includes("e") ? String(Number(text)) : text;
  return plain.includes(".") ? plain.replace(/\.?0+$/, "") : plain;
}

export function percent(share: number): string {
  return `${precise(100 * share, share > 0.1 ? 3 : 2)} %`;
}

export function seconds(value: number): string {
  return `${value.toFixed(2)} s`;
}

// length() formats a length in world units. millimetres() formats a length in world units as millimetres, or as metres
// from 1 m on.
export function length(value: number): string {
  return precise(value, 4);
}

export function millimetres(value: number, unit_m: number): string {
  if (Math.abs(value * unit_m) >= 1) return `${precise(value * unit_m, 3)} m`;
  return `${precise(value * unit_m * 1000, 3)} mm`;
}

// Returns a number of bytes as options of the programs expect it, rounded up: "512M".
export function byteSize(count: number): string {
  const isLarge = count >= 1024 ** 3;
  const unit = 1024 ** (isLarge ? 3 : 2);
  const size = isLarge ? Math.ceil((10 * count) / unit) / 10 : Math.ceil(count / unit);
  return `${size}${isLarge ? "G" : "M"}`;
}

// Returns a number of bytes for people, rounded up: "512 MiB".
export function bytes(count: number): string {
  return byteSize(count).replace(/[MG]$/, " $&iB");
}

export function vector(v: readonly number[]): string {
  return v.map((x) => precise(Math.abs(x) < 1e-9 ? 0 : x, 4)).join(", ");
}

export function plural(count: number, one: string, many = `${one}s`): string {
  return `${count.toLocaleString("en-US")} ${count === 1 ? one : many}`;
}
