// SPDX-License-Identifier: MIT
// Opens the page of a running csgmesh view, or the page of tools/web, in headless Chromium, does what is asked and prints
// what is to be seen. $CSGMESH_LOOK has more options of browser.mjs as JSON, and `lacks`, the
// name of a thing that the browser is to be without.
//
//   CSGMESH_VIEW=tools/view node tests/cli/look_at_view.mjs URL WIDTHxHEIGHT STEP...
//
// Steps: wait=PHASE (done, failed: of a state later than the last one), picture=FILE, edges, no-edges, section=AXIS,
// measure=X,Y:X,Y (shares of the canvas), from=VIEW, set=NAME=VALUE (a box of numbers), key=KEY, write=FILE=TEXT
// (so that a change comes while the page is open), download=FORMAT=FILE, refused=FORMAT (waits for
// what is said then), look (adds what is to be seen to the list that is printed).
// Of the page of tools/web: type=TEXT (where the cursor is), put=TEXT (instead of all), end (the cursor to the end of the text), choose=SCENE (of the menu),
// slide=NAME=VALUE, press=KEY*TIMES (wherever the focus is; the elements that get it are printed), click=SELECTOR, said=WORDS (waits for them in the status), unfit (waits for
// the word that there is no module), reload, open=FRAGMENT (of the address).
import { writeFileSync } from "node:fs";
import { withPage } from "./browser.mjs";

const [url, size, ...steps] = process.argv.slice(2);

// Run in the page: words, and what the canvas has.
function lookAtPage() {
  view.draw();
  const gl = view.gl, pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
  gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let cut = 0, drawn = 0, red = 0, dark = 0;
  for (let i = 0; i < pixels.length; i += 4) {
    const [r, g, b] = pixels.subarray(i, i + 3);
    drawn += r !== pixels[0] || g !== pixels[1] || b !== pixels[2];
    cut += Math.abs(r - 237) < 4 && Math.abs(g - 168) < 4 && Math.abs(b - 92) < 4;
    red += r > 1.5 * g && r > 1.5 * b;
    dark += r + g + b < 240;
  }
  const text = (id) => (byId(id)?.hidden === false ? byId(id).innerText : "");
  const all = (selector) => [...document.querySelectorAll(selector)].map((one) => one.textContent);
  return {
    name: text("name"), figures: text("figures"), findings: text("findings"), echo: text("echo"), status: text("status"),
    absent: text("absent"), parameters: text("parameters"), length: text("length"), title: document.title, drawn: (4 * drawn) / pixels.length,
    cut: (4 * cut) / pixels.length, red: (4 * red) / pixels.length, dark: (4 * dark) / pixels.length, stale: byId("stage").classList.contains("stale"),
    wide: document.documentElement.scrollWidth, kinds: view.layers?.map((layer) => layer.kind) ?? [],
    triangles: view.layers?.[0]?.triangles ?? 0, camera: view.camera ?? null, hash: location.hash, formats: all("#format option"),
    text: all(".cm-line").join("\n"), wrong: all(".cm-lintRange-error"), dim: dimTexts(),
  };
}

// Run in the page: texts whose contrast with what is behind them is less than WCAG 2 asks of the level AA.
function dimTexts() {
  const parse = (color) => (color.match(/[\d.]+/g) ?? [0, 0, 0, 0]).map(Number);
  const luminance = (rgb) => [0.2126, 0.7152, 0.0722].reduce((sum, weight, i) => {
    const share = rgb[i] / 255;
    return sum + weight * (share <= 0.03928 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4);
  }, 0);
  const behind = (element) => {
    const layers = [];
    for (let one = element; one; one = one.parentElement) {
      const [r, g, b, a = 1] = parse(getComputedStyle(one).backgroundColor);
      if (a > 0) layers.push([r, g, b, a]);
      if (a === 1) break;
    }
    return layers.reverse().reduce((under, [r, g, b, a]) => [r, g, b].map((v, i) => v * a + under[i] * (1 - a)), [255, 255, 255]);
  };
  const words = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT), dim = new Set();
  for (let node = words.nextNode(); node; node = words.nextNode()) {
    const element = node.parentElement, style = getComputedStyle(element);
    if (!node.data.trim() || !element.checkVisibility({ visibilityProperty: true }) || element.closest("svg, option, script")) continue;
    const [light, dark] = [luminance(parse(style.color)), luminance(behind(element))].sort((a, b) => b - a);
    const least = parseFloat(style.fontSize) >= 24 ? 3 : 4.5, ratio = (light + 0.05) / (dark + 0.05);
    if (ratio < least) dim.add(`${node.data.trim().slice(0, 30)}: ${ratio.toFixed(2)}`);
  }
  return [...dim];
}

let version = 0;
async function waitFor(page, phase) {
  for (;;) { // waitForFunction needs eval, which the page forbids
    const [shown, number] = (await page.evaluate(() => document.body.dataset.shown ?? "")).split(" ");
    if (shown === phase && Number(number) > version) return (version = Number(number));
    await page.waitForTimeout(20);
  }
}

const focused = (page) => page.evaluate(async () => {
  const one = document.activeElement, editor = one.closest(".cm-editor");
  while (editor && !editor.classList.contains("cm-focused")) await new Promise((resolve) => setTimeout(resolve, 10));
  const style = getComputedStyle(editor ?? one);
  return [one.id || one.className || one.tagName, style.outlineStyle];
});

async function landed(page) {
  while (await page.evaluate(() => Boolean(view.flight))) await page.waitForTimeout(20);
}

const shares = (text, box) => text.split(":").map((pair) => pair.split(",").map(Number))
  .map(([x, y]) => [box.x + x * box.width, box.y + y * box.height]);

const actions = {
  wait: waitFor,
  picture: (page, file) => page.screenshot({ path: file }),
  edges: (page) => page.locator("#wire").check(),
  "no-edges": (page) => page.locator("#wire").uncheck(),
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
  type: (page, text) => page.keyboard.type(text),
  put: async (page, text) => {
    await page.locator(".cm-content").focus();
    await page.keyboard.press("Control+a");
    await page.keyboard.insertText(text);
  },
  end: async (page) => {
    await page.locator(".cm-content").focus();
    await page.keyboard.press("Control+End");
  },
  choose: (page, name) => page.locator("#scene").selectOption({ label: name }),
  slide: (page, text) => {
    const [name, value] = text.split("=");
    return page.getByRole("slider", { name }).fill(value);
  },
  press: async (page, text) => {
    const [key, times = "1"] = text.split("*");
    for (let i = 0; i < Number(times); i++) {
      await page.keyboard.press(key);
      seen.focus.push(await focused(page));
    }
  },
  click: (page, selector) => page.locator(selector).click(),
  said: (page, words) => page.locator("#status", { hasText: words }).waitFor(),
  unfit: (page) => page.locator("#absent", { hasText: "No solids can be made here" }).waitFor(),
  reload: async (page) => {
    version = 0;
    await page.reload();
  },
  open: (page, fragment) => page.evaluate((hash) => (location.hash = hash), fragment),
  write: (page, text) => {
    const at = text.indexOf("=");
    writeFileSync(text.slice(0, at), text.slice(at + 1));
  },
};

const { lacks, ...options } = JSON.parse(process.env.CSGMESH_LOOK ?? "{}");
const seen = { looks: [], errors: [], focus: [] };
await withPage(size, async (page) => {
  page.on("pageerror", (error) => seen.errors.push(String(error)));
  page.on("console", (message) => message.type() === "error" && seen.errors.push(message.text()));
  if (lacks) await page.addInitScript((name) => delete globalThis[name], lacks);
  await page.goto(url);
  for (const step of steps) {
    const at = step.indexOf("="), name = at < 0 ? step : step.slice(0, at), argument = step.slice(at + 1);
    if (name === "look") seen.looks.push(await page.evaluate(`(() => { ${dimTexts} return (${lookAtPage})(); })()`));
    else await actions[name](page, argument);
  }
}, { ignoreDefaultArgs: ["--disable-extensions"], ...options });
console.log(JSON.stringify(seen));
