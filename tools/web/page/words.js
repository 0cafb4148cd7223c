// SPDX-License-Identifier: MIT
// The colours of a scene's text, by the same grammar as in editors (tools/editor): its patterns are tried at each place,
// in their order.
import { StreamLanguage } from "@codemirror/language";
import grammar from "../../editor/csgmesh.tmLanguage.json";

// Scopes of the grammar, the longest that fits, and what CodeMirror calls them.
const NAMES = {
  comment: "comment", "string": "string", "constant.character.escape": "escape", "constant.language": "atom",
  "constant.numeric": "number", "keyword.control": "keyword", "storage.type": "definitionKeyword", "keyword.operator": "operator",
  "variable.parameter": "propertyName", "variable.language": "variableName.special", "support.function.module": "typeName",
  "support.function": "variableName.standard", "entity.name.function": "variableName.function", punctuation: "punctuation",
};

function styleOf(scope) {
  for (let name = scope; name; name = name.replace(/\.?[^.]*$/, "")) if (NAMES[name]) return NAMES[name];
  return null;
}

const sticky = (text) => new RegExp(text, "y");

function compile({ name, match, begin, end, captures, patterns }) {
  return {
    style: name && styleOf(name), match: match && sticky(match), begin: begin && sticky(begin), end: end && sticky(end),
    captures: captures && Object.values(captures).map((capture) => styleOf(capture.name)), inner: (patterns ?? []).map(compile),
  };
}

const rules = grammar.patterns.map(compile);

function find(pattern, stream) {
  pattern.lastIndex = stream.pos;
  const found = pattern.exec(stream.string);
  return found?.[0] ? found : null;
}

// What a rule with captures has matched, piece by piece.
function queue(state, found, styles) {
  let at = found.index;
  styles.forEach((style, i) => {
    const piece = found[i + 1] ?? "", start = found.input.indexOf(piece, at);
    if (start > at) state.pieces.push([start - at, null]);
    state.pieces.push([piece.length, style]);
    at = start + piece.length;
  });
}

function insideOf(rule, stream, state) {
  const end = find(rule.end, stream), inner = !end && rule.inner.find((one) => find(one.match, stream));
  if (end) state.inside = null, stream.pos += end[0].length;
  else if (inner) stream.pos += find(inner.match, stream)[0].length;
  else stream.next();
  return inner ? inner.style : rule.style;
}

function token(stream, state) {
  if (state.pieces.length) {
    const [length, style] = state.pieces.shift();
    stream.pos += length;
    return style;
  }
  if (state.inside) return insideOf(state.inside, stream, state);
  for (const rule of rules) {
    const found = find(rule.match ?? rule.begin, stream);
    if (!found) continue;
    if (rule.begin) state.inside = rule;
    else if (rule.captures) {
      queue(state, found, rule.captures);
      return token(stream, state);
    }
    stream.pos += found[0].length;
    return rule.style;
  }
  stream.next();
  return null;
}

export const words = StreamLanguage.define({
  name: "csgmesh",
  startState: () => ({ inside: null, pieces: [] }),
  copyState: ({ inside, pieces }) => ({ inside, pieces: [...pieces] }),
  token,
  languageData: {
    commentTokens: { line: "//", block: { open: "/*", close: "*/" } },
    closeBrackets: { brackets: ["(", "[", "{", '"'] },
    indentOnInput: /^\s*[}\])]$/,
  },
  indent: ({ inside }, text, context) => {
    if (inside) return null;
    const line = context.lineAt(context.pos, -1), before = context.lineIndent(line.from), opened = /[{([]\s*(\/\/.*)?$/.test(line.text);
    return before + (opened ? context.unit : 0) - (/^[}\])]/.test(text) && !opened ? context.unit : 0);
  },
});
