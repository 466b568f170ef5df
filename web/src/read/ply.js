// PLY, text and binary: positions, the lists of faces, and the colours of both.

import { Faces, FileProblem, words } from "./bytes.js";
import { Channels, ofCorners } from "./colors.js";

const TYPES = {
  char: ["getInt8", 1], int8: ["getInt8", 1], uchar: ["getUint8", 1], uint8: ["getUint8", 1],
  short: ["getInt16", 2], int16: ["getInt16", 2], ushort: ["getUint16", 2], uint16: ["getUint16", 2],
  int: ["getInt32", 4], int32: ["getInt32", 4], uint: ["getUint32", 4], uint32: ["getUint32", 4],
  float: ["getFloat32", 4], float32: ["getFloat32", 4], double: ["getFloat64", 8], float64: ["getFloat64", 8],
};

export function readPly(bytes) {
  const { format, elements, end, isTextured } = header(bytes);
  const number = format === "ascii" ? textNumbers(bytes, end) : binaryNumbers(bytes, end, format);
  let vertices = new Float64Array(0);
  let faces = new Faces(() => 0);
  let [ofVertices, ofFaces] = [null, null];
  for (const element of elements) {
    if (element.name === "vertex") {
      ({ vertices, colors: ofVertices } = readVertices(element, number));
    } else {
      const read = readElements(element, number, vertices.length / 3);
      if (element.name === "face") ({ faces, colors: ofFaces } = read);
    }
  }
  const mesh = faces.mesh(vertices);
  return { ...mesh, colors: ofCorners(mesh, ofVertices, ofFaces), isTextured };
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
  return { format, elements, end: last.index + last[0].length, isTextured: /^comment TextureFile\b/m.test(text) };
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

// Which channel of a colour a property is; -1: none. Integers go to 255, others to 1.
function channelsOf(properties) {
  const channels = properties.map(({ name }) => ["red", "green", "blue"].indexOf(name.replace(/^diffuse_/, "")));
  const first = properties[channels.indexOf(0)];
  return { channels, scale: /^(float|double)/.test(first?.type ?? "") ? 255 : 1 };
}

function readVertices({ count, properties }, number) {
  const vertices = new Float64Array(count * 3);
  const [colors, color] = [new Channels(), [NaN, NaN, NaN]];
  const { channels, scale } = channelsOf(properties);
  const axis = properties.map(({ name }) => "xyz".indexOf(name));
  for (let i = 0; i < count; i += 1) {
    properties.forEach(({ type, list }, at) => {
      if (list) for (let left = number(list); left > 0; left -= 1) number(type);
      else if (axis[at] >= 0) vertices[i * 3 + axis[at]] = number(type);
      else if (channels[at] >= 0) color[channels[at]] = number(type);
      else number(type);
    });
    colors.add(...color);
  }
  return { vertices, colors: colors.done(scale) };
}

function readElements({ count, properties }, number, vertexCount) {
  const faces = new Faces(() => vertexCount);
  const [colors, color] = [new Channels(), [NaN, NaN, NaN]];
  const { channels, scale } = channelsOf(properties);
  for (let i = 0; i < count; i += 1) {
    for (const [at, { name, type, list }] of properties.entries()) {
      if (!list) {
        const value = number(type);
        if (channels[at] >= 0) color[channels[at]] = value;
        continue;
      }
      const items = Array.from({ length: number(list) }, () => number(type));
      if (name === "vertex_indices" || name === "vertex_index") faces.add(items);
    }
    colors.add(...color);
  }
  return { faces, colors: colors.done(scale) };
}
