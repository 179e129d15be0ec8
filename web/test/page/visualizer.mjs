// SPDX-License-Identifier: Apache-2.0
// Runs lfvisualizer as a process, and a browser that shows its page.
import { spawn } from "node:child_process";
import { existsSync } from "node:fs";
import { createServer } from "node:http";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { extname, join, normalize, resolve } from "node:path";
import { chromium } from "playwright-core";

export const BIN = process.env.LF_BIN ? resolve(process.env.LF_BIN) : "";
export const DATA = process.env.LF_TEST_DATA ?? "";
const BROWSERS = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];

export function program(name) {
  const path = join(BIN, name);
  if (!BIN || !existsSync(path)) throw new Error(`LF_BIN: expected the folder of ${name}`);
  return path;
}

export function findBrowser() {
  return BROWSERS.find((path) => existsSync(path));
}

export async function temporaryFolder() {
  const folder = await mkdtemp(join(tmpdir(), "lfvisualizer-test-"));
  return { folder, remove: () => rm(folder, { recursive: true, force: true }) };
}

// Waits for the end of a program; rejects unless its exit code is `code`.
export function run(name, words, code = 0) {
  return new Promise((resolve, reject) => {
    const child = spawn(program(name), words, { stdio: ["ignore", "pipe", "pipe"] });
    let output = "";
    let complaints = "";
    child.stdout.on("data", (data) => (output += data));
    child.stderr.on("data", (data) => (complaints += data));
    child.on("error", reject);
    child.on("close", (status) => {
      if (status === code) resolve({ output, complaints });
      else reject(new Error(`${name} ${words.join(" ")}: exit ${status}\n${complaints}`));
    });
  });
}

// Starts the program as a server. stop() ends it like Ctrl-C and returns its exit status.
export async function serve(words) {
  const child = spawn(program("lfvisualizer"), words, { stdio: ["ignore", "pipe", "pipe"] });
  let complaints = "";
  child.stderr.on("data", (data) => (complaints += data));
  const ended = new Promise((resolve) => child.on("close", resolve));
  const address = await new Promise((resolve, reject) => {
    let text = "";
    child.stdout.on("data", (data) => {
      text += data;
      if (text.includes("\n")) resolve(text.trim());
    });
    child.on("error", reject);
    child.on("close", (status) => reject(new Error(`lfvisualizer: exit ${status}\n${complaints}`)));
  });
  return {
    address,
    stop: async () => {
      child.kill("SIGINT");
      return ended;
    },
  };
}

// Renders by software, so that all machines draw the same.
export function openBrowser(words = []) {
  return chromium.launch({
    executablePath: findBrowser(),
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", ...words],
  });
}

// Opens a page and records its error messages and its requests to other hosts.
//   query  is added to the address
export async function openPage(browser, address, { query = "", ...options } = {}) {
  const context = await browser.newContext({
    viewport: { width: 1280, height: 720 },
    colorScheme: "dark",
    ...options,
  });
  const page = await context.newPage();
  const faults = [];
  page.on("console", (message) => {
    // Messages of Chromium about drawing without a graphics card, and about tests that read pixels or lose contexts.
    if (/GPU stall due to ReadPixels|swiftshader|willReadFrequently|CONTEXT_LOST_WEBGL/i.test(message.text())) return;
    if (["error", "warning"].includes(message.type())) faults.push(message.text());
  });
  page.on("pageerror", (error) => faults.push(error.message));
  page.on("request", (request) => {
    const url = request.url();
    if (!url.startsWith(address) && !/^(data|blob):/.test(url)) faults.push(`asks for ${url}`);
  });
  await page.goto(address + query);
  await page.waitForSelector("body[data-ready=yes]", { timeout: 120_000 });
  return { page, faults, close: () => context.close() };
}

// Waits until an expression of the page's `app` (its state and view) is true. The page's policy
// forbids code from strings, so the expression is evaluated from outside. `act`, if given, is
// repeated about twice a second until then.
export async function until(page, condition, act = null) {
  const expression = `(() => { const app = window.lfvisualizer; return Boolean(${condition}); })()`;
  for (const end = Date.now() + 240_000; Date.now() < end; await page.waitForTimeout(act ? 500 : 30)) {
    if (await page.evaluate(expression)) return;
    if (act) await act();
  }
  throw new Error(`not within four minutes: ${condition}`);
}

// Serves an exported page from a plain web server.
export async function serveFiles(folder) {
  const types = {
    ".html": "text/html",
    ".js": "text/javascript",
    ".css": "text/css",
    ".json": "application/json",
    ".jpg": "image/jpeg",
  };
  const server = createServer(async (request, response) => {
    const name = normalize(decodeURIComponent(new URL(request.url, "http://x").pathname));
    try {
      const bytes = await readFile(join(folder, name === "/" ? "index.html" : name));
      response.writeHead(200, {
        "Content-Type": types[extname(name || "")] ?? (name === "/" ? "text/html" : "application/octet-stream"),
      });
      response.end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return {
    address: `http://127.0.0.1:${server.address().port}/`,
    close: () => new Promise((resolve) => server.close(resolve)),
  };
}
