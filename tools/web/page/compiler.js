// SPDX-License-Identifier: MIT
// The compiler for the page: one worker is at work, another waits. What is outdated is ended with its worker, and the
// one that waits goes on; the compiled module, which all of them share, keeps its code.
const PATIENCE_MS = 20; // what a request that is nearly done may take before its worker is ended
const SHORT_MS = 60; // a mesh that takes less is not shown coarsely first

export class Compiler {
  // module: a promise. source: text of worker.js. files: [path, bytes] of all workers.
  constructor(module, source, files) {
    this.module = module;
    this.address = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
    this.files = files;
    this.number = 0;
    this.lastMesh = Infinity;
    this.active = this.start();
  }

  // It takes requests at once and waits for the module.
  start() {
    const worker = new Worker(this.address);
    worker.begun = this.module.then((module) => worker.postMessage({ module, files: this.files }));
    worker.begun.catch(() => {}); // whoever has made the promise says what is wrong with the module
    return worker;
  }

  // Takes answers to the newest request alone: {state, model, status, took, last} or {broken}.
  show(request, answered) {
    this.wanted = { ...request, number: ++this.number, answered };
    if (!this.busy) return this.next();
    this.hurry ??= setTimeout(() => this.replace(), PATIENCE_MS);
  }

  // The worker that is at work is of no use any more.
  replace() {
    this.active.terminate();
    this.active = this.spare ?? this.start();
    this.spare = this.start();
    this.busy = false;
    this.next();
  }

  next() {
    clearTimeout(this.hurry);
    this.hurry = null;
    const wanted = this.wanted;
    if (!wanted) return;
    this.wanted = null;
    this.busy = true;
    const { answered, number } = wanted;
    this.active.onmessage = ({ data }) => this.answer(data, number, answered);
    this.active.onerror = (event) => this.answer({ number, broken: event.message ?? "the worker ended" }, number, answered);
    const { active } = this;
    active.begun.then(() => active.postMessage({ show: wanted.arguments, files: wanted.files, number, coarse: this.lastMesh > SHORT_MS }), () => {});
  }

  answer(data, number, answered) {
    if (data.number !== number) return;
    if (data.state?.scene.phase === "done") this.lastMesh = data.took;
    if (number === this.number && (data.state || data.broken)) answered(data);
    this.spare ??= this.start(); // not before there is a picture
    if (data.broken) return this.replace();
    if (!data.last) return;
    this.busy = false;
    this.next();
  }

  // {pieces, said, status}: a file, made by a worker of its own.
  write(request) {
    return this.alone({ write: request.arguments, files: request.files }, (data) => data.pieces);
  }

  async about() {
    return (await this.alone({ about: true }, (data) => data.about)).about;
  }

  alone(message, isAnswer) {
    const worker = this.start();
    return new Promise((resolve, reject) => {
      worker.onerror = (event) => reject(new Error(event.message ?? "the worker ended"));
      worker.onmessage = ({ data }) => {
        if (data.broken) reject(new Error(data.broken));
        else if (isAnswer(data)) resolve(data);
      };
      worker.begun.then(() => worker.postMessage(message), reject);
    }).finally(() => worker.terminate());
  }
}
