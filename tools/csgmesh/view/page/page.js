// SPDX-License-Identifier: MIT
// The page of csgmesh view: asks for states one after the other, shows models, findings, parameters.
const byId = (id) => document.getElementById(id);
const make = (name, text, members = {}) => Object.assign(document.createElement(name), { textContent: text ?? "" }, members);
const rounded = (v, digits = 5) => String(Number(v.toPrecision(digits)));

// ---- the view

const view = new SolidView(byId("canvas"), placed);
const measured = []; // places of the scene: none, one or two

function placed(project, frame) {
  drawAxes(frame);
  const ends = measured.map((place) => project(place)), span = byId("span");
  ["from", "to"].forEach((id, i) => {
    const circle = byId(id);
    circle.style.visibility = ends[i] ? "visible" : "hidden";
    if (ends[i]) circle.setAttribute("cx", ends[i][0]), circle.setAttribute("cy", ends[i][1]);
  });
  span.style.visibility = ends[0] && ends[1] ? "visible" : "hidden";
  if (ends[0] && ends[1])
    for (const [key, value] of [["x1", ends[0][0]], ["y1", ends[0][1]], ["x2", ends[1][0]], ["y2", ends[1][1]]])
      span.setAttribute(key, value);
}

// Where x, y and z point to, in the upper left corner.
function drawAxes({ right, up }) {
  const group = byId("axes"), svg = "http://www.w3.org/2000/svg";
  if (!group.children.length)
    for (const [name, color] of [["x", "#d2373c"], ["y", "#2f9e44"], ["z", "#3b6fe0"]]) {
      const line = document.createElementNS(svg, "line"), text = document.createElementNS(svg, "text");
      line.setAttribute("stroke", color);
      text.textContent = name;
      group.append(line, text);
    }
  [0, 1, 2].forEach((k) => {
    const [line, text] = [group.children[2 * k], group.children[2 * k + 1]];
    const tip = [48 + 26 * right[k], 92 - 26 * up[k]], beyond = [44 + 36 * right[k], 97 - 36 * up[k]];
    for (const [key, value] of [["x1", 48], ["y1", 92], ["x2", tip[0]], ["y2", tip[1]]]) line.setAttribute(key, value);
    text.setAttribute("x", beyond[0]);
    text.setAttribute("y", beyond[1]);
  });
}

function showLength() {
  const output = byId("length"), [a, b] = measured;
  output.hidden = !byId("measure").checked;
  if (!a) output.textContent = "Choose two places.";
  else if (!b) output.textContent = `at ${a.map((v) => rounded(v)).join(", ")}`;
  else {
    const way = add(b, a, -1);
    output.textContent = `${rounded(norm(way))}\n${["x", "y", "z"].map((name, k) => `${name} ${rounded(way[k])}`).join("  ")}`;
  }
  view.draw();
}

function listenToTools() {
  const canvas = byId("canvas");
  let pressed = null;
  byId("fit").addEventListener("click", () => view.fit());
  byId("from-where").addEventListener("change", ({ target }) => {
    if (target.value) view.lookFrom(target.value);
    target.value = "";
  });
  byId("wire").addEventListener("change", ({ target }) => {
    view.edges = target.checked;
    view.draw();
  });
  byId("measure").addEventListener("change", ({ target }) => {
    measured.length = 0;
    canvas.classList.toggle("measuring", target.checked);
    showLength();
  });
  canvas.addEventListener("pointerdown", (event) => (pressed = [event.clientX, event.clientY]));
  canvas.addEventListener("pointerup", (event) => {
    const moved = pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]);
    if (!byId("measure").checked || !view.frame || !(moved < 4)) return;
    const place = view.placeAt(event.clientX, event.clientY);
    if (!place) return;
    if (measured.length === 2) measured.length = 0;
    measured.push(place);
    showLength();
  });
  byId("section").addEventListener("change", () => cut());
  byId("cut").addEventListener("input", () => cut());
  byId("flip").addEventListener("click", () => {
    byId("flip").dataset.flipped = byId("flip").dataset.flipped ? "" : "1";
    cut();
  });
}

function cut() {
  const axis = byId("section").value, share = byId("cut").value / 1000;
  byId("cutting").hidden = axis === "";
  view.section = axis === "" ? null : { axis: Number(axis), share, flipped: Boolean(byId("flip").dataset.flipped) };
  if (view.section && view.box) {
    const { low, high } = view.box;
    byId("cut-at").textContent = `${"xyz"[axis]} = ${rounded(low[axis] + share * (high[axis] - low[axis]), 4)}`;
  }
  view.draw();
}

// ---- what is said

function showStatus(text, isBad = false) {
  byId("status").textContent = text;
  byId("status").classList.toggle("bad", isBad);
}

function findingItem(finding) {
  const item = make("li", "", { className: finding.severity });
  const place = finding.file ? `${finding.file.split("/").pop()}${finding.line ? `:${finding.line}:${finding.column}` : ""}` : "";
  item.append(make("small", [place, finding.severity, finding.code].filter(Boolean).join(" ")), finding.message);
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
let shownParameters = "", sending = 0;

// The same text is a literal of the scene language.
const literal = (value) => JSON.stringify(value);

function send() {
  clearTimeout(sending);
  sending = setTimeout(() => {
    const lines = [...chosen].map(([name, value]) => `${name}=${literal(value)}`).join("\n");
    fetch("set", { method: "POST", body: lines }).catch(() => {});
  }, 40);
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
  byId("format").replaceChildren(optionGroup("Meshes", formats), optionGroup("Drawings of flat scenes", drawings));
  byId("format").value = formats.includes("glb") ? "glb" : formats[0];
}

// The same bytes as csgmesh mesh writes; what stands in their way is said.
async function download(format) {
  const button = byId("files").querySelector("button");
  button.disabled = true;
  showStatus(`${format.toUpperCase()} is being written.`);
  try {
    const response = await fetch(`file?format=${encodeURIComponent(format)}`);
    if (!response.ok) throw new Error(await response.text());
    const link = make("a", "", { href: URL.createObjectURL(await response.blob()), download: `${sceneName}.${format}` });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
    showStatus("");
  } catch (error) {
    showStatus(`No file: ${String(error.message ?? error).trim()}`, true);
  } finally {
    button.disabled = false;
  }
}

// ---- following

let shownModel = 0;

async function showModel(number) {
  const response = number && number !== shownModel ? await fetch(`model?number=${number}`) : null;
  if (!response?.ok) return;
  view.show(await response.arrayBuffer());
  shownModel = number;
  byId("absent").hidden = Boolean(view.gl) && !view.isEmpty;
  byId("absent").textContent = view.gl ? "The scene is empty." : "This browser shows no models (it lacks WebGL 2).";
  if (view.section) cut();
}

async function showState(state) {
  const { scene } = state;
  document.title = `${scene.name} - csgmesh view`;
  byId("name").textContent = scene.name;
  await showModel(scene.model);
  const failed = scene.phase === "failed";
  byId("stage").classList.toggle("stale", failed);
  if (failed) showStatus("There is an error: this is the model before it.", true);
  else if (scene.phase === "done") showStatus("");
  else showStatus(scene.phase === "coarse" ? "Coarse; the mesh is being made." : "Reading.");
  if (failed && !shownModel) {
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
  document.body.dataset.shown = `${scene.phase} ${state.version}`;
}

async function follow() {
  let version = 0;
  for (;;) {
    try {
      const response = await fetch(`state?after=${version}`);
      if (response.status === 204) continue;
      if (!response.ok) throw new Error(await response.text());
      const state = await response.json();
      version = state.version;
      await showState(state);
    } catch (error) {
      if (error instanceof TypeError) showStatus("csgmesh view has ended. Start it again and open its new address.", true);
      else showStatus(String(error.message ?? error), true);
      await new Promise((resolve) => setTimeout(resolve, 1000));
    }
  }
}

byId("reset").addEventListener("click", () => {
  chosen.clear();
  shownParameters = "";
  send();
});
byId("files").querySelector("form").addEventListener("submit", (event) => {
  event.preventDefault();
  download(byId("format").value);
});
listenToTools();
if (!view.gl) {
  byId("absent").hidden = false;
  byId("absent").textContent = "This browser shows no models (it lacks WebGL 2).";
}
follow();
