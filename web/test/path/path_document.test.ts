// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { PathDocument } from "../../src/path/path_document";
import { assertOtherLinesKept, example, kExamples, kSmall, near, readByPrograms } from "./real_parser";

test("a text that is not edited is the same text", () => {
  for (const name of kExamples) {
    const text = example(name);
    const path = PathDocument.parse(text);
    for (const quantity of PathDocument.quantityNames()) path.quantity(quantity);
    assert.equal(path.text(), text);
  }
});

test("quantities are found by names with and without unit", () => {
  const path = PathDocument.parse(kSmall);
  for (const name of ["focus_distance", "focus_distance_mm"]) {
    const focus = path.quantity(name);
    assert.equal(focus.name, "focus_distance");
    assert.equal(focus.key, "focus_distance_mm");
    assert.equal(focus.section, "lens");
    near(focus.base as number, 0.4, 1e-12);
  }
  assert.equal(path.quantity("roll").key, "roll_deg");
  assert.equal(path.quantity("roll_deg").given, false);
  assert.throws(() => path.quantity("aperature_diameter_mm"), /no quantity/);
});

test("millimetres become world units by the file's unit, else by the light field's", () => {
  const text = kSmall.replace("fps: 10 ", "unit_m: 0.1\nfps: 10 ");
  near(PathDocument.parse(text, 5).quantity("focus_distance").base as number, 4, 1e-12);
  near(PathDocument.parse(kSmall, 0.5).quantity("focus_distance").base as number, 0.8, 1e-12);
  const path = PathDocument.parse(text);
  path.setBase("focus_distance", 3.5);
  assert.match(path.text(), /focus_distance_mm: 350  # the subject/);
  near(readByPrograms(path.text()).cameras[0].focus_distance_w, 3.5, 1e-9);
});

test("keyframes, speeds and accelerations are told as they are listed", () => {
  const demo = PathDocument.parse(example("demo"));
  const focus = demo.quantity("focus_distance");
  assert.deepEqual(
    focus.keyframes.map((key) => key.time),
    [0.5, 1.5, 2, 3],
  );
  assert.equal(focus.keyframes[1].interpolation, "ease");
  assert.equal(focus.base, 0.55);
  assert.equal(focus.baseIsKey, true);
  assert.equal(PathDocument.parse(example("tilt")).quantity("aperture_diameter").baseIsKey, true);
  const slide = PathDocument.parse(example("slide")).quantity("position");
  assert.equal(slide.hasAccelerations, true);
  assert.deepEqual(slide.accelerations[1], { from: 1.75, to: 2.25, value: [-0.08, 0, 0] });
  const tilt = PathDocument.parse(example("tilt")).quantity("focus_tilt_deg");
  assert.deepEqual(tilt.keyframes[1].value, { horizontal: 0, vertical: 70 });
  const orbit = PathDocument.parse(example("orbit")).quantity("focus_point");
  assert.deepEqual(orbit.base, [0, 0, 0]);
});

test("a changed number leaves every other byte", () => {
  const path = PathDocument.parse(kSmall);
  path.setBase("position", [0.01, 0, -0.3999999]);
  assert.equal(path.text(), kSmall.replace("[0.0, 0, -0.40]", "[0.01, 0, -0.4]"));
  path.setBase("position", [0, 0, -0.123456789]);
  assert.equal(path.text(), kSmall.replace("[0.0, 0, -0.40]", "[0, 0, -0.123457]"));
  path.setConstant("fps", 24);
  path.setConstant("resolution", [320, 180]);
  assert.equal(
    path.text(),
    kSmall
      .replace("[0.0, 0, -0.40]", "[0, 0, -0.123457]")
      .replace("fps: 10     # few", "fps: 24     # few")
      .replace("[ 64,  36 ]", "[320, 180]"),
  );
  readByPrograms(path.text());
});

test("line breaks of another system stay, and a missing last one does no harm", () => {
  const text = kSmall.trimEnd().replace("\n# the end", "").replace(/\n/g, "\r\n");
  const path = PathDocument.parse(text);
  path.setKeyframe("focus_distance", 1, 0.5);
  path.setKeyframe("focus_distance", 2, 0.6);
  assert.equal(
    path.text(),
    `${text}\r\nkeyframes:\r\n  focus_distance_mm:\r\n` + "    - {time: 1, value: 500}\r\n    - {time: 2, value: 600}",
  );
  assert.equal(readByPrograms(path.text()).cameras[20].focus_distance_w, 0.6);
});

test("a first keyframe makes the section and the list, and the base is its key at time 0", () => {
  const path = PathDocument.parse(kSmall);
  path.setKeyframe("position", 1.5, [0.02, 0, -0.4], "linear");
  assert.equal(
    path.text(),
    kSmall.replace(
      "# the subject\n",
      "# the subject\nkeyframes:\n" + "  position:\n    - {time: 1.5, value: [0.02, 0, -0.4], interpolation: linear}\n",
    ),
  );
  assert.equal(path.quantity("position").baseIsKey, true);
  const film = readByPrograms(path.text());
  near(film.cameras[0].position_w[0], 0, 1e-12);
  near(film.cameras[15].position_w[0], 0.02, 1e-12);
  near(film.cameras[6].position_w[0], 0.008, 1e-9);
});

test("keys are sorted by time, and one at the same time is replaced", () => {
  const path = PathDocument.parse(kSmall);
  path.setKeyframe("focus_distance", 2, 0.6);
  path.setKeyframe("focus_distance", 1, 0.5);
  path.setKeyframe("focus_distance", 1.5, 0.55);
  assert.deepEqual(
    path.quantity("focus_distance").keyframes.map((key) => key.time),
    [1, 1.5, 2],
  );
  path.setKeyframe("focus_distance", 1.5 + 1e-9, 0.7, "step");
  path.setKeyframe("focus_distance", 2, 0.8, "linear");
  path.setKeyframe("focus_distance", 2, 0.9);
  assert.match(path.text(), /- \{time: 1.5, value: 700, interpolation: step\}/);
  assert.match(path.text(), /- \{time: 2, value: 900, interpolation: linear\}/);
  path.setKeyframe("focus_distance", 0, 0.35);
  assert.equal(path.quantity("focus_distance").keyframes.length, 3);
  const film = readByPrograms(path.text());
  near(film.cameras[0].focus_distance_w, 0.35, 1e-9);
  near(film.cameras[14].focus_distance_w, 0.5, 1e-9);
  near(film.cameras[15].focus_distance_w, 0.7, 1e-9);
});

test("a rate may be a fraction", () => {
  const path = PathDocument.parse(kSmall.replace("fps: 10 ", "fps: 24000/1001 "));
  assert.equal(path.constant("fps"), 24000 / 1001);
  assert.ok(Number.isNaN(PathDocument.parse(kSmall.replace("fps: 10 ", "fps: 24/a ")).constant("fps")));
});

test("the key of a frame is found again although its time was rounded", () => {
  const path = PathDocument.parse(kSmall.replace("fps: 10 ", "fps: 30 "));
  path.setKeyframe("focus_distance", 100 + 1 / 3, 0.5);
  path.setKeyframe("focus_distance", 100 + 1 / 3, 0.6);
  assert.equal(path.quantity("focus_distance").keyframes.length, 1);
  path.setKeyframe("focus_distance", 100 + 1 / 3 + 1 / 30, 0.6);
  assert.equal(path.quantity("focus_distance").keyframes.length, 2);
});

test("keys join lists as these are written, and comments stay with their keys", () => {
  const before = example("demo");
  const path = PathDocument.parse(before);
  path.setKeyframe("focus_distance", 1.75, 0.7);
  assert.equal(
    path.text(),
    before.replace("    - {time: 2, value: 0.8}", "    - {time: 1.75, value: 0.7}\n    - {time: 2, value: 0.8}"),
  );
  path.setKeyframe("focus_distance", 0.25, 0.6);
  path.setKeyframe("focus_distance", 4, 1.2);
  assertOtherLinesKept(before, path.text(), []);
  readByPrograms(path.text());

  const smooth = example("focus-pull").replaceAll(", interpolation: ease", "");
  const pull = PathDocument.parse(smooth);
  pull.setKeyframe("focus_distance", 1, 0.4);
  assert.equal(pull.text(), smooth.replace("value: 0.3}, {time: 2", "value: 0.3}, {time: 1, value: 0.4}, {time: 2"));
  pull.setKeyframe("focus_distance", 3, 0.4);
  assert.ok(
    pull
      .text()
      .split("\n")
      .every((line) => line.length <= 100),
  );
  readByPrograms(pull.text());
});

test("a list in brackets that grows too long becomes one key per line", () => {
  const before = example("demo").replace("-0.8]}]\n", "-0.8]}]  # slow\n");
  const path = PathDocument.parse(before);
  path.setKeyframe("position", 2, [0, -0.125, -0.8]);
  assert.match(
    path.text(),
    new RegExp(
      [
        "  position:  # slow",
        "    - {time: 0.5, value: \\[-0.004, -0.125, -0.8\\]}",
        "    - {time: 2, value: \\[0, -0.125, -0.8\\]}",
        "    - {time: 3, value: \\[0.004, -0.125, -0.8\\]}",
        "  focus_distance:",
      ].join("\n"),
    ),
  );
  assertOtherLinesKept(before, path.text(), [19]);
  readByPrograms(path.text());
});

test("a key moves in time, and past others", () => {
  const before = example("demo");
  const path = PathDocument.parse(before);
  assert.equal(path.moveKeyframe("focus_distance", 1, 1.25), 1);
  assert.equal(path.text(), before.replace("- {time: 1.5,", "- {time: 1.25,"));
  assert.equal(path.moveKeyframe("focus_distance", 1, 2.5), 2);
  assert.deepEqual(
    path.quantity("focus_distance").keyframes.map((key) => key.value),
    [0.55, 0.8, 0.8, 1.1],
  );
  assert.equal(path.moveKeyframe("focus_distance", 3, 0.25), 0);
  const text = path.text();
  assert.throws(() => path.moveKeyframe("focus_distance", 0, 0.5), /has a key at 0.5 s already/);
  assert.throws(() => path.moveKeyframe("focus_distance", 0, 0), /has a key at 0 s already/);
  assert.throws(() => path.moveKeyframe("focus_distance", 0, -1), /0 s or later/);
  assert.throws(() => path.moveKeyframe("focus_distance", 9, 1), /no keyframe 10/);
  assert.equal(path.text(), text);
  near(readByPrograms(text).cameras[6].focus_distance_w, 1.1, 1e-9);
});

test("the base moves and goes as the key that it is", () => {
  const path = PathDocument.parse(example("demo"));
  assert.equal(path.moveKeyframe("focus_distance", -1, 0.25), 0);
  assert.equal(path.quantity("focus_distance").base, undefined);
  assert.equal(path.quantity("focus_distance").keyframes[0].time, 0.25);
  readByPrograms(path.text());
  path.deleteKeyframe("position", -1);
  assert.equal(path.quantity("position").baseIsKey, false);
  readByPrograms(path.text());
  assert.throws(() => path.deleteKeyframe("position", -1), /no keyframe/);
});

test("a deleted key takes its line, the last one its list and leaves the value", () => {
  const before = example("tilt");
  const path = PathDocument.parse(before);
  path.deleteKeyframe("focus_tilt_deg", 0);
  assert.equal(path.text(), before.replace("    - {time: 0, value: {vertical: 0}}\n", ""));
  path.deleteKeyframe("focus_tilt_deg", 0);
  assert.deepEqual(path.quantity("focus_tilt").base, { horizontal: 0, vertical: 70 });
  assert.deepEqual(path.quantity("focus_tilt").keyframes, []);
  near(readByPrograms(path.text()).cameras[0].focus_tilt_deg[1], 70, 1e-9);
  path.deleteKeyframe("aperture_diameter", 1);
  path.deleteKeyframe("aperture_diameter", 0);
  assert.doesNotMatch(path.text(), /keyframes:/);
  // The base was a key at time 0, and remains.
  assert.match(path.text(), /aperture_diameter_mm: 8\n/);
  readByPrograms(path.text());
});

test("deleting in brackets leaves brackets", () => {
  for (const index of [0, 1]) {
    const path = PathDocument.parse(example("focus-pull").replaceAll(", interpolation: ease", ""));
    path.deleteKeyframe("focus_distance", index);
    assert.match(
      path.text(),
      index === 0 ? /focus_distance: \[\{time: 2, value: 0.5\}\]/ : /focus_distance: \[\{time: 0.5, value: 0.3\}\]/,
    );
    readByPrograms(path.text());
  }
});

test("a base that a key at time 0 hid does not come to light", () => {
  const text = kSmall + "keyframes:\n  focus_distance: [{time: 0, value: 0.7}, {time: 1, " + "value: 0.9}]\n";
  const moved = PathDocument.parse(text);
  moved.moveKeyframe("focus_distance", 0, 0.5);
  near(readByPrograms(moved.text()).cameras[0].focus_distance_w, 0.7, 1e-9);
  const deleted = PathDocument.parse(text);
  deleted.deleteKeyframe("focus_distance", 0);
  near(readByPrograms(deleted.text()).cameras[0].focus_distance_w, 0.9, 1e-9);
  const set = PathDocument.parse(text);
  set.setBase("focus_distance", 0.8);
  near(readByPrograms(set.text()).cameras[0].focus_distance_w, 0.8, 1e-9);
});

test("what is 0 when left out starts at 0 when it gets its first key", () => {
  const path = PathDocument.parse(kSmall);
  path.setKeyframe("roll_deg", 1, 30);
  assert.match(path.text(), /  roll_deg: 0\n/);
  path.setKeyframe("focus_tilt", 2, { horizontal: 0, vertical: 20 }, "linear");
  path.setKeyframe("blade_rotation", 0, 10);
  near(readByPrograms(path.text()).cameras[10].focus_tilt_deg[1], 10, 1e-9);
});

test("what moves by accelerations says so, and moves by keys once that is removed", () => {
  const before = example("slide");
  const path = PathDocument.parse(before);
  assert.throws(
    () => path.setKeyframe("position", 1, [0, 0, -0.4]),
    /position moves by accelerations; remove its motion/,
  );
  assert.equal(path.text(), before);
  path.removeMotion("position");
  assert.equal(path.text(), before.slice(0, before.indexOf("accelerations:\n")));
  path.setKeyframe("position", 2, [0.03, 0, -0.4]);
  near(readByPrograms(path.text()).cameras[60].position_w[0], 0.03, 1e-9);
});

test("removed motion takes the speed and leaves the motion of others", () => {
  const text =
    kSmall.replace("lens:", "  speed_mm: [10, 0, 0] # slow\nlens:") +
    "accelerations:\n  - quantity: position\n    from: 0\n    to: 1\n    value: [1, 0, 0]\n" +
    "  # the other\n  - {quantity: focus_distance_mm, from: 0, to: 1, value: 5}\n";
  const path = PathDocument.parse(text);
  assert.deepEqual(path.quantity("position").speed, [0.01, 0, 0]);
  assert.throws(() => path.setKeyframe("position", 1, [0, 0, 0]), /a speed and accelerations/);
  path.removeMotion("position", [0, 0, -0.5]);
  assert.doesNotMatch(path.text(), /speed_mm|quantity: position/);
  assert.match(path.text(), /accelerations:\n {2}# the other\n {2}- \{quantity: focus_distance_mm/);
  near(readByPrograms(path.text()).cameras[20].position_w[2], -0.5, 1e-12);
  path.removeMotion("focus_distance");
  assert.doesNotMatch(path.text(), /accelerations:/);
  readByPrograms(path.text());
});

test("motion by keys leaves the value of time 0", () => {
  const path = PathDocument.parse(example("orbit"));
  path.removeMotion("position");
  assert.doesNotMatch(path.text(), /^keyframes/m);
  assert.deepEqual(path.quantity("position").base, [0.03, 0, -0.4]);
  readByPrograms(path.text());
});

test("the lens focuses by distance in place of a point, and back", () => {
  const before = example("slide");
  const path = PathDocument.parse(before);
  assert.throws(() => path.setBase("focus_distance", 0.4), /has focus_point.*switch/);
  assert.throws(() => path.setKeyframe("focus_distance", 1, 0.4), /has focus_point/);
  path.useFocusDistance(0.4);
  assert.match(path.text(), /  f_number: 8\n  focus_distance: 0.4\naccelerations/);
  near(readByPrograms(path.text()).cameras[9].focus_distance_w, 0.4, 1e-12);
  path.setKeyframe("focus_distance", 2, 0.5);
  path.useFocusPoint([0, 0, 0.1]);
  assert.doesNotMatch(path.text(), /focus_distance|keyframes/);
  readByPrograms(path.text());
});

test("f-number and diameter replace each other", () => {
  const path = PathDocument.parse(example("slide"));
  path.useAperture(0.0045);
  assert.match(path.text(), /  aperture_diameter_mm: 4.5\n/);
  near(readByPrograms(path.text()).cameras[0].aperture_diameter_mm, 4.5, 1e-9);
  path.useFNumber(11);
  near(readByPrograms(path.text()).cameras[0].f_number, 11, 1e-9);
});

test("the camera looks at a point in place of an orientation, and back", () => {
  const path = PathDocument.parse(example("tilt"));
  path.useLookAt([0, 0, 0]);
  assert.doesNotMatch(path.text(), /orientation/);
  assert.match(path.text(), /  look_at: \[0, 0, 0\]\n/);
  readByPrograms(path.text());
  path.setConstant("up", [0, -1, 0]);
  path.setConstant("follow", "look_at");
  readByPrograms(path.text());
  path.useOrientation({ yaw: 5, pitch: 0, roll: 0 });
  assert.doesNotMatch(path.text(), /look_at|up:|follow/);
  readByPrograms(path.text());
});

test("focal length and field of view replace each other beside the sensor's width", () => {
  const path = PathDocument.parse(example("demo"));
  assert.throws(() => path.setBase("field_of_view_deg", 40), /focal_length_mm/);
  path.useFieldOfView(40);
  near(readByPrograms(path.text()).cameras[0].field_of_view_deg[0], 40, 1e-9);
  path.useFocalLength(0.035);
  near(readByPrograms(path.text()).cameras[0].focal_length_mm, 35, 1e-9);
});

test("what shares an anchor with a removed value keeps the value", () => {
  const path = PathDocument.parse(example("orbit"));
  path.setBase("look_at", [0, 0, 0.1]);
  assert.match(path.text(), /look_at: &subject \[0, 0, 0.1\] {4}# YAML's/);
  assert.deepEqual(path.quantity("focus_point").base, [0, 0, 0.1]);
  readByPrograms(path.text());
  path.useOrientation({ yaw: 0, pitch: 0, roll: 0 });
  assert.match(path.text(), /focus_point: \[0, 0, 0.1\]\n/);
  readByPrograms(path.text());
  const other = PathDocument.parse(example("orbit"));
  other.setBase("focus_point", [0, 0, 0.2]);
  assert.deepEqual(other.quantity("look_at").base, [0, 0, 0]);
  readByPrograms(other.text());
});

test("files in brackets, in blocks and with aliases are edited, too", () => {
  const flow = PathDocument.parse(
    "{format: lfpath 1, fps: 10, frames: 11, resolution: [64, 36], camera: {position: [0, 0, -1]," +
      " look_at: [0, 0, 0], focal_length_mm: 50}, lens: {f_number: 8, focus_distance: 1}}\n",
  );
  flow.setKeyframe("position", 1, [0.1, 0, -1]);
  flow.setKeyframe("position", 0.5, [0, 0, -1]);
  flow.setConstant("blades", 5);
  flow.useFocusPoint([0, 0, 0]);
  near(readByPrograms(flow.text()).cameras[10].position_w[0], 0.1, 1e-12);
  flow.deleteKeyframe("position", 1);
  flow.deleteKeyframe("position", 0);
  assert.doesNotMatch(flow.text(), /^keyframes/m);
  readByPrograms(flow.text());

  const block = PathDocument.parse(
    kSmall.replace("[0.0, 0, -0.40]   # in front", "&start\n    - 0 # x\n    - 0\n    - -0.4") +
      "keyframes:\n  position:\n" +
      "  - time: 1\n    value: *start\n  -\n    time: 2  # late\n    value: [1, 0, -0.4]\n" +
      "  look_at: &k\n  - {time: 1, value: [0, 0, 0]}\n  focus_distance: &f [{time: 1, value: 1}]\n",
  );
  readByPrograms(block.text());
  block.setKeyframe("position", 1, [0.5, 0, -0.4], "linear");
  block.setKeyframe("position", 1.5, [0.7, 0, -0.4]);
  assert.equal(block.moveKeyframe("position", 2, 0.5), 0);
  block.setBase("position", [0.1, 0, -0.4]);
  block.setKeyframe("look_at", 0.5, [0, 0, 0.1]);
  const film = readByPrograms(block.text());
  near(film.cameras[0].position_w[0], 0.1, 1e-12);
  near(film.cameras[5].position_w[0], 1, 1e-12);
  near(film.cameras[15].position_w[0], 0.7, 1e-12);
});

test("an edit behind an alias does not reach its anchor", () => {
  const path = PathDocument.parse(
    kSmall +
      "keyframes:\n  look_at: &k\n    - {time: 1, value: " +
      "[0, 0, 0]}\n    - {time: 2, value: [0, 0, 0.1]}\n  position_mm: *k\n",
  );
  path.removeMotion("position", [0, 0, -0.4]);
  path.setKeyframe("position", 1, [0.01, 0, -0.4]);
  assert.deepEqual(path.quantity("look_at").keyframes[0].value, [0, 0, 0]);
  readByPrograms(path.text());
  const other = PathDocument.parse(
    example("tilt")
      .replace("{vertical: 0}}", "&rest {vertical: 0}}")
      .replace("vertical: 70}}", "vertical: 70}}\n    - {time: 3, value: *rest}"),
  );
  other.setKeyframe("focus_tilt", 3, { horizontal: 0, vertical: 5 });
  assert.deepEqual(other.quantity("focus_tilt").keyframes[0].value, { horizontal: 0, vertical: 0 });
  other.moveKeyframe("focus_tilt", 0, 4);
  readByPrograms(other.text());
});

test("constants are added where they belong, and removed", () => {
  const path = PathDocument.parse(kSmall);
  path.setConstant("blades", 6);
  path.setConstant("sensor_width", 0.024);
  path.setConstant("unit_m", 1);
  path.setConstant("breathing", true);
  assert.match(path.text(), /  focus_distance_mm: 400  # the subject\n  blades: 6\n/);
  assert.match(path.text(), /  sensor_width_mm: 24\n/);
  assert.equal(path.constant("sensor_width"), 0.024);
  assert.equal(readByPrograms(path.text()).cameras[0].blades, 6);
  path.removeConstant("blades");
  assert.equal(path.constant("blades"), undefined);
  assert.throws(() => path.setConstant("frames", 1.5), /expected a/);
  assert.throws(() => path.setConstant("resolution", [1]), /2 numbers/);
  readByPrograms(path.text());
});

test("values that the programs would refuse are refused, and nothing changes", () => {
  const path = PathDocument.parse(kSmall);
  assert.throws(() => path.setBase("focus_distance", 0), /above 0/);
  assert.throws(() => path.setBase("position", 3), /3 numbers/);
  assert.throws(() => path.setBase("position", [0, 0, NaN]), /expected a number/);
  assert.throws(() => path.setBase("focal_length", [1, 2, 3]), /expected a number/);
  assert.throws(() => path.setKeyframe("position", NaN, [0, 0, 0]), /time/);
  assert.throws(() => path.setKeyframe("aperture_diameter", 1, -1), /0 or more/);
  path.setConstant("follow", "direction");
  assert.throws(() => path.setKeyframe("look_at", 1, [0, 0, 1]), /follow/);
  path.removeConstant("follow");
  assert.equal(path.text(), kSmall);
});

test("several edits are one, or none", () => {
  const path = PathDocument.parse(kSmall);
  assert.throws(
    () =>
      path.edit(() => {
        path.setBase("focus_distance", 1);
        path.setBase("focus_distance", -1);
      }),
    /above 0/,
  );
  assert.equal(path.text(), kSmall);
});

test("places far from the origin keep their tenths of a millimetre", () => {
  const path = PathDocument.parse(kSmall);
  path.setBase("position", [500000.12344, 0, 1e-20]);
  assert.match(path.text(), /position: \[500000.1234, 0, 0\] /);
});

test("a text that is no path says where", () => {
  assert.throws(() => PathDocument.parse("camera: {position: [0, 0"), /line 1/);
  assert.throws(() => PathDocument.parse("- 1\n"), /has keys/);
  const wrong = PathDocument.parse(kSmall.replace("400 ", "four "));
  assert.throws(() => wrong.quantity("focus_distance"), /lens.focus_distance_mm: expected a number/);
});
