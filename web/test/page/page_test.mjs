// SPDX-License-Identifier: Apache-2.0
// Tests the page in a browser: what a person sees and does, and what the programs then read.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { readFile, writeFile } from "node:fs/promises";
import { request } from "node:http";
import { join } from "node:path";
import { test } from "node:test";

import { browser, chart, SHOP, temporary, withChart, withPage, withShop, writePath } from "./page_case.mjs";
import { CHART_PATH, SHOP_PATH } from "./paths.mjs";
import { openPage, program, run, serveFiles, until } from "./visualizer.mjs";

// Sends a request exactly as written, which browsers and fetch() would normalise.
function rawStatus(address, path, headers = {}) {
  const { hostname, port } = new URL(address);
  return new Promise((resolve, reject) => {
    request({ hostname, port, path, headers }, (response) => {
      response.resume();
      resolve(response.statusCode);
    })
      .on("error", reject)
      .end();
  });
}

test("what a frame takes is what the program says", withShop, async () => {
  const path = await writePath(SHOP_PATH);
  const { output } = await run("lfvisualizer", [SHOP, path, "--text", "--frames", "1,25", "-q"]);
  const collected = (frame) =>
    output
      .split("\n")
      .map((line) => line.split(" "))
      .filter(([word, number]) => word === "collected" && Number(number) === frame)
      .map(([, , id]) => Number(id));
  await withPage([SHOP, path], async (page) => {
    await until(page, "app.state.use && app.state.use.frame === 1");
    const ids = () => page.evaluate(() => [...window.lfvisualizer.state.use.ids].sort((a, b) => a - b));
    assert.deepEqual(await ids(), collected(1));
    assert.equal(await page.textContent("#legend label:first-child b"), String(collected(1).length));
    await page.evaluate(() => window.lfvisualizer.state.setFrame(25));
    await until(page, "app.state.use.frame === 25");
    assert.deepEqual(await ids(), collected(25));
    await until(page, "app.state.film && app.state.film.done === 49");
    const film = await page.evaluate(() => window.lfvisualizer.state.film);
    assert.equal(film.images[24], collected(25).length);
  });
});

// Figure 5.1 of the thesis.
test("the LF cameras of a triangular aperture form a triangle", withShop, async () => {
  const path = await writePath(SHOP_PATH.replace("-0.06, 0, 0]\n", "0, 0, 0]\n").replace(/  position: \[\{.*\n/, ""));
  await withPage([SHOP, path, "--lens-weights", "none"], async (page) => {
    await until(page, "app.state.use");
    await page.keyboard.press("2");
    const { used, all, lens } = await page.evaluate(() => {
      const { state } = window.lfvisualizer;
      const place = (id) => [state.positions[3 * id], -state.positions[3 * id + 1]];
      return {
        used: [...state.use.ids].map(place),
        all: Array.from({ length: state.positions.length / 3 }, (_, id) => place(id)),
        lens: { radius: state.camera.radius, blades: state.camera.blades },
      };
    });
    assert.equal(lens.blades, 3);
    // Tests by distances from the three edges: one normal points down, the others 30 degrees above
    // right and left.
    const inside = ([x, y], margin) =>
      [
        [0, -1],
        [Math.cos(Math.PI / 6), 0.5],
        [-Math.cos(Math.PI / 6), 0.5],
      ].every(([nx, ny]) => nx * x + ny * y <= lens.radius / 2 + margin);
    assert.ok(used.length > 80, `${used.length}`);
    for (const place of used) assert.ok(inside(place, 1e-6), `${place}`);
    assert.equal(used.length, all.filter((place) => inside(place, 1e-6)).length);
  });
});

test("the overview shows a rig of centimetres and what it sees a metre away", async () => {
  await withChart(async (page) => {
    const [ax, ay, bx, by] = await page.evaluate(`(() => {
      const { camera, points } = window.lfvisualizer.view;
      const { min, max } = points.object.geometry.boundingBox;
      const a = min.clone().project(camera), b = max.clone().project(camera);
      return [a.x, a.y, b.x, b.y];
    })()`);
    for (const one of [ax, ay, bx, by]) assert.ok(Math.abs(one) < 1);
    assert.ok(Math.hypot(bx - ax, by - ay) > 0.3);
  });
});

test("keys and the timeline move through the film", async () => {
  await withChart(async (page) => {
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("ArrowRight");
    await until(page, "app.state.frame === 3 && app.state.use.frame === 3");
    assert.match(await page.textContent("#clock"), /^3 \/ 11/);
    await page.keyboard.press("End");
    await until(page, "app.state.frame === 11");
    await page.keyboard.press("Shift+ArrowLeft");
    await until(page, "app.state.frame === 1");
    await page.keyboard.press("Space");
    await until(page, "app.state.frame > 4");
    await until(page, "app.state.frame === 11");
    const box = await page.locator("#curves").boundingBox();
    await page.mouse.click(box.x + 118 + (box.width - 130) / 2, box.y + 20);
    await until(page, "app.state.frame === 6");
    await page.keyboard.press("]");
    await until(page, "app.state.selected !== null");
    await page.waitForFunction(() => document.querySelector(".picture img").naturalWidth === 120);
    await page.waitForSelector(".picture svg polygon, .picture svg rect");
  });
});

test("the view in space is drawn again after the browser has lost its graphics context", async () => {
  await withChart(async (page) => {
    await until(page, "app.state.use && app.state.density");
    const picture = () => page.locator("#scene").screenshot();
    await page.keyboard.press("2");
    // The view may still be turning.
    let before = await picture();
    for (let last = null; !last?.equals(before); last = before, before = await picture())
      await page.waitForTimeout(200);
    const event = (name) =>
      page.evaluate((kind) => {
        const canvas = document.getElementById("scene");
        const extension = canvas.getContext("webgl2").getExtension("WEBGL_lose_context");
        window.lose ??= extension; // a lost context has no extensions
        const happened = new Promise((resolve) => canvas.addEventListener(kind, resolve, { once: true }));
        if (kind === "webglcontextlost") window.lose.loseContext();
        else window.lose.restoreContext();
        return happened.then(() => true);
      }, name);
    for (let i = 0; i < 2; ++i) {
      await event("webglcontextlost");
      assert.ok(!(await picture()).equals(before));
      await event("webglcontextrestored");
      let after = await picture();
      for (let tries = 0; tries < 40 && !after.equals(before); ++tries) {
        await page.waitForTimeout(100);
        after = await picture();
      }
      assert.ok(after.equals(before));
    }
  });
});

test("a click on a point shows its LF image", async () => {
  await withChart(async (page) => {
    await until(page, "app.state.use");
    await page.keyboard.press("2");
    const box = await page.locator("#scene").boundingBox();
    // The view may still be turning at the first click.
    const click = () => page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
    await until(page, "app.state.selected && app.state.selected.id === 40", click);
    assert.equal(await page.getAttribute("[data-tab=image]", "aria-selected"), "true");
  });
});

test("a key is edited, saved with its comments, and rendered", async () => {
  await withChart(async (page, path) => {
    await page.keyboard.press("End");
    await page.click("[data-tab=edit]");
    await page.click("summary:has-text('Focus distance')");
    await page.fill("[data-quantity=focus_distance]", "1.4");
    await page.keyboard.press("Enter");
    await until(page, "Math.abs(app.state.cameras[10].focusDistance - 1.4) < 1e-9");
    await page.keyboard.press("ArrowLeft");
    await page.click("summary:has-text('Aperture')");
    await page.fill("[data-quantity=aperture_diameter]", "0.02");
    await page.keyboard.press("Enter");
    await until(page, "Math.abs(app.state.cameras[0].radius - 0.01) < 1e-9");
    await page.click("#undo");
    await until(page, "Math.abs(app.state.cameras[0].radius - 0.006) < 1e-9");
    await page.click("#redo");
    await until(page, "Math.abs(app.state.cameras[0].radius - 0.01) < 1e-9");
    assert.equal(await readFile(path, "utf8"), CHART_PATH);
    await page.keyboard.press("Control+s");
    await until(page, "!app.state.isChanged");
    const saved = await readFile(path, "utf8");
    assert.equal(
      saved,
      CHART_PATH.replace("value: 1.2", "value: 1.4").replace("aperture_diameter_mm: 12", "aperture_diameter_mm: 20"),
    );
    await run("lfrenderer", [chart, path, "-o", `${path}.frames`, "--frames", "11", "-q", "--no-contact-sheet"]);
    const report = JSON.parse(await readFile(`${path}.frames/report.json`, "utf8"));
    assert.match(JSON.stringify(report.frames[0]), /"frame.focus_distance_w":"1.4"/);
  });
});

test("keys ease: a new one by itself, others as the list says, and the file has the words", async () => {
  const text = CHART_PATH.replace(/keyframes:\n.*\n.*\n/, "");
  await withChart(async (page, path) => {
    await page.keyboard.press("End");
    await until(page, "app.state.frame === 11");
    await page.click("[data-tab=edit]");
    await page.click("summary:has-text('Focus distance')");
    await page.click("[data-add-key=focus_distance]");
    await page.fill("[data-quantity=focus_distance]", "1.2");
    await page.keyboard.press("Enter");
    const shares = (expected) =>
      until(
        page,
        `${JSON.stringify(expected)}.every((share, i) =>
          Math.abs(app.state.cameras[i].focusDistance - 1 - 0.2 * share) < 1e-6)`,
      );
    await shares([0, 0.00856, 0.05792, 0.16308, 0.31744, 0.5]);
    const list = page.locator("[aria-label='How the value gets to 1.00 s']");
    assert.equal(await list.inputValue(), "ease");
    assert.ok(await page.isDisabled("[aria-label='How the value gets to 0.00 s']"));
    assert.deepEqual(await list.locator("option").allTextContents(), [
      "smooth",
      "ease",
      "ease in",
      "ease out",
      "linear",
      "step",
    ]);
    await list.selectOption("ease_out");
    await shares([0, 0.1981, 0.3856]);
    // The mark of the key at the end is round to the left, and so wider there than a diamond.
    const isMarked = () =>
      page.evaluate(() => {
        const canvas = document.getElementById("curves");
        const { clientWidth, clientHeight } = canvas;
        const ratio = canvas.width / clientWidth;
        const [x, y] = [clientWidth - 12 - 3, (clientHeight / 5) * 3 - 8 - 3];
        const { data } = canvas.getContext("2d").getImageData(x * ratio, y * ratio, 1, 1);
        return data[3] > 128;
      });
    assert.ok(await isMarked());
    await list.selectOption("linear");
    await shares([0, 0.1, 0.2]);
    assert.ok(!(await isMarked()));
    await list.selectOption("ease");
    await shares([0, 0.00856, 0.05792]);
    await page.evaluate("lfvisualizer.state.setFrame(6)");
    await page.waitForSelector("h2:has-text('At frame 6')");
    await page.fill("[data-quantity=focus_distance]", "1.12");
    await page.keyboard.press("Enter");
    await until(page, "app.state.document.quantity('focus_distance').keyframes.length === 2 && app.state.isShown");
    await page.keyboard.press("Control+s");
    await until(page, "!app.state.isChanged");
    const saved = await readFile(path, "utf8");
    assert.match(saved, /\{time: 0.5, value: 1.12, interpolation: ease_in\}/);
    assert.match(saved, /\{time: 1, value: 1.2, interpolation: ease_out\}/);
    await run("lfcammvminfo", [path]);
  }, text);
});

test("a page shows the file as it is now, and loses no edit to another program", async () => {
  await withChart(async (page, path) => {
    const focusThere = () => page.evaluate("lfvisualizer.state.cameras[10].focusDistance");
    const message = (words) => page.waitForSelector(`#message:has-text("${words}")`);
    await writeFile(path, CHART_PATH.replace("value: 1.2", "value: 1.3"));
    await message("this is what it says now");
    assert.equal(await focusThere(), 1.3);
    assert.equal(await page.evaluate("lfvisualizer.state.isChanged"), false);
    await page.click("#undo");
    await until(page, "app.state.cameras[10].focusDistance === 1.2");
    await writeFile(path, CHART_PATH.replace("value: 1.2", "value: 1.5"));
    await message("edits here are not saved");
    assert.equal(await focusThere(), 1.2);
    await page.click("#save");
    await page.click("button:text-is('Write over it')");
    await until(page, "!app.state.isChanged");
    assert.equal(await readFile(path, "utf8"), CHART_PATH);
    await writeFile(path, CHART_PATH.replace("frames: 11", "frames: 5"));
    await message("this is what it says now");
    await page.reload();
    await page.waitForSelector("body[data-ready=yes]");
    assert.equal(await page.evaluate("lfvisualizer.state.path.frames"), 5);
    await writeFile(path, "format: lfpath 1\nfps: none\n");
    await message("has a fault: path");
    await page.reload();
    await page.waitForSelector("body[data-ready=yes]");
    await message("has a fault: path");
    assert.equal(await focusThere(), 1.2);
  });
});

test("what is no path is told with its line and not saved", async () => {
  await withChart(async (page, path) => {
    await page.click("[data-tab=edit]");
    await page.click("summary:has-text('The file')");
    await page.fill("textarea", CHART_PATH.replace("focus_distance: 1\n", "focus_distanc: 1\n"));
    await page.waitForFunction(() =>
      /:11:.*focus_distanc/.test(document.querySelector("aside p.bad")?.textContent ?? ""),
    );
    assert.ok(await page.isDisabled("#save"));
    // The edit is refused before it changes the text; the field keeps its value.
    await page.fill("[aria-label=Blades]", "2.5");
    await page.keyboard.press("Enter");
    await page.waitForSelector("#message:has-text('expected a whole number, found 2.5')");
    assert.equal(await page.inputValue("[aria-label=Blades]"), "0");
    await page.fill("textarea", CHART_PATH.replace("fps: 10", "fps: 20"));
    await until(page, "app.state.path.fps === 20 && app.state.invalid === null");
    // Another program writes the file in the meantime.
    await writeFile(path, `${CHART_PATH}# mine\n`);
    await page.click("#save");
    await page.click("dialog button:has-text('Cancel')");
    assert.match(await readFile(path, "utf8"), /# mine/);
    await page.click("#save");
    await page.click("dialog button:has-text('Write over it')");
    await until(page, "!app.state.isChanged");
    assert.match(await readFile(path, "utf8"), /fps: 20/);
  });
});

test("what is typed is saved as it is seen, and at the frame at which it was begun", async () => {
  const text = CHART_PATH.replaceAll("\n", "\r\n").replace(
    "keyframes:",
    "keyframes:\r\n  position: [{time: 0, value: [0, 0, -1]}, {time: 1, value: [0.1, 0.2, -0.9]}]",
  );
  await withChart(async (page, path) => {
    await page.click("[data-tab=edit]");
    await page.click("summary:has-text('The file')");
    // A focused text area in which nothing is typed shows the new text and is no edit.
    await page.click("textarea");
    await writeFile(path, text.replace("fps: 10", "fps: 20"));
    await until(page, "app.state.path.fps === 20");
    assert.match(await page.inputValue("textarea"), /fps: 20/);
    await page.click("h2:has-text('At frame')");
    assert.equal(await page.evaluate("lfvisualizer.state.isChanged"), false);
    // The text is saved at once, with the line ends of the file.
    await page.fill("textarea", (await page.inputValue("textarea")).replace("fps: 20", "fps: 10"));
    await page.keyboard.press("Control+s");
    await until(page, "!app.state.isChanged && app.state.path.fps === 10");
    assert.equal(await readFile(path, "utf8"), text);
    // Invalid YAML stays in the text area to be mended, and is not saved.
    const broken = (await page.inputValue("textarea")).replace("[96, 64]", "[96, 64");
    await page.fill("textarea", broken);
    await page.click("h2:has-text('At frame')");
    await page.keyboard.press("Control+s");
    await page.waitForSelector("#message:has-text('Not saved')");
    assert.equal(await page.inputValue("textarea"), broken);
    assert.equal(await readFile(path, "utf8"), text);
    await page.fill("textarea", text.replaceAll("\r", ""));
    await until(page, "app.state.invalid === null");
    // The timeline moves on while a number is typed.
    await page.click("summary:has-text('Position')");
    await page.fill("[aria-label='Position x']", "0.05");
    await page.evaluate("lfvisualizer.state.setFrame(11)");
    await page.keyboard.press("Tab");
    await until(page, "Math.abs(app.state.cameras[0].centre[0] - 0.05) < 1e-9");
    assert.equal(await page.evaluate("document.activeElement.ariaLabel"), "Position y");
    const last = await page.evaluate("lfvisualizer.state.cameras[10].centre");
    [0.1, 0.2, -0.9].forEach((x, i) => assert.ok(Math.abs(last[i] - x) < 1e-9, String(last)));
    // Between keys, the value is that of the frame.
    await page.evaluate("lfvisualizer.state.setFrame(6)");
    await page.click("summary:has-text('Focus distance')");
    const now = await page.evaluate("lfvisualizer.state.camera.focusDistance");
    assert.ok(Math.abs((await page.inputValue("[data-quantity=focus_distance]")) - now) < 1e-5);
  }, text);
});

test("movements are made, and commands are those of the programs", async () => {
  await withChart(async (page) => {
    await page.click("[data-tab=edit]");
    await page.click("summary:has-text('Movements')");
    await page.fill("[aria-label='Degrees of the orbit']", "10");
    await page.fill("[aria-label='Seconds of the orbit']", "2");
    await page.click(".row:has([aria-label='Degrees of the orbit']) button");
    await until(page, "app.state.path.frames === 21");
    const radii = await page.evaluate(() =>
      window.lfvisualizer.state.cameras.map((camera) => Math.hypot(...camera.centre)),
    );
    for (const radius of radii) assert.ok(Math.abs(radius - 1) < 0.002, `${radius}`);
    await page.keyboard.press("Escape");
    await page.click("#commands");
    assert.match(await page.textContent("dialog"), /lfrenderer .*chart .*path-\d+\.yaml -o frames/);
    assert.match(await page.textContent("dialog"), /not saved/);
  });
});

test("a preview comes in, and a click on it focuses there", async () => {
  await withChart(
    async (page) => {
      await page.keyboard.press("p");
      await until(page, "app.state.preview && app.state.preview.state === 'finished'");
      await page.waitForSelector(".picture canvas[data-version^='preview/1.bin']");
      const lightest = () =>
        page.evaluate(() => {
          const canvas = document.querySelector(".picture canvas[data-version]");
          const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
          return data.reduce((most, value, i) => (i % 4 === 0 ? Math.max(most, value) : most), 0);
        });
      assert.ok((await lightest()) > 200);
      const status = page.locator("#panels > :has(#start-preview) [role=status]");
      assert.equal(await status.textContent(), "Frame 1, finished");
      await page.evaluate(() => {
        const { state } = window.lfvisualizer;
        state.preview = { ...state.preview, message: "2 of 81 LF images were left out" };
        state.emit("preview");
      });
      assert.equal(await status.textContent(), "Frame 1, finished: 2 of 81 LF images were left out");
      await page.locator("[aria-label='Exposure, stops']:visible").fill("-6");
      assert.ok((await lightest()) < 60);
      // The star in the middle is at the distance 1.
      const box = await page.locator(".picture:has(canvas)").boundingBox();
      await page.mouse.click(box.x + (box.width * 56) / 96, box.y + (box.height * 40) / 64);
      await until(page, "app.state.isChanged");
      await until(page, "Math.abs(app.state.camera.focusDistance - 1) < 0.05");
    },
    CHART_PATH.replace("time: 0, value: 1}", "time: 0, value: 1.15}"),
    ["--max-angle", "45"],
  );
});

test("three clicks with Shift are asked for before the focus plane is tilted", async () => {
  await withChart(
    async (page) => {
      await page.keyboard.press("p");
      await until(page, "app.state.preview && app.state.preview.state === 'finished'");
      await page.waitForSelector(".picture canvas[data-version^='preview/1.bin']");
      const box = await page.locator(".picture:has(canvas)").boundingBox();
      await page.keyboard.down("Shift");
      await page.mouse.click(box.x + (box.width * 56) / 96, box.y + (box.height * 40) / 64);
      await until(page, "/Point 1 of 3/.test(app.state.message?.text ?? '')");
      await page.keyboard.up("Shift");
      assert.equal(await page.evaluate("lfvisualizer.state.isChanged"), false);
      assert.equal(await page.evaluate("lfvisualizer.state.planePoints.points.length"), 1);
    },
    CHART_PATH.replace("time: 0, value: 1}", "time: 0, value: 1.15}"),
    ["--max-angle", "45"],
  );
});

test("frames of a render are seen while they grow", async () => {
  // All 225 LF images are used, and a checkpoint may follow every 64 of them.
  const many = join(temporary.folder, "many");
  await run("lfsynth", ["chart", "-o", many, "--count", "225", "--size", "60x40", "-q"]);
  const path = await writePath(CHART_PATH.replace("[96, 64]", "[320, 216]").replace("_mm: 12", "_mm: 60"));
  const frames = `${path}.frames`;
  await withPage([many, path, "--watch", frames], async (page) => {
    assert.match(await page.textContent("aside"), /No frames lie there yet/);
    const renderer = spawn(program("lfrenderer"), [
      many,
      path,
      "-o",
      frames,
      "--dump-every",
      "1s",
      "--threads",
      "1",
      "--frames",
      "1-3",
      "--back-end",
      "reference",
      "-q",
      "--no-contact-sheet",
    ]);
    const ended = new Promise((resolve) => renderer.on("close", resolve));
    await until(page, "app.state.watch && app.state.watch.frames.some((one) => !one.finished)");
    await page.waitForSelector(".picture canvas[data-version^='watch/1.bin']");
    const first = await page.getAttribute(".picture canvas", "data-version");
    assert.equal(await ended, 0);
    await until(page, "app.state.watch.frames.filter((one) => one.finished).length === 3");
    await page.waitForFunction((old) => document.querySelector(".picture canvas").dataset.version !== old, first);
    await page.click("text=Rays per element");
    assert.match(await page.textContent("aside"), /Rays of each element: least/);
    // The picture is that of the current frame, even if another one was being read, or if there was
    // none.
    const show = (frame) => page.evaluate(`lfvisualizer.state.setFrame(${frame})`);
    await show(2);
    await show(3);
    await page.waitForSelector(".picture canvas[data-version^='watch/3.bin']");
    await show(5);
    await page.waitForSelector("text=Frame 5 has no picture yet");
    assert.equal(await page.isVisible(".picture canvas"), false);
    await show(3);
    await page.waitForSelector(".picture canvas", { state: "visible" });
  });
});

test("nobody is answered without the token, and nothing outside is given", async () => {
  await withChart(async (page, path, address) => {
    const { pathname, port } = new URL(address);
    assert.equal(await rawStatus(address, `${pathname}scene.json`), 200);
    const refused = [
      "/",
      "/scene.json",
      `/${"0".repeat(32)}/scene.json`,
      pathname.slice(0, -2),
      `${pathname}../scene.json`,
      `${pathname}../../etc/passwd`,
      `${pathname}%2e%2e/%2e%2e/etc/passwd`,
      `${pathname}image/..%5c..%5cpasswd`,
    ];
    for (const target of refused) assert.equal(await rawStatus(address, target), 403, target);
    assert.equal(await rawStatus(address, pathname, { Host: `evil.example:${port}` }), 403);
    for (const target of [
      "etc/passwd",
      "image/1280/81.jpg",
      "image/9/1.jpg",
      "camera/-1.json",
      "path/x/use/1.bin",
      "watch/frames.json",
      "live/1/99999.bin",
      "live/1/0x1.bin",
      "live/0.bin",
      "camera/1.yaml",
    ])
      assert.ok([404, 410].includes(await rawStatus(address, pathname + target)), target);
  });
});

test("an exported page opens from a plain web server", async () => {
  const path = await writePath(CHART_PATH);
  const site = join(temporary.folder, "site");
  const { output } = await run("lfvisualizer", [chart, path, "--export", site, "-q"]);
  assert.match(output, /site: \d+ files/);
  await run("lfvisualizer", [chart, path, "--export", site, "-q"], 2);
  const server = await serveFiles(site);
  const { page, faults, close } = await openPage(browser, server.address);
  await until(page, "app.state.use");
  await page.keyboard.press("End");
  await until(page, "app.state.frame === 11 && app.state.use.frame === 11");
  await page.keyboard.press("]");
  await until(page, "app.state.selected !== null");
  await page.waitForFunction(() => document.querySelector(".picture img").naturalWidth === 120);
  await page.click("[data-tab=edit]");
  assert.match(await page.textContent("aside"), /exported files/);
  assert.ok(await page.isHidden("#save"));
  assert.deepEqual(faults, []);
  await close();
  await server.close();
});

test("a frame without LF images says so", async () => {
  await withChart(
    async (page) => {
      await until(page, "app.state.use");
      assert.match(await page.textContent("#empty"), /takes no LF image/);
      assert.match(await page.textContent("aside"), /it is black/);
    },
    CHART_PATH.replace("look_at: [0, 0, 0]", "look_at: [0, 0, -2]"),
  );
});

test("a film may have one frame, and a lens no opening", async () => {
  await withChart(
    async (page) => {
      await until(page, "app.state.film && app.state.film.done === 1");
      assert.match(await page.textContent("aside"), /0, a pinhole/);
      await page.keyboard.press("Space");
      await page.keyboard.press("ArrowRight");
      await until(page, "app.state.frame === 1");
    },
    CHART_PATH.replace("frames: 11", "frames: 1").replace("mm: 12", "mm: 0"),
  );
});

test("packages say which frames are theirs; those of another path are left aside", async () => {
  const path = await writePath(CHART_PATH);
  const packages = join(temporary.folder, "packages");
  await run("lfpreprocessor", [chart, path, "-o", packages, "--packages", "2", "-q", "--max-images", "9"]);
  const words = [chart, path, join(packages, "package-0000.lfp"), join(packages, "package-0001.lfp")];
  await withPage(words, async (page) => {
    await until(page, "app.state.use");
    assert.equal(await page.evaluate(() => window.lfvisualizer.state.use.ids.length), 9);
    assert.match(await page.textContent("aside"), /Packagepackage-0000/);
  });
  await writeFile(path, CHART_PATH.replace("frames: 11", "frames: 12"));
  await withPage(words, async (page) => {
    assert.match(await page.textContent("#message"), /another path/);
  });
});

test("it is readable in light and in a small window", async () => {
  const path = await writePath(CHART_PATH);
  await withPage(
    [chart, path],
    async (page) => {
      await until(page, "app.state.use");
      const isWithin = await page.evaluate(
        () =>
          document.documentElement.scrollWidth <= innerWidth && document.documentElement.scrollHeight <= innerHeight,
      );
      assert.ok(isWithin);
      assert.equal(await page.getAttribute("html", "data-theme"), "light");
      await page.click("#theme");
      assert.equal(await page.getAttribute("html", "data-theme"), "dark");
      for (const button of await page.locator("button:visible").all())
        assert.ok((await button.getAttribute("aria-label")) ?? (await button.textContent()));
    },
    { viewport: { width: 1000, height: 600 }, colorScheme: "light" },
  );
});
