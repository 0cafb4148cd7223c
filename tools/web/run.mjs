// SPDX-License-Identifier: MIT
// node run.mjs MODULE FOLDER ARGUMENTS...: `csgmesh mesh ARGUMENTS...` by the module, in a file system that has FOLDER
// alone. What it says goes to standard output, a JSON object a line; the exit status is the command's.
import { readFile } from "node:fs/promises";
import { WASI } from "node:wasi";

const [, , path, folder, ...given] = process.argv;
const wasi = new WASI({ version: "preview1", preopens: { "/": folder }, env: process.env });
const module = await WebAssembly.compile(await readFile(path));
const instance = await WebAssembly.instantiate(module, wasi.getImportObject());
wasi.initialize(instance);
const { memory, web_allocate, web_write, web_answer } = instance.exports;

const text = new TextEncoder().encode(given.map((argument) => argument + "\0").join(""));
const at = web_allocate(text.length);
if (!at) throw new Error("out of memory");
new Uint8Array(memory.buffer, at, text.length).set(text);
const status = web_write(at, text.length);
const answer = new Uint8Array(memory.buffer, web_answer());
process.stdout.write(answer.slice(0, answer.indexOf(0)), () => process.exit(status));
