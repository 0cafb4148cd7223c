// SPDX-License-Identifier: MIT
// The page that view.js opens: window.show(model) renders one GLB to a picture in the sheet.
import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { DRACOLoader } from "three/addons/loaders/DRACOLoader.js";
import { MeshoptDecoder } from "three/addons/libs/meshopt_decoder.module.js";
import { RoomEnvironment } from "three/addons/environments/RoomEnvironment.js";

const BACKGROUND = 0xf3f1ec;
const PLAIN = 0xa9b8c6; // of a mesh without vertex colours
const OVERSAMPLING = 2;

const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
renderer.shadowMap.enabled = true;
renderer.shadowMap.type = THREE.VSMShadowMap;
renderer.toneMapping = THREE.NeutralToneMapping;
renderer.toneMappingExposure = 1.0;
const surroundings = new THREE.PMREMGenerator(renderer).fromScene(new RoomEnvironment(), 0.04).texture;

const loader = new GLTFLoader();
loader.setMeshoptDecoder(MeshoptDecoder);
loader.setDRACOLoader(new DRACOLoader().setDecoderPath("/three/examples/jsm/libs/draco/"));

function dress(model, wire) {
  model.traverse((node) => {
    if (!node.isMesh) return;
    const colored = Boolean(node.geometry.attributes.color);
    if (!node.geometry.attributes.normal) node.geometry.computeVertexNormals();
    node.material = new THREE.MeshStandardMaterial({
      color: colored ? 0xffffff : PLAIN,
      vertexColors: colored,
      roughness: 0.5,
      wireframe: wire,
    });
    node.castShadow = node.receiveShadow = true;
  });
}

function light(scene, center, radius) {
  const key = new THREE.DirectionalLight(0xffffff, 1.9);
  key.position.copy(center).add(new THREE.Vector3(-0.9, 3.2, 1.3).multiplyScalar(radius));
  key.target.position.copy(center);
  key.castShadow = true;
  key.shadow.mapSize.set(2048, 2048);
  key.shadow.radius = 10;
  key.shadow.blurSamples = 20;
  key.shadow.bias = -0.0004;
  key.shadow.normalBias = radius * 0.004;
  const box = key.shadow.camera;
  box.left = box.bottom = -1.6 * radius;
  box.right = box.top = 1.6 * radius;
  box.far = 6 * radius;
  scene.add(key, key.target);
}

// At most some ten thousand points of the model, in the world's frame.
function outline(object) {
  const points = [];
  object.traverse((node) => {
    const position = node.isMesh && node.geometry.attributes.position;
    const step = Math.ceil((position ? position.count : 1) / 10000);
    for (let i = 0; position && i < position.count; i += step)
      points.push(new THREE.Vector3().fromBufferAttribute(position, i).applyMatrix4(node.matrixWorld));
  });
  return points;
}

// The camera looks from `azimuth`, `elevation` (degrees) at the model's middle as it sees it, and
// stands as near as its points allow.
function frame(camera, points, box, azimuth, elevation, zoom) {
  const center = box.getCenter(new THREE.Vector3());
  const a = THREE.MathUtils.degToRad(azimuth);
  const e = THREE.MathUtils.degToRad(elevation);
  const towards = new THREE.Vector3(Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e));
  const right = new THREE.Vector3(Math.cos(a), 0, -Math.sin(a));
  const up = new THREE.Vector3().crossVectors(towards, right);
  const half = Math.tan(THREE.MathUtils.degToRad(camera.fov / 2));
  for (const axis of [right, up]) {
    const along = points.map((point) => point.dot(axis));
    const middle = (along.reduce((a, b) => Math.min(a, b)) + along.reduce((a, b) => Math.max(a, b))) / 2;
    center.addScaledVector(axis, middle - center.dot(axis));
  }
  let distance = 0;
  for (const point of points) {
    const corner = point.clone().sub(center);
    const across = Math.max(Math.abs(corner.dot(up)), Math.abs(corner.dot(right)) / camera.aspect);
    distance = Math.max(distance, corner.dot(towards) + across / half);
  }
  distance *= 1.3 / zoom;
  camera.near = distance / 100;
  camera.far = distance * 20;
  camera.position.copy(center).addScaledVector(towards, distance);
  camera.up.set(0, 1, 0);
  camera.lookAt(center);
  camera.updateProjectionMatrix();
}

async function render(model) {
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(BACKGROUND);
  scene.environment = surroundings;
  scene.environmentIntensity = 0.55;
  const object = (await loader.loadAsync(model.url)).scene;
  dress(object, model.wire);
  scene.add(object);
  object.updateMatrixWorld(true);
  const box = new THREE.Box3().setFromObject(object, true);
  const radius = box.getSize(new THREE.Vector3()).length() / 2;
  const center = box.getCenter(new THREE.Vector3());
  light(scene, center, radius);
  const floor = new THREE.Mesh(new THREE.PlaneGeometry(20 * radius, 20 * radius),
    new THREE.ShadowMaterial({ opacity: 0.2 }));
  floor.rotation.x = -Math.PI / 2;
  floor.position.set(center.x, box.min.y - 0.002 * radius, center.z);
  floor.receiveShadow = true;
  scene.add(floor);
  renderer.setSize(model.width * OVERSAMPLING, model.height * OVERSAMPLING, false);
  const camera = new THREE.PerspectiveCamera(28, model.width / model.height);
  frame(camera, outline(object), box, model.azimuth, model.elevation, model.zoom);
  renderer.render(scene, camera);
  return renderer.domElement.toDataURL("image/png");
}

window.show = async (model) => {
  const figure = document.createElement("figure");
  const image = new Image(model.width, model.height);
  image.src = await render(model);
  await image.decode();
  figure.append(image);
  if (model.caption) {
    const caption = document.createElement("figcaption");
    caption.textContent = model.caption;
    figure.append(caption);
  }
  const sheet = document.getElementById("sheet");
  sheet.style.gridTemplateColumns = `repeat(${model.columns}, auto)`;
  sheet.append(figure);
};
window.ready = true;
