// SPDX-License-Identifier: MIT
// The compiler in a worker: tools/csgmesh/web/web.c in a file system of its own, in memory.
//
// Messages, one after the other:
//   {module, files}          once: the compiled module, and [path, bytes] of what scenes may include. Answer: {ready}.
//   {show, number, coarse}   arguments of `csgmesh mesh`: reads, meshes coarsely (where `coarse`) and as asked. Answers:
//                            {number, state, model, status, took}, each time there is something; the last one has `last`.
//   {write}                  arguments of `csgmesh mesh` whose output is `-`. Answer: {pieces, said, status}.
//   {about}                  Answer: {about}.
// `files` of a show or write are [path, bytes] that replace what there is.
import { Directory, Fd, File, OpenFile, PreopenDirectory, WASI, wasi as names } from "@bjorn3/browser_wasi_shim";

const decoder = new TextDecoder(), encoder = new TextEncoder();
let calls, root, latest = 0, pieces = [];

// Standard output, and what nobody reads.
class Sink extends Fd {
  constructor(keeps) {
    super();
    this.keeps = keeps;
  }

  fd_fdstat_get() {
    return { ret: 0, fdstat: new names.Fdstat(names.FILETYPE_UNKNOWN, 0) };
  }

  fd_write(bytes) {
    if (this.keeps) pieces.push(bytes.slice());
    return { ret: 0, nwritten: bytes.byteLength };
  }
}

// access() asks the folder that was opened for what is allowed in it, and this library says nothing.
class Root extends PreopenDirectory {
  fd_fdstat_get() {
    const fdstat = new names.Fdstat(names.FILETYPE_DIRECTORY, 0);
    fdstat.fs_rights_base = fdstat.fs_rights_inherited = ~0n;
    return { ret: 0, fdstat };
  }
}

// The folder that a path lies in, made where it is not there, and the file's name.
function place(path) {
  const parts = path.split("/").filter(Boolean), name = parts.pop();
  let contents = root.dir.contents;
  for (const part of parts) {
    if (!contents.has(part)) contents.set(part, new Directory(new Map()));
    contents = contents.get(part).contents;
  }
  return { contents, name };
}

function put(path, bytes) {
  const { contents, name } = place(path);
  contents.set(name, new File(bytes));
}

async function begin({ module, files }) {
  root = new Root("/", new Map());
  for (const [path, bytes] of files) put(path, bytes);
  const wasi = new WASI(["csgmesh"], [], [new OpenFile(new File([])), new Sink(true), new Sink(false), root], { debug: false });
  const instance = await WebAssembly.instantiate(module, { wasi_snapshot_preview1: wasi.wasiImport });
  wasi.initialize(instance);
  calls = instance.exports;
  postMessage({ ready: true });
}

// ---- memory of the module: it grows, so views of it are made when they are read

function giveBytes(bytes) {
  const at = calls.web_allocate(bytes.length);
  if (!at) throw new Error("out of memory");
  new Uint8Array(calls.memory.buffer, at, bytes.length).set(bytes);
  return [at, bytes.length];
}

const giveArguments = (list) => giveBytes(encoder.encode(list.map((argument) => `${argument}\0`).join("")));

function readText(at) {
  const bytes = new Uint8Array(calls.memory.buffer, at);
  return decoder.decode(bytes.subarray(0, bytes.indexOf(0)));
}

const stateOf = (phase) => JSON.parse(`{${readText(calls.web_state(giveBytes(encoder.encode(`${phase}\0`))[0]))}}`);
const modelOf = () => calls.memory.buffer.slice(calls.web_model(), calls.web_model() + calls.web_model_length());

// ---- requests

// A newer request that came meanwhile is taken in this pause.
const pause = () => new Promise((resolve) => {
  const { port1, port2 } = new MessageChannel();
  port1.onmessage = resolve;
  port2.postMessage(0);
});

function tell(number, phase, status, took, last) {
  const model = phase === "failed" ? null : modelOf();
  postMessage({ number, status, took, last, model, state: stateOf(phase) }, model ? [model] : []);
}

async function show({ show: list, number, coarse }) {
  const began = performance.now();
  let status = calls.web_begin(...giveArguments(list));
  if (status === 0 && coarse && calls.web_mesh(1) === 0) {
    tell(number, "coarse", 0, performance.now() - began, false);
    await pause();
    if (number !== latest) return postMessage({ number, last: true });
  }
  const middle = performance.now();
  if (status === 0) status = calls.web_mesh(0);
  tell(number, status === 0 ? "done" : "failed", status, performance.now() - middle, true);
}

function write({ write: list }) {
  pieces = [];
  const status = calls.web_write(...giveArguments(list));
  postMessage({ pieces, status, said: readText(calls.web_answer()) });
}

onmessage = async ({ data }) => {
  latest = data.number ?? latest;
  for (const [path, bytes] of (data.module ? [] : data.files ?? [])) put(path, bytes);
  try {
    if (data.module) await begin(data);
    else if (data.show) await show(data);
    else if (data.write) write(data);
    else postMessage({ about: JSON.parse(readText(calls.web_about())) });
  } catch (error) {
    postMessage({ broken: String(error.message ?? error), number: data.number });
  }
};
