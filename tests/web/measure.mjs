// SPDX-License-Identifier: MIT
// For measure.py: times of the page in headless Chromium, in milliseconds, as JSON.
//
//   CSGMESH_VIEW=tools/view node measure.mjs URL COUNT SCENE...
//
// Of each scene COUNT times from a key until the first mesh that it makes is given to WebGL, until that is drawn, until the mesh as
// asked is given; the first again for a key that comes while a mesh is made. Of the page COUNT times from the beginning of a warm visit
// until the first mesh is given to WebGL, and is drawn.
import { withPage } from "../cli/browser.mjs";

const [, , url, count, ...scenes] = process.argv;

// Run in the page: each frame with the phase that it shows, when its commands were given and when it was drawn, without a
// GPU by the processor.
function watch() {
  globalThis.frames_ = [];
  globalThis.keyed = 0;
  addEventListener("keydown", () => (globalThis.keyed = performance.now()), true);
  new MutationObserver(() => {
    const frame = { phase: document.body.dataset.shown.split(" ")[0], given: performance.now() };
    requestAnimationFrame(() => {
      view.gl.readPixels(0, 0, 1, 1, view.gl.RGBA, view.gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits for it
      globalThis.frames_.push({ ...frame, drawn: performance.now() });
    });
  }).observe(document, { subtree: true, attributeFilter: ["data-shown"] });
}

const frames = (page) => page.evaluate(() => globalThis.frames_);

async function until(page, phases) {
  for (;;) {
    const found = (await frames(page)).find(({ phase }) => phases.includes(phase));
    if (found) return found;
    await page.waitForTimeout(5);
  }
}

const ANY = ["coarse", "done"];

// A key, and the first frame of these phases behind it.
async function type(page, phases) {
  await page.evaluate(() => (globalThis.frames_ = []));
  await page.keyboard.press("Space");
  const first = await until(page, phases), keyed = await page.evaluate(() => globalThis.keyed);
  return { keyed, given: first.given - keyed, drawn: first.drawn - keyed };
}

async function edits(page, scene) {
  const times = { given: [], drawn: [], full: [], interrupting: [] };
  await page.goto(`${url}#scene=${scene}`);
  await page.reload();
  await until(page, ["done"]);
  await page.locator(".cm-content").focus();
  await page.keyboard.press("Control+End");
  for (let i = 0; i < Number(count) + 1; i++) {
    const first = await type(page, ANY), full = await until(page, ["done"]);
    await page.waitForTimeout(500);
    await type(page, ANY);
    const interrupting = await type(page, ANY);
    await until(page, ["done"]);
    await page.waitForTimeout(500);
    if (i === 0) continue; // the module's code is still being made
    times.given.push(first.given);
    times.drawn.push(first.drawn);
    times.full.push(full.given - first.keyed);
    times.interrupting.push(interrupting.given);
  }
  return times;
}

const seen = { visits: { given: [], drawn: [] }, scenes: {} };
await withPage("1280x800", async (page) => {
  await page.addInitScript(watch);
  for (const scene of scenes) seen.scenes[scene] = await edits(page, scene);
  for (let i = 0; i < Number(count) + 1; i++) {
    const visit = await page.context().newPage();
    await visit.addInitScript(watch);
    await visit.goto(url);
    const { given, drawn } = await until(visit, ANY);
    if (i > 0) {
      seen.visits.given.push(given);
      seen.visits.drawn.push(drawn);
    }
    await visit.close();
  }
});
console.log(JSON.stringify(seen));
