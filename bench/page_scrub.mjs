// SPDX-License-Identifier: Apache-2.0
// Measures the page with many LF cameras: time to the first picture, bytes sent, and JavaScript
// time per frame of a scrub, in headless Chromium with software rendering.
//
// usage: LF_BIN=build/release/bin node bench/page_scrub.mjs [LF CAMERAS ...]
import { writeFile } from "node:fs/promises";
import { join } from "node:path";

import {
  openBrowser, openPage, run, serve, temporaryFolder,
} from "../web/test/page/visualizer.mjs";

const FRAMES = 61;
const PATH = `format: lfpath 1
fps: 30
frames: ${FRAMES}
resolution: [960, 640]
camera:
  field_of_view_deg: 50
  position: [0, 0, -1]
  look_at: [0, 0, 0]
lens:
  aperture_diameter: 0.2
  focus_distance: 1
  blades: 5
keyframes:
  position: [{time: 0, value: [-0.1, 0, -1]}, {time: 2, value: [0.1, 0, -1]}]
`;

function median(values) {
  return values.sort((a, b) => a - b)[values.length >> 1];
}

const counts = process.argv.slice(2).map(Number);
const { folder, remove } = await temporaryFolder();
const browser = await openBrowser();
console.log("LF cameras  open_s  sent_MB  scrub_ms (median, 95 %)  whole_ms  drawn_ms");
for (const count of counts.length > 0 ? counts : [1_000, 100_000, 1_000_000]) {
  const field = join(folder, `field-${count}`);
  const path = join(folder, "path.yaml");
  await writeFile(path, PATH);
  await run("lfsynth", ["still-life", "-o", field, "--count", String(count), "--spacing",
                        String(0.5 / Math.sqrt(count)), "--calibration-only", "-q"]);
  const server = await serve([field, path, "--lens-weights", "none"]);
  const begin = performance.now();
  const { page, close } = await openPage(browser, server.address);
  const open_s = (performance.now() - begin) / 1000;
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable");
  const scriptSeconds = async () =>
    (await session.send("Performance.getMetrics")).metrics.find(
      (metric) => metric.name === "ScriptDuration").value;
  await page.waitForTimeout(3000);
  const script = [];
  const whole = [];
  for (let frame = 2; frame <= FRAMES; ++frame) {
    const before = await scriptSeconds();
    whole.push(await page.evaluate(
      (number) => new Promise((resolve) => {
        const { state } = window.lfvisualizer;
        const start = performance.now();
        state.setFrame(number);
        const look = () => state.use.frame === number
          ? requestAnimationFrame(() => resolve(performance.now() - start))
          : setTimeout(look, 1);
        look();
      }), frame));
    script.push(1000 * ((await scriptSeconds()) - before));
  }
  const sent = await page.evaluate(() => window.lfvisualizer.receivedBytes());
  // The time of drawing alone. The processor draws, because there is no graphics card.
  const drawn = await page.evaluate(() => {
    const { view } = window.lfvisualizer;
    const start = performance.now();
    for (let i = 0; i < 10; ++i) view.render();
    return (performance.now() - start) / 10;
  });
  const spread = [...script].sort((a, b) => a - b)[Math.floor(0.95 * script.length)];
  console.log([
    String(count).padStart(10), open_s.toFixed(2).padStart(7), (sent / 1e6).toFixed(1).padStart(8),
    `${median(script).toFixed(1)}, ${spread.toFixed(1)}`.padStart(24),
    median(whole).toFixed(0).padStart(9), drawn.toFixed(0).padStart(9),
  ].join(" "));
  await close();
  await server.stop();
}
await browser.close();
await remove();
