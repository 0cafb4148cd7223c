// SPDX-License-Identifier: MIT
// The TextMate grammar against the program's own lexer: every token of every scene has the scope of
// its kind, everything between tokens is comment or space.
// Usage: node check.mjs TOKENS GRAMMAR SCENES; exit status 77 (a skip) without `npm ci` in this folder.
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { createRequire } from "node:module";

const require = createRequire(import.meta.url);
let textmate, oniguruma, wasm;
try {
  textmate = require("vscode-textmate");
  oniguruma = require("vscode-oniguruma");
  wasm = fs.readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm"));
} catch {
  console.log("vscode-textmate is not installed: run `npm ci` in tests/editor");
  process.exit(77);
}
const [tokensProgram, grammarPath, scenes] = process.argv.slice(2);

function scenesIn(folder) {
  return fs.readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    const full = path.join(folder, entry.name);
    if (entry.isDirectory()) return entry.name === "bad" ? [] : scenesIn(full);
    return /\.(txt|scad|csgmesh)$/.test(entry.name) ? [full] : [];
  });
}

// What a token's scopes must hold, by the lexer's kind.
const WANTED = {
  KEYWORD: /^(keyword\.control|storage\.type|constant\.language)/,
  NUMBER: /^constant\.numeric/,
  STRING: /^(string\.quoted\.double|constant\.character\.escape)/,
  PATH: /^string\.quoted\.other/,
  NAME: /^(variable|support\.function|entity\.name\.function|constant\.language)/,
  PUNCTUATION: /^(keyword\.operator|punctuation)/,
};

// The innermost scope of every byte, "" for the source itself. Bytes are taken as characters, so that
// offsets agree.
function scopesOf(grammar, text) {
  const scopes = new Array(text.length).fill("");
  let state = textmate.INITIAL, at = 0;
  for (const line of text.split("\n")) {
    const result = grammar.tokenizeLine(line, state);
    for (const token of result.tokens)
      for (let i = token.startIndex; i < Math.min(token.endIndex, line.length); i++)
        scopes[at + i] = token.scopes.length > 1 ? token.scopes[token.scopes.length - 1] : "";
    state = result.ruleStack;
    at += line.length + 1;
  }
  return scopes;
}

function lexed() {
  const files = new Map();
  const output = execFileSync(tokensProgram, scenesIn(scenes), { encoding: "latin1", maxBuffer: 1 << 28 });
  let tokens;
  for (const line of output.trim().split("\n")) {
    if (line.startsWith("file ")) files.set(line.slice(5), (tokens = []));
    else {
      const [kind, offset, length] = line.split(" ");
      if (kind !== "END") tokens.push({ kind, offset: +offset, length: +length });
    }
  }
  return files;
}

let faults = 0;
function fault(file, text, offset, message) {
  if (++faults <= 20) console.log(`${file}:${text.slice(0, offset).split("\n").length}: ${message}`);
}

function check(grammar, file, tokens) {
  const text = fs.readFileSync(file, "latin1");
  const scopes = scopesOf(grammar, text);
  const covered = new Uint8Array(text.length);
  for (const { kind, offset, length } of tokens) {
    const shown = text.slice(offset, offset + length);
    for (let i = offset; i < offset + length; i++) {
      covered[i] = 1;
      if (!WANTED[kind].test(scopes[i])) {
        fault(file, text, i, `${kind} '${shown}' has scope '${scopes[i]}'`);
        break;
      }
    }
  }
  for (let i = 0; i < text.length; i++)
    if (!covered[i] && text.charCodeAt(i) > 0x20 && !scopes[i].startsWith("comment.")) {
      fault(file, text, i, `'${text[i]}' is a comment and has scope '${scopes[i]}'`);
      break;
    }
}

// What the tables' names become.
function checkWords(grammar) {
  for (const [line, word, scope] of [
    ["sphere(1);", "sphere", "support.function.module"], ["x = sin(30);", "sin", "support.function.csgmesh"],
    ["module wheel(r) {", "wheel", "entity.name.function"], ["wheel(3);", "wheel", "entity.name.function.call"],
    ["sphere(r = 1);", "r ", "variable.parameter"], ["$fn = 3;", "$fn", "variable.language"],
    ["use <a.txt>", "<a", "string.quoted.other"], ["echo(\"a\\n\");", "\\n", "constant.character.escape"],
    ["for (i = [0 : 2])", "for", "keyword.control"], ["/* a", "a", "comment.block"]]) {
    const scopes = scopesOf(grammar, line);
    const found = scopes[line.indexOf(word)];
    if (!found.startsWith(scope)) fault(line, line, 0, `'${word}' has scope '${found}', not '${scope}'`);
  }
}

await oniguruma.loadWASM(wasm.buffer.slice(wasm.byteOffset, wasm.byteOffset + wasm.byteLength));
const registry = new textmate.Registry({
  onigLib: Promise.resolve({
    createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
    createOnigString: (text) => new oniguruma.OnigString(text),
  }),
  loadGrammar: async () => textmate.parseRawGrammar(fs.readFileSync(grammarPath, "utf8"), grammarPath),
});
const grammar = await registry.loadGrammar("source.csgmesh");
const files = lexed();
let tokens = 0;
for (const [file, found] of files) {
  check(grammar, file, found);
  tokens += found.length;
}
checkWords(grammar);
console.log(`${files.size} scenes, ${tokens} tokens, ${faults} faults`);
process.exit(faults || files.size < 10 ? 1 : 0);
