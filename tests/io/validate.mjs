// SPDX-License-Identifier: MIT
// node validate.mjs WRITER: runs WRITER on a fresh folder, then the Khronos glTF validator over every
// file there; any error or warning fails. Files may also be named: node validate.mjs --files A.glb ...
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

async function check(file) {
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {uri: path.basename(file)});
  const {numErrors, numWarnings, messages} = report.issues;
  for (const m of messages.filter(m => m.severity <= 1 || process.env.VERBOSE))
    console.log(`${path.basename(file)}: ${m.severity === 0 ? 'error' : m.severity === 1 ? 'warning' : 'note'} ${m.code} at ${m.pointer}: ${m.message}`);
  return numErrors + numWarnings === 0;
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
console.log(`${count} files, ${bad} with errors or warnings`);
process.exit(bad || !count ? 1 : 0);
