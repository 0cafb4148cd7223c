// SPDX-License-Identifier: MIT
// The text of a scene: CodeMirror with our colours, and findings at their places.
import { autocompletion, closeBrackets, closeBracketsKeymap, completeAnyWord, completionKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap } from "@codemirror/commands";
import { HighlightStyle, bracketMatching, indentOnInput, indentUnit, syntaxHighlighting } from "@codemirror/language";
import { lintGutter, lintKeymap, setDiagnostics } from "@codemirror/lint";
import { highlightSelectionMatches, search, searchKeymap } from "@codemirror/search";
import { EditorState } from "@codemirror/state";
import { EditorView, drawSelection, highlightActiveLine, highlightActiveLineGutter, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import { words } from "./words.js";

const color = (tag, name, more = {}) => ({ tag, color: `var(--${name})`, ...more });
const colors = HighlightStyle.define([
  color(tags.comment, "soft", { fontStyle: "italic" }), color([tags.string, tags.escape], "string"),
  color([tags.number, tags.atom], "number"), color([tags.keyword, tags.definitionKeyword], "keyword"),
  color(tags.typeName, "solid"), color([tags.standard(tags.variableName), tags.function(tags.variableName)], "called"),
  color(tags.propertyName, "named"), color([tags.operator, tags.punctuation], "soft"), color(tags.special(tags.variableName), "number"),
]);

// A column of the compiler counts bytes of UTF-8 from one.
function placeOf(doc, number, column) {
  const line = doc.line(Math.min(Math.max(1, number), doc.lines)), bytes = new TextEncoder().encode(line.text);
  return line.from + Math.min(line.length, new TextDecoder().decode(bytes.subarray(0, Math.max(0, column - 1))).length);
}

export class Editor {
  constructor(parent, changed) {
    this.quiet = false;
    this.extensions = [
      lineNumbers(), highlightActiveLineGutter(), highlightActiveLine(), history(), drawSelection(), indentOnInput(), bracketMatching(),
      closeBrackets(), autocompletion({ override: [completeAnyWord] }), highlightSelectionMatches(), search({ top: true }), lintGutter(), words,
      syntaxHighlighting(colors), indentUnit.of("  "), EditorState.tabSize.of(2),
      EditorView.contentAttributes.of({ "aria-label": "Text of the scene", spellcheck: "false" }),
      keymap.of([...closeBracketsKeymap, ...completionKeymap, ...searchKeymap, ...historyKeymap, ...lintKeymap, ...defaultKeymap]),
      EditorView.updateListener.of((update) => update.docChanged && !this.quiet && changed()),
    ];
    this.view = new EditorView({ parent, extensions: this.extensions });
  }

  get text() {
    return this.view.state.doc.toString();
  }

  // Another scene, with a history of its own.
  set text(text) {
    this.view.setState(EditorState.create({ doc: text, extensions: this.extensions }));
  }

  // Findings of this text, of `csgmesh --diagnostics=json`.
  showFindings(findings) {
    const { doc } = this.view.state;
    const marks = findings.map((finding) => {
      const from = placeOf(doc, finding.line, finding.column);
      const to = finding.end_line ? placeOf(doc, finding.end_line, finding.end_column) : from;
      const message = [finding.message, finding.hint].filter(Boolean).join("\n");
      return { from: Math.min(from, to), to: Math.max(from, to), severity: finding.severity === "error" ? "error" : finding.severity === "warning" ? "warning" : "info", message, source: finding.code };
    });
    this.view.dispatch(setDiagnostics(this.view.state, marks.sort((a, b) => a.from - b.from)));
  }

  goTo({ line, column }) {
    const at = placeOf(this.view.state.doc, line, column);
    this.view.dispatch({ selection: { anchor: at }, effects: EditorView.scrollIntoView(at, { y: "center" }) });
    this.view.focus();
  }
}
