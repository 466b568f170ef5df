// The work on meshes that would stop the page: reading, welding, comparing. One request, one answer.

import { FileProblem } from "../read/bytes.js";
import { read } from "../read/read.js";
import { sha256 } from "../read/sha256.js";
import { COARSE_ABOVE, coarse } from "./cluster.js";
import { brokenEdges, next, segmentsOf } from "./edges.js";
import { Grid } from "./grid.js";
import { deviation, thickness } from "./maps.js";
import { boundsOf, bulkOf, cornerNormals, faceNormals, positionsOf } from "./soup.js";
import { kept, weld } from "./weld.js";

const meshes = new Map(); // by the names that the page gives them
let origin = null; // the middle of the mesh that came first: both are drawn around it
const VAST = 1e18; // millimetres, of which a square is beyond 32-bit numbers

const work = {
  // What is needed for a first picture. `scale`: millimetres of a unit of the file, where it does not state its own.
  async read({ name, bytes, fileName, scale, isFirst }) {
    const file = await read(new Uint8Array(bytes), fileName);
    const unit = file.millimetres ?? scale;
    const whole = weld(scaled(file, unit));
    const { drawn, format, faceCount, project, colors, isTextured } = whole;
    const mesh = { ...whole, corners: whole.corners.subarray(0, drawn * 3), faceOf: whole.faceOf.subarray(0, drawn) };
    const bounds = boundsOf(mesh);
    if (!bounds.min.every(Number.isFinite)) throw new FileProblem("no-triangle");
    if (!(Math.hypot(...bounds.min, ...bounds.max) < VAST)) throw new FileProblem("too-vast");
    const bulk = bulkOf(mesh, bounds);
    if (isFirst || !origin) origin = bulk.bounds.min.map((low, axis) => (low + bulk.bounds.max[axis]) / 2);
    const all = positionsOf(whole, origin);
    const positions = all.subarray(0, drawn * 9);
    const flat = faceNormals(positions);
    const normals = cornerNormals(mesh, flat, mesh.vertices.length / 3);
    meshes.set(name, { ...mesh, positions, flat, bounds, unit });
    return { drawn, format, faceOf: whole.faceOf.slice(), faceCount, bounds, bulk, origin, positions: all.slice(), normals, project, colors: colors && colors.slice(), isTextured };
  },

  // What else there is to see of a mesh, and coarse copies of a large one, of about so many triangles.
  look({ name, sizes }) {
    const mesh = meshes.get(name);
    const { open, crowded, turned } = brokenEdges(mesh);
    const drawn = (halves) => segmentsOf(halves, mesh.positions);
    const wanted = mesh.faceOf.length > COARSE_ABOVE ? sizes.filter((size) => size < mesh.faceOf.length / 2) : [];
    const ends = Uint32Array.from(open, (half) => mesh.corners[half]);
    const others = Uint32Array.from(open, (half) => mesh.corners[next(half)]);
    return {
      rims: { halves: open, ends, others }, edges: { open: drawn(open), crowded: drawn(crowded), turned: drawn(turned) },
      coarse: wanted.map((size) => coarse(mesh, mesh.bounds, size)),
    };
  },

  // Which triangles of each mesh the other one has as well.
  compare() {
    const [before, after] = [meshes.get("before"), meshes.get("after")];
    // A result is rounded in its own unit.
    before.kept = kept(before, after, after.unit);
    after.kept = kept(after, before, after.unit);
    return { before: before.kept.slice(), after: after.kept.slice() };
  },

  deviation() {
    const [before, after] = [meshes.get("before"), meshes.get("after")];
    return {
      before: deviation(before, before.kept, new Grid(after.positions)),
      after: deviation(after, after.kept, new Grid(before.positions)),
    };
  },

  thickness({ name }) {
    const mesh = meshes.get(name);
    const size = mesh.bounds.max.map((high, axis) => high - mesh.bounds.min[axis]);
    return thickness(mesh, Math.hypot(...size));
  },

  digest: ({ bytes }) => sha256(new Uint8Array(bytes)),
};

function scaled(mesh, scale) {
  return scale === 1 ? mesh : { ...mesh, vertices: mesh.vertices.map((value) => value * scale) };
}

self.onmessage = async ({ data }) => {
  try {
    const answer = await work[data.work](data);
    self.postMessage({ id: data.id, answer }, buffersOf(answer));
  } catch (error) {
    const isKnown = error instanceof FileProblem;
    self.postMessage({ id: data.id, problem: isKnown ? error.message : "unreadable", detail: isKnown ? "" : String(error) });
  }
};

// Arrays move to the page, without a copy; those that are needed here were copied before.
function buffersOf(value, found = new Set()) {
  if (ArrayBuffer.isView(value)) found.add(value.buffer);
  else if (value && typeof value === "object") Object.values(value).forEach((item) => buffersOf(item, found));
  return [...found];
}
