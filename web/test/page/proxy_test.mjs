// SPDX-License-Identifier: Apache-2.0
// Tests the page where its address is not that of lfvisualizer: behind a forwarded port, and behind nginx.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { after, before, test } from "node:test";

import { allLoaded, openLive } from "./live_case.mjs";
import { chart, temporary, writePath } from "./page_case.mjs";
import { CHART_PATH } from "./paths.mjs";
import { findNginx, forwardPort, freePort, startNginx } from "./proxies.mjs";
import { openBrowser, openPage, serve, until } from "./visualizer.mjs";

if (!findNginx()) {
  console.log("nginx is missing: nothing is tested");
  process.exit(77);
}

const PUBLIC = "fields.example"; // is this machine for the browser of this test
let browser;

before(async () => {
  browser = await openBrowser([`--host-resolver-rules=MAP ${PUBLIC} 127.0.0.1`]);
});
after(() => browser?.close());

// Serves a page of the chart, puts a proxy before it, and opens it there.
//   start      starts the proxy: forwards the port `own` to another port
//   name       of the host that the browser shows
//   folder     which the proxy forwards
//   isAllowed  true: lfvisualizer is told the origin that the browser shows
async function withProxy({ start, name, folder = "/fields", isAllowed = false }, body) {
  const path = await writePath(CHART_PATH);
  const own = await freePort();
  const origin = `http://${name}:${own}`;
  const server = await serve([chart, path, ...(isAllowed ? ["--allow-origin", origin] : [])]);
  try {
    const { port, pathname } = new URL(server.address);
    const stop = await start(own, Number(port));
    try {
      const { page, faults, close } = await openPage(browser, `${origin}${folder}${pathname}`);
      await body(page, path, { faults, origin });
      await close();
    } finally {
      await stop();
    }
  } finally {
    assert.equal(await server.stop(), 0);
  }
}

// Uses everything that the server answers: the live picture, edits, saving, news, previews, and LF images.
async function useAll(page, path, { faults }) {
  await openLive(page);
  await allLoaded(page);
  await page.keyboard.press("l");
  await page.click("[data-tab=edit]");
  await page.click("summary:has-text('Aperture')");
  await page.fill("[data-quantity=aperture_diameter]", "0.02");
  await page.keyboard.press("Enter");
  await until(page, "Math.abs(app.state.cameras[0].radius - 0.01) < 1e-9");
  await page.keyboard.press("Control+s");
  await until(page, "!app.state.isChanged");
  const saved = await readFile(path, "utf8");
  assert.equal(saved, CHART_PATH.replace("aperture_diameter_mm: 12", "aperture_diameter_mm: 20"));
  await writeFile(path, saved.replace("fps: 10", "fps: 20"));
  await until(page, "app.state.path.fps === 20");
  await page.keyboard.press("p");
  await until(page, "app.state.preview?.state === 'finished'");
  await page.waitForSelector(".picture canvas[data-version^='preview/1.bin']");
  await page.keyboard.press("]");
  await page.waitForFunction(() => document.querySelector(".picture img")?.naturalWidth === 120);
  assert.deepEqual(faults, []);
}

test("the page works at a forwarded port", async () => {
  for (const name of ["127.0.0.1", "localhost"]) await withProxy({ start: forwardPort, name, folder: "" }, useAll);
});

const nginx = (lines) => (own, port) => startNginx(temporary.folder, own, port, lines);

test("the page works below a folder of nginx on this machine, as nginx is by default", async () => {
  await withProxy({ start: nginx(""), name: "localhost" }, useAll);
});

for (const [name, lines] of [
  ["by default", ""],
  ["which passes the host on", "proxy_set_header Host $host;"],
  ["which passes the host and the port on", "proxy_set_header Host $http_host;"],
])
  test(`the page works at another name, below a folder of nginx ${name}`, async () => {
    await withProxy({ start: nginx(lines), name: PUBLIC, isAllowed: true }, useAll);
  });

test("a page of an origin that is not allowed says so, and not that the path has a fault", async () => {
  await withProxy({ start: nginx(""), name: PUBLIC }, async (page, path, { origin }) => {
    const words = `a page of the origin "${origin}" may not use lfvisualizer`;
    await page.click("[data-tab=edit]");
    await page.click("summary:has-text('Aperture')");
    await page.fill("[data-quantity=aperture_diameter]", "0.02");
    await page.keyboard.press("Enter");
    await page.waitForSelector(`#verdict:has-text('This edit was not checked: ${words}')`);
    const message = await page.textContent("#message");
    assert.ok(message.startsWith(`This edit was not checked: ${words}: expected http://127.0.0.1:`), message);
    assert.ok(message.includes(`start lfvisualizer with --allow-origin ${origin}`), message);
    await page.keyboard.press("l");
    await page.waitForSelector(`#live-fault:has-text('The last edit was not checked')`);
    assert.equal(await page.locator("text=has a fault").count(), 0);
    await page.keyboard.press("Control+s");
    await page.waitForSelector(`#message:has-text('${words}')`);
    assert.equal(await readFile(path, "utf8"), CHART_PATH);
  });
});

test("a host that is not allowed is refused with the option that allows it", async () => {
  const path = await writePath(CHART_PATH);
  const server = await serve([chart, path]);
  const { port, pathname } = new URL(server.address);
  const own = await freePort();
  const stop = await nginx("proxy_set_header Host $http_host;")(own, Number(port));
  const page = await browser.newPage();
  const answer = await page.goto(`http://${PUBLIC}:${own}/fields${pathname}`);
  assert.equal(answer.status(), 403);
  assert.ok((await answer.json()).error.includes(`--allow-origin https://${PUBLIC}:${own}`));
  await page.close();
  await stop();
  assert.equal(await server.stop(), 0);
});
