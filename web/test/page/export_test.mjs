// SPDX-License-Identifier: Apache-2.0
// Tests an exported page that is opened from the disk, without a network.
import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";

import { dragFocus, focusNow, gradientEnergy, openLive, STAR, stillPicture, WIDE } from "./live_case.mjs";
import { browser, temporary, writePath } from "./page_case.mjs";
import { openPage, run, until } from "./visualizer.mjs";

let exports = 0;

// Exports a page of a chart that is made with some options, and opens it from the disk.
async function withExport(made, words, body) {
  const [chart, site] = ["field", "site"].map((name) => join(temporary.folder, `${name}${++exports}`));
  await run("lfsynth", ["chart", "-o", chart, "--count", "81", "--size", "240x160", "-q", ...made]);
  const path = await writePath(WIDE);
  const { output } = await run("lfvisualizer", [chart, path, "--max-angle", "45", "--export", site, "-q", ...words]);
  const address = `${pathToFileURL(site).href}/`;
  const options = { query: "index.html", offline: true, viewport: { width: 700, height: 500 } };
  const { page, faults, close } = await openPage(browser, address, options);
  await body(page, output);
  assert.deepEqual(faults, []);
  await close();
}

// Waits until all LF images of the export are decoded. On a busy machine, pictures are then made of some of them.
function allDecoded(page) {
  return until(page, "(({ done, wanted, images }) => done === wanted && images > 0)(app.live.view.shown.facts)");
}

// Waits until the page shows another picture than the one with this number, and returns its number.
async function nextPicture(page, version) {
  await until(page, `app.live.view.canvas.dataset.version > ${version}`);
  await stillPicture(page);
  return page.evaluate("Number(lfvisualizer.live.view.canvas.dataset.version)");
}

const cameraNow = (page) => page.evaluate("lfvisualizer.live.camera.camera");

test("an exported page on the disk refocuses, and opens, tilts and moves its camera", async () => {
  await withExport([], [], async (page, output) => {
    assert.match(output, /81 for live pictures \([\d.]+ [kM]?B\)/);
    const box = await openLive(page);
    await allDecoded(page);
    await stillPicture(page);
    assert.equal(await page.evaluate("lfvisualizer.live.view.shown.by"), "webgl");
    const before = await gradientEnergy(page, STAR);
    let version = await nextPicture(page, 0);
    await dragFocus(page, box, 1.003);
    await page.mouse.up();
    version = await nextPicture(page, version);
    assert.ok((await focusNow(page)) < 1.1);
    const after = await gradientEnergy(page, STAR);
    assert.ok(after > 1.3 * before, `${before} to ${after}`);

    const { radius } = await cameraNow(page);
    await page.mouse.move(box.x + 50, box.y + 50);
    await page.mouse.wheel(0, 100);
    version = await nextPicture(page, version);
    assert.ok((await cameraNow(page)).radius < radius);
    await page.selectOption("[aria-label='Blades of the aperture']", "5");
    version = await nextPicture(page, version);
    await page.locator("[aria-label='Tilt ↔']").fill("0.5");
    version = await nextPicture(page, version);
    const { blades, normal, centre } = await cameraNow(page);
    assert.equal(blades, 5);
    assert.ok(Math.abs(normal[0]) > 0.4, `${normal}`);
    await page.click("button:text-is('Camera')");
    await page.keyboard.press("ArrowLeft");
    version = await nextPicture(page, version);
    assert.notDeepEqual((await cameraNow(page)).centre, centre);
    await page.keyboard.press("c");
    await page.mouse.click(box.x + 20, box.y + 20);
    await page.waitForSelector("#message:has-text('cannot measure distances')");
    // Another frame forgets the changes.
    await page.keyboard.press("End");
    await nextPicture(page, version);
    assert.equal((await cameraNow(page)).blades, 0);
  });
});

test("an export keeps to the size of its live pictures, and masks pixels", async () => {
  const made = ["--alpha", "straight", "--format", "png"];
  await withExport(made, ["--export-live", "100K", "--image-alpha", "mask"], async (page, output) => {
    const [, count, size] = output.match(/(\d+) for live pictures \(([\d.]+) kB\)/);
    assert.ok(Number(count) > 5 && Number(count) < 81, output);
    assert.ok(Number(size) < 110, output);
    await openLive(page);
    await allDecoded(page);
    const shares = await page.evaluate(() => {
      const { halves } = window.lfvisualizer.live.view.shown.picture;
      let covered = 0;
      for (let i = 3; i < halves.length; i += 4) covered += halves[i] > 0 ? 1 : 0;
      return (4 * covered) / halves.length;
    });
    assert.ok(shares > 0.1 && shares < 0.9, `${shares}`);
  });
});

test("an export of distorted LF images refocuses", async () => {
  await withExport(["--distortion", "0.12,-0.25,0.001,-0.002"], [], async (page, output) => {
    assert.match(output, /81 for live pictures/);
    const box = await openLive(page);
    await allDecoded(page);
    await stillPicture(page);
    const before = await gradientEnergy(page, STAR);
    const version = await nextPicture(page, 0);
    await dragFocus(page, box, 1.003);
    await page.mouse.up();
    await nextPicture(page, version);
    const after = await gradientEnergy(page, STAR);
    assert.ok(after > 1.3 * before, `${before} to ${after}`);
  });
});

test("an export without live pictures says why", async () => {
  const made = ["--alpha", "straight", "--format", "png"];
  await withExport(made, ["--background", "none"], async (page) => {
    assert.equal(await page.isVisible("[data-view=live]"), false);
    await page.click("[data-tab=lens]");
    assert.match(await page.textContent("aside"), /without live pictures: .*opacities/);
  });
});
