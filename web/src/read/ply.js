// PLY, text and binary: positions and the lists of faces.

import { Faces, FileProblem, words } from "./bytes.js";

const TYPES = {
  char: ["getInt8", 1], int8: ["getInt8", 1], uchar: ["getUint8", 1], uint8: ["getUint8", 1],
  short: ["getInt16", 2], int16: ["getInt16", 2], ushort: ["getUint16", 2], uint16: ["getUint16", 2],
  int: ["getInt32", 4], int32: ["getInt32", 4], uint: ["getUint32", 4], uint32: ["getUint32", 4],
  float: ["getFloat32", 4], float32: ["getFloat32", 4], double: ["getFloat64", 8], float64: ["getFloat64", 8],
};

export function readPly(bytes) {
  const { format, elements, end } = header(bytes);
  const number = format === "ascii" ? textNumbers(bytes, end) : binaryNumbers(bytes, end, format);
  let vertices = new Float64Array(0);
  let faces = new Faces(() => 0);
  for (const element of elements) {
    if (element.name === "vertex") {
      vertices = readVertices(element, number);
    } else {
      const read = readElements(element, number, vertices.length / 3);
      if (element.name === "face") faces = read;
    }
  }
  return { vertices, corners: faces.corners.done(), faceOf: faces.faceOf.done(), faceCount: faces.count };
}

function header(bytes) {
  const text = new TextDecoder("latin1").decode(bytes.subarray(0, 65536));
  const last = /end_header[^\n]*\n/.exec(text);
  if (!last) throw new FileProblem("unreadable");
  const elements = [];
  let format = "";
  for (const line of text.slice(0, last.index).split(/\r?\n/)) {
    const [word, ...rest] = line.trim().split(/\s+/);
    if (word === "format") [format] = rest;
    if (word === "element") elements.push({ name: rest[0], count: Number(rest[1]), properties: [] });
    if (word === "property") elements.at(-1)?.properties.push(property(rest));
  }
  if (elements.some(({ count }) => !(count >= 0 && count <= bytes.length))) throw new FileProblem("unreadable");
  return { format, elements, end: last.index + last[0].length };
}

function property(words) {
  const types = words[0] === "list" ? [words[1], words[2]] : [words[0]];
  if (types.some((type) => !TYPES[type])) throw new FileProblem("unreadable");
  return { name: words.at(-1), type: types.at(-1), list: words[0] === "list" ? types[0] : null };
}

function textNumbers(bytes, from) {
  const all = words(bytes, from);
  return () => {
    const { value, done } = all.next();
    if (done) throw new FileProblem("truncated");
    return Number(value);
  };
}

function binaryNumbers(bytes, from, format) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const little = format === "binary_little_endian";
  let at = from;
  return (type) => {
    const [getter, size] = TYPES[type];
    if (at + size > view.byteLength) throw new FileProblem("truncated");
    const value = view[getter](at, little);
    at += size;
    return value;
  };
}

function readVertices({ count, properties }, number) {
  const vertices = new Float64Array(count * 3);
  const axis = properties.map(({ name }) => "xyz".indexOf(name));
  for (let i = 0; i < count; i += 1) {
    properties.forEach(({ type, list }, at) => {
      if (list) for (let left = number(list); left > 0; left -= 1) number(type);
      else if (axis[at] >= 0) vertices[i * 3 + axis[at]] = number(type);
      else number(type);
    });
  }
  return vertices;
}

function readElements({ count, properties }, number, vertexCount) {
  const faces = new Faces(() => vertexCount);
  for (let i = 0; i < count; i += 1) {
    for (const { name, type, list } of properties) {
      if (!list) { number(type); continue; }
      const items = Array.from({ length: number(list) }, () => number(type));
      if (name === "vertex_indices" || name === "vertex_index") faces.add(items);
    }
  }
  return faces;
}
