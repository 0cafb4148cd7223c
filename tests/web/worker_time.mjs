// SPDX-License-Identifier: MIT
// node worker_time.mjs MODULE FOLDER COUNT SCENE...: processor time of the module in milliseconds, as JSON: {scene: {coarse, full}}, each
// COUNT times. Both read the scene and mesh it, as a page's worker does; what comes before they are counted makes the code.
import { readFile } from "node:fs/promises";
import { WASI } from "node:wasi";

const [, , path, folder, count, ...scenes] = process.argv;
const module = await WebAssembly.compile(await readFile(path));

async function measure(scene) {
  const wasi = new WASI({ version: "preview1", preopens: { "/": folder }, env: process.env });
  const instance = await WebAssembly.instantiate(module, wasi.getImportObject());
  wasi.initialize(instance);
  const { memory, web_allocate, web_begin, web_mesh } = instance.exports;
  const text = new TextEncoder().encode(`/${scene}\0`), times = { coarse: [], full: [] };
  const timed = (coarsely) => {
    const at = web_allocate(text.length), before = process.cpuUsage();
    new Uint8Array(memory.buffer, at, text.length).set(text);
    const status = web_begin(at, text.length) || web_mesh(coarsely), { user, system } = process.cpuUsage(before);
    if (status) throw new Error(`${scene}: ${status}`);
    return (user + system) / 1000;
  };
  for (let i = 0; i < Number(count) + 1; i++) {
    const coarse = timed(1), full = timed(0);
    if (i === 0) continue;
    times.coarse.push(coarse);
    times.full.push(full);
  }
  return times;
}

const seen = {};
for (const scene of scenes) seen[scene] = await measure(scene);
console.log(JSON.stringify(seen));
