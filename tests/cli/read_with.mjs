// SPDX-License-Identifier: MIT
// node read_with.mjs READER NODE_MODULES FILE...: as read_with.py, with three.js or draco3d of that folder.
import fs from 'node:fs';
import path from 'node:path';
import {createRequire} from 'node:module';
import {pathToFileURL} from 'node:url';

const [reader, modules, ...files] = process.argv.slice(2);
const load = name => import(pathToFileURL(path.join(modules, name)));
const gold = [218, 165, 32].map(c => c / 255), linear = gold.map(c => ((c + 0.055) / 1.055) ** 2.4);
const isGold = color => [gold, linear].some(wanted => wanted.every((c, k) => Math.abs(c - color[k]) < 0.02));

function rowsOf(attribute) {
  return Array.from({length: attribute.count}, (_, i) => [attribute.getX(i), attribute.getY(i), attribute.getZ(i)]);
}

async function withThree(file) {
  globalThis.self ??= globalThis;
  globalThis.ProgressEvent ??= class {};
  const three = await load('three/build/three.module.js');
  const bytes = fs.readFileSync(file), ending = path.extname(file).slice(1), name = {glb: 'GLTF'}[ending] ?? ending.toUpperCase();
  const loader = new (await load(`three/examples/jsm/loaders/${name}Loader.js`))[`${name}Loader`]();
  const whole = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
  let root, title;
  if (ending === 'glb') {
    loader.setMeshoptDecoder((await load('three/examples/jsm/libs/meshopt_decoder.module.js')).MeshoptDecoder);
    const found = await loader.parseAsync(whole, '');
    [root, title] = [found.scene, found.asset.extras?.title];
  } else if (ending === 'obj') {
    const materials = new (await load('three/examples/jsm/loaders/MTLLoader.js')).MTLLoader();
    loader.setMaterials(materials.parse(fs.readFileSync(file.replace(/obj$/, 'mtl'), 'utf8'), ''));
    root = loader.parse(bytes.toString());
  } else {
    root = new three.Mesh(loader.parse(whole));
  }
  const meshes = [], box = new three.Box3().setFromObject(root, true), size = box.getSize(new three.Vector3());
  root.traverse(object => object.isMesh && meshes.push(object));
  const materials = meshes.flatMap(mesh => mesh.material), arrays = meshes.map(mesh => mesh.geometry.attributes);
  const names = new Set();
  root.traverse(object => names.add(object.name));
  return {size: [size.x, size.y, size.z], names: [...names], shapes: new Set(meshes.map(mesh => mesh.geometry)).size, shown: meshes.length,
          normals: arrays.some(a => a.normal), metadata: title === 'Three parts',
          colours: arrays.some(a => a.color && rowsOf(a.color).some(isGold)) || materials.some(m => isGold(m.color.toArray())),
          materials: materials.some(m => m.metalness === 1 && Math.abs(m.roughness - 0.3) < 1e-6)};
}

async function withDraco3d(file) {
  const draco = await createRequire(path.join(modules, 'x.js'))('draco3d').createDecoderModule({});
  const decoder = new draco.Decoder(), mesh = new draco.Mesh(), bytes = new Int8Array(fs.readFileSync(file));
  const status = decoder.DecodeArrayToMesh(bytes, bytes.length, mesh);
  if (!status.ok())
    throw new Error(status.error_msg());
  const valuesOf = kind => {
    const id = decoder.GetAttributeId(mesh, kind), values = new draco.DracoFloat32Array();
    if (id < 0)
      return null;
    const attribute = decoder.GetAttribute(mesh, id), width = attribute.num_components();
    decoder.GetAttributeFloatForAllPoints(mesh, attribute, values);
    return Array.from({length: mesh.num_points()}, (_, i) => Array.from({length: width}, (_, k) => values.GetValue(width * i + k)));
  };
  const points = valuesOf(draco.POSITION), colors = valuesOf(draco.COLOR), corners = new draco.DracoInt32Array();
  let flat = 0;
  for (let i = 0; i < mesh.num_faces(); i++) {
    decoder.GetFaceFromMesh(mesh, i, corners);
    const [a, b, c] = [0, 1, 2].map(k => points[corners.GetValue(k)]), u = b.map((x, k) => x - a[k]), v = c.map((x, k) => x - a[k]);
    flat += u[1] * v[2] === u[2] * v[1] && u[2] * v[0] === u[0] * v[2] && u[0] * v[1] === u[1] * v[0];
  }
  return {size: [0, 1, 2].map(k => Math.max(...points.map(p => p[k])) - Math.min(...points.map(p => p[k]))), zero_area: flat, shapes: 1, shown: 1,
          normals: valuesOf(draco.NORMAL) !== null, colours: !!colors?.some(c => isGold(c.map(x => (x > 1 ? x / 255 : x))))};
}

for (const file of files) {
  try {
    console.log('FOUND' + JSON.stringify(await (reader === 'draco3d' ? withDraco3d : withThree)(file)));
  } catch (error) {
    console.log('FOUND' + JSON.stringify({refused: String(error)}));
  }
}
