#!/usr/bin/env node
// SPDX-License-Identifier: MIT
// Pictures of meshes: opens GLB files in headless Chromium with three.js and writes one PNG.
//
//   npm ci --prefix tools/view                        once; Chromium itself comes from Debian
//   node tools/view/view.js mug.glb -o mug.png
//   node tools/view/view.js a.glb b.glb c.glb d.glb -o sheet.png --columns 2 --size 480x360 --labels
//
// Options: --size WxH (of one picture, 960x720), --azimuth and --elevation in degrees (35, 24; azimuth
// 0 looks along the scene's +y), --zoom (1), --columns (1), --labels (file names under the pictures),
// --wire (edges instead of faces), --chromium PATH. A file may carry a view of its own:
// mug.glb@20,30 or mug.glb@20,30,1.2.
import { accessSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { basename, dirname, extname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { tmpdir } from "node:os";
import { parseArgs } from "node:util";
import { chromium } from "playwright-core";

const here = dirname(fileURLToPath(import.meta.url));
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm" };
const BYTES = "application/octet-stream";
const FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
  "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync", "--force-color-profile=srgb"];

function readOptions() {
  const string = (value) => ({ type: "string", default: value });
  const { values, positionals } = parseArgs({
    allowPositionals: true,
    options: {
      output: { type: "string", short: "o" },
      size: string("960x720"), azimuth: string("35"), elevation: string("24"), zoom: string("1"),
      columns: string("1"), labels: { type: "boolean" }, wire: { type: "boolean" },
      chromium: string("/usr/bin/chromium"),
    },
  });
  if (!values.output || !positionals.length)
    throw new Error("usage: view.js MESH.glb... -o OUT.png [options]; see the head of this file");
  for (const file of positionals) accessSync(file.split("@")[0]);
  return { values, files: positionals };
}

function describe(file, values) {
  const [path, view = ""] = file.split("@");
  const own = view.split(",");
  const pick = (index, name) => Number(own[index] || values[name]);
  const [width, height] = values.size.split("x").map(Number);
  return {
    path, width, height, columns: Number(values.columns), wire: Boolean(values.wire),
    caption: values.labels ? basename(path, extname(path)) : "",
    azimuth: pick(0, "azimuth"), elevation: pick(1, "elevation"), zoom: pick(2, "zoom"),
  };
}

// Nothing comes from a network: every address is a file of this folder, of three, or a mesh.
async function serve(route, models) {
  const path = new URL(route.request().url()).pathname;
  let file = join(here, path);
  if (path.startsWith("/three/")) file = join(here, "node_modules", path);
  if (path.startsWith("/mesh/")) file = resolve(models[Number(path.slice(6))].path);
  try {
    return await route.fulfill({ body: readFileSync(file), contentType: TYPES[extname(file)] ?? BYTES });
  } catch {
    return route.fulfill({ status: 404 });
  }
}

async function main() {
  const { values, files } = readOptions();
  const models = files.map((file) => describe(file, values));
  const profile = mkdtempSync(join(tmpdir(), "csgmesh-view-"));
  const browser = await chromium.launchPersistentContext(profile, {
    executablePath: values.chromium, headless: true, args: FLAGS,
    viewport: { width: models[0].width, height: models[0].height },
  });
  try {
    const page = await browser.newPage();
    page.on("console", (message) => message.type() === "error" && console.error(message.text()));
    page.on("pageerror", (error) => console.error(String(error)));
    await page.route("**/*", (route) => serve(route, models));
    await page.goto("http://view.invalid/page.html");
    await page.waitForFunction("window.ready === true");
    for (const [index, model] of models.entries())
      await page.evaluate((m) => window.show(m), { ...model, url: `/mesh/${index}` });
    await page.locator("#sheet").screenshot({ path: values.output });
  } finally {
    await browser.close();
    rmSync(profile, { recursive: true, force: true });
  }
}

main().catch((error) => {
  console.error(String(error.message ?? error));
  process.exitCode = 1;
});
