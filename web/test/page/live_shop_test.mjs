// SPDX-License-Identifier: Apache-2.0
// Tests the live picture of photographs: what a person focuses there, lfrenderer renders sharply.
import assert from "node:assert/strict";
import { copyFile } from "node:fs/promises";
import { test } from "node:test";

import { allLoaded, dragFocus, focusNow, gradientEnergy, labels, openLive, stillPicture } from "./live_case.mjs";
import { SHOP, withPage, withShop, writePath } from "./page_case.mjs";
import { run, until } from "./visualizer.mjs";

// Places in the frame, and the path, which is focused far before both.
const SIGN = { x: 0.63, y: 0.24 };
const ROBOT = { x: 0.54, y: 0.78 };
const PATH = `format: lfpath 1
fps: 1
frames: 2
resolution: [240, 160]
camera:
  focal_length_mm: 30
  position: [0, 0, 0]
  orientation: {yaw: 0}
lens:
  aperture_diameter: 0.4
keyframes:
  focus_distance: [{time: 0, value: 4.5}, {time: 1, value: 4.5}]
`;

// Renders both frames of a path, and returns their files.
async function rendered(path) {
  const frames = `${path}.frames`;
  await run("lfrenderer", [SHOP, path, "-o", frames, "--format", "png", "--no-contact-sheet", "-q"]);
  return [1, 2].map((frame) => `${frames}/frame_000${frame}.png`);
}

test("what is focused in the live picture is sharp in the rendered frames", withShop, async () => {
  const path = await writePath(PATH);
  const old = `${path}.old.yaml`;
  await copyFile(path, old);
  await withPage([SHOP, path], async (page) => {
    const box = await openLive(page);
    await allLoaded(page);
    const energies = async () => [await gradientEnergy(page, SIGN), await gradientEnergy(page, ROBOT)];
    const before = await energies();

    // A click focuses the first frame on the sign.
    await page.mouse.click(box.x + SIGN.x * box.width, box.y + SIGN.y * box.height);
    await until(page, "app.state.isShown && app.state.camera.focusDistance > 7");
    await stillPicture(page);
    const clicked = await energies();
    assert.ok(clicked[0] > 2 * before[0], `sign: ${before[0]} to ${clicked[0]}`);

    // A drag focuses the second one on the robot, which is nearer.
    await page.keyboard.press("ArrowRight");
    await until(page, "app.state.frame === 2 && app.state.isShown");
    await stillPicture(page);
    await dragFocus(page, box, 6.3);
    await page.mouse.up();
    await until(page, "app.state.isShown && app.state.camera.focusDistance > 6");
    await stillPicture(page);
    const dragged = await energies();
    assert.ok(dragged[1] > 2 * before[1], `robot: ${before[1]} to ${dragged[1]}`);
    assert.deepEqual(await labels(page), ["focus there", "change focus distance"]);
    assert.ok(Math.abs((await focusNow(page)) - 6.3) < 0.2);

    await page.keyboard.press("Control+s");
    await until(page, "!app.state.isChanged");
    const [blurred, films] = [await rendered(old), await rendered(path)];
    for (const [i, place] of [SIGN, ROBOT].entries()) {
      const [was, is] = [blurred[i], films[i]].map((file) => gradientEnergy(page, place, 0.05, file));
      assert.ok((await is) > 2 * (await was), `frame ${i + 1}: ${await was} to ${await is}`);
    }
  });
});
