// SPDX-License-Identifier: MIT
// The stage of a page: a SolidView, its tools, and the words over it.
const byId = (id) => document.getElementById(id);
const make = (name, text, members = {}) => Object.assign(document.createElement(name), { textContent: text ?? "" }, members);
const rounded = (v, digits = 5) => String(Number(v.toPrecision(digits)));

const NO_MODELS = "This browser shows no models (it lacks WebGL 2).";
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

listenToTools();
if (!view.gl) {
  byId("absent").hidden = false;
  byId("absent").textContent = NO_MODELS;
}
