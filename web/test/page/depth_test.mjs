// SPDX-License-Identifier: Apache-2.0
// Tests the layer of depths in the view in space: what is drawn, and focusing on a point.
import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

import { browser, chart, temporary, withPage, writePath } from "./page_case.mjs";
import { CHART_PATH } from "./paths.mjs";
import { openPage, run, until } from "./visualizer.mjs";

let made = null;

// Returns a path, and the depths of its first frame as a map and as a cloud. They are made once.
async function depthFiles() {
  const make = async () => {
    const path = await writePath(CHART_PATH);
    const [map, cloud] = ["depth.exr", "points.ply"].map((name) => join(temporary.folder, name));
    await run("lffocus", ["depth", chart, path, "-o", map, "-o", cloud, "--near", "0.5", "--far", "2", "--fill", "-q"]);
    return { path, map, cloud };
  };
  made ??= make();
  return made;
}

// Returns the share of the view that differs from its background, without cameras and focus plane.
async function drawnShare(page) {
  return page.evaluate(`(() => {
    const { view } = lfvisualizer;
    view.model.object.visible = view.points.object.visible = false;
    const canvas = document.getElementById("scene");
    view.render();
    const gl = canvas.getContext("webgl2");
    const { drawingBufferWidth: width, drawingBufferHeight: height } = gl;
    const pixels = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let count = 0;
    for (let i = 0; i < pixels.length; i += 4)
      if (Math.hypot(pixels[i] - pixels[0], pixels[i + 1] - pixels[1], pixels[i + 2] - pixels[2]) > 24) ++count;
    return count / (width * height);
  })()`);
}

const shownCount = (page) => page.textContent("[data-depth=file] ~ b");
const focusDistance = (page) => page.evaluate("lfvisualizer.state.camera.focusDistance");

// Sets a slider as a person does.
const slide = (page, name, value) =>
  page.evaluate(
    `(() => {
      const slider = document.querySelector("[data-depth=${name}]");
      slider.value = "${value}";
      slider.dispatchEvent(new Event("input"));
    })()`,
  );

// Returns the focus distance for the point that is drawn at a place in the view in space, in pixels from its middle.
const distanceAt = (page, across, down) =>
  page.evaluate(`(() => {
    const { view, state } = lfvisualizer;
    const { clientWidth, clientHeight } = document.getElementById("scene");
    const { place } = view.pickPoint(clientWidth / 2 + ${across}, clientHeight / 2 + ${down});
    const { origin } = state.scene.light_field;
    return place.reduce((sum, x, i) => sum + (x + origin[i] - state.camera.centre[i]) * state.camera.forward[i], 0);
  })()`);

test("depths are drawn, hidden by D, coloured by distance, and limited to sure ones", async () => {
  const { path, map } = await depthFiles();
  await withPage([chart, path, "--depth", map], async (page) => {
    await until(page, "app.state.use");
    await page.keyboard.press("5");
    const all = await drawnShare(page);
    await page.keyboard.press("d");
    const without = await drawnShare(page);
    assert.ok(all > without + 0.1, `${without} to ${all}`);
    assert.equal(await page.isChecked("[data-depth=shown]"), false);
    await page.keyboard.press("d");
    assert.equal(await drawnShare(page), all);
    await page.click("[data-depth=colour]");
    assert.equal(await page.evaluate("lfvisualizer.view.clouds[0].uniforms.byDepth.value"), 1);
    const count = await page.evaluate("lfvisualizer.depths.facts[0].points");
    // With --fill, all elements have a depth.
    assert.equal(count, await page.evaluate("lfvisualizer.state.path.width * lfvisualizer.state.path.height"));
    await slide(page, "least", 0.7);
    const sure = await page.evaluate("lfvisualizer.view.clouds[0].shownCount()");
    assert.ok(sure > 0 && sure < count, `${sure} of ${count}`);
    assert.ok((await shownCount(page)).length > 0);
    assert.ok((await drawnShare(page)) < all);
    await page.click("[data-depth=file]");
    assert.ok(Math.abs((await drawnShare(page)) - without) < 0.002);
  });
});

test("a click on a point, or X, focuses on it, and Undo takes it back", async () => {
  const { path, map, cloud } = await depthFiles();
  await withPage([chart, path, "--depth", map, "--depth", cloud], async (page) => {
    await until(page, "app.state.use");
    await page.keyboard.press("5");
    const before = await focusDistance(page);
    // Beside the LF camera in the middle, which is in front of all points.
    const expected = await distanceAt(page, 90, 40);
    assert.ok(Math.abs(expected - before) > 1e-3, `${expected}`);
    const box = await page.locator("#scene").boundingBox();
    await page.mouse.click(box.x + box.width / 2 + 90, box.y + box.height / 2 + 40);
    await until(page, `Math.abs(app.state.camera.focusDistance - ${expected}) < 1e-5`);
    assert.match(await page.textContent("#message"), /^Focused at [\d.]+ \([\d.]+ m+\), the point at /);
    assert.equal(await page.evaluate("lfvisualizer.state.selected"), null);
    await page.keyboard.press("Control+z");
    await until(page, `Math.abs(app.state.camera.focusDistance - ${before}) < 1e-9`);
    const ofMiddle = await distanceAt(page, 0, 0);
    await page.keyboard.press("x");
    await until(page, `Math.abs(app.state.camera.focusDistance - ${ofMiddle}) < 1e-5`);
    // Hidden points cannot be focused on.
    await page.keyboard.press("d");
    await page.keyboard.press("x");
    await until(page, "app.state.message?.text.startsWith('No point of the depths')");
  });
});

test("an exported page tells where a point is, without a network", async () => {
  const { path, cloud } = await depthFiles();
  const site = join(temporary.folder, "site");
  await run("lfvisualizer", [chart, path, "--depth", cloud, "--export", site, "-q"]);
  const { page, faults, close } = await openPage(browser, `${pathToFileURL(site).href}/`, {
    query: "index.html",
    offline: true,
  });
  await until(page, "app.state.use");
  await page.keyboard.press("5");
  const before = await focusDistance(page);
  await page.keyboard.press("x");
  await until(page, "app.state.message?.text.startsWith('At ')");
  assert.match(await page.textContent("#message"), /^At [\d.]+ \([\d.]+ m+\), the point at /);
  assert.equal(await focusDistance(page), before);
  assert.notEqual(await page.evaluate("lfvisualizer.live.camera.camera.focusDistance"), before);
  assert.deepEqual(faults, []);
  await close();
});
