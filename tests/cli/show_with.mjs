// SPDX-License-Identifier: MIT
// Draws GLB files with three.js or Babylon.js in headless Chromium, each to FILE.LIBRARY.ppm: in the light of an even white sky and of a lamp at the upper left of the camera, as csgmesh's is.
//
//   CSGMESH_VIEW=tools/view node tests/cli/show_with.mjs three|babylon NODE_MODULES WIDTHxHEIGHT CAMERA FILE...
//
// CAMERA: JSON of eye, target and up in metres, Y up, and fov in degrees, from top to bottom.
import { createReadStream, existsSync, statSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { basename, extname, join, resolve } from "node:path";
import { withPage } from "./browser.mjs";

const [library, modules, size, camera, ...files] = process.argv.slice(2);
const IMPORTS = JSON.stringify({ imports: {
  three: "/modules/three/build/three.module.js", "three/addons/": "/modules/three/examples/jsm/",
  "@babylonjs/core/": "/modules/@babylonjs/core/", "@babylonjs/core": "/modules/@babylonjs/core/index.js",
  "@babylonjs/loaders/": "/modules/@babylonjs/loaders/", "babylonjs-gltf2interface": "/empty.js",
} });

const three = `
import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { DRACOLoader } from "three/addons/loaders/DRACOLoader.js";
import { MeshoptDecoder } from "three/addons/libs/meshopt_decoder.module.js";
window.show = async (url, camera) => {
  const canvas = document.querySelector("canvas");
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
  renderer.setSize(canvas.width, canvas.height, false);
  renderer.setClearColor(0xffffff);
  const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder);
  loader.setDRACOLoader(new DRACOLoader().setDecoderPath("/modules/three/examples/jsm/libs/draco/gltf/"));
  const scene = new THREE.Scene(), eye = new THREE.PerspectiveCamera(camera.fov, canvas.width / canvas.height, 0.001, 100);
  scene.add((await loader.loadAsync(url)).scene, new THREE.AmbientLight(0xffffff, 1), eye);
  eye.up.set(...camera.up);
  eye.position.set(...camera.eye);
  eye.lookAt(...camera.target);
  const lamp = new THREE.DirectionalLight(0xffffff, 2.4);
  lamp.position.set(...camera.lamp);
  scene.add(lamp);
  renderer.render(scene, eye);
};`;

const babylon = `
import { Engine } from "@babylonjs/core/Engines/engine.js";
import { Scene } from "@babylonjs/core/scene.js";
import { FreeCamera } from "@babylonjs/core/Cameras/freeCamera.js";
import { HemisphericLight } from "@babylonjs/core/Lights/hemisphericLight.js";
import { DirectionalLight } from "@babylonjs/core/Lights/directionalLight.js";
import { Vector3 } from "@babylonjs/core/Maths/math.vector.js";
import { Color3, Color4 } from "@babylonjs/core/Maths/math.color.js";
import { MeshoptCompression } from "@babylonjs/core/Meshes/Compression/meshoptCompression.js";
import { ImportMeshAsync } from "@babylonjs/core/Loading/sceneLoader.js";
import "@babylonjs/core/Materials/standardMaterial.js";
import "@babylonjs/loaders/glTF/2.0/index.js";
import { MeshoptDecoder } from "three/addons/libs/meshopt_decoder.module.js";
globalThis.MeshoptDecoder = MeshoptDecoder;
MeshoptCompression.Configuration.decoder.url = "/empty.js";
window.show = async (url, camera) => {
  const canvas = document.querySelector("canvas"), engine = new Engine(canvas, true, { preserveDrawingBuffer: true });
  const scene = new Scene(engine);
  scene.useRightHandedSystem = true;
  scene.clearColor = new Color4(1, 1, 1, 1);
  const eye = new FreeCamera("eye", new Vector3(...camera.eye), scene);
  eye.upVector = new Vector3(...camera.up);
  eye.setTarget(new Vector3(...camera.target));
  [eye.fov, eye.minZ, eye.maxZ] = [camera.fov * Math.PI / 180, 0.001, 100];
  const sky = new HemisphericLight("sky", new Vector3(0, 1, 0), scene);
  sky.groundColor = new Color3(1, 1, 1);
  sky.intensity = 1;
  new DirectionalLight("lamp", new Vector3(...camera.lamp).scale(-1), scene).intensity = 2.4;
  await ImportMeshAsync(url, scene);
  await scene.whenReadyAsync();
  scene.render();
};`;

const PAGES = { three, babylon };
const TYPES = { ".js": "text/javascript", ".mjs": "text/javascript", ".wasm": "application/wasm", ".glb": "model/gltf-binary", ".json": "application/json" };

function page() {
  const [width, height] = size.split("x");
  return `<!doctype html><meta charset="utf-8"><style>body { margin: 0 } canvas { display: block }</style><canvas width="${width}" height="${height}"></canvas>
<script type="importmap">${IMPORTS}</script><script type="module">${PAGES[library]}
window.isReady = true;</script>`;
}

function answer(request, response) {
  const path = decodeURIComponent(new URL(request.url, "http://x").pathname), type = TYPES[extname(path)] ?? "text/html";
  const found = path.startsWith("/modules/") ? join(resolve(modules), path.slice(9)) : files.find((file) => path === "/files/" + basename(file));
  if (path === "/" || path === "/empty.js") return response.setHeader("content-type", type).end(path === "/" ? page() : "");
  if (!found || !existsSync(found) || !statSync(found).isFile()) return response.writeHead(404).end();
  response.setHeader("content-type", type);
  return createReadStream(found).pipe(response);
}

// Run in the page.
function pixelsOf() {
  const canvas = document.querySelector("canvas"), { width, height } = canvas, flat = new OffscreenCanvas(width, height).getContext("2d");
  flat.drawImage(canvas, 0, 0);
  return { width, height, rgba: [...flat.getImageData(0, 0, width, height).data] };
}

function ppmOf({ width, height, rgba }) {
  return Buffer.concat([Buffer.from(`P6\n${width} ${height}\n255\n`), Buffer.from(rgba.filter((_, i) => i % 4 !== 3))]);
}

// Where the lamp is, seen from the solid.
function lampOf({ eye, target, up }) {
  const cross = (a, b) => [0, 1, 2].map((i) => a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
  const unit = (a) => a.map((value) => value / Math.hypot(...a));
  const back = unit(eye.map((value, i) => value - target[i])), right = unit(cross(up, back)), top = cross(back, right);
  return back.map((value, i) => 0.75 * value - 0.55 * right[i] + 0.85 * top[i]);
}

const server = createServer(answer);
await new Promise((done) => server.listen(0, "127.0.0.1", done));
const errors = [], from = { ...JSON.parse(camera), lamp: lampOf(JSON.parse(camera)) };
await withPage(size, async (view) => {
  view.on("pageerror", (error) => errors.push(error.message));
  view.on("requestfailed", (request) => errors.push(request.url()));
  for (const file of files) {
    await view.goto(`http://127.0.0.1:${server.address().port}/`);
    await view.waitForFunction(() => window.isReady, null, { timeout: 120000 });
    try {
      await view.evaluate(([url, seen]) => window.show(url, seen), ["/files/" + basename(file), from]);
    } catch (error) {
      errors.push(`${basename(file)}: ${error.message}`);
      continue;
    }
    writeFileSync(`${file}.${library}.ppm`, ppmOf(await view.evaluate(pixelsOf)));
  }
});
server.close();
if (errors.length) {
  console.error([...new Set(errors)].join("\n"));
  process.exit(1);
}
