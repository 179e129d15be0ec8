// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";

import type { LiveFacts } from "../../src/data/live_picture";
import { USES, type FrameUse } from "../../src/data/frame_use";
import type { DensityFacts } from "../../src/data/scene";
import { copiesText, differenceText, memoryText } from "../../src/live/live_status";
import { bytes, byteSize } from "../../src/words";

test("sizes are rounded up, and can be given to the programs", () => {
  assert.equal(byteSize(512 * 1024 ** 2), "512M");
  assert.equal(byteSize(512 * 1024 ** 2 + 1), "513M");
  assert.equal(byteSize(1024 ** 3), "1G");
  assert.equal(byteSize(3.41 * 1024 ** 3), "3.5G");
  assert.equal(bytes(1.5 * 1024 ** 3), "1.5 GiB");
});

test("a memory limit is shown with what all LF images need", () => {
  const facts = { wanted: 109, needed: 729, memory_bytes: 512 * 1024 ** 2, image_bytes: 4_900_000 } as LiveFacts;
  assert.equal(memoryText(facts), "109 of 729 LF images: memory limit 512 MiB; all need --live-memory 3.4G");
});

test("copies that are far apart are shown with the command that fills the lens", () => {
  const density = { copies_px: 31.4 } as DensityFacts;
  const command = "lfrenderer capture path.yaml --densify -o frames";
  assert.equal(copiesText(density, command, false), `copies 31 elements apart: ${command} fills the lens`);
  assert.equal(
    copiesText(density, command, true),
    `copies 31 elements apart: save the path, and then ${command} fills the lens`,
  );
  assert.equal(copiesText(density, "", false), null);
  assert.equal(copiesText({ copies_px: null } as DensityFacts, command, false), null);
  assert.equal(copiesText(null, command, false), null);
});

test("a live picture that has not the LF images of the frame says why", () => {
  const facts = { used: 69, wanted: 100, needed: 100, broken: 0 } as LiveFacts;
  const use = (count: number, why: (typeof USES)[number] | null = null): FrameUse => ({
    frame: 1,
    cameraDistance: null,
    ids: new Uint32Array(count),
    shares: new Float32Array(count),
    ofCameras: Uint8Array.from(why ? [USES.indexOf("used"), USES.indexOf(why)] : [USES.indexOf("used")]),
  });
  assert.equal(differenceText(facts, use(69, "limit")), null);
  assert.equal(differenceText(facts, use(9, "limit")), "the frame takes 9, limited by --max-images or its package");
  assert.equal(differenceText(facts, use(9, "angle")), "the frame takes 9, limited by --max-angle");
  assert.equal(
    differenceText(facts, use(70)),
    "the frame takes 70, because the film has another size than this picture",
  );
  assert.equal(
    differenceText({ ...facts, needed: 800, broken: 2 }, use(20_000)),
    "the frame takes 20 k, because memory is limited, broken ones included",
  );
});
