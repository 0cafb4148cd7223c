// SPDX-License-Identifier: MIT
// Opens a page of csgmesh diff --html from its file in headless Chromium and prints what is to be seen as JSON.
//
//   CSGMESH_VIEW=tools/view node tests/cli/look_at_report.mjs report.html [picture.png] [WIDTHxHEIGHT] [dark]
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { withPage } from "./browser.mjs";

const [file, picture, size = "1440x950", scheme = "light"] = process.argv.slice(2);

// How many colours are in the middle of the canvas, and how many pixels are not the background.
function lookAtCanvas() {
  const view = window.report.view, gl = view.gl;
  if (!gl || !view.models) return null;
  view.draw();
  const w = gl.drawingBufferWidth, h = gl.drawingBufferHeight, pixels = new Uint8Array(4 * w * h);
  gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  const words = new Uint32Array(pixels.buffer), colors = new Set(words);
  let red = 0;
  for (let i = 0; i < pixels.length; i += 4) red += pixels[i] > 90 && pixels[i] > 2 * pixels[i + 1];
  return { colors: colors.size, drawn: words.filter((word) => word !== words[0]).length / words.length, red };
}

const cameraOf = (page) => page.evaluate(() => structuredClone(window.report.view.camera ?? null));

// The camera at the end of its way: a loaded machine takes its time. (waitForFunction needs eval, which the page forbids.)
async function landed(page) {
  while (await page.evaluate(() => Boolean(window.report.view.flight))) await page.waitForTimeout(50);
  return cameraOf(page);
}

// Fingers as the screen sees them: one turns, two that part zoom, two side by side move.
async function useFingers(page, seen) {
  const box = await page.locator("#canvas").boundingBox(), x = box.x + box.width / 2, y = box.y + box.height / 2;
  const session = await page.context().newCDPSession(page);
  const touch = (type, ...points) => session.send("Input.dispatchTouchEvent",
    { type, touchPoints: points.map(([dx, dy], id) => ({ x: x + dx, y: y + dy, id })) });
  const stroke = async (from, to) => {
    await touch("touchStart", ...from);
    for (const share of [0.5, 1])
      await touch("touchMove", ...from.map((at, i) => at.map((v, k) => v + (to[i][k] - v) * share)));
    await touch("touchEnd");
    return cameraOf(page);
  };
  seen.touch = { before: await cameraOf(page) };
  seen.touch.turned = await stroke([[0, 0]], [[80, 30]]);
  seen.touch.pinched = await stroke([[-40, 0], [40, 0]], [[-80, 0], [80, 0]]);
  seen.touch.moved = await stroke([[-40, 0], [40, 0]], [[-40, 60], [40, 60]]);
}

async function useHands(page, seen) {
  const box = await page.locator("#canvas").boundingBox(), x = box.x + box.width / 2, y = box.y + box.height / 2;
  seen.start = await cameraOf(page);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 60, y + 20);
  await page.mouse.up();
  seen.dragged = await cameraOf(page);
  await page.mouse.wheel(0, -240);
  await page.waitForTimeout(50);
  seen.zoomed = await cameraOf(page);
  await page.locator("#canvas").focus();
  await page.keyboard.press("ArrowLeft");
  seen.keyed = await cameraOf(page);
  seen.modes = {};
  for (const key of ["1", "2", "3", "4", "5"]) {
    await page.keyboard.press(key);
    seen.modes[await page.evaluate(() => window.report.view.mode)] = await page.evaluate(lookAtCanvas);
  }
  await page.locator("#slider").fill("80");
  seen.split = await page.evaluate(() => [window.report.view.mode, window.report.view.split]);
  await page.keyboard.press("5");
  await page.locator("#fit").click();
  seen.fitted = await landed(page);
  await useFingers(page, seen);
}

async function visit(page, seen) {
  seen.title = await page.title();
  seen.text = await page.locator("body").innerText();
  seen.word = await page.locator("#word").innerText();
  seen.pairs = await page.locator("#pairs button").allInnerTexts();
  seen.canvas = await page.evaluate(lookAtCanvas);
  seen.worst = await page.locator("#worst button").count();
  seen.folded = await page.evaluate(() => { const box = document.querySelector("#pairs details");
    return box && [box.querySelectorAll("button").length, box.open]; });
  seen.order = await page.evaluate(() => Object.fromEntries(["changes", "view", "worst"].map((id) =>
    [id, document.getElementById(id).getBoundingClientRect().top])));
  seen.panes = await page.evaluate(() => window.report.view.gl ? window.report.view.panes().map((pane) => [pane.side ?? "", pane.y]) : []);
  seen.overflow = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
  if (picture) await page.screenshot({ path: picture });
  if (!seen.canvas) return;
  await useHands(page, seen);
  if (!seen.worst) return;
  await page.locator("#worst button").first().click();
  seen.flown = await landed(page);
  seen.ring = await page.evaluate(() => [getComputedStyle(document.getElementById("marks")).visibility,
    Number(document.getElementById("ring").getAttribute("cx")), document.getElementById("canvas").clientWidth]);
  if (picture) await page.screenshot({ path: picture.replace(/\.png$/, "-worst.png") });
}

const seen = { errors: [], requests: [] };
await withPage(size, async (page) => {
  page.on("console", (message) => ["error", "warning"].includes(message.type())
    && !/GPU stall/.test(message.text()) && seen.errors.push(message.text()));
  page.on("pageerror", (error) => seen.errors.push(String(error)));
  page.on("request", (request) => /^(file|data):/.test(request.url()) || seen.requests.push(request.url()));
  await page.goto(pathToFileURL(resolve(file)).href);
  await visit(page, seen);
}, { colorScheme: scheme, offline: true });
process.stdout.write(JSON.stringify(seen));
