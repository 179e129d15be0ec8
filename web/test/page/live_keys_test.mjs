// SPDX-License-Identifier: Apache-2.0
// Tests that every change in the live picture can become a key of the path, and is undone.
import assert from "node:assert/strict";
import { test } from "node:test";

import { labels, openLive } from "./live_case.mjs";
import { chart, withChart, withPage, writePath } from "./page_case.mjs";
import { CHART_PATH } from "./paths.mjs";
import { until } from "./visualizer.mjs";

const TIME = 0.5; // of frame 6, at which the tests change the path
const textNow = (page) => page.evaluate("lfvisualizer.state.document.text()");

// Makes a change, and checks that these quantities have a key at this frame and that undoing restores the text.
async function becomesKeys(page, change, quantities) {
  const before = await textNow(page);
  await change();
  await until(page, `app.state.document.text() !== ${JSON.stringify(before)} && app.state.isShown`);
  assert.equal(await page.evaluate("lfvisualizer.state.invalid"), null);
  for (const name of quantities) {
    const times = await page.evaluate((one) => {
      const quantity = window.lfvisualizer.state.document.quantity(one);
      return quantity.keyframes.map((key) => key.time);
    }, name);
    assert.ok(times.includes(TIME), `${name}: keys at ${times}`);
  }
  await page.keyboard.press("Control+z");
  await until(page, `app.state.document.text() === ${JSON.stringify(before)} && app.state.isShown`);
}

// Shift-clicks one place on the left board and two on the star, which is farther away.
async function clickPlane(page, box) {
  await page.keyboard.down("Shift");
  for (const [i, [x, y]] of [
    [0.3, 0.3],
    [0.6, 0.7],
    [0.4, 0.7],
  ].entries()) {
    await page.mouse.click(box.x + x * box.width, box.y + y * box.height);
    await until(page, i < 2 ? `app.state.planePoints?.points.length === ${i + 1}` : "app.state.planePoints === null");
  }
  await page.keyboard.up("Shift");
}

test("every change of the lens and the camera becomes a key if keys are wanted, and is undone", async () => {
  const path = CHART_PATH.replace("  focus_distance: 1\n", "  focus_distance: 1\n  blades: 6\n");
  await withChart(
    async (page) => {
      const box = await openLive(page);
      await page.evaluate("lfvisualizer.state.setFrame(6)");
      await page.click("button:text-is('◆ Keys')");
      assert.equal(await page.getAttribute("button:text-is('◆ Keys')", "aria-pressed"), "true");
      await becomesKeys(page, () => clickPlane(page, box), ["focus_distance", "focus_tilt"]);
      await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
      await becomesKeys(page, () => page.keyboard.press("."), ["focus_distance"]);
      await becomesKeys(page, () => page.mouse.wheel(0, -100), ["aperture_diameter"]);
      await becomesKeys(page, () => page.locator("[aria-label=Aperture]").fill("0.4"), ["aperture_diameter"]);
      await becomesKeys(page, () => page.locator("[aria-label=Rotation]").fill("0.5"), ["blade_rotation"]);
      await page.evaluate("document.activeElement.blur()"); // a slider takes arrow keys
      await page.keyboard.press("c");
      await becomesKeys(page, () => page.keyboard.press("ArrowLeft"), ["position"]);
      await becomesKeys(page, () => page.keyboard.press("Shift+ArrowUp"), ["position", "look_at"]);
      await becomesKeys(page, () => page.keyboard.press("PageUp"), ["position"]);
      // The number of blades and the exposure cannot change in a film.
      await page.selectOption("[aria-label='Blades of the aperture']", "5");
      await until(page, "app.state.isShown && app.state.cameras[0].blades === 5");
      await page.keyboard.press("Control+z");
      await until(page, "!app.state.isChanged && app.state.isShown && app.state.camera.blades === 6");
      await page.locator("[aria-label='Exposure, stops']:visible").fill("1");
      assert.equal(await page.evaluate("lfvisualizer.state.isChanged"), false);
    },
    path,
    ["--max-angle", "45"],
  );
});

test("without keys, a change holds for the whole film", async () => {
  await withChart(async (page) => {
    const box = await openLive(page);
    await page.evaluate("lfvisualizer.state.setFrame(6)");
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.wheel(0, -100);
    await until(page, "app.state.isShown && app.state.cameras.every((one) => one.radius > 0.0065)");
    assert.deepEqual(await labels(page), ["change aperture"]);
  });
});

test("the slider of the focus moves although the film has one focus distance", async () => {
  const path = await writePath(CHART_PATH.slice(0, CHART_PATH.indexOf("keyframes:")));
  await withPage([chart, path], async (page) => {
    await openLive(page);
    const slider = page.locator("[aria-label=Focus]");
    const places = [];
    for (const share of [0.3, 0.7]) {
      await slider.fill(String(share));
      await until(page, "app.state.isShown && !app.live.camera.isChanging");
      places.push(Number(await slider.inputValue()));
    }
    assert.ok(Math.abs(places[0] - 0.3) < 0.01 && Math.abs(places[1] - 0.7) < 0.01, `${places}`);
  });
});
