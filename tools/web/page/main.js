// SPDX-License-Identifier: MIT
// The page: text and parameters go to the compiler, what it answers to the view. view.js, solid.js, stage.js and scene.js
// stand before this script and are shared with csgmesh view and csgmesh diff.
/* global byId, make, host, chosen, chooseAll, definitions, save, showState, showStatus, view */
import workerSource from "worker-source";
import { Compiler } from "./compiler.js";
import { Editor } from "./editor.js";
import { readLink, writeLink } from "./link.js";

const FIRST = "scenes/parts/mug.txt", NEW = "scene.txt";
const NEW_TEXT = "// A scene of your own: what is here is a beginning.\nsize = 20; // [5:50]\n\n"
  + "difference(blend = 2) {\n  cube(size, center = true);\n  cylinder(h = 2 * size, r = size / 4, center = true);\n}\n";
const data = JSON.parse(byId("data").textContent); // {scenes: [path, text], groups}
const encoder = new TextEncoder();
const kept = new Map([[NEW, NEW_TEXT], ...data.scenes]);

let path = NEW, compiler = null, shown = 0, notice = ""; // notice: what stays to be read while a scene is shown

// ---- the scene as it is now

const values = () => Object.fromEntries(chosen);
const quality = () => byId("quality").value;
const argumentsOf = (more = []) => [`/${path}`, "--quality", quality(), ...definitions(chosen).flatMap((line) => ["-D", line]), ...more];
const filesOf = () => [[`/${path}`, encoder.encode(editor.text)]];

function mesh() {
  const at = performance.now();
  compiler?.show({ arguments: argumentsOf(), files: filesOf() }, (answer) => take(answer, at));
}

function take(answer, asked) {
  if (answer.broken) return showStatus(`The compiler broke off: ${answer.broken}. Change something to go on.`, true);
  const { state, model } = answer, own = state.findings.filter((finding) => finding.file === `/${path}` && finding.line);
  showState(state, model);
  if (notice && state.scene.phase === "done") showStatus(notice, true);
  if (state.scene.phase !== "coarse") editor.showFindings(own);
  document.body.dataset.shown = `${state.scene.phase} ${++shown} ${Math.round(performance.now() - asked)}`;
}

let linking = 0;
function remember() {
  clearTimeout(linking);
  linking = setTimeout(async () => history.replaceState(null, "", await writeLink({ path, text: editor.text, values: values() }, kept)), 250);
}

function changed() {
  notice = "";
  mesh();
  remember();
}

const editor = new Editor(byId("text"), changed);

function open(scene) {
  path = scene.path;
  editor.text = scene.text;
  const name = path.split("/").pop();
  byId("scene").value = kept.has(path) ? path : "";
  document.title = `${name} - csgmesh`;
  view.camera = null; // the next model is looked at as a whole
  chooseAll(scene.values);
}

host.setValues = changed;
host.goTo = (finding) => editor.goTo(finding);
// The bytes of `csgmesh mesh -o - -f FORMAT`.
host.file = async (format) => {
  const { pieces, said, status } = await compiler.write({ arguments: argumentsOf(["-o", "-", "-f", format]), files: filesOf() });
  if (status === 0) return new Blob(pieces);
  const finding = said.split("\n").filter(Boolean).map((line) => JSON.parse(line)).find((one) => one.severity === "error");
  throw new Error(finding ? [finding.message, finding.hint].filter(Boolean).join("; ") : "the compiler gave no reason");
};

// ---- the bar

function fillMenu() {
  const groups = data.groups.map(([label, scenes]) => {
    const group = make("optgroup", "", { label });
    group.append(...scenes.map(([value, name]) => make("option", name, { value })));
    return group;
  });
  byId("scene").append(make("option", "New scene", { value: NEW }), ...groups);
}

async function openFile(file) {
  if (!file) return;
  if (file.size > 4 << 20) return showStatus(`${file.name} is too large for a scene.`, true);
  history.pushState(null, "", location.hash);
  open({ path: file.name, text: await file.text(), values: {} });
}

async function copyLink() {
  const link = await writeLink({ path, text: editor.text, values: values() }, kept);
  history.replaceState(null, "", link);
  try {
    await navigator.clipboard.writeText(location.href);
    showStatus("The link is copied.");
  } catch {
    showStatus("The link is in the address bar.");
  }
}

async function showAbout() {
  const about = await compiler?.about();
  byId("about-text").textContent = about ? `csgmesh ${about.version}\n${about.features}` : "The compiler is not running.";
  byId("licences-text").textContent = new TextDecoder().decode(await inflate("licences"));
  byId("licences-box").hidden = !byId("licences-text").textContent;
  byId("about").showModal();
}

function listen() {
  byId("scene").addEventListener("change", ({ target }) => {
    history.pushState(null, "", `#scene=${target.value}`);
    open({ path: target.value, text: kept.get(target.value), values: {} });
  });
  byId("quality").addEventListener("change", mesh);
  byId("open").addEventListener("click", () => byId("file").click());
  byId("file").addEventListener("change", ({ target }) => openFile(target.files[0]));
  byId("save").addEventListener("click", () => save(new Blob([editor.text], { type: "text/plain" }), path.split("/").pop()));
  byId("link").addEventListener("click", copyLink);
  byId("about-button").addEventListener("click", showAbout);
  addEventListener("dragover", (event) => event.preventDefault());
  addEventListener("drop", (event) => {
    event.preventDefault();
    openFile(event.dataTransfer.files[0]);
  });
  addEventListener("popstate", openLink);
}

async function openLink() {
  try {
    open((await readLink(location.hash, kept)) ?? { path: FIRST, text: kept.get(FIRST), values: {} });
  } catch (error) {
    open({ path: NEW, text: NEW_TEXT, values: {} });
    notice = `No scene: ${error.message}.`;
  }
}

// ---- the module: base64 of gzip in the page

function bytesOfBase64(text) {
  const characters = atob(text), bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = characters.charCodeAt(i);
  return bytes;
}

const inflated = (id, type) => new Response(new Blob([bytesOfBase64(byId(id).textContent)]).stream().pipeThrough(new DecompressionStream("gzip")), { headers: { "content-type": type } });
const inflate = (id) => inflated(id, "application/octet-stream").arrayBuffer();

// The module is compiled while it is inflated, and while a worker starts.
async function compile() {
  const lacks = typeof WebAssembly === "undefined" ? "WebAssembly" : typeof DecompressionStream === "undefined" ? "DecompressionStream" : "";
  if (lacks) throw new Error(`this browser has no ${lacks}`);
  const module = WebAssembly.compileStreaming(inflated("module", "application/wasm")), font = new Uint8Array(await inflate("font"));
  const files = data.scenes.map(([name, text]) => [`/${name}`, encoder.encode(text)]);
  if (font.length) files.push([data.font, font]);
  compiler = new Compiler(module, workerSource, files);
  mesh();
  await module;
}

async function start() {
  fillMenu();
  listen();
  await openLink();
  compile().catch((error) => fail(error.message));
}

function fail(reason) {
  byId("absent").hidden = false;
  byId("absent").textContent = `No solids can be made here: ${reason}. The page needs a browser of 2023 or later, with WebAssembly and its vectors (SIMD).`;
  document.body.dataset.shown = "none 1 0";
}

start();
