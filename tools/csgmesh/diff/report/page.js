// SPDX-License-Identifier: MIT
// The report around the models: the verdict, what changed in words, figures, worst places, the list of pairs.
const data = JSON.parse(document.getElementById("data").textContent);
const find = (id) => document.getElementById(id);
const show = (number, digits = 6) => number === null || number === undefined ? "–"
  : Number.isInteger(number) && Math.abs(number) < 1e15 ? number.toLocaleString("en-US").replace(/,/g, "\u202f")
    : String(Number(number.toPrecision(digits)));
const signed = (number, digits) => (number > 0 ? "+" : number < 0 ? "−" : "±") + show(Math.abs(number), digits);
const percent = (share) => `${signed(100 * share, 3)} %`;

function make(tag, options = {}, ...children) {
  const element = Object.assign(document.createElement(tag), options);
  element.append(...children);
  return element;
}

const nameOf = (pair) => (pair.file_b ?? pair.file_a).split("/").pop();
const shortName = (pair) => pair.file_a && pair.file_b ? `${pair.file_a} → ${pair.file_b}` : pair.file_a ?? pair.file_b;
const kindOf = (pair) => pair.verdict === "same" ? "same" : pair.verdict === "failed" ? "failed" : "different";
const sizeOf = (side) => side.bounds ? side.bounds[1].map((v, i) => v - side.bounds[0][i]) : null;

// ---- words

function addSizes(words, report) {
  const a = sizeOf(report.a), b = sizeOf(report.b);
  if (!a || !b) return;
  const least = Math.max(report.tolerance, 4 * report.precision, 1e-6 * norm(a));
  "xyz".split("").forEach((axis, i) => {
    const grown = b[i] - a[i];
    if (Math.abs(grown) > least)
      words.push(`${show(Math.abs(grown), 4)} ${grown > 0 ? "longer" : "shorter"} in ${axis} (${show(a[i], 5)} to ${show(b[i], 5)})`);
  });
}

function addVolumes(words, report) {
  const { a, b, volume } = report;
  if (!a.closed || !b.closed || !a.volume) return;
  const change = b.volume / a.volume - 1;
  if (Math.abs(change) > 1e-6) words.push(`Volume ${percent(change)} (${show(a.volume, 5)} to ${show(b.volume, 5)})`);
  if (!volume || !(volume.ratio > 1e-6)) return;
  const share = (part) => part > Math.max(2 * volume.accuracy, 1e-6 * a.volume)
    ? `${show(part, 3)} (${show((100 * part) / a.volume, 2)} %)` : "none";
  words.push(`Material added: ${share(volume.only_b)}; removed: ${share(volume.only_a)}`);
}

function addTopology(words, { a, b }) {
  const word = { components: "component", genus: "through hole", boundary_edges: "boundary edge", nonmanifold_edges: "non-manifold edge" };
  for (const key of Object.keys(word)) {
    if (a[key] === b[key] || a[key] === undefined || b[key] === undefined) continue;
    if (key === "genus" && !(a.closed && b.closed)) continue;
    words.push(`${show(a[key])} ${word[key]}${a[key] === 1 ? "" : "s"} became ${show(b[key])}`);
  }
}

function changesOf(pair) {
  const words = [], report = pair.report;
  if (!report?.a || report.level === "same triangles") return words;
  addSizes(words, report);
  addVolumes(words, report);
  addTopology(words, report);
  return words;
}

// ---- figures

function table(heads, rows) {
  const body = make("tbody");
  for (const { cells, changed } of rows)
    body.append(make("tr", { className: changed ? "changed" : "" },
      ...cells.map((cell, i) => make(i ? "td" : "th", i ? {} : { scope: "row" }, cell))));
  return make("table", {}, make("thead", {}, make("tr", {}, ...heads.map((head) => make("th", { scope: "col" }, head)))), body);
}

function figureRows(report) {
  const { a, b } = report, sizeA = sizeOf(a), sizeB = sizeOf(b);
  const row = (name, x, y, least = 1e-9) => {
    const known = typeof x === "number" && typeof y === "number", change = known ? y - x : 0;
    const tells = known && Math.abs(change) > least * Math.max(Math.abs(x), Math.abs(y));
    const share = tells && x && least > 0 ? percent(change / Math.abs(x)) : "";
    return { cells: [name, show(x), show(y), tells ? signed(change, 4) : "", share], changed: tells };
  };
  const rows = [row("Triangles", a.triangles, b.triangles), row("Vertices", a.vertices, b.vertices)];
  "xyz".split("").forEach((axis, i) => rows.push(row(`Size ${axis}`, sizeA?.[i], sizeB?.[i], 1e-6)));
  const names = {
    area: "Area", volume: "Volume", components: "Components", genus: "Genus (holes)",
    boundary_edges: "Boundary edges", nonmanifold_edges: "Non-manifold edges",
  };
  for (const [key, name] of Object.entries(names)) rows.push(row(name, a[key], b[key], key === "area" || key === "volume" ? 1e-9 : 0));
  return rows;
}

function distanceTable(report) {
  const there = report.a_to_b ?? {}, back = report.b_to_a ?? {};
  const far = (v) => v < report.precision ? "0" : show(v, 4); // less is rounding
  const most = (d) => d.max_lower === undefined ? "–"
    : d.max_upper - d.max_lower > 1e-3 * d.max_upper ? `${show(d.max_lower, 4)} to ${show(d.max_upper, 4)}` : show(d.max_upper, 5);
  const rows = [{ cells: ["Largest, proven", most(there), most(back)] }];
  for (const [key, name] of Object.entries({ mean: "Mean", rms: "RMS", p95: "95 % below", p99: "99 % below" }))
    rows.push({ cells: [name, far(there[key]), far(back[key])] });
  return table(["", "A to B", "B to A"], rows);
}

function volumeTable({ volume }) {
  if (!volume) return make("p", {}, "Volumes are not compared: a mesh is open.");
  return table(["", ""], [
    { cells: ["Only in A (removed)", show(volume.only_a, 5)] }, { cells: ["Only in B (added)", show(volume.only_b, 5)] },
    { cells: ["Share of the union", `${show(100 * volume.ratio, 4)} %`] },
    { cells: ["Accuracy", `± ${show(volume.accuracy, 2)}`] },
  ]);
}

function fillFigures(pair) {
  const box = find("figures"), report = pair.report;
  box.replaceChildren(make("h2", {}, "Figures"));
  if (!report?.a) return box.append(make("p", {}, report ? "The files are the same: nothing was measured." : "Nothing was measured."));
  box.append(table(["", "A", "B", "Change", ""], figureRows(report)), make("h2", {}, "Distances"), distanceTable(report),
    make("h2", {}, "Volumes"), volumeTable(report));
  const more = [];
  for (const [key, name] of [["a_to_field_of_b", "A from B's exact surface"], ["b_to_field_of_a", "B from A's exact surface"]])
    if (report[key]) more.push({ cells: [name, `${show(report[key].distance_lower, 4)} to ${show(report[key].distance_upper, 4)}`] });
  for (const [key, name, unit] of [["normals", "Normals differ by up to", "°"], ["colors", "Colours, up to (of 255)", ""]])
    if (report[key]) more.push({ cells: [name, show(report[key].largest, 4) + unit] });
  if (more.length) box.append(make("h2", {}, "Also"), table(["", ""], more));
}

// ---- worst places

function placesOf(pair) {
  const of = (key, side) => (pair.report?.[key]?.worst ?? []).map((place) => ({ ...place, side }));
  const all = [...of("a_to_b", "a"), ...of("b_to_a", "b")].sort((p, q) => q.distance - p.distance);
  const most = pair.models?.most ?? 0, kept = [];
  const span = pair.models ? norm(pair.models.box.slice(3).map((v, i) => v - pair.models.box[i])) : 0;
  // one place of a change, whose surroundings are as wide as it is far
  const apartFrom = (other) => Math.max(0.05 * span, Math.min(other.distance, 0.25 * span));
  for (const place of all)
    if (place.distance > 0.02 * most && most > 0 && kept.every((other) => norm(add(place.at, other.at, -1)) > apartFrom(other)))
      kept.push(place);
  return kept.slice(0, 8);
}

function colorOf(stops, share) {
  const place = 4 * Math.min(1, Math.max(0, share)), below = Math.min(3, Math.floor(place));
  return `rgb(${stops[below].map((v, i) => Math.round(v + (stops[below + 1][i] - v) * (place - below))).join()})`;
}

function fillWorst(pair, view) {
  const places = placesOf(pair), list = find("worst").querySelector("ol");
  find("worst").hidden = !places.length;
  list.replaceChildren();
  for (const place of places) {
    const dot = make("i");
    dot.style.background = colorOf(pair.models.stops, place.distance / pair.models.most);
    const button = make("button", { type: "button" }, dot, make("b", {}, show(place.distance, 4)),
      `at ${place.at.map((v) => show(v, 4)).join(", ")}`, make("small", {}, place.side === "a" ? "on A" : "on B"));
    button.setAttribute("aria-pressed", "false");
    button.addEventListener("click", () => {
      for (const other of list.querySelectorAll("button")) other.setAttribute("aria-pressed", String(other === button));
      view.flyTo(place);
      find("view").scrollIntoView({ block: "nearest" });
    });
    list.append(make("li", {}, button));
  }
}

// ---- the stage

function fillLegend(pair) {
  const { stops, most } = pair.models;
  find("bar").style.background = `linear-gradient(to right, ${stops.map((stop) => `rgb(${stop.join()})`).join()})`;
  find("ticks").replaceChildren(...[0, 1, 2, 3, 4].map((i) => make("span", {}, show((most * i) / 4, 3))));
}

function fillNote(pair) {
  const words = [];
  for (const side of ["a", "b"]) {
    const model = pair.models?.[side], whole = pair.report?.[side]?.triangles;
    if (model?.cell)
      words.push(`${side.toUpperCase()} is drawn with ${show(model.triangles)} of its ${show(whole)} triangles (details below ${show(model.cell, 3)} are joined)`);
  }
  find("note").hidden = !words.length;
  find("note").textContent = `${words.join("; ")}. All figures are of the whole meshes.`;
}

function absence(pair, view) {
  if (!view.gl) return "This browser draws no WebGL 2: the figures are here all the same.";
  if (pair.models) return "";
  if (pair.models === null) return "Not drawn: the page would be too large. Compare this pair alone.";
  if (pair.verdict === "same") return "Nothing to look at: both are the same.";
  return pair.verdict === "failed" ? "It could not be compared: see the messages of the run." : "There is nothing to compare it with.";
}

function mark(view, project) {
  const marks = find("marks"), place = view.place;
  const at = place && project(place.at), nearest = place && project(place.nearest);
  marks.style.visibility = at && nearest ? "visible" : "hidden";
  if (!at || !nearest) return;
  const set = (id, values) => Object.entries(values).forEach(([key, value]) => find(id).setAttribute(key, value.toFixed(1)));
  set("ring", { cx: at[0], cy: at[1] });
  set("dot", { cx: at[0], cy: at[1] });
  set("link", { x1: at[0], y1: at[1], x2: nearest[0], y2: nearest[1] });
}

// What stands on the canvas, where its panes are: beside each other, or on a narrow screen one above the other.
function placeParts(view) {
  const box = find("view"), isStacked = view.mode === "side" && view.panes()[1].y > 0;
  box.classList.toggle("side", view.mode === "side");
  box.classList.toggle("stacked", isStacked);
  find("cut").style.left = isStacked ? "" : `calc(${view.mode === "side" ? 50 : 100 * view.split}% - 1px)`;
}

function setMode(view, mode) {
  view.mode = mode;
  const radio = document.querySelector(`#modes input[value="${mode}"]`);
  radio.checked = true;
  const both = mode === "split" || mode === "side";
  find("cut").hidden = !both;
  find("left").hidden = !(mode === "a" || both);
  find("right").hidden = !(mode === "b" || both);
  find("legend").hidden = !(mode === "heat" || mode === "side") || !(view.models && view.heats);
  if (view.models && view.untouched) view.fit(false);
  else view.draw();
  placeParts(view);
}

function listen(view) {
  for (const radio of document.querySelectorAll("#modes input"))
    radio.addEventListener("change", () => setMode(view, radio.value));
  find("slider").addEventListener("input", () => {
    view.split = find("slider").value / 100;
    setMode(view, "split");
  });
  find("fit").addEventListener("click", () => {
    for (const button of document.querySelectorAll("#worst button")) button.setAttribute("aria-pressed", "false");
    view.fit();
  });
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const mode = { 1: "a", 2: "b", 3: "split", 4: "heat", 5: "side" }[event.key];
    if (mode) setMode(view, mode);
    const free = !event.target.closest("button, input, a");
    if (event.key !== " " || !free) return;
    event.preventDefault();
    setMode(view, view.mode === "a" ? "b" : "a");
  });
}

// ---- a pair

function showPair(pair, view) {
  const header = find("verdict"), words = changesOf(pair), gone = absence(pair, view);
  header.className = kindOf(pair);
  header.hidden = false;
  find("word").textContent = pair.verdict;
  find("names").textContent = shortName(pair);
  find("why").textContent = pair.why + (pair.updated ? "; A is now B" : "");
  find("changes").hidden = !words.length;
  find("changes").querySelector("ul").replaceChildren(...words.map((word) => make("li", {}, word)));
  fillFigures(pair);
  fillWorst(pair, view);
  fillNote(pair);
  find("absent").hidden = !gone;
  find("absent").textContent = gone;
  for (const id of ["canvas", "controls", "help"]) find(id).hidden = Boolean(gone);
  view.heats = Boolean(pair.models?.a.heat && pair.models.b.heat && pair.models.most > 0);
  if (pair.models && view.gl) {
    view.load(pair.models);
    fillLegend(pair);
  } else {
    view.models = null;
    find("marks").style.visibility = "hidden";
  }
  find("modes").lastElementChild.hidden = !view.heats;
  const areTwo = pair.models?.a.triangles && pair.models.b.triangles && pair.verdict !== "same";
  setMode(view, areTwo ? "side" : view.heats ? "heat" : "b");
  for (const id of ["left", "right", "cut"]) if (gone) find(id).hidden = true;
}

// What differs first; what is the same folded away, unless there is nothing else.
function listPairs(view) {
  const list = find("pairs"), folded = make("details");
  const isSame = (pair) => kindOf(pair) === "same", others = data.pairs.filter((pair) => !isSame(pair));
  const same = data.pairs.filter(isSame);
  list.hidden = data.pairs.length < 2;
  document.querySelector("main").classList.toggle("many", data.pairs.length > 1);
  const buttonOf = (pair) => {
    const button = make("button", { type: "button", className: kindOf(pair) }, nameOf(pair),
      make("small", {}, isSame(pair) ? "same" : `${pair.verdict}: ${pair.why}`));
    button.addEventListener("click", () => {
      for (const other of list.querySelectorAll("button")) other.setAttribute("aria-current", String(other === button));
      showPair(pair, view);
    });
    return button;
  };
  list.append(...others.map(buttonOf));
  if (same.length) {
    folded.open = !others.length;
    folded.append(make("summary", {}, `${same.length} same`), ...same.map(buttonOf));
    list.append(folded);
  }
  list.querySelector("button")?.click();
}

function start() {
  const view = new View(find("canvas"), (project) => mark(view, project));
  window.report = { data, view };
  document.querySelector("main").hidden = false;
  const same = data.pairs.filter((pair) => pair.verdict === "same").length;
  find("foot").textContent = `csgmesh ${data.csgmesh}` + (data.folders ? `: ${same} of ${data.pairs.length} same` : "");
  listen(view);
  new ResizeObserver(() => placeParts(view)).observe(find("view"));
  listPairs(view);
}
start();
