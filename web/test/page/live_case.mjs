// SPDX-License-Identifier: Apache-2.0
// Opens the live picture in tests of the page, and measures it.
import { readFile } from "node:fs/promises";

import { CHART_PATH } from "./paths.mjs";
import { until } from "./visualizer.mjs";

// The star of the chart is at the distance 1, and seen here in the frame.
export const STAR = { x: 56 / 96, y: 40 / 64 };
export const BLURRED = CHART_PATH.replace("time: 0, value: 1}", "time: 0, value: 1.15}");
export const WIDE = BLURRED.replace("time: 0, value: 1.15}", "time: 0, value: 1.3}").replace("_mm: 12", "_mm: 30");

// Records the requests of live pictures.
export function recordRequests(page) {
  const asked = [];
  page.on("request", (request) => {
    if (request.url().endsWith("/live")) asked.push(request.postDataJSON());
  });
  return asked;
}

// Waits until the still picture of the current camera is shown.
export function stillPicture(page) {
  return until(
    page,
    "app.state.isShown && !app.live.camera.isChanging && " +
      "document.querySelector('#live-picture canvas').dataset.still === 'true' && " +
      "document.querySelector('#live-picture canvas').dataset.focus === String(app.live.camera.camera.focusDistance)",
  );
}

// Waits until the picture is made of all LF images that the frame needs.
export function allLoaded(page) {
  return until(
    page,
    "(({ done, wanted, images, takeable }) => done === wanted && images > 0 && images === takeable)" +
      "(app.live.view.shown.facts)",
  );
}

export async function openLive(page) {
  await page.keyboard.press("l");
  await stillPicture(page);
  return page.locator("#live-picture").boundingBox();
}

// Returns the mean square of the brightness differences around a place of the live picture or of another picture.
//   file  the other picture, a PNG file; unset: the live picture
export async function gradientEnergy(page, { x, y }, half = 0.05, file = null) {
  const bytes = file && (await readFile(file)).toString("base64");
  const blank = file && (await page.context().newPage()); // the policy of the page forbids foreign pictures
  const energy = await (blank ?? page).evaluate(
    async ([u, v, size, png]) => {
      let canvas = document.querySelector("#live-picture canvas");
      if (png) {
        const image = new Image();
        image.src = `data:image/png;base64,${png}`;
        await image.decode();
        canvas = document.createElement("canvas");
        [canvas.width, canvas.height] = [image.width, image.height];
        canvas.getContext("2d").drawImage(image, 0, 0);
      }
      const { width, height } = canvas;
      const { data } = canvas.getContext("2d").getImageData(0, 0, width, height);
      const at = (column, row) => data[4 * (row * width + column) + 1];
      const [left, right] = [u - size, u + size].map((share) => Math.round(share * width));
      const [top, bottom] = [v - size, v + size].map((share) => Math.round(share * height));
      let sum = 0;
      for (let row = top; row < bottom; ++row)
        for (let column = left; column < right; ++column)
          sum += (at(column + 1, row) - at(column, row)) ** 2 + (at(column, row + 1) - at(column, row)) ** 2;
      return sum / ((right - left) * (bottom - top));
    },
    [x, y, half, bytes],
  );
  await blank?.close();
  return energy;
}

export const focusNow = (page) => page.evaluate("lfvisualizer.live.camera.camera.focusDistance");
export const labels = (page) => page.evaluate("lfvisualizer.state.history.labels");

// Drags from the middle of the box until the focus distance has passed `wanted`; returns without letting go.
export async function dragFocus(page, box, wanted) {
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  const right = (await focusNow(page)) < wanted ? 1 : -1;
  for (let i = 1; right * (wanted - (await focusNow(page))) > 0 && i < 200; ++i)
    await page.mouse.move(x + 5 * right * i, y);
}
