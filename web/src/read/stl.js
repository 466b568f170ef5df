// STL, binary and ASCII: triangles without a common numbering of vertices.

import { FileProblem, Numbers, lines } from "./bytes.js";

const HEAD = 84;
const RECORD = 50;

// True when it is exactly as long as its count says.
export const isWholeStl = (bytes) => bytes.length >= HEAD && bytes.length === HEAD + new DataView(bytes.buffer, bytes.byteOffset).getUint32(80, true) * RECORD;

const isBinaryStl = (bytes) => isWholeStl(bytes) || (bytes.length >= HEAD && !startsWithSolid(bytes));

const startsWithSolid = (bytes) => /^\s*solid/i.test(new TextDecoder("latin1").decode(bytes.subarray(0, 80)));

export const looksLikeAsciiStl = (bytes) => startsWithSolid(bytes) && !isBinaryStl(bytes);

export function readStl(bytes) {
  const vertices = isBinaryStl(bytes) ? binary(bytes) : ascii(bytes);
  const corners = Uint32Array.from({ length: vertices.length / 3 }, (_, at) => at);
  const faceOf = Uint32Array.from({ length: corners.length / 3 }, (_, at) => at);
  return { vertices, corners, faceOf, faceCount: faceOf.length };
}

function binary(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const stated = view.getUint32(80, true);
  const count = Math.min(stated, Math.floor((bytes.length - HEAD) / RECORD));
  if (count < stated && bytes.length < HEAD + RECORD) throw new FileProblem("truncated");
  const vertices = new Float64Array(count * 9);
  for (let face = 0; face < count; face += 1) {
    const from = HEAD + face * RECORD + 12;
    for (let i = 0; i < 9; i += 1) vertices[face * 9 + i] = view.getFloat32(from + i * 4, true);
  }
  return vertices;
}

function ascii(bytes) {
  const vertices = new Numbers(Float64Array);
  let inFacet = 0;
  for (const line of lines(bytes, "")) {
    if (/^vertex\s/i.test(line)) {
      const [, x, y, z] = line.split(/\s+/);
      for (const value of [x, y, z]) vertices.push(Number(value));
      inFacet += 1;
    } else if (/^endfacet/i.test(line)) {
      if (inFacet % 3 !== 0) throw new FileProblem("unreadable");
    }
  }
  vertices.length -= vertices.length % 9;
  return vertices.done();
}
