// SPDX-License-Identifier: Apache-2.0
// Makes doc/images/visualizer_live.webp, a film of the live picture in use: focus, aperture, blades, tilt and orbit by the
// mouse. Needs Chromium and ffmpeg, and the packages of web/.
//
// usage: LF_BIN=build/release/bin node doc/figures/live_film.mjs FILM.webp [PICTURES]
//
// PICTURES  a folder that receives the single pictures
//
// Each picture of the film is a screenshot of the page after the live picture has followed the mouse, so that the film
// does not depend on the speed of the machine.
import { execFileSync } from "node:child_process";
import { mkdir, stat, writeFile } from "node:fs/promises";
import { join, resolve } from "node:path";

import { allLoaded, stillPicture } from "../../web/test/page/live_case.mjs";
import { openBrowser, openPage, run, serve, temporaryFolder, until } from "../../web/test/page/visualizer.mjs";

const VIEW = { width: 1000, height: 600 };
const PER_SECOND = 8;
const MOST_BYTES = 2e6;
// Two places on the far ball at the left, and one on the near glass ball at the right, as shares of width and height.
const PLACES = [
  [0.1, 0.45],
  [0.1, 0.55],
  [0.66, 0.5],
];
const PATH = `format: lfpath 1
fps: 8
frames: 9
resolution: [360, 240]
camera:
  field_of_view_deg: 47
  position: [0, -0.12495, -0.799]
  look_at: [0, -0.0016, 1.668]
lens:
  aperture_diameter: 0.04
  focus_distance: 0.85
`;

const [film, kept] = process.argv.slice(2).map((name) => resolve(name));
if (!film) throw new Error("usage: LF_BIN=build/release/bin node doc/figures/live_film.mjs FILM.webp [PICTURES]");
const { folder, remove } = await temporaryFolder();
const browser = await openBrowser();
const pictures = kept ?? join(folder, "pictures");
await mkdir(pictures, { recursive: true });
process.chdir(folder); // so that the page shows short names
await writeFile("film.yaml", PATH);
await run("lfsynth", ["still-life", "-o", "still-life", "--count", "289", "--size", "360x240", "--samples", "4", "-q"]);
const server = await serve(["still-life", "film.yaml"]);
const { page } = await openPage(browser, server.address, { viewport: VIEW });

// An arrow stands for the mouse, which screenshots do not show.
await page.evaluate(() => {
  const space = "http://www.w3.org/2000/svg";
  const mouse = document.createElementNS(space, "svg");
  mouse.id = "film-mouse";
  mouse.setAttribute("viewBox", "0 0 12 18");
  Object.assign(mouse.style, { position: "fixed", width: "16px", height: "24px", zIndex: 99, pointerEvents: "none" });
  const arrow = document.createElementNS(space, "path");
  arrow.setAttribute("d", "M0 0 L0 15 L4 11 L7 18 L9 17 L6 10 L12 10 Z");
  for (const [name, value] of Object.entries({ fill: "white", stroke: "black" })) arrow.setAttribute(name, value);
  mouse.append(arrow);
  document.body.append(mouse);
});

let count = 0;
async function shoot(times = 1) {
  for (let i = 0; i < times; ++i)
    await page.screenshot({ path: join(pictures, `${String(++count).padStart(4, "0")}.png`) });
}

let mouse = [VIEW.width / 3, VIEW.height / 3];
async function moveTo(x, y) {
  mouse = [x, y];
  await page.mouse.move(x, y);
  await page.evaluate(([left, top]) => {
    Object.assign(document.querySelector("#film-mouse").style, { left: `${left}px`, top: `${top}px` });
  }, mouse);
}

// Waits until the live picture does not change any more, although a mouse button may still be down.
async function followed() {
  const version = "document.querySelector('#live-picture canvas').dataset.version";
  let last = "";
  for (let same = 0; same < 3; await page.waitForTimeout(80)) {
    const now = await page.evaluate(version);
    same = now === last ? same + 1 : 0;
    last = now;
  }
}

async function glide(x, y, steps) {
  const [fromX, fromY] = mouse;
  for (let i = 1; i <= steps; ++i) {
    await moveTo(fromX + ((x - fromX) * i) / steps, fromY + ((y - fromY) * i) / steps);
    await followed();
    await shoot();
  }
}

async function settled() {
  await stillPicture(page);
  await followed();
}

await page.keyboard.press("l");
await settled();
await allLoaded(page);
await followed();
const box = await page.locator("#live-picture").boundingBox();
const at = (u, v) => [box.x + u * box.width, box.y + v * box.height];

// Focus: drags from the balls behind to the marbles in front, and back.
await moveTo(...at(0.98, 0.6));
await shoot(4);
for (const u of [0.02, 0.98]) {
  await page.mouse.down();
  await glide(...at(u, 0.6), 14);
  await page.mouse.up();
  await settled();
  await shoot(3);
}
await glide(...at(0.5, 0.6), 3);

// Aperture: the wheel closes and opens it.
for (const turn of [100, -100]) {
  for (let i = 0; i < 8; ++i) {
    await page.mouse.wheel(0, 2 * turn);
    await followed();
    await shoot();
  }
  await until(page, "app.state.isShown && !app.live.camera.isChanging");
  await settled();
}
await shoot(2);

// Tilt: three places become sharp.
await page.keyboard.down("Shift");
for (const [i, place] of PLACES.entries()) {
  await glide(...at(...place), 3);
  await page.mouse.click(...mouse);
  await until(page, "!/Comparing/.test(app.state.message?.text ?? '')");
  console.log(`place ${i + 1}: ${await page.evaluate("lfvisualizer.state.message?.text")}`);
  await until(page, "app.state.isShown");
  await settled();
  await shoot(3);
}
await page.keyboard.up("Shift");
await shoot(4);

// The camera moves round the point in focus.
await page.keyboard.down("Alt");
await moveTo(...at(0.5, 0.5));
await page.mouse.down();
await glide(...at(0.57, 0.5), 5);
await glide(...at(0.45, 0.5), 8);
await glide(...at(0.5, 0.5), 4);
await page.mouse.up();
await page.keyboard.up("Alt");
await settled();
await shoot(6);

await server.stop();
await browser.close();
// prettier-ignore
execFileSync("ffmpeg", ["-y", "-loglevel", "error", "-framerate", PER_SECOND, "-i", join(pictures, "%04d.png"),
  "-c:v", "libwebp_anim", "-loop", "0", "-quality", "60", "-compression_level", "6", film]);
const { size } = await stat(film);
console.log(`${film}: ${count} pictures, ${size} bytes`);
await remove();
if (size > MOST_BYTES) throw new Error(`${film} is larger than ${MOST_BYTES} bytes`);
