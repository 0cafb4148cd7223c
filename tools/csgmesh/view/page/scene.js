// SPDX-License-Identifier: MIT
// A scene beside its stage: what is said of it, its parameters, its files. Where these come from is the page's own
// matter: its script fills `host`.
const host = {
  setValues(values) {}, // a Map of names to values, as the reader chose them
  async file(format) {}, // a Blob; throws what stands in its way
  goTo: null, // (finding): its place in the text, where a page has that
};

// ---- what is said

function showStatus(text, isBad = false) {
  byId("status").textContent = text;
  byId("status").classList.toggle("bad", isBad);
}

function findingItem(finding) {
  const item = make("li", "", { className: finding.severity }), goes = host.goTo && finding.line;
  const place = finding.file ? `${finding.file.split("/").pop()}${finding.line ? `:${finding.line}:${finding.column}` : ""}` : "";
  const words = make("small", [place, finding.severity, finding.code].filter(Boolean).join(" "));
  if (goes) item.append(words, make("button", finding.message, { type: "button", className: "place", onclick: () => host.goTo(finding) }));
  else item.append(words, finding.message);
  if (finding.hint) item.append(make("small", finding.hint));
  for (const note of finding.notes ?? []) item.append(make("small", `${note.line ? `${note.line}: ` : ""}${note.message}`));
  return item;
}

function showFindings(findings) {
  const said = findings.filter((finding) => finding.message !== undefined);
  const echo = findings.filter((finding) => finding.echo !== undefined).map((finding) => finding.echo);
  byId("findings").hidden = !said.length;
  byId("findings").querySelector("ol").replaceChildren(...said.map(findingItem));
  byId("echo").hidden = !echo.length;
  byId("echo").querySelector("pre").textContent = echo.map((line) => line.trimEnd()).join("\n");
}

function showFigures(scene) {
  const lines = [], size = view.size;
  if (size && !view.isEmpty) lines.push(size.map((v) => rounded(v, 6)).join(" x "));
  if (scene.mesh) {
    const within = scene.mesh.tolerance ? `, within ${rounded(scene.mesh.tolerance, 3)}` : "";
    lines.push(`${scene.mesh.triangles.toLocaleString("en")} triangles${scene.phase === "coarse" ? ", coarse" : within}`);
  }
  byId("figures").textContent = lines.join("\n");
}

// ---- parameters

const chosen = new Map(); // name -> value, where it is not the file's
let shownParameters = "";

// The same text is a literal of the scene language.
const literal = (value) => JSON.stringify(value);
const definitions = (values) => [...values].map(([name, value]) => `${name}=${literal(value)}`);
const send = () => host.setValues(chosen);

// What was chosen before, in an earlier visit or for another scene, is forgotten.
function chooseAll(values) {
  chosen.clear();
  for (const [name, value] of Object.entries(values)) chosen.set(name, value);
  shownParameters = "";
  send();
}

function choose(parameter, value) {
  chosen.set(parameter.name, value);
  byId("reset").hidden = false;
  send();
}

function numberInputs(parameter, value, changed) {
  const box = make("input", "", { type: "number", value, step: parameter.step ?? "any" }), row = [box];
  if (parameter.min !== undefined) box.min = parameter.min;
  if (parameter.max !== undefined) box.max = parameter.max;
  let slider = null;
  if (parameter.min !== undefined && parameter.max !== undefined) {
    const step = parameter.step ?? ((parameter.max - parameter.min) / 200 || "any");
    slider = make("input", "", { type: "range", min: parameter.min, max: parameter.max, step, value });
    slider.setAttribute("aria-label", parameter.name);
    slider.addEventListener("input", () => changed(Number((box.value = slider.value))));
    row.push(slider);
  }
  box.addEventListener("input", () => {
    if (box.value === "" || !Number.isFinite(box.valueAsNumber)) return;
    if (slider) slider.value = box.value;
    changed(box.valueAsNumber);
  });
  return row;
}

function inputsOf(parameter) {
  const value = chosen.get(parameter.name) ?? parameter.value ?? parameter.initial, changed = (v) => choose(parameter, v);
  if (parameter.options) {
    const select = make("select");
    parameter.options.forEach((option, i) => select.append(make("option", option.name, { value: i, selected: literal(option.value) === literal(value) })));
    select.addEventListener("change", () => changed(parameter.options[select.value].value));
    return [select];
  }
  if (typeof value === "boolean") {
    const box = make("input", "", { type: "checkbox", checked: value });
    box.addEventListener("change", () => changed(box.checked));
    return [box];
  }
  if (typeof value === "number") return numberInputs(parameter, value, changed);
  if (Array.isArray(value)) {
    const numbers = [...value], parts = make("span");
    numbers.forEach((number, i) => {
      const box = make("input", "", { type: "number", step: parameter.step ?? "any", value: number });
      box.setAttribute("aria-label", `${parameter.name}[${i}]`);
      box.addEventListener("input", () => {
        if (Number.isFinite(box.valueAsNumber)) changed((numbers[i] = box.valueAsNumber, [...numbers]));
      });
      parts.append(box);
    });
    return [parts];
  }
  const box = make("input", "", { type: "text", value });
  if (parameter.maxLength) box.maxLength = parameter.maxLength;
  box.addEventListener("input", () => changed(box.value));
  return [box];
}

function parameterRow(parameter) {
  const row = make("label", "", { className: "row" });
  row.append(make("span", parameter.name), ...inputsOf(parameter));
  if (parameter.caption) row.append(make("small", parameter.caption));
  return row;
}

// Inputs stay while somebody moves them: they are made anew when the file has others.
function showParameters(parameters) {
  const kept = literal((parameters ?? []).map(({ value, ...rest }) => ({ ...rest, line: 0 })));
  byId("parameters").hidden = !parameters?.length;
  byId("reset").hidden = !chosen.size;
  if (!parameters || kept === shownParameters) return;
  shownParameters = kept;
  const names = new Set(parameters.map((parameter) => parameter.name));
  for (const name of [...chosen.keys()]) if (!names.has(name)) chosen.delete(name), send();
  const groups = new Map();
  for (const parameter of parameters) groups.set(parameter.group, [...(groups.get(parameter.group) ?? []), parameter]);
  byId("parameters").querySelector("form").replaceChildren(...[...groups].map(([name, rows]) => {
    const set = make("fieldset");
    if (name && groups.size > 1) set.append(make("legend", name));
    set.append(...rows.map(parameterRow));
    return set;
  }));
}

// ---- files

let shownFormats = "", sceneName = "scene";

function optionGroup(label, names) {
  const group = make("optgroup", "", { label });
  group.append(...names.map((name) => make("option", name.toUpperCase(), { value: name })));
  return group;
}

function showFormats({ formats, drawings, scene }) {
  sceneName = scene.name.replace(/(?!^)\.[^.]*$/, "");
  byId("files").hidden = false;
  if (literal(formats) === shownFormats) return;
  shownFormats = literal(formats);
  byId("format").replaceChildren(optionGroup("Meshes", formats), ...(drawings.length ? [optionGroup("Drawings of flat scenes", drawings)] : []));
  byId("format").value = formats.includes("glb") ? "glb" : formats[0];
}

// As a file of the browser's downloads.
function save(blob, name) {
  const link = make("a", "", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

// The same bytes as csgmesh mesh writes; what stands in their way is said.
async function download(format) {
  const button = byId("files").querySelector("button");
  button.disabled = true;
  showStatus(`${format.toUpperCase()} is being written.`);
  try {
    save(await host.file(format), `${sceneName}.${format}`);
    showStatus("");
  } catch (error) {
    showStatus(`No file: ${String(error.message ?? error).trim()}`, true);
  } finally {
    button.disabled = false;
  }
}

byId("reset").addEventListener("click", () => chooseAll({}));
byId("files").querySelector("form").addEventListener("submit", (event) => {
  event.preventDefault();
  download(byId("format").value);
});

// ---- states

let isShown = false; // a model

function showModel(bytes) {
  view.show(bytes);
  isShown = true;
  byId("absent").hidden = Boolean(view.gl) && !view.isEmpty;
  byId("absent").textContent = view.gl ? "The scene is empty." : NO_MODELS;
  if (view.section) cut();
}

// state: of view_job.h. model: its bytes, where there is a new one.
function showState(state, model) {
  const { scene } = state;
  if (model) showModel(model);
  const failed = scene.phase === "failed";
  byId("stage").classList.toggle("stale", failed);
  if (failed) showStatus("There is an error: this is the model before it.", true);
  else if (scene.phase === "done") showStatus("");
  else showStatus(scene.phase === "coarse" ? "Coarse; the mesh is being made." : "Reading.");
  if (failed && !isShown) {
    showStatus("There is an error.", true);
    byId("absent").hidden = false;
    byId("absent").textContent = "Nothing to show yet.";
  }
  if (scene.phase !== "reading") {
    showFindings(state.findings);
    showFigures(scene);
    if (state.parameters || !failed) showParameters(state.parameters);
    showFormats(state);
  }
}
