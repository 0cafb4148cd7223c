// SPDX-License-Identifier: MIT
// The models of one comparison on a canvas (WebGL 2): A, B, side by side, A beside B at a line, or the heat map; a camera
// that turns, moves, zooms and flies. Triangles are shaded by their own normals, so every facet shows.
const VERTEX = `#version 300 es
in vec3 position; in float heat; in vec3 color;
uniform mat4 matrix; uniform vec3 scale, corner;
out vec3 at; out float hot; out vec3 own;
void main() {
  at = corner + position * scale;
  hot = heat; own = color;
  gl_Position = matrix * vec4(at, 1.0);
}`;
const FRAGMENT = `#version 300 es
precision highp float;
in vec3 at; in float hot; in vec3 own;
uniform vec3 stops[5], plain, eye, right, up; uniform int paint;
out vec4 pixel;
vec3 ramp(float t) {
  float place = 4.0 * clamp(t, 0.0, 1.0);
  int below = min(int(place), 3);
  return mix(stops[below], stops[below + 1], place - float(below));
}
void main() {
  vec3 toEye = normalize(eye - at), normal = normalize(cross(dFdx(at), dFdy(at)));
  if (dot(normal, toEye) < 0.0) normal = -normal;
  vec3 light = normalize(toEye - 0.55 * right + 0.8 * up);
  float lit = 0.42 + 0.62 * max(dot(normal, light), 0.0);
  int kind = paint & 3;
  if (kind == 2) lit = 0.35 + 0.65 * lit;
  vec3 base = kind == 0 ? plain : kind == 1 ? own : ramp(hot);
  if (paint > 3) base = mix(base, ramp(hot), smoothstep(0.03, 0.07, hot));
  if (!gl_FrontFacing) base = mix(base, vec3(0.75, 0.2, 0.45), 0.6);
  pixel = vec4(base * lit, 1.0);
}`;
const PLAIN = { a: [0.51, 0.65, 0.85], b: [0.92, 0.70, 0.38] };
const HALF_ANGLE = Math.PI / 12;

const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = (a) => Math.hypot(...a);
const bytesOf = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;

class View {
  constructor(canvas, changed) {
    this.canvas = canvas;
    this.changed = changed;
    this.mode = "heat";
    this.split = 0.5;
    this.gl = canvas.getContext("webgl2", { antialias: true, alpha: false });
    if (!this.gl) return;
    this.program = this.build();
    new ResizeObserver(() => (this.untouched && this.models ? this.fit(false) : this.draw())).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
    this.listen();
  }

  build() {
    this.gl.enable(this.gl.SCISSOR_TEST);
    return this.link(VERTEX, FRAGMENT, ["position", "heat", "color"],
      ["matrix", "scale", "corner", "stops", "plain", "eye", "right", "up", "paint"]);
  }

  // A program of two shaders, in use from here on; the places of its uniforms are this.places.
  link(vertex, fragment, attributes, uniforms) {
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    attributes.forEach((name, i) => gl.bindAttribLocation(program, i, name));
    gl.linkProgram(program);
    gl.useProgram(program);
    gl.enable(gl.DEPTH_TEST);
    this.places = Object.fromEntries(uniforms.map((name) => [name, gl.getUniformLocation(program, name)]));
    return program;
  }

  // ---- models

  load(models) {
    const low = models.box.slice(0, 3), high = models.box.slice(3);
    for (const model of Object.values(this.models ?? {})) this.forget(model);
    this.middle = low.map((v, i) => (v + high[i]) / 2);
    this.size = high.map((v, i) => v - low[i]);
    this.radius = norm(this.size) / 2 || 1;
    this.stops = models.stops.flat().map((v) => v / 255);
    this.toward = models.toward;
    this.models = { a: this.upload(models.a, models.most > 0), b: this.upload(models.b) };
    this.place = null;
    this.fit(false);
  }

  upload(data, marksMoved) {
    const model = { triangles: data.triangles, moved: 0, buffers: [], painted: Boolean(data.colors) };
    model.positions = new Uint16Array(bytesOf(data.positions));
    model.indices = new Uint32Array(bytesOf(data.indices));
    if (!this.gl) return model;
    const gl = this.gl;
    model.array = gl.createVertexArray();
    gl.bindVertexArray(model.array);
    this.attribute(model, 0, model.positions, 3, gl.UNSIGNED_SHORT);
    const heat = data.heat && new Uint16Array(bytesOf(data.heat));
    if (heat) this.attribute(model, 1, heat, 1, gl.UNSIGNED_SHORT);
    if (data.colors) this.attribute(model, 2, new Uint8Array(bytesOf(data.colors)), 3, gl.UNSIGNED_BYTE);
    const order = marksMoved && heat ? this.sortMoved(model, heat) : model.indices;
    this.buffer(model, gl.ELEMENT_ARRAY_BUFFER, order);
    gl.bindVertexArray(null);
    return model;
  }

  // Triangles that are far from the other mesh first: the heat map draws them of A too.
  sortMoved(model, heat) {
    const moved = [], rest = [], index = model.indices, limit = 0.05 * 65535;
    for (let t = 0; t < index.length; t += 3) {
      const hottest = Math.max(heat[index[t]], heat[index[t + 1]], heat[index[t + 2]]);
      (hottest > limit ? moved : rest).push(index[t], index[t + 1], index[t + 2]);
    }
    model.moved = moved.length / 3;
    return Uint32Array.from(moved.concat(rest));
  }

  buffer(model, kind, data) {
    const buffer = this.gl.createBuffer();
    this.gl.bindBuffer(kind, buffer);
    this.gl.bufferData(kind, data, this.gl.STATIC_DRAW);
    model.buffers.push(buffer);
  }

  attribute(model, place, data, count, type) {
    const gl = this.gl, padded = count === 3;
    // three small components would not lie on four bytes: a fourth is put in
    let bytes = data;
    if (padded) {
      bytes = new data.constructor((data.length / 3) * 4);
      for (let i = 0, j = 0; i < data.length; i += 3, j += 4) bytes.set(data.subarray(i, i + 3), j);
    }
    this.buffer(model, gl.ARRAY_BUFFER, bytes);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, count, type, true, padded ? 4 * data.BYTES_PER_ELEMENT : 0, 0);
  }

  forget(model) {
    for (const buffer of model.buffers) this.gl.deleteBuffer(buffer);
    if (model.array) this.gl.deleteVertexArray(model.array);
  }

  // ---- camera: target and distance relative to the middle, azimuth and elevation in radians

  fit(flies = true) {
    const camera = {
      target: [0, 0, 0], distance: this.fitDistance(),
      azimuth: Math.atan2(this.toward[1], this.toward[0]), elevation: Math.asin(this.toward[2]),
    };
    this.place = null;
    this.untouched = true;
    if (flies) return this.fly(camera);
    this.camera = camera;
    this.draw();
  }

  // What the canvas is divided into, in CSS pixels: two panes along its longer side where both models stand side by side.
  panes() {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    if (this.mode !== "side") return [{ x: 0, y: 0, width, height }];
    return width >= height
      ? [{ side: "a", x: 0, y: 0, width: width / 2, height }, { side: "b", x: width / 2, y: 0, width: width / 2, height }]
      : [{ side: "a", x: 0, y: 0, width, height: height / 2 }, { side: "b", x: 0, y: height / 2, width, height: height / 2 }];
  }

  aspect() {
    const pane = this.panes()[0];
    return pane.width / Math.max(1, pane.height) || 1;
  }

  fitDistance() {
    const { right, up } = this.axes(Math.atan2(this.toward[1], this.toward[0]), Math.asin(this.toward[2]));
    const aspect = this.aspect();
    let distance = 0;
    for (let i = 0; i < 8; i++) {
      const corner = this.size.map((v, k) => (i >> k & 1 ? v : -v) / 2);
      const reach = Math.max(Math.abs(dot(corner, right)) / aspect, Math.abs(dot(corner, up)));
      distance = Math.max(distance, dot(corner, this.toward) + reach / Math.tan(HALF_ANGLE));
    }
    return (distance || 1) * 1.12;
  }

  axes(azimuth, elevation) {
    const level = Math.cos(elevation);
    const back = [level * Math.cos(azimuth), level * Math.sin(azimuth), Math.sin(elevation)];
    const right = [-Math.sin(azimuth), Math.cos(azimuth), 0];
    return { back, right, up: cross(back, right) };
  }

  turn(dx, dy) {
    const limit = Math.PI / 2 - 0.01;
    this.untouched = false;
    this.camera.azimuth -= dx * 0.008;
    this.camera.elevation = Math.min(limit, Math.max(-limit, this.camera.elevation + dy * 0.008));
    this.draw();
  }

  zoom(factor) {
    const distance = this.camera.distance * factor;
    this.untouched = false;
    this.camera.distance = Math.min(40 * this.radius, Math.max(0.004 * this.radius, distance));
    this.draw();
  }

  move(dx, dy) {
    const { right, up } = this.axes(this.camera.azimuth, this.camera.elevation);
    const step = (2 * this.camera.distance * Math.tan(HALF_ANGLE)) / this.panes()[0].height;
    this.untouched = false;
    this.camera.target = add(add(this.camera.target, right, -dx * step), up, dy * step);
    this.draw();
  }

  fly(to) {
    const from = structuredClone(this.camera), start = performance.now();
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    let swing = (to.azimuth - from.azimuth) % (2 * Math.PI);
    if (Math.abs(swing) > Math.PI) swing -= 2 * Math.PI * Math.sign(swing);
    cancelAnimationFrame(this.flight);
    const step = (now) => {
      const raw = still ? 1 : Math.min(1, Math.max(0, (now - start) / 500)), share = raw * raw * (3 - 2 * raw);
      const mix = (a, b) => a + (b - a) * share;
      this.camera = {
        target: from.target.map((v, i) => mix(v, to.target[i])),
        distance: from.distance * (to.distance / from.distance) ** share,
        azimuth: from.azimuth + swing * share, elevation: mix(from.elevation, to.elevation),
      };
      this.draw();
      this.flight = raw < 1 ? requestAnimationFrame(step) : 0;
    };
    this.flight = requestAnimationFrame(step);
  }

  // place: {side, at, nearest, distance}; the camera comes from where the surface looks to.
  flyTo(place) {
    const at = add(place.at, this.middle, -1), out = this.outward(place.side, at);
    this.place = place;
    this.untouched = false;
    this.fly({
      target: at, distance: Math.min(this.fitDistance(), Math.max(7 * place.distance, 1.1 * this.radius)),
      azimuth: Math.atan2(out[1], out[0]), elevation: Math.min(1.2, Math.max(-1.2, Math.asin(out[2]))),
    });
  }

  // The mean normal near a point, turned a little toward where the camera is.
  outward(side, at) {
    const { positions, indices } = this.models[side], reach = 0.05 * this.radius;
    const corner = (i) => this.size.map((v, k) => (positions[3 * i + k] / 65535 - 0.5) * v);
    let sum = [0, 0, 0];
    for (let t = 0; t < indices.length; t += 3) {
      const p = corner(indices[t]);
      if (Math.abs(p[0] - at[0]) > reach || Math.abs(p[1] - at[1]) > reach || Math.abs(p[2] - at[2]) > reach) continue;
      const q = corner(indices[t + 1]), r = corner(indices[t + 2]);
      sum = add(sum, cross(add(q, p, -1), add(r, p, -1)));
    }
    const { back } = this.axes(this.camera.azimuth, this.camera.elevation);
    const length = norm(sum), away = length > 0 ? sum.map((v) => v / length) : back;
    const mixed = add(away, back, 0.45), whole = norm(mixed);
    return whole > 0.1 ? mixed.map((v) => v / whole) : back;
  }

  // ---- drawing

  matrix(aspect) {
    const { azimuth, elevation, target, distance } = this.camera;
    const { back, right, up } = this.axes(azimuth, elevation), eye = add(target, back, distance);
    const near = Math.max(distance / 100, norm(eye) - 1.05 * this.radius), far = norm(eye) + 1.1 * this.radius;
    const f = 1 / Math.tan(HALF_ANGLE), depth = (near + far) / (near - far), shift = (2 * near * far) / (near - far);
    const rows = [
      [...right.map((v) => (v * f) / aspect), (-dot(right, eye) * f) / aspect],
      [...up.map((v) => v * f), -dot(up, eye) * f],
      [...back.map((v) => v * depth), -dot(back, eye) * depth + shift],
      [...back.map((v) => -v), dot(back, eye)],
    ];
    return { rows, eye, right, up };
  }

  // Clears the canvas in its size on the screen and sets the camera; gives the size and the camera's frame.
  begin() {
    const gl = this.gl, canvas = this.canvas, places = this.places;
    const ratio = Math.min(2, devicePixelRatio || 1);
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const background = getComputedStyle(canvas.parentElement).backgroundColor.match(/[\d.]+/g).map((v) => v / 255);
    gl.viewport(0, 0, width, height);
    gl.scissor(0, 0, width, height);
    gl.clearColor(background[0], background[1], background[2], 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const frame = this.matrix(this.aspect());
    gl.uniformMatrix4fv(places.matrix, true, frame.rows.flat());
    for (const name of ["eye", "right", "up"]) gl.uniform3fv(places[name], frame[name]);
    return { width, height, frame };
  }

  draw() {
    const gl = this.gl;
    if (!gl || !this.models) return;
    const { width, height, frame } = this.begin(), places = this.places, ratio = width / this.canvas.clientWidth;
    gl.uniform3fv(places.scale, this.size);
    gl.uniform3fv(places.corner, this.size.map((v) => -v / 2));
    gl.uniform3fv(places.stops, this.stops);
    const cut = Math.round(this.split * width);
    if (this.mode === "side") {
      for (const pane of this.panes()) {
        const low = this.canvas.clientHeight - pane.y - pane.height;
        const box = [pane.x, low, pane.width, pane.height].map((v) => Math.round(v * ratio));
        gl.viewport(...box);
        gl.scissor(...box);
        this.drawModel(pane.side, (this.models[pane.side].painted ? 1 : 0) + (this.heats ? 4 : 0));
      }
    } else if (this.mode === "split") {
      gl.scissor(0, 0, cut, height);
      this.drawModel("a");
      gl.scissor(cut, 0, width - cut, height);
      this.drawModel("b");
    } else if (this.mode === "heat") {
      this.drawModel("b", 2);
      this.drawModel("a", 2, this.models.a.moved);
    } else {
      this.drawModel(this.mode);
    }
    this.changed((point) => this.project(frame.rows, point, this.place?.side));
  }

  drawModel(side, paint, triangles) {
    const model = this.models[side], gl = this.gl;
    gl.bindVertexArray(model.array);
    gl.uniform1i(this.places.paint, paint ?? (model.painted ? 1 : 0));
    gl.uniform3fv(this.places.plain, PLAIN[side]);
    gl.drawElements(gl.TRIANGLES, 3 * (triangles ?? model.triangles), gl.UNSIGNED_INT, 0);
  }

  // A point of the scene in CSS pixels of the canvas, in the pane of its side; null behind the camera.
  project(rows, point, side) {
    const panes = this.panes(), pane = panes.find((one) => one.side === side) ?? panes[0];
    const p = [...add(point, this.middle, -1), 1];
    const [x, y, , w] = rows.map((row) => row.reduce((sum, v, i) => sum + v * p[i], 0));
    if (!(w > 0)) return null;
    return [pane.x + ((x / w + 1) / 2) * pane.width, pane.y + ((1 - y / w) / 2) * pane.height];
  }

  // ---- hands

  listen() {
    const canvas = this.canvas, fingers = new Map();
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, event);
      cancelAnimationFrame(this.flight);
      this.flight = 0;
    });
    for (const name of ["pointerup", "pointercancel"])
      canvas.addEventListener(name, (event) => fingers.delete(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      const before = fingers.get(event.pointerId);
      if (!before || !this.models) return;
      const dx = event.clientX - before.clientX, dy = event.clientY - before.clientY;
      const other = [...fingers.values()].find((finger) => finger.pointerId !== event.pointerId);
      if (other) {
        const span = (e) => Math.max(1, Math.hypot(e.clientX - other.clientX, e.clientY - other.clientY));
        this.zoom(span(before) / span(event));
        this.move(dx / 2, dy / 2);
      } else if (event.buttons & 6 || event.shiftKey) this.move(dx, dy);
      else this.turn(dx, dy);
      fingers.set(event.pointerId, event);
    });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      if (this.models) this.zoom(Math.exp(Math.sign(event.deltaY) * Math.min(0.3, Math.abs(event.deltaY) * 0.0015)));
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  key(event) {
    const moves = {
      ArrowLeft: () => this.turn(-24, 0), ArrowRight: () => this.turn(24, 0),
      ArrowUp: () => this.turn(0, -24), ArrowDown: () => this.turn(0, 24),
      "+": () => this.zoom(0.85), "=": () => this.zoom(0.85), "-": () => this.zoom(1 / 0.85), Home: () => this.fit(),
    };
    if (!moves[event.key] || !this.models) return;
    event.preventDefault();
    moves[event.key]();
  }
}
