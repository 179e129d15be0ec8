// SPDX-License-Identifier: Apache-2.0
// Tests the live picture in a browser.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { test } from "node:test";

import { chart, SHOP, temporary, withChart, withPage, withShop, writePath } from "./page_case.mjs";
import {
  allLoaded,
  BLURRED,
  dragFocus,
  focusNow,
  gradientEnergy,
  labels,
  openLive,
  recordRequests,
  STAR,
  stillPicture,
  WIDE,
} from "./live_case.mjs";
import { CHART_PATH, SHOP_PATH } from "./paths.mjs";
import { run, until } from "./visualizer.mjs";

test("a drag in the live picture focuses, and is one undo step", async () => {
  // A chart with LF images that are fine enough to be blurred by this lens.
  const fineChart = join(temporary.folder, "fine");
  await run("lfsynth", ["chart", "-o", fineChart, "--count", "81", "--size", "360x240", "-q"]);
  const path = await writePath(WIDE);
  await withPage([fineChart, path, "--max-angle", "45"], async (page) => {
    const asked = recordRequests(page);
    const box = await openLive(page);
    await allLoaded(page);
    const before = await gradientEnergy(page, STAR);
    asked.length = 0;
    await dragFocus(page, box, 1.003);
    await until(page, "document.querySelector('#live-picture canvas').dataset.focus < 1.1");
    assert.equal(await page.evaluate("lfvisualizer.state.isChanged"), false);
    assert.ok(asked.some((one) => one.budget_ms > 0));
    await page.mouse.up();
    await until(page, "app.state.isChanged && app.state.isShown");
    await stillPicture(page);
    assert.equal(asked.at(-1).budget_ms, undefined);
    const after = await gradientEnergy(page, STAR);
    assert.ok(after > 1.3 * before, `${before} to ${after}`);
    assert.deepEqual(await labels(page), ["change focus distance"]);
    await page.keyboard.press("Control+s");
    await until(page, "!app.state.isChanged");
    const focus = await focusNow(page);
    const saved = await readFile(path, "utf8");
    assert.equal(saved, WIDE.replace("value: 1.3}", `value: ${Number(focus.toPrecision(6))}}`));
    await page.keyboard.press("Control+z");
    await until(page, "app.state.isShown && app.state.camera.focusDistance === 1.3");
    await stillPicture(page);
    const undone = await gradientEnergy(page, STAR);
    assert.ok(Math.abs(undone - before) < 0.05 * before, `${undone} instead of ${before}`);
  });
});

test("Escape forgets a drag", async () => {
  await withChart(async (page) => {
    const box = await openLive(page);
    await dragFocus(page, box, 0.95);
    await page.keyboard.press("Escape");
    assert.equal(await focusNow(page), 1);
    await page.mouse.up();
    assert.deepEqual(await labels(page), []);
  });
});

test("a click in the live picture focuses there", async () => {
  await withChart(
    async (page) => {
      const box = await openLive(page);
      await page.mouse.click(box.x + STAR.x * box.width, box.y + STAR.y * box.height);
      await until(page, "app.state.isShown && Math.abs(app.state.camera.focusDistance - 1) < 0.05");
      assert.ok(await page.isVisible("#live-picture .mark"));
      assert.deepEqual(await labels(page), ["focus there"]);
    },
    BLURRED,
    ["--max-angle", "45"],
  );
});

test("wheel, keys and sliders change the lens, each as one undo step", async () => {
  await withChart(async (page) => {
    const box = await openLive(page);
    await page.mouse.move(box.x + 50, box.y + 50);
    // Turns and keys that follow each other at once are one step. None is awaited, so that a busy machine delays all.
    await Promise.all([1, 2, 3].map(() => page.mouse.wheel(0, -100)));
    await until(page, "app.state.isShown && app.state.camera.radius > 0.0075");
    await Promise.all([page.keyboard.press("."), page.keyboard.press(".")]);
    await until(page, "app.state.isShown && app.state.camera.focusDistance > 1.001");
    await page.selectOption("[aria-label='Blades of the aperture']", "6");
    await until(page, "app.state.isShown && app.state.camera.blades === 6");
    await page.locator("[aria-label=Rotation]").fill("0.5");
    await until(page, "app.state.isShown && app.state.camera.rotation > 0.5");
    await page.locator("[aria-label=Aperture]").fill("0");
    await until(page, "app.state.isShown && app.state.camera.radius === 0");
    await page.waitForSelector("#live-status:has-text('pinhole')");
    assert.deepEqual(await labels(page), [
      "change aperture",
      "change focus distance",
      "change blades",
      "turn blades",
      "change aperture",
    ]);
    for (let i = 0; i < 5; ++i) await page.click("#undo");
    await until(page, "!app.state.isChanged && app.state.isShown && app.state.camera.radius === 0.006");
  });
});

test("a finger focuses, and two open the aperture", async () => {
  const path = await writePath(CHART_PATH);
  await withPage(
    [chart, path],
    async (page) => {
      const box = await openLive(page);
      const fingers = await page.context().newCDPSession(page);
      const touch = (type, ...shares) =>
        fingers.send("Input.dispatchTouchEvent", {
          type,
          touchPoints: shares.map((x, id) => ({ x: box.x + x * box.width, y: box.y + box.height / 2, id })),
        });
      await touch("touchStart", 0.4);
      await touch("touchMove", 0.45);
      await touch("touchMove", 0.6);
      await touch("touchEnd");
      await until(page, "app.state.isShown && app.state.camera.focusDistance > 1.05");
      await touch("touchStart", 0.4, 0.5);
      await touch("touchMove", 0.3, 0.5);
      await touch("touchEnd");
      await until(page, "app.state.isShown && Math.abs(app.state.camera.radius - 0.012) < 1e-4");
      await page.locator("button:text-is('Camera')").tap();
      const before = await page.evaluate("lfvisualizer.state.camera.centre[2]");
      await touch("touchStart", 0.4, 0.5);
      await touch("touchMove", 0.36, 0.5);
      await touch("touchEnd");
      await until(page, `app.state.isShown && app.state.camera.centre[2] > ${before} + 0.1`);
      assert.deepEqual(await labels(page), ["change focus distance", "change aperture", "dolly"]);
    },
    { viewport: { width: 390, height: 844 }, hasTouch: true },
  );
});

test("the camera orbits, slides and dollies", async () => {
  await withChart(
    async (page) => {
      const box = await openLive(page);
      const middle = [box.x + box.width / 2, box.y + box.height / 2];
      const drag = async (dx, dy) => {
        await page.mouse.move(...middle);
        await page.mouse.down();
        await page.mouse.move(middle[0] + dx, middle[1] + dy, { steps: 3 });
        await page.mouse.up();
        await until(page, "app.state.isShown");
      };
      const centre = () => page.evaluate("lfvisualizer.state.camera.centre");
      await page.keyboard.down("Alt");
      await drag(-20, 0);
      await page.keyboard.up("Alt");
      const orbited = await centre();
      assert.ok(orbited[0] > 0.01 && Math.abs(Math.hypot(...orbited) - 1) < 1e-4, `${orbited}`);
      await page.keyboard.press("c");
      await page.keyboard.down("Shift");
      await drag(0, 20);
      await page.keyboard.up("Shift");
      assert.ok((await centre())[1] < -0.01, `${await centre()}`);
      await page.mouse.wheel(0, -100);
      await until(page, `app.state.isShown && app.state.camera.centre[2] > ${orbited[2]} + 0.005`);
      await page.keyboard.press("ArrowLeft");
      await until(page, `app.state.isShown && app.state.camera.centre[0] < ${orbited[0]} - 0.005`);
      assert.equal(await page.evaluate("lfvisualizer.state.frame"), 1);
      assert.deepEqual(await labels(page), ["orbit", "slide the camera", "dolly", "orbit"]);
    },
    CHART_PATH,
    ["--max-angle", "45"],
  );
});

test("a hidden page, and another view, ask for no pictures", async () => {
  await withChart(async (page) => {
    const asked = recordRequests(page);
    await openLive(page);
    const setHidden = (isHidden) =>
      page.evaluate((value) => {
        Object.defineProperty(document, "hidden", { value, configurable: true });
        document.dispatchEvent(new Event("visibilitychange"));
      }, isHidden);
    await setHidden(true);
    asked.length = 0;
    await page.evaluate("lfvisualizer.state.setFrame(5)");
    await page.waitForTimeout(600);
    assert.equal(asked.length, 0);
    await setHidden(false);
    await stillPicture(page);
    assert.ok(asked.length > 0);
    await page.keyboard.press("1");
    asked.length = 0;
    await page.evaluate("lfvisualizer.state.setFrame(6)");
    await page.waitForTimeout(600);
    assert.equal(asked.length, 0);
  });
});

test("faults of the path are shown in the live picture", async () => {
  await withChart(async (page) => {
    await openLive(page);
    await page.click("[data-tab=edit]");
    await page.click("summary:has-text('The file')");
    await page.fill("textarea", CHART_PATH.replace("focus_distance: 1\n", "focus_distanc: 1\n"));
    await page.waitForSelector("#live-fault:has-text('focus_distanc')");
    await page.fill("textarea", CHART_PATH);
    await page.waitForSelector("#live-fault", { state: "hidden" });
  });
});

test("the film is played live, and scrubbed", async () => {
  await withChart(async (page) => {
    const asked = recordRequests(page);
    await openLive(page);
    asked.length = 0;
    await page.keyboard.press("Space");
    await until(page, "app.state.frame === 11 && !app.state.isPlaying");
    await stillPicture(page);
    assert.ok(asked.filter((one) => one.budget_ms > 0).length > 0);
    await page.keyboard.press("Home");
    await stillPicture(page);
  });
});

test("two settings are compared, and edges in focus are coloured", async () => {
  await withChart(
    async (page) => {
      const box = await openLive(page);
      await page.keyboard.press("a");
      await page.mouse.move(box.x + 50, box.y + 50);
      await page.mouse.wheel(0, 300);
      await until(page, "app.state.isShown && app.state.camera.radius < 0.005");
      await stillPicture(page);
      await page.waitForSelector(".live-side[data-side=B]:not(:has-text('12 mm'))");
      assert.match(await page.textContent(".live-side[data-side=A]"), /12 mm/);
      const line = await page.locator("#live-line").boundingBox();
      await page.mouse.move(line.x + line.width / 2, line.y + 20);
      await page.mouse.down();
      await page.mouse.move(box.x + box.width / 4, line.y + 20);
      await page.mouse.up();
      assert.equal(await page.getAttribute("#live-line", "aria-valuenow"), "25");
      const versionOfA = () => page.evaluate("document.querySelector('#live-a').toDataURL()");
      const ofFrame1 = await versionOfA();
      await page.evaluate("lfvisualizer.state.setFrame(11)");
      await until(page, "app.live.comparison.kept.frame === 11");
      assert.notEqual(await versionOfA(), ofFrame1);
      assert.match(await page.textContent(".live-side[data-side=A]"), /12 mm, focus 1$/);
      await page.evaluate("lfvisualizer.state.setFrame(1)");
      await until(page, "app.live.comparison.kept.frame === 1");
      await page.click("button:text-is('Back to A')");
      await until(page, "app.state.isShown && Math.abs(app.state.camera.radius - 0.006) < 1e-9");
      await page.keyboard.press("a");
      assert.equal(await page.isVisible("#live-line"), false);
      const greenElements = () =>
        page.evaluate(() => {
          const canvas = document.querySelector("#live-picture canvas");
          const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
          let count = 0;
          for (let i = 0; i < data.length; i += 4) if (data[i + 1] > data[i] + data[i + 2]) ++count;
          return count;
        });
      const before = await greenElements();
      await page.keyboard.press("e");
      assert.ok((await greenElements()) > before + 20);
    },
    CHART_PATH.replace(
      "keyframes:\n",
      "keyframes:\n  position: [{time: 0, value: [0, 0, -1]}, {time: 1, value: [0.03, 0, -1]}]\n",
    ),
    ["--max-angle", "45"],
  );
});

test("the live picture says if the frame takes another number of LF images, and why", async () => {
  const path = await writePath(WIDE);
  const difference = "[data-part=difference]";
  await withPage([chart, path], async (page) => {
    await openLive(page);
    await allLoaded(page);
    await until(page, "app.live.view.shown.facts.used === app.state.use?.ids.length");
    assert.equal(await page.locator(difference).count(), 0);
  });
  await withPage([chart, path, "--max-images", "9"], async (page) => {
    await openLive(page);
    await allLoaded(page);
    await page.waitForSelector(difference);
    assert.equal(await page.textContent(difference), "the frame takes 9, limited by --max-images or its package");
    // The number is that of the path's lens, not of one that is being changed.
    await page.mouse.move(300, 300);
    await page.mouse.wheel(0, 300);
    await until(page, "app.state.isChanged && app.state.isShown");
    await page.waitForSelector(difference);
  });
});

test("the live picture of a dense light field says what it is made of", withShop, async () => {
  const path = await writePath(SHOP_PATH);
  await withPage([SHOP, path], async (page) => {
    await openLive(page);
    await allLoaded(page);
    const { facts } = await page.evaluate(() => ({ facts: window.lfvisualizer.live.view.shown.facts }));
    const density = await page.evaluate("lfvisualizer.state.density");
    assert.ok(Math.abs(facts.camera_distance - density.camera_distance) < 0.1 * density.camera_distance);
    const status = await page.textContent("#live-status");
    assert.match(status, new RegExp(`${facts.used} LF images, spacing 3\\d(\\.\\d)? mm`));
    assert.match(status, /of the lens recorded/);
    assert.equal(facts.used, await page.evaluate("lfvisualizer.state.use.ids.length"));
    assert.ok(facts.used < facts.images);
  });
});

for (const [width, height] of [
  [390, 844],
  [360, 740],
  [740, 360],
  [844, 390],
  [1000, 600],
])
  test(`the live picture fits a window of ${width} × ${height}`, async () => {
    const path = await writePath(CHART_PATH);
    await withPage(
      [chart, path],
      async (page) => {
        const box = await openLive(page);
        assert.ok(box.width > 0.5 * Math.min(width, height), `${box.width}`);
        const isWithin = await page.evaluate(
          () =>
            document.documentElement.scrollWidth <= innerWidth && document.documentElement.scrollHeight <= innerHeight,
        );
        assert.ok(isWithin);
        for (const button of await page.locator("button:visible").all())
          assert.ok((await button.getAttribute("aria-label")) ?? (await button.textContent()));
        // Picture and panels have room, and the buttons around them are not cut off; panels and views can be scrolled.
        assert.ok(box.height > 0.25 * height && box.y + box.height <= height, `${box.y}, ${box.height}`);
        const panels = await page.locator("#panels").boundingBox();
        assert.ok(panels.height > 0.3 * height && panels.width > 240, `${panels.width} x ${panels.height}`);
        for (const part of await page.locator("header button, #tabs button, footer button, footer input").all()) {
          const { x, y, width: wide, height: high } = await part.boundingBox();
          const place = `${await part.textContent()}: ${x}, ${y}, ${wide} x ${high}`;
          assert.ok(x >= 0 && y >= 0 && x + wide <= width && y + high <= height, place);
        }
      },
      { viewport: { width, height }, colorScheme: "light", hasTouch: Math.min(width, height) < 500 },
    );
  });
