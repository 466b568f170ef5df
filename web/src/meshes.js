// The worker, as promises.

import { Problem } from "./api.js";

export class Meshes {
  constructor() {
    this.worker = new Worker("/worker.js");
    this.waiting = new Map();
    this.count = 0;
    this.worker.onmessage = ({ data }) => {
      const { resolve, reject } = this.waiting.get(data.id);
      this.waiting.delete(data.id);
      if (data.problem) reject(new Problem({ code: data.problem, detail: data.detail }));
      else resolve(data.answer);
    };
  }

  ask(work, values = {}, transfer = []) {
    this.count += 1;
    const id = this.count;
    this.worker.postMessage({ id, work, ...values }, transfer);
    return new Promise((resolve, reject) => { this.waiting.set(id, { resolve, reject }); });
  }
}
