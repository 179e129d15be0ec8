// Code that the tests of live pictures share: a path, the state of the page, and what a person does.
import { CHART_PATH } from "./paths.mjs";
import { until } from "./visualizer.mjs";

// The star of the chart is at the distance 1, and seen here in the frame.
export const STAR = { x: 56 / 96, y: 40 / 64 };
export const BLURRED = CHART_PATH.replace("time: 0, value: 1}", "time: 0, value: 1.15}");
export const WIDE = BLURRED.replace("time: 0, value: 1.15}", "time: 0, value: 1.3}").replace("_mm: 12", "_mm: 30");

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

// Returns the mean square of the brightness differences around a place of the live picture.
export function gradientEnergy(page, { x, y }, half = 0.05) {
  return page.evaluate(
    ([u, v, size]) => {
      const { picture } = window.lfvisualizer.live.view.shown;
      const { width, height } = picture;
      const canvas = document.querySelector("#live-picture canvas");
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
    [x, y, half],
  );
}

export const focusNow = (page) => page.evaluate("lfvisualizer.live.camera.camera.focusDistance");
// Drags from the middle of the box until the focus distance is below `wanted`; returns without letting go.
export async function dragFocus(page, box, wanted) {
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; (await focusNow(page)) > wanted && i < 200; ++i) await page.mouse.move(x - 5 * i, y);
}
