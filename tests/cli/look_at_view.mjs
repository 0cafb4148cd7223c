// SPDX-License-Identifier: MIT
// Opens the page of a running csgmesh view in headless Chromium, does what is asked and prints what is to be seen.
//
//   CSGMESH_VIEW=tools/view node tests/cli/look_at_view.mjs URL WIDTHxHEIGHT STEP...
//
// Steps: wait=PHASE (done, failed: of a state later than the last one), picture=FILE, edges, section=AXIS,
// measure=X,Y:X,Y (shares of the canvas), from=VIEW, set=NAME=VALUE (a box of numbers), key=KEY, write=FILE=TEXT
// (so that a change comes while the page is open), download=FORMAT=FILE, refused=FORMAT (waits for
// what is said then), look (adds what is to be seen to the list that is printed).
import { writeFileSync } from "node:fs";
import { withPage } from "./browser.mjs";

const [url, size, ...steps] = process.argv.slice(2);

// Run in the page: words, and what the canvas has.
function lookAtPage() {
  view.draw();
  const gl = view.gl, pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
  gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let cut = 0, drawn = 0, red = 0;
  for (let i = 0; i < pixels.length; i += 4) {
    const [r, g, b] = pixels.subarray(i, i + 3);
    drawn += r !== pixels[0] || g !== pixels[1] || b !== pixels[2];
    cut += Math.abs(r - 237) < 4 && Math.abs(g - 168) < 4 && Math.abs(b - 92) < 4;
    red += r > 1.5 * g && r > 1.5 * b;
  }
  const text = (id) => (byId(id).hidden ? "" : byId(id).innerText);
  return {
    name: text("name"), figures: text("figures"), findings: text("findings"), echo: text("echo"), status: text("status"),
    absent: text("absent"), parameters: text("parameters"), length: text("length"), title: document.title, drawn: (4 * drawn) / pixels.length,
    cut: (4 * cut) / pixels.length, red: (4 * red) / pixels.length, stale: byId("stage").classList.contains("stale"),
    wide: document.documentElement.scrollWidth, kinds: view.layers?.map((layer) => layer.kind) ?? [],
    triangles: view.layers?.[0]?.triangles ?? 0,
  };
}

let version = 0;
async function waitFor(page, phase) {
  for (;;) { // waitForFunction needs eval, which the page forbids
    const [shown, number] = (await page.evaluate(() => document.body.dataset.shown ?? "")).split(" ");
    if (shown === phase && Number(number) > version) return (version = Number(number));
    await page.waitForTimeout(20);
  }
}

async function landed(page) {
  while (await page.evaluate(() => Boolean(view.flight))) await page.waitForTimeout(20);
}

const shares = (text, box) => text.split(":").map((pair) => pair.split(",").map(Number))
  .map(([x, y]) => [box.x + x * box.width, box.y + y * box.height]);

const actions = {
  wait: waitFor,
  picture: (page, file) => page.screenshot({ path: file }),
  edges: (page) => page.locator("#wire").check(),
  section: (page, axis) => page.locator("#section").selectOption({ label: axis }),
  measure: async (page, places) => {
    await page.locator("#measure").check();
    for (const [x, y] of shares(places, await page.locator("#canvas").boundingBox())) await page.mouse.click(x, y);
  },
  from: async (page, name) => {
    await page.locator("#from-where").selectOption(name);
    await landed(page);
  },
  set: async (page, text) => {
    const [name, value] = text.split("=");
    await page.getByRole("spinbutton", { name: new RegExp(`^${name}`) }).fill(value);
  },
  key: async (page, key) => {
    await page.locator("#canvas").focus();
    await page.keyboard.press(key);
  },
  download: async (page, text) => {
    const [format, file] = text.split("=");
    await page.locator("#format").selectOption(format);
    const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Download" }).click()]);
    await download.saveAs(file);
  },
  refused: async (page, format) => {
    await page.locator("#format").selectOption(format);
    await page.getByRole("button", { name: "Download" }).click();
    await page.locator("#status", { hasText: "No file" }).waitFor();
  },
  write: (page, text) => {
    const at = text.indexOf("=");
    writeFileSync(text.slice(0, at), text.slice(at + 1));
  },
};

const seen = { looks: [], errors: [] };
await withPage(size, async (page) => {
  page.on("pageerror", (error) => seen.errors.push(String(error)));
  page.on("console", (message) => message.type() === "error" && seen.errors.push(message.text()));
  await page.goto(url);
  for (const step of steps) {
    const at = step.indexOf("="), name = at < 0 ? step : step.slice(0, at), argument = step.slice(at + 1);
    if (name === "look") seen.looks.push(await page.evaluate(lookAtPage));
    else await actions[name](page, argument);
  }
}, { ignoreDefaultArgs: ["--disable-extensions"] });
console.log(JSON.stringify(seen));
