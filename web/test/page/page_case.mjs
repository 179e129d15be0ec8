// SPDX-License-Identifier: Apache-2.0
// Opens a browser for the tests that import this, makes a light field, and serves pages of it. Without Chromium, ends
// the process with 77: skipped.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before } from "node:test";

import { CHART_PATH } from "./paths.mjs";
import { DATA, findBrowser, openBrowser, openPage, run, serve, temporaryFolder } from "./visualizer.mjs";

if (!findBrowser()) {
  console.log("Chromium is missing: nothing is tested");
  process.exit(77);
}

export const SHOP = join(DATA, "data/blender-shop/images");
export const withShop = { skip: DATA && existsSync(SHOP) ? false : "blender-shop is not there" };

// Are set before the first test.
export let browser, temporary, chart;
let pathCount = 0;

before(async () => {
  browser = await openBrowser();
  temporary = await temporaryFolder();
  chart = join(temporary.folder, "chart");
  await run("lfsynth", ["chart", "-o", chart, "--count", "81", "--size", "120x80", "-q"]);
});

after(async () => {
  await browser?.close();
  await temporary?.remove();
});

export async function writePath(text) {
  const path = join(temporary.folder, `path-${++pathCount}.yaml`);
  await writeFile(path, text);
  return path;
}

// Serves and opens a page. At the end, checks that there were no error messages and that Ctrl-C
// ends the server.
export async function withPage(words, body, options) {
  const server = await serve(words);
  try {
    const { page, faults, close } = await openPage(browser, server.address, options);
    await body(page, server.address);
    assert.deepEqual(faults, []);
    await close();
  } finally {
    assert.equal(await server.stop(), 0);
  }
}

export async function withChart(body, text = CHART_PATH, words = []) {
  const path = await writePath(text);
  await withPage([chart, path, ...words], (page, address) => body(page, path, address));
}
