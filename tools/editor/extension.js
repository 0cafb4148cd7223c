// SPDX-License-Identifier: MIT
// Starts `csgmesh lsp` for scenes, and the view that its lens asks for.
const vscode = require("vscode");

let client;

function program() {
  return vscode.workspace.getConfiguration("csgmesh").get("path") || "csgmesh";
}

function view(uri) {
  const file = vscode.Uri.parse(uri || vscode.window.activeTextEditor.document.uri.toString()).fsPath;
  const terminal = vscode.window.createTerminal({ name: "csgmesh view", shellPath: program(), shellArgs: ["view", file] });
  terminal.show(true);
}

async function activate(context) {
  context.subscriptions.push(vscode.commands.registerCommand("csgmesh.view", view));
  let languageClient;
  try {
    languageClient = require("vscode-languageclient/node");
  } catch {
    vscode.window.showWarningMessage("csgmesh: only colours, as vscode-languageclient is missing: run npm install in the extension's folder");
    return;
  }
  const options = vscode.workspace.getConfiguration("csgmesh").get("options") || [];
  client = new languageClient.LanguageClient("csgmesh", "csgmesh", { command: program(), args: ["lsp", ...options] },
    { documentSelector: [{ language: "csgmesh", scheme: "file" }] });
  try {
    await client.start();
  } catch (error) {
    vscode.window.showErrorMessage(`csgmesh: cannot start '${program()} lsp': ${error?.message ?? error ?? "is it on the PATH?"}`);
  }
}

function deactivate() {
  return client && client.stop();
}

module.exports = { activate, deactivate };
