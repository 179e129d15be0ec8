// SPDX-License-Identifier: Apache-2.0
// Makes doc/images/visualizer.jpg, a picture of the page of lfvisualizer that shows an LF image. Needs Chromium and
// ffmpeg, and the packages of web/.
//
// usage: LF_BIN=build/release/bin node doc/figures/page_picture.mjs PICTURE.jpg
import { execFileSync } from "node:child_process";
import { writeFile } from "node:fs/promises";
import { resolve } from "node:path";

import { openBrowser, openPage, run, serve, temporaryFolder, until } from "../../web/test/page/visualizer.mjs";

const PATH = `format: lfpath 1
fps: 24
frames: 73
resolution: [360, 240]
camera:
  field_of_view_deg: 40
  position: [-0.006, -0.12495, -0.83]
  speed: [0.004, 0, 0]
  look_at: [0, -0.0016, 1.668]
lens:
  aperture_diameter: 0.04
  focus_distance: 1.1
  blades: 6
keyframes:
  focus_distance: [{time: 0, value: 1.1}, {time: 1, value: 1.1}, {time: 2.5, value: 0.7}, {time: 3, value: 0.7}]
`;

const [picture] = process.argv.slice(2).map((name) => resolve(name));
if (!picture) throw new Error("usage: LF_BIN=build/release/bin node doc/figures/page_picture.mjs PICTURE.jpg");
const { folder, remove } = await temporaryFolder();
const browser = await openBrowser();
process.chdir(folder); // so that the page shows short names
await writeFile("film.yaml", PATH);
await run("lfsynth", ["still-life", "-o", "still-life", "--count", "441", "--size", "720x480", "--samples", "4", "-q"]);
const server = await serve(["still-life", "film.yaml"]);
const { page } = await openPage(browser, server.address, { viewport: { width: 1120, height: 630 } });
await until(page, "app.state.use");
// One of the LF images that the frame takes; each key chooses the next.
for (let i = 0; i < 60; ++i) await page.keyboard.press("]");
await until(page, "app.state.selected !== null");
await page.click("[data-tab=image]");
await page.waitForFunction(() => document.querySelector(".picture img").naturalWidth > 0);
await page.waitForTimeout(1000); // until the view has turned
await page.screenshot({ path: "page.png" });
execFileSync("ffmpeg", ["-loglevel", "error", "-y", "-i", "page.png", "-q:v", "3", picture]);
await browser.close();
await server.stop();
await remove();
console.log(picture);
