// SPDX-License-Identifier: Apache-2.0
// Bundles the page: index.html, page.js, page.css.
//
// usage: node build.mjs FOLDER [SOURCES]
//
// SOURCES receives, of each package, the files that are bundled, its licence and its package.json, and what three.js is
// made of.
import { copyFile, cp, mkdir, readFile } from "node:fs/promises";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const web = path.dirname(fileURLToPath(import.meta.url));
const [folder, sources] = process.argv.slice(2).map((name) => path.resolve(name));
if (!folder) {
  console.error("usage: node build.mjs FOLDER [SOURCES]");
  process.exit(2);
}

const packages = ["three", "yaml"];
// The licences of the bundled packages, which require to be included.
const licences = await Promise.all(
  packages.map(async (name) => {
    const text = await readFile(path.join(web, "node_modules", name, "LICENSE"), "utf8");
    return `${name}\n\n${text.trim()}`;
  }),
);

await mkdir(folder, { recursive: true });
const { metafile } = await build({
  entryPoints: { page: path.join(web, "src/main.ts") },
  absWorkingDir: web,
  bundle: true,
  metafile: true,
  minify: true,
  format: "iife",
  target: "es2022",
  banner: { js: `/*\n${licences.join("\n\n")}\n*/` },
  outdir: folder,
  logLevel: "warning",
});
await build({
  entryPoints: { page: path.join(web, "src/page.css") },
  bundle: true,
  minify: true,
  outdir: folder,
  logLevel: "warning",
});
await copyFile(path.join(web, "src/index.html"), path.join(folder, "index.html"));

if (sources) {
  const bundled = Object.keys(metafile.inputs).filter((name) => !name.startsWith("src/"));
  const foreign = bundled.filter((name) => !packages.some((known) => name.startsWith(`node_modules/${known}/`)));
  if (foreign.length > 0) throw new Error(`the page would contain ${foreign.join(", ")} without a licence`);
  const notes = packages.flatMap((name) => ["LICENSE", "package.json"].map((file) => `node_modules/${name}/${file}`));
  for (const name of [...bundled, ...notes]) {
    const copy = path.join(sources, path.relative("node_modules", name));
    await mkdir(path.dirname(copy), { recursive: true });
    await copyFile(path.join(web, name), copy);
  }
  await cp(path.join(web, "node_modules/three/src"), path.join(sources, "three/src"), { recursive: true });
}
