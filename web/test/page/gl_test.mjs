// SPDX-License-Identifier: Apache-2.0
// Compares live pictures that WebGL renders with those of the server. Chromium renders WebGL by software here.
import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";

import { temporary, withPage, writePath } from "./page_case.mjs";
import { run, until } from "./visualizer.mjs";

const LEAST_DB = 60;
const MOST_UNEQUAL = 1e-4; // share of elements that only one of the two pictures covers
const WIDTH = 128;

// A chart that is out of focus, seen by a camera beside the LF cameras.
const PATH = `format: lfpath 1
fps: 1
frames: 1
resolution: [96, 64]
camera:
  field_of_view_deg: 66
  position: [0.004, -0.003, -0.97]
  look_at: [0.01, 0.02, 0]
lens:
  aperture_diameter: 0.05
  focus_distance: 0.8
`;

// Asks the page for the same picture of the server and of WebGL. Returns how they differ: over the elements that both
// cover, the peak signal-to-noise ratio in linear light; and the share of elements that only one covers.
function difference(page, width) {
  return page.evaluate(async (wide) => {
    const { pictures } = window.lfvisualizer.live.view;
    const { camera } = window.lfvisualizer.live.camera;
    const request = { camera, width: wide, budget_ms: null, recordedOnly: false };
    let picture = null;
    for (let i = 0; i < 400; ++i) {
      picture = await pictures.local.ask(request);
      const server = await pictures.server.ask(request);
      // A picture that the page has asked for may supersede that of the server.
      const isLoaded = server?.facts.images > 0 && server.facts.done === server.facts.wanted;
      if (isLoaded && picture?.facts.images === server.facts.images) return compared(picture, server);
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    return "no picture";

    function compared(a, b) {
      const { width: columns, height: rows, halves } = a.picture;
      const other = b.picture.halves;
      if (columns !== b.picture.width || rows !== b.picture.height) return "other sizes";
      let [sum, both, one, most] = [0, 0, 0, 0];
      for (let i = 0; i < columns * rows; ++i) {
        const [isHere, isThere] = [halves[4 * i + 3] !== 0, other[4 * i + 3] !== 0];
        one += isHere !== isThere ? 1 : 0;
        if (!isHere || !isThere) continue;
        ++both;
        for (let c = 0; c < 3; ++c) {
          const d = fromHalf(halves[4 * i + c]) - fromHalf(other[4 * i + c]);
          sum += d * d;
          most = Math.max(most, Math.abs(d));
        }
      }
      const db = sum > 0 ? -10 * Math.log10(sum / (3 * both)) : Infinity;
      return { db, most, unequal: one / (columns * rows), covered: both / (columns * rows), images: a.facts.images };
    }

    function fromHalf(half) {
      const exponent = (half >> 10) & 31;
      const size = exponent === 0 ? (half & 1023) * 2 ** -24 : (1 + (half & 1023) / 1024) * 2 ** (exponent - 15);
      return half & 0x8000 ? -size : size;
    }
  }, width);
}

function check(found, name) {
  assert.ok(found.db >= LEAST_DB, `${name}: ${JSON.stringify(found)}`);
  assert.ok(found.unequal <= MOST_UNEQUAL, `${name}: ${JSON.stringify(found)}`);
  assert.ok(found.images > 20, `${name}: ${JSON.stringify(found)}`);
  console.log(`${name}: ${found.db.toFixed(1)} dB, ${(100 * found.covered).toFixed(1)} % covered`);
}

const FORCED = { query: "?live=webgl", viewport: { width: 500, height: 400 } };

// Returns a function that waits for a picture that was rendered in this way, and checks why.
function openedBy(who, reason) {
  return async (page) => {
    if (await page.isHidden("#live")) await page.keyboard.press("l");
    await until(
      page,
      `app.live.view.pictures.${who === "server" ? "reason" : "local"} && app.live.view.shown?.by === '${who}'`,
    );
    assert.match(await page.evaluate("lfvisualizer.live.view.pictures.reason"), reason);
  };
}

async function withGl(words, body) {
  const show = async (page) => {
    await openedBy("webgl", /^$/)(page);
    await body(page);
  };
  await withPage(words, show, FORCED);
}

const charts = new Set();

// Returns a light field of the chart, made with these options.
async function chartWith(...words) {
  const folder = join(temporary.folder, ["gl", ...words].join(""));
  if (!charts.has(folder))
    await run("lfsynth", ["chart", "-o", folder, "--count", "81", "--size", "120x80", "-q", ...words]);
  charts.add(folder);
  return folder;
}

const LENS_PLANE = PATH.replace("-0.97]", "-1]").replace("look_at: [0.01, 0.02, 0]", "orientation: {yaw: 0}");

const PENTAGON = `${PATH}  blades: 5\n  blade_rotation_deg: 20\n`;

for (const [name, text, { made = [], read = [] } = {}] of [
  ["a disk", PATH],
  ["a pentagon", PENTAGON],
  ["a disk without lens weights", PATH, { read: ["--lens-weights", "none"] }],
  ["a pentagon without lens weights", PENTAGON, { read: ["--lens-weights", "none"] }],
  ["a tilted focus plane", `${PATH}  focus_tilt_deg: {horizontal: 35, vertical: -20}\n`],
  ["a horizon in the picture", `${PATH}  focus_tilt_deg: {horizontal: 0, vertical: 78}\n`],
  ["a camera in the lens plane", LENS_PLANE],
  ["a narrow lens", PATH.replace("0.05", "0.004")],
  ["LF cameras at random positions", PATH, { made: ["--jitter", "0.3"] }],
  ["masked pixels", PATH, { made: ["--alpha", "straight", "--format", "png"], read: ["--image-alpha", "mask"] }],
])
  test(`WebGL renders the picture of the server: ${name}`, async () => {
    await withGl([await chartWith(...made), await writePath(text), "--max-angle", "45", ...read], async (page) => {
      check(await difference(page, WIDTH), name);
    });
  });

test("a lens that bends rays is left to the server", async () => {
  const bent = await chartWith("--distortion", "0.12,-0.25,0.001,-0.002");
  await withPage([bent, await writePath(PATH), "--max-angle", "45"], openedBy("server", /distortion/), FORCED);
});

test("software renders no pictures unless it is asked for", async () => {
  await withPage([await chartWith(), await writePath(PATH)], openedBy("server", /SwiftShader/i));
});

test("the server renders if the graphics card loses its memory", async () => {
  await withGl([await chartWith(), await writePath(PATH), "--max-angle", "45"], async (page) => {
    await page.evaluate("lfvisualizer.live.view.pictures.local.renderer.close()");
    // The event of the lost context and the picture that is being rendered may come in any order.
    await openedBy("server", /lost|forgotten/)(page);
  });
});
