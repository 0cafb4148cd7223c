// SPDX-License-Identifier: MIT
// node validate.mjs WRITER: runs WRITER on a fresh folder, then the Khronos glTF validator over every
// file there; any error or warning fails, and so does any information but that it does not know an extension, or
// that it finds no use of an object which only such an extension, or --uv without a texture, uses. Files may also be named: node validate.mjs --files A.glb ...
// Exit 77 (skipped) when gltf-validator is not installed: run `npm ci` in this folder.
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';

let validator;
try {
  validator = (await import('gltf-validator')).default;
} catch {
  console.log('skipped: gltf-validator is not installed; run `npm ci` in tests/io');
  process.exit(77);
}

function documentOf(bytes) {
  const isBinary = bytes.toString('latin1', 0, 4) === 'glTF';
  return JSON.parse(isBinary ? bytes.toString('utf8', 20, 20 + bytes.readUInt32LE(12)) : bytes.toString('utf8'));
}

// JSON pointers of what only extensions name that the validator does not know.
function namedByExtensions(document) {
  const found = new Set();
  const add = (list, index) => Number.isInteger(index) && found.add(`/${list}/${index}`);
  const look = extension => {
    for (const index of extension.ids ?? []) // of MSFT_lod
      add('nodes', index);
    for (const index of [extension.manifoldPrimitive?.indices, extension.mergeIndices, extension.mergeValues])
      add('accessors', index);
    add('bufferViews', extension.bufferView); // of Draco
    add('buffers', extension.buffer); // of meshoptimizer
  };
  const known = new Set(['KHR_mesh_quantization']);
  const visit = value => {
    for (const [key, inner] of Object.entries(value)) {
      if (key === 'extensions')
        Object.entries(inner).filter(([name]) => !known.has(name)).forEach(([, extension]) => look(extension));
      if (inner && typeof inner === 'object')
        visit(inner);
    }
  };
  visit(document);
  return found;
}

function isExpected(message, document) {
  if (message.code === 'UNSUPPORTED_EXTENSION')
    return true;
  const [, mesh, primitive] = message.pointer.match(/^\/meshes\/(\d+)\/primitives\/(\d+)\/attributes\/TEXCOORD_0$/) ?? [];
  const material = mesh && document.materials?.[document.meshes[mesh].primitives[primitive].material];
  const picture = material?.pbrMetallicRoughness?.metallicRoughnessTexture; // the only one that we write
  const isWithoutTexture = mesh && (!picture || picture.texCoord === 1);
  return message.code === 'UNUSED_OBJECT' && (isWithoutTexture || namedByExtensions(document).has(message.pointer));
}

async function check(file) {
  const bytes = fs.readFileSync(file), document = documentOf(bytes);
  const {messages} = (await validator.validateBytes(new Uint8Array(bytes), {uri: path.basename(file)})).issues;
  const bad = messages.filter(m => m.severity <= 1 || !isExpected(m, document));
  for (const m of process.env.VERBOSE ? messages : bad)
    console.log(`${path.basename(file)}: ${['error', 'warning'][m.severity] ?? 'information'} ${m.code} at ${m.pointer}: ${m.message}`);
  return bad.length === 0;
}

const named = process.argv[2] === '--files';
const folder = named ? null : fs.mkdtempSync(path.join(os.tmpdir(), 'csgmesh-validate-'));
let bad = 0, count = 0;
try {
  if (!named)
    execFileSync(process.argv[2], [folder], {stdio: 'inherit'});
  const files = named ? process.argv.slice(3) : fs.readdirSync(folder).sort().map(name => path.join(folder, name));
  for (const file of files) {
    count++;
    if (!await check(file))
      bad++;
  }
  // the check itself must be able to fail: a file with a planted fault
  if (!named) {
    const broken = path.join(folder, 'broken.gltf');
    fs.writeFileSync(broken, fs.readFileSync(path.join(folder, 'cube-plain.gltf'), 'utf8').replace('"max":[', '"max":[1'));
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(broken)));
    if (report.issues.numErrors === 0)
      throw new Error('the validator passed a file with a wrong maximum');
  }
} finally {
  if (folder)
    fs.rmSync(folder, {recursive: true});
}
console.log(`${count} files, ${bad} with errors, warnings or information`);
process.exit(bad || !count ? 1 : 0);
