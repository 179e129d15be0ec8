// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";

import {
  rotationPerStop,
  rotationWriter,
  withFocusDistance,
  withRadius,
  withTilt,
  writeAperture,
  writeFocusDistance,
  writeTilt,
} from "../../src/live/lens_changes";
import { oneFramePath } from "../../src/live/one_frame_path";
import { PathDocument } from "../../src/path/path_document";
import { readByPrograms } from "../path/real_parser";
import { assertNear, cameraAt } from "./test_camera";

const path = (lens: string): string => `format: lfpath 1
fps: 10
frames: 2
resolution: [96, 64]
camera:
  focal_length_mm: 50
  position: [0, 0, 0]
  look_at: [0, 0, 1]
lens:
${lens}
`;

test("the aperture is written as the path gives it", () => {
  const camera = cameraAt([0, 0, 0], { focalLength: 0.05 });
  const wider = withRadius(camera, 0.0125);
  const byNumber = PathDocument.parse(path("  f_number: 4\n  focus_distance: 1"));
  assert.equal(writeAperture(byNumber, 0, wider), "");
  assert.match(byNumber.text(), /f_number: 2\n/);
  assert.match(writeAperture(byNumber, 0, withRadius(camera, 0)), /aperture_diameter replaces f_number/);
  assertNear([readByPrograms(byNumber.text()).cameras[0].aperture_diameter_mm], [0]);
  const byDiameter = PathDocument.parse(path("  aperture_diameter_mm: 4\n  focus_distance: 1"));
  writeAperture(byDiameter, 0, wider);
  assert.match(byDiameter.text(), /aperture_diameter_mm: 25\n/);
});

test("a focus distance that replaces another definition is told", () => {
  const camera = withFocusDistance(cameraAt([0, 0, 0]), 2);
  const given = PathDocument.parse(path("  f_number: 4\n  focus_distance: 1"));
  assert.equal(writeFocusDistance(given, 0, camera), "");
  const point = PathDocument.parse(path("  f_number: 4\n  focus_point: [0, 0, 1]"));
  assert.match(writeFocusDistance(point, 0, camera), /replaces/);
  assertNear([readByPrograms(point.text()).cameras[0].focus_distance_w], [2]);
});

test("the field of view breathes as the programs say", () => {
  const text = path("  f_number: 4\n  focus_distance: 0.5\n  breathing: true");
  const widthAt = (distance: number): number => {
    const film = readByPrograms(text.replace("0.5", String(distance)));
    return Math.tan((film.cameras[0].field_of_view_deg[0] * Math.PI) / 360);
  };
  const fx = (distance: number): number => 48 / widthAt(distance);
  const near = cameraAt([0, 0, 0], { focalLength: 0.05, focusDistance: 0.5, fx: fx(0.5), fy: fx(0.5) });
  assertNear([withFocusDistance(near, 2).fx], [fx(2)], 1e-3);
  assert.match(oneFramePath(near, { unit_m: 1 }), /breathing: true/);
  assert.ok(Math.abs(fx(2) - fx(0.5)) > 1, "the field of view changes");
});

test("blades turn as the lens is stopped down, also while it is dragged", () => {
  const text = path(
    "  aperture_diameter_mm: 8\n  focus_distance: 1\n  blades: 6\n  blade_rotation_deg: 5\n" +
      "  blade_rotation_per_stop_deg: 10",
  );
  const document = PathDocument.parse(text);
  const [open, degrees] = [cameraAt([0, 0, 0], { radius: 0.004, blades: 6 }), Math.PI / 180];
  open.rotation = 5 * degrees;
  const closed = withRadius(open, 0.002, rotationPerStop(document));
  assertNear([closed.rotation], [25 * degrees]); // two stops
  // A turn by 3 degrees is written as a change of blade_rotation, without the rotation that the stops cause.
  rotationWriter(open.radius)(document, 0.1, { ...closed, rotation: 28 * degrees });
  assert.match(document.text(), /blade_rotation_deg: 8\n/);
});

test("a tilted focus plane is that of the programs", () => {
  const document = PathDocument.parse(path("  f_number: 4\n  focus_distance: 2"));
  const camera = cameraAt([0, 0, 0], { focusDistance: 2, tiltHorizontal: 0.5, tiltVertical: -0.3 });
  const tilted = withTilt(camera);
  // A point 0.4 to the right and 0.2 above, at the depth that the definition of the tilt gives.
  const depth = 2 + 0.4 * Math.tan(0.5) + 0.2 * Math.tan(-0.3);
  assertNear([0.4 * tilted.normal[0] - 0.2 * tilted.normal[1] + depth * tilted.normal[2]], [tilted.offset]);
  assertNear([Math.hypot(...tilted.normal)], [1]);
  assert.equal(writeTilt(document, 0, tilted), "");
  const read = readByPrograms(document.text()).cameras[0];
  assertNear(read.focus_tilt_deg, [28.6479, -17.1887], 1e-3);
});
