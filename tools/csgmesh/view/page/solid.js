// SPDX-License-Identifier: MIT
// A solid on the canvas of a View, with what the scene marks (# and %), its edges, a section and places
// to measure between.
const SOLID_VERTEX = `#version 300 es
in vec3 position, normal; in vec4 color;
uniform mat4 matrix; uniform float pull;
out vec3 at, facing; out vec4 own;
void main() {
  at = position; facing = normal; own = color;
  gl_Position = matrix * vec4(position, 1.0);
  gl_Position.z -= pull * gl_Position.w; // edges lie before their triangles
}`;
// Inner sides are seen through a section only: they are drawn as its cut face, hatched, without edges.
const SOLID_FRAGMENT = `#version 300 es
precision highp float;
in vec3 at, facing; in vec4 own;
uniform vec3 eye, right, up; uniform vec4 section, tint; uniform int paint;
out vec4 pixel;
void main() {
  bool cuts = section.w < 1e30;
  if (dot(section.xyz, at) > section.w || (paint == 2 && cuts && dot(facing, eye - at) < 0.0)) discard;
  vec3 light = normalize(normalize(eye - at) - 0.55 * right + 0.8 * up);
  float bright = 0.5 + 0.55 * max(dot(normalize(facing), light), 0.0);
  float line = mod(gl_FragCoord.x + gl_FragCoord.y, 12.0) < 2.0 ? 0.82 : 1.0;
  if (paint == 2) pixel = tint;
  else if (gl_FrontFacing) pixel = vec4((paint == 1 ? own.rgb : tint.rgb) * bright, tint.a);
  else if (cuts) pixel = vec4(vec3(0.93, 0.66, 0.36) * line, 1.0);
  else pixel = vec4(0.75, 0.2, 0.45, 1.0);
}`;
const NO_SECTION = [0, 0, 0, 3e38];
const TINTS = { solid: [0.51, 0.65, 0.85, 1], highlight: [1, 0.32, 0.32, 0.5], background: [0.65, 0.65, 0.65, 0.5] };
const VIEWS = { corner: [35, 25], front: [-90, 0], right: [0, 0], back: [90, 0], left: [180, 0], top: [-90, 90], bottom: [-90, -90] };
const RADIANS = Math.PI / 180;

class SolidView extends View {
  constructor(canvas, changed) {
    super(canvas, changed);
    this.edges = false;
    this.section = null; // {axis, share, flipped}
    this.toward = [0.742, 0.520, 0.423];
  }

  build() {
    this.gl.blendFunc(this.gl.SRC_ALPHA, this.gl.ONE_MINUS_SRC_ALPHA);
    return this.link(SOLID_VERTEX, SOLID_FRAGMENT, ["position", "normal", "color"],
      ["matrix", "eye", "right", "up", "section", "tint", "paint", "pull"]);
  }

  // ---- models

  // bytes: of view_model.h. The camera stays where it is, but for the first model.
  show(bytes) {
    const length = new DataView(bytes).getUint32(0, true), start = 4 + length;
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
    const array = (layer, kind, key, count) =>
      layer[key] === undefined ? null : new kind(bytes, start + layer[key], count);
    for (const layer of this.layers ?? []) this.forget(layer);
    this.layers = header.layers.map((layer) => ({
      ...layer, buffers: [],
      positions: array(layer, Float32Array, "positions", 3 * layer.vertices),
      normals: array(layer, Float32Array, "normals", 3 * layer.vertices),
      colors: array(layer, Uint8Array, "colors", 4 * layer.vertices),
      indices: array(layer, Uint32Array, "indices", 3 * layer.triangles),
    }));
    this.frameAll();
    for (const layer of this.layers) this.upload(layer);
    this.models = this.layers;
    if (this.camera) return this.draw();
    this.fit(false);
  }

  // The box of the solid, or of what is marked where there is none; the middle stays with the first model's.
  frameAll() {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    const seen = this.layers.filter((layer) => layer.triangles);
    for (const layer of seen.some((layer) => layer.kind === "solid") ? seen.filter((layer) => layer.kind === "solid") : seen)
      for (let i = 0; i < layer.positions.length; i++) {
        const k = i % 3, v = layer.positions[i] + layer.origin[k];
        if (v < low[k]) low[k] = v;
        if (v > high[k]) high[k] = v;
      }
    this.isEmpty = !seen.length;
    if (this.isEmpty) low.fill(-1), high.fill(1);
    const middle = low.map((v, i) => (v + high[i]) / 2);
    const moved = this.middle ? add(this.middle, middle, -1) : [0, 0, 0];
    if (this.camera) this.camera.target = add(this.camera.target, moved);
    this.box = { low, high };
    this.middle = middle;
    this.size = high.map((v, i) => v - low[i]);
    this.radius = norm(this.size) / 2 || 1;
  }

  // Places relative to the middle, so that floats are fine there.
  upload(layer) {
    const off = add(layer.origin, this.middle, -1), local = new Float32Array(layer.positions.length);
    for (let i = 0; i < local.length; i++) local[i] = layer.positions[i] + off[i % 3];
    layer.local = local;
    layer.lines = null;
    if (!this.gl) return;
    const gl = this.gl;
    layer.array = gl.createVertexArray();
    gl.bindVertexArray(layer.array);
    this.stream(layer, 0, local, 3, gl.FLOAT, false);
    layer.facing = layer.normals ?? this.normalsOf(layer);
    this.stream(layer, 1, layer.facing, 3, gl.FLOAT, false);
    if (layer.colors) this.stream(layer, 2, layer.colors, 4, gl.UNSIGNED_BYTE, true);
    this.buffer(layer, gl.ELEMENT_ARRAY_BUFFER, layer.indices);
    gl.bindVertexArray(null);
  }

  stream(layer, place, data, count, type, normalized) {
    this.buffer(layer, this.gl.ARRAY_BUFFER, data);
    this.gl.enableVertexAttribArray(place);
    this.gl.vertexAttribPointer(place, count, type, normalized, 0, 0);
  }

  normalsOf(layer) {
    const normals = new Float32Array(layer.local.length), p = (i) => [...layer.local.subarray(3 * i, 3 * i + 3)];
    for (let t = 0; t < layer.indices.length; t += 3) {
      const [a, b, c] = layer.indices.subarray(t, t + 3);
      const n = cross(add(p(b), p(a), -1), add(p(c), p(a), -1));
      for (const v of [a, b, c]) for (let k = 0; k < 3; k++) normals[3 * v + k] += n[k];
    }
    return normals;
  }

  // Each edge once, of two vertex numbers.
  uploadLines(layer) {
    const gl = this.gl, seen = new Set(), lines = [];
    for (let t = 0; t < layer.indices.length; t += 3)
      for (let k = 0; k < 3; k++) {
        const a = layer.indices[t + k], b = layer.indices[t + ((k + 1) % 3)];
        const key = a < b ? a * layer.vertices + b : b * layer.vertices + a;
        if (seen.has(key)) continue;
        seen.add(key);
        lines.push(a, b);
      }
    layer.lineCount = lines.length;
    layer.lines = gl.createVertexArray();
    gl.bindVertexArray(layer.lines);
    this.stream(layer, 0, layer.local, 3, gl.FLOAT, false);
    this.stream(layer, 1, layer.facing, 3, gl.FLOAT, false);
    this.buffer(layer, gl.ELEMENT_ARRAY_BUFFER, Uint32Array.from(lines));
    gl.bindVertexArray(null);
  }

  forget(layer) {
    super.forget(layer);
    if (layer.lines) this.gl.deleteVertexArray(layer.lines);
  }

  // ---- drawing

  // Half a space in coordinates of the canvas: what lies beyond is not drawn.
  plane() {
    if (!this.section) return NO_SECTION;
    const { axis, share, flipped } = this.section, sign = flipped ? -1 : 1, plane = [0, 0, 0, 0];
    plane[axis] = sign;
    plane[3] = sign * (share - 0.5) * this.size[axis];
    return plane;
  }

  draw() {
    if (!this.gl || !this.layers || !this.camera) return;
    const { frame } = this.begin();
    this.frame = frame;
    for (const layer of this.layers) if (layer.kind === "solid") this.drawLayer(layer);
    for (const layer of this.layers) if (layer.kind !== "solid") this.drawLayer(layer);
    this.changed(this.project.bind(this, frame.rows), frame);
  }

  drawLayer(layer) {
    const gl = this.gl, places = this.places, tint = TINTS[layer.kind], clear = tint[3] < 1;
    if (!layer.triangles) return;
    gl.uniform4fv(places.section, layer.kind === "solid" ? this.plane() : NO_SECTION);
    gl.uniform4fv(places.tint, tint);
    gl.uniform1i(places.paint, layer.colors && !clear ? 1 : 0);
    for (const [feature, on] of [[gl.BLEND, clear], [gl.CULL_FACE, clear]])
      if (on) gl.enable(feature);
      else gl.disable(feature);
    gl.depthMask(!clear);
    gl.uniform1f(places.pull, 0);
    gl.bindVertexArray(layer.array);
    gl.drawElements(gl.TRIANGLES, 3 * layer.triangles, gl.UNSIGNED_INT, 0);
    gl.depthMask(true);
    if (!this.edges || clear) return;
    if (!layer.lines) this.uploadLines(layer);
    gl.uniform1i(places.paint, 2);
    gl.uniform1f(places.pull, 0.002);
    gl.uniform4fv(places.tint, [0.1, 0.13, 0.2, 0.55]);
    gl.enable(gl.BLEND);
    gl.bindVertexArray(layer.lines);
    gl.drawElements(gl.LINES, layer.lineCount, gl.UNSIGNED_INT, 0);
  }

  lookFrom(name) {
    const [azimuth, elevation] = VIEWS[name].map((v) => v * RADIANS), limit = Math.PI / 2 - 0.01;
    this.toward = [Math.cos(elevation) * Math.cos(azimuth), Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation)];
    this.fly({
      target: [0, 0, 0], distance: this.fitDistance(), azimuth,
      elevation: Math.min(limit, Math.max(-limit, elevation)),
    });
  }

  // ---- places

  // The place of the solid under a pixel of the page, of a vertex where one is within a few pixels; null: none.
  placeAt(x, y) {
    const { rows, eye } = this.frame, rect = this.canvas.getBoundingClientRect();
    const left = (2 * (x - rect.left)) / rect.width - 1, below = 1 - (2 * (y - rect.top)) / rect.height;
    const { back, right, up } = this.axes(this.camera.azimuth, this.camera.elevation), reach = Math.tan(HALF_ANGLE);
    const ray = add(add(back.map((v) => -v), right, (left * reach * rect.width) / rect.height), up, below * reach);
    const hit = this.nearestHit(eye, ray);
    if (!hit) return null;
    const scene = (p) => add(p, this.middle);
    let best = scene(hit.at), near = 10;
    for (const corner of hit.corners) {
      const at = this.project(rows, scene(corner));
      const away = at ? Math.hypot(at[0] - (x - rect.left), at[1] - (y - rect.top)) : Infinity;
      if (away < near && dot(this.plane().slice(0, 3), corner) <= this.plane()[3]) [near, best] = [away, scene(corner)];
    }
    return best;
  }

  // Moeller and Trumbore 1997, over all triangles of the solid. What is seen from within through a section lies in
  // its plane.
  nearestHit(eye, ray) {
    const plane = this.plane(), normal = plane.slice(0, 3);
    let least = Infinity, found = null;
    for (const { local, indices } of this.layers.filter((layer) => layer.kind === "solid"))
      for (let t = 0; t < indices.length; t += 3) {
        const a = 3 * indices[t], b = 3 * indices[t + 1], c = 3 * indices[t + 2];
        const ax = local[a], ay = local[a + 1], az = local[a + 2];
        const e = [local[b] - ax, local[b + 1] - ay, local[b + 2] - az];
        const f = [local[c] - ax, local[c + 1] - ay, local[c + 2] - az];
        const h = cross(ray, f), det = dot(e, h);
        if (Math.abs(det) < 1e-30) continue;
        const s = [eye[0] - ax, eye[1] - ay, eye[2] - az], u = dot(s, h) / det;
        if (u < 0 || u > 1) continue;
        const q = cross(s, e), v = dot(ray, q) / det, along = dot(f, q) / det;
        if (v < 0 || u + v > 1 || !(along > 0) || along >= least) continue;
        const at = add(eye, ray, along);
        if (dot(normal, at) > plane[3]) continue;
        least = along;
        const inPlane = (plane[3] - dot(normal, eye)) / dot(normal, ray);
        found = det > 0 || !this.section
          ? { at, corners: [a, b, c].map((i) => [local[i], local[i + 1], local[i + 2]]) }
          : { at: add(eye, ray, inPlane), corners: [] };
      }
    return found;
  }
}
