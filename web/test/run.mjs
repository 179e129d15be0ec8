// SPDX-License-Identifier: Apache-2.0
// Runs the page's tests: node test/run.mjs [PART OF A NAME]...
// LF_BIN is the folder of the programs: what the page writes is read by the real parser.
import { spawnSync } from "node:child_process";
import { mkdtempSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, relative, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const testFolder = fileURLToPath(new URL(".", import.meta.url));
const webFolder = resolve(testFolder, "..");

function testsIn(folder) {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    const path = join(folder, entry.name);
    if (entry.isDirectory()) return testsIn(path);
    return entry.name.endsWith(".test.ts") ? [path] : [];
  });
}

const parts = process.argv.slice(2);
const tests = testsIn(testFolder)
  .filter((path) => parts.length === 0 || parts.some((part) => path.includes(part)))
  .sort();
if (tests.length === 0) {
  console.error("No test has such a name.");
  process.exit(1);
}

const bundles = mkdtempSync(join(tmpdir(), "lfvisualizer-page-"));
let status = 1;
try {
  const names = tests.map((path) => relative(testFolder, path).replace(/[\\/]/g, "-"));
  await build({
    entryPoints: tests.map((path, i) => ({ in: path, out: names[i].replace(/\.ts$/, "") })),
    outdir: bundles,
    outExtension: { ".js": ".mjs" },
    bundle: true,
    platform: "node",
    format: "esm",
    // The build of `yaml` for browsers, as in the page; its build for Node.js cannot be bundled as
    // a module.
    alias: { yaml: join(webFolder, "node_modules/yaml/browser/index.js") },
    target: "node18",
    sourcemap: "inline",
    logLevel: "warning",
  });
  const files = names.map((name) => join(bundles, name.replace(/\.ts$/, ".mjs")));
  const bin = process.env.LF_BIN;
  const run = spawnSync(process.execPath, ["--enable-source-maps", "--test", ...files], {
    cwd: webFolder,
    env: { ...process.env, ...(bin ? { LF_BIN: resolve(bin) } : {}) },
    stdio: "inherit",
  });
  if (run.error) console.error(run.error.message);
  status = run.status ?? 1;
} finally {
  rmSync(bundles, { recursive: true, force: true });
}
process.exit(status);
