// SPDX-License-Identifier: MIT
// Headless Chromium with a profile of its own, for drivers of tests: playwright-core is that of $CSGMESH_VIEW (tools/view).
import { createRequire } from "node:module";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";

const { chromium } = createRequire(join(resolve(process.env.CSGMESH_VIEW), "package.json"))("playwright-core");
const FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic",
  "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
  "--force-color-profile=srgb"];

// work(page) in a window of size "WIDTHxHEIGHT". options: playwright's.
export async function withPage(size, work, options = {}) {
  const [width, height] = size.split("x").map(Number), profile = mkdtempSync(join(tmpdir(), "csgmesh-browser-"));
  const browser = await chromium.launchPersistentContext(profile, {
    executablePath: process.env.CSGMESH_CHROMIUM ?? "/usr/bin/chromium", headless: true, args: FLAGS,
    viewport: { width, height }, ...options,
  });
  try {
    return await work(browser.pages()[0] ?? (await browser.newPage()));
  } finally {
    await browser.close();
    rmSync(profile, { recursive: true, force: true });
  }
}
