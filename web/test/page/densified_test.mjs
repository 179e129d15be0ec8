// SPDX-License-Identifier: Apache-2.0
// Tests the page of a densified light field: virtual LF cameras differ from recorded ones, and a preview shows the
// picture with or without virtual LF images.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { test } from "node:test";

import { allLoaded, openLive } from "./live_case.mjs";
import { temporary, withPage } from "./page_case.mjs";
import { run, until } from "./visualizer.mjs";

// Makes 4 x 4 LF images, a densified store of them, and a path.
async function makeStore(name) {
  const field = join(temporary.folder, name);
  const store = `${field}.lfs`;
  await run("lfsynth", ["still-life", "-o", field, "--count", "16", "--size", "96x72", "--spacing", "0.02", "-q"]);
  await run("lfdensify", [field, "-o", store, "--most", "60", "--depths", "0.35", "6", "--force"]);
  const path = `${field}.yaml`;
  await run("lfexample", [field, "-o", path, "--move", "static", "-q"]);
  return { field, store, path };
}

// Renders a preview and returns the pixels of its picture.
async function previewed(page, start) {
  const old = await page.evaluate("lfvisualizer.state.preview?.changed ?? ''");
  await start();
  await until(page, `app.state.preview?.state === 'finished' && app.state.preview.changed !== ${JSON.stringify(old)}`);
  const { frame, changed } = await page.evaluate("lfvisualizer.state.preview");
  await page.waitForSelector(`.picture canvas[data-version='preview/${frame}.bin?${changed}']`);
  return page.evaluate(() => {
    const canvas = document.querySelector(".picture canvas[data-version]");
    return [...canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data];
  });
}

test("virtual LF cameras have a row of the legend, and are marked and hidden", async () => {
  const { store, path } = await makeStore("marked");
  await withPage([store, path], async (page) => {
    await until(page, "app.state.use");
    const [[begin, end]] = await page.evaluate("lfvisualizer.state.scene.light_field.virtual_ranges");
    assert.equal(begin, 16);
    const row = page.locator("#legend label:has([data-use=virtual])");
    assert.equal(await row.locator("b").textContent(), String(end - begin));
    await page.keyboard.press("2");
    const picked = (id) =>
      page.evaluate((id) => {
        const { view, state } = window.lfvisualizer;
        const [x, y, z] = state.positions.slice(3 * id, 3 * id + 3);
        const place = view.points.object.position.clone().set(x, y, z).project(view.camera);
        return view.points.pick(view.camera, 1000, 1000, 500 + 500 * place.x, 500 - 500 * place.y);
      }, id);
    assert.equal(await picked(begin), begin);
    assert.equal(await picked(0), 0);
    await row.click();
    assert.notEqual(await picked(begin), begin);
    assert.equal(await picked(0), 0);
    await page.evaluate((id) => window.lfvisualizer.state.select(id), begin);
    await page.click("[data-tab=image]");
    await page.waitForSelector("dd:has-text('Virtual: interpolated from recorded LF images')");
    await page.evaluate(() => window.lfvisualizer.state.select(0));
    await page.waitForSelector("h2:has-text('LF image 0')");
    assert.equal(await page.locator("dd:has-text('Virtual')").count(), 0);
  });
});

test("the live picture is made with or without virtual LF images", async () => {
  const { field, store, path } = await makeStore("live");
  const images = (page) => page.evaluate("lfvisualizer.live.view.shown.facts.images");
  await withPage([store, path], async (page) => {
    await openLive(page);
    await allLoaded(page);
    const all = await images(page);
    await page.click("button:text-is('Recorded alone'):visible");
    await until(page, `app.live.view.shown.facts.images < ${all}`);
    await allLoaded(page);
    assert.ok((await images(page)) <= 16);
    await page.click("button:text-is('Densified'):visible");
    await until(page, `app.live.view.shown.facts.images === ${all}`);
  });
  await withPage([field, path], async (page) => {
    await openLive(page);
    assert.equal(await page.locator("button:text-is('Recorded alone'):visible").count(), 0);
  });
});

test("copies of a sparse light field are shown with the command that fills the lens, which works", async () => {
  const field = join(temporary.folder, "sparse");
  const path = `${field}.yaml`;
  await run("lfsynth", ["still-life", "-o", field, "--count", "16", "--size", "192x144", "--spacing", "0.03", "-q"]);
  await run("lfexample", [field, "-o", path, "--move", "static", "-q"]);
  await writeFile(path, (await readFile(path, "utf8")).replace(/aperture_diameter: \S+/, "aperture_diameter: 0.06"));
  const line = "[data-part=copies]";
  let command;
  await withPage([field, path], async (page) => {
    await openLive(page);
    await allLoaded(page);
    await page.waitForSelector(line);
    [, command] = /elements apart: (lfrenderer .* --densify -o frames) fills the lens$/.exec(
      await page.textContent(line),
    );
    assert.equal(await page.evaluate("lfvisualizer.state.scene.commands.densify"), command);
    await page.click("#commands");
    await page.waitForSelector(`dialog pre:has-text("--densify")`);
  });
  const frames = join(temporary.folder, "frames");
  await run("lfrenderer", [
    ...command
      .replace(/ -o frames$/, "")
      .split(" ")
      .slice(1),
    "-o",
    frames,
    "-q",
  ]);
  await withPage([join(frames, "densified.lfs"), path], async (page) => {
    await openLive(page);
    await allLoaded(page);
    assert.ok(await page.evaluate("lfvisualizer.live.view.shown.facts.images > 16"));
    assert.equal(await page.locator(line).count(), 0);
  });
});

test("a preview shows the frame with virtual LF images, or that of the light field as it was recorded", async () => {
  const { field, store, path } = await makeStore("previewed");
  let alone;
  await withPage([store, path], async (page) => {
    const dense = await previewed(page, () => page.keyboard.press("p"));
    alone = await previewed(page, () => page.click("button:has-text('Recorded alone'):visible"));
    assert.notDeepEqual(alone, dense);
    assert.deepEqual(await previewed(page, () => page.click("button:has-text('Densified'):visible")), dense);
  });
  await withPage([field, path], async (page) => {
    assert.equal(await page.locator("#legend [data-use=virtual]").count(), 0);
    assert.deepEqual(await previewed(page, () => page.keyboard.press("p")), alone);
    assert.equal(await page.locator("button:has-text('Recorded alone'):visible").count(), 0);
  });
});
