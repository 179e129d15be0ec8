// SPDX-License-Identifier: Apache-2.0
// Reads paths with the parser of the programs. Tests run in the folder web.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";

export interface Camera {
  time_s: number;
  position_w: number[];
  forward: number[];
  up: number[];
  focal_length_mm: number;
  field_of_view_deg: number[];
  aperture_diameter_mm: number;
  f_number: number;
  focus_distance_w: number;
  focus_tilt_deg: number[];
  blades: number;
  shift_mm: number[];
  hood_mm: number[];
  transmission: number;
  ratio: number;
  blade_roundness: number;
}

export interface Film {
  fps: number;
  frames: number;
  unit_m: number;
  cameras: Camera[];
}

interface Answer {
  status: number | null;
  stdout: string;
  stderr: string;
}

function ask(text: string): Answer {
  const folder = process.env.LF_BIN;
  assert.ok(
    folder,
    "LF_BIN is not set: it must name the folder of lfcammvminfo, which reads " + "the paths that these tests write",
  );
  const temporary = mkdtempSync(join(tmpdir(), "lfpath-"));
  try {
    const file = join(temporary, "path.yaml");
    writeFileSync(file, text);
    const program = join(folder, "lfcammvminfo");
    const run = spawnSync(program, [file, "--json"], { encoding: "utf8", maxBuffer: 1 << 28 });
    assert.ok(!run.error, `LF_BIN: ${program} does not run: ${run.error?.message}`);
    return run;
  } finally {
    rmSync(temporary, { recursive: true, force: true });
  }
}

export function readByPrograms(text: string): Film {
  const { status, stdout, stderr } = ask(text);
  assert.equal(status, 0, `${stderr}\n${text}`);
  return JSON.parse(stdout) as Film;
}

// Returns the error message, or "" if the path is accepted.
export function refusalByPrograms(text: string): string {
  const { status, stderr } = ask(text);
  return status === 0 ? "" : stderr;
}

export function example(name: string): string {
  return readFileSync(resolve("..", "examples", `${name}.yaml`), "utf8");
}

export const kExamples = ["demo", "focus-pull", "orbit", "slide", "tilt"];

// Checks that `after` has all lines of `before`, in the same order, except those in `changed`
// (counted from 1).
export function assertOtherLinesKept(before: string, after: string, changed: number[]): void {
  const kept = before.split("\n").filter((_, i) => !changed.includes(i + 1));
  let at = 0;
  const lines = after.split("\n");
  for (const line of kept) {
    const found = lines.indexOf(line, at);
    assert.ok(found >= 0, `lost: '${line}'\n${after}`);
    at = found + 1;
  }
}

export function near(found: number, expected: number, tolerance: number): void {
  assert.ok(Math.abs(found - expected) <= tolerance, `${found} is not ${expected} +- ${tolerance}`);
}

export const kSmall = `# a film
format: lfpath 1

fps: 10     # few
frames: 21
resolution: [ 64,  36 ]
camera:
  position: [0.0, 0, -0.40]   # in front
  look_at: [0, 0, 0]
  focal_length_mm: 50.0

  # not turned
  up: [0, -1, 0]
lens:
  aperture_diameter_mm: 4.00
  focus_distance_mm: 400  # the subject
# the end
`;
