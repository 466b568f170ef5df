// Text out of bytes, without a string of the whole file: a large text file is walked, not split.

import { divide } from "./polygons.js";

export class FileProblem extends Error {}

const SPACE = 32;
const NEWLINE = 10;

// The lines of `bytes` from `from`, as strings, without what stands behind `comment`.
export function* lines(bytes, comment = "#", from = 0) {
  const decoder = new TextDecoder("latin1");
  let begin = from;
  while (begin < bytes.length) {
    let end = bytes.indexOf(NEWLINE, begin);
    if (end < 0) end = bytes.length;
    let line = decoder.decode(bytes.subarray(begin, end));
    const cut = comment ? line.indexOf(comment) : -1;
    if (cut >= 0) line = line.slice(0, cut);
    line = line.trim();
    if (line) yield line;
    begin = end + 1;
  }
}

// The words of `bytes` from `from`.
export function* words(bytes, from = 0) {
  const decoder = new TextDecoder("latin1");
  let begin = from;
  while (begin < bytes.length) {
    while (begin < bytes.length && bytes[begin] <= SPACE) begin += 1;
    let end = begin;
    while (end < bytes.length && bytes[end] > SPACE) end += 1;
    if (end > begin) yield decoder.decode(bytes.subarray(begin, end));
    begin = end;
  }
}

// A growing list of numbers in a typed array.
export class Numbers {
  constructor(Type, capacity = 1024) {
    this.items = new Type(capacity);
    this.length = 0;
  }

  push(value) {
    if (this.length === this.items.length) {
      const wider = new this.items.constructor(this.length * 2);
      wider.set(this.items);
      this.items = wider;
    }
    this.items[this.length] = value;
    this.length += 1;
  }

  done() {
    return this.items.slice(0, this.length);
  }
}

// Gathers polygons as triangles, each with the number of its polygon in the file.
export class Faces {
  constructor(vertexCount) {
    this.vertexCount = vertexCount;
    this.corners = new Numbers(Uint32Array);
    this.faceOf = new Numbers(Uint32Array);
    this.count = 0;
  }

  // A face that names a vertex which is not there is counted, and not drawn.
  add(polygon) {
    const face = this.count;
    this.count += 1;
    for (const at of polygon) if (!(at >= 0 && at < this.vertexCount())) return;
    for (let i = 2; i < polygon.length; i += 1) {
      this.corners.push(polygon[0]);
      this.corners.push(polygon[i - 1]);
      this.corners.push(polygon[i]);
      this.faceOf.push(face);
    }
  }

  mesh(vertices) {
    const mesh = { vertices, corners: this.corners.done(), faceOf: this.faceOf.done(), faceCount: this.count };
    divide(mesh);
    return mesh;
  }
}
