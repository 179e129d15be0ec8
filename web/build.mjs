// Bundles the page: index.html, page.js, page.css.
//
// usage: node build.mjs FOLDER
import { copyFile, mkdir, readFile } from "node:fs/promises";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const web = path.dirname(fileURLToPath(import.meta.url));
const folder = process.argv[2];
if (!folder) {
  console.error("usage: node build.mjs FOLDER");
  process.exit(2);
}

// The licences of the bundled packages, which require to be included.
const licences = await Promise.all(
  ["three", "yaml"].map(async (name) => {
    const text = await readFile(path.join(web, "node_modules", name, "LICENSE"), "utf8");
    return `${name}\n\n${text.trim()}`;
  }),
);

await mkdir(folder, { recursive: true });
await build({
  entryPoints: { page: path.join(web, "src/main.ts") },
  bundle: true,
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
