// SPDX-License-Identifier: Apache-2.0
// Makes hundreds of random edits in a row: the file remains a path, and only what was edited
// changes.
import assert from "node:assert/strict";
import { test } from "node:test";
import { deleteKey, INTERPOLATIONS, setEasedKey } from "../../src/path/eases";
import { PathDocument } from "../../src/path/path_document";
import type { Interpolation } from "../../src/path/path_facts";
import { quantitySpec } from "../../src/path/path_quantities";
import type { PathValue } from "../../src/path/path_quantities";
import { example, kExamples, kSmall, refusalByPrograms } from "./real_parser";

// Lehmer's generator, so that the edits are always the same.
function makeRandom(seed: number): (below: number) => number {
  let state = seed;
  return (below) => {
    state = (state * 48271) % 2147483647;
    return (state / 2147483647) * below;
  };
}

const kCentres: Record<string, number> = {
  roll: 0,
  focal_length: 0.05,
  field_of_view: 40,
  aperture_diameter: 0.006,
  f_number: 8,
  focus_distance: 0.4,
  blade_rotation: 0,
};

function drawValue(name: string, random: (below: number) => number): PathValue {
  const spread = (): number => random(2) - 1;
  switch (name) {
    case "position":
      return [0.05 * spread(), 0.05 * spread(), -0.4 + 0.05 * spread()];
    case "look_at":
    case "focus_point":
      return [0.05 * spread(), 0.05 * spread(), 0.1 * spread()];
    case "orientation":
      return { yaw: 20 * spread(), pitch: 20 * spread(), roll: 20 * spread() };
    case "focus_tilt":
      return { horizontal: 20 * spread(), vertical: 20 * spread() };
    case "shift":
      return { horizontal: 0.01 * spread(), vertical: 0.01 * spread() };
    case "quaternion":
      return [1, 0, 0, 0];
    default:
      return kCentres[name] === 0 ? 90 * spread() : kCentres[name] * (1 + 0.3 * spread());
  }
}

function facts(path: PathDocument, name: string): string {
  const { base, keyframes, speed, accelerations } = path.quantity(name);
  return JSON.stringify({ base, keyframes, speed, accelerations });
}

const kInterpolations: (Interpolation | undefined)[] = [undefined, ...INTERPOLATIONS];

function editAtRandom(path: PathDocument, name: string, random: (below: number) => number): void {
  const { keyframes, baseIsKey } = path.quantity(name);
  const index = Math.floor(random(keyframes.length + (baseIsKey ? 1 : 0))) - (baseIsKey ? 1 : 0);
  const time = Math.round(random(40)) / 10;
  switch (Math.floor(random(12))) {
    case 0:
    case 1:
    case 2:
      path.setKeyframe(name, time, drawValue(name, random), kInterpolations[Math.floor(random(7))]);
      break;
    case 3:
    case 4:
      path.moveKeyframe(name, index, time);
      break;
    case 5:
      path.deleteKeyframe(name, index);
      break;
    case 6:
      path.setBase(name, drawValue(name, random));
      break;
    case 7:
      if (random(3) < 1) path.removeMotion(name);
      break;
    case 8:
    case 9:
      setEasedKey(path, name, time, drawValue(name, random));
      break;
    case 10:
      deleteKey(path, name, index);
      break;
    case 11:
      switch (name) {
        case "look_at":
          path.useLookAt(drawValue(name, random) as number[]);
          break;
        case "orientation":
          path.useOrientation(drawValue(name, random) as Record<string, number>);
          break;
        case "focus_point":
          path.useFocusPoint(drawValue(name, random) as number[]);
          break;
        case "focus_distance":
          path.useFocusDistance(drawValue(name, random) as number);
          break;
        case "aperture_diameter":
          path.useAperture(drawValue(name, random) as number);
          break;
        case "f_number":
          path.useFNumber(drawValue(name, random) as number);
          break;
      }
  }
}

// A file in a style that nobody should use.
const kOdd = `---
# odd
"format" : lfpath 1
fps: 1e1
frames: 21
resolution:
- 64
- 36
keyframes: # of all
    # first these
    position:   # where
    - {time: 0.5,
       value: [0, 0, -.4]}  # a
    # before b
    -
        value:
        - 0.01
        - 0
        - -0.4
        time: 1   # b

    # between
    focus_distance_mm : [
      {time: 0, value: 400},  # x
      {time: 1, value: 500},

      {time: 2, value: 450}   # y
    ]
    orientation:

      - "time": 1
        value: {yaw: 3}
        # the end of orientations
# the camera
camera: {focal_length_mm: 50,  # a comma

  'position': &p [0, 0, -0.4], orientation:
    {pitch: 0, yaw: 1}}
lens:
        aperture_diameter_mm: 4

        focus_distance: 0.4   # hidden
# done
...
`;

// Returns comments on lines of their own that belong to no single key.
const looseComments = (text: string): string[] => text.split("\n").filter((line) => line.startsWith("#"));

test("random edits leave a path that the programs take, and everything else as it was", () => {
  const texts = [kSmall, ...kExamples.map(example), kSmall.replace(/\n/g, "\r\n"), kOdd];
  let made = 0;
  let refused = 0;
  texts.forEach((text, which) => {
    const random = makeRandom(1 + which);
    let path = PathDocument.parse(text);
    let unread: string[] = [];
    const names = PathDocument.quantityNames().filter((name) => name !== "quaternion");
    for (let step = 0; step < 240; ++step) {
      const name = names[Math.floor(random(names.length))];
      const before = path.text();
      const shared = /[&*]subject/.test(before);
      const rivals = quantitySpec(name).rivals;
      const others = names.filter((other) => other !== name && !rivals.includes(other));
      const known = others.map((other) => facts(path, other));
      try {
        editAtRandom(path, name, random);
      } catch (error) {
        assert.equal(path.text(), before);
        assert.match((error as Error).message, /has no keyframe|already|moves by|switch to|follow/);
        ++refused;
        continue;
      }
      ++made;
      // With anchors, an edit may change two quantities that share a value.
      if (!shared)
        assert.deepEqual(
          others.map((other) => facts(path, other)),
          known,
          path.text(),
        );
      assert.deepEqual(looseComments(path.text()), looseComments(before));
      if (text.includes("\r\n")) assert.doesNotMatch(path.text(), /[^\r]\n/);
      assert.equal(PathDocument.parse(path.text()).text(), path.text());
      unread.push(`${path.text()}# after an edit of ${name}\n`);
      if (step % 20 !== 19) continue; // starting a program takes longer than reading a path
      const refusal = refusalByPrograms(path.text());
      if (refusal === "") {
        unread = [];
        continue;
      }
      // Not the edit's fault: half a turn between two orientations, a point behind the lens.
      if (!/half a turn|focus plane through/.test(refusal)) {
        const first = unread.findIndex((each) => refusalByPrograms(each) !== "");
        assert.fail(`${refusal}\n${unread[first - 1] ?? ""}\n${unread[first]}`);
      }
      path = PathDocument.parse(text);
      unread = [];
    }
  });
  console.log(`${made} edits were made, ${refused} refused`);
  assert.ok(made > (3 * refused) / 2, `${made} edits were made, ${refused} refused`);
});
