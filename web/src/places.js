// From the elements that a report names to what is drawn of them.

import { crossing } from "./mesh/crossing.js";
import { Project } from "./project.js";

// The picture of a mesh, as the worker read it, with what finds faces and rims in it.
export class Picture {
  constructor({ project, ...read }) {
    Object.assign(this, read);
    this.project = project ? new Project(project) : null;
  }

  // Triangles of a face that a report names; their faces ascend. A part that is in several places has it in each, unless only
  // the first is wanted.
  trianglesOf(named, isFirst = false) {
    const face = this.project ? this.project.face(named) : named;
    let [low, high] = [0, this.faceOf.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.faceOf[middle] < face) low = middle + 1;
      else high = middle;
    }
    const found = [];
    for (; this.faceOf[low] === face; low += 1) found.push(low);
    return isFirst && this.project ? found.slice(0, 1) : found;
  }

  facesAt(faces, isFirst) {
    return faces.flatMap((face) => this.trianglesOf(face, isFirst)).flatMap((triangle) => this.cornersOf(triangle));
  }

  cornersOf(triangle) {
    return [...this.positions.subarray(triangle * 9, triangle * 9 + 9)];
  }

  // A place of a report in the picture, near `face`; null: it is not there. `unit`: millimetres of the report's unit.
  place(position, unit, face) {
    const placed = this.project ? this.project.placed(position, face) : position;
    return placed && placed.map((value, axis) => value * unit - this.origin[axis]);
  }

  // The middle and the radius of a part at the first of its places, and its faces where it is no material, which is not drawn;
  // null: it is not in the picture.
  whereIs(part) {
    const found = this.project?.trianglesOf(part, this.faceOf);
    if (!found?.length) return null;
    const [min, max] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    for (const triangle of found) {
      for (let i = 0; i < 9; i += 1) {
        const value = this.positions[triangle * 9 + i];
        if (value < min[i % 3]) min[i % 3] = value;
        if (value > max[i % 3]) max[i % 3] = value;
      }
    }
    const undrawn = found[0] < this.drawn ? null : { segments: [], faces: found.flatMap((triangle) => this.cornersOf(triangle)), points: [] };
    return { place: min.map((low, axis) => (low + max[axis]) / 2), radius: Math.hypot(...min.map((low, axis) => max[axis] - low)) / 2, undrawn };
  }

  // The whole rim that these faces lie on: open edges that hang together.
  rimAt(faces, isFirst) {
    if (!this.rims) return [];
    this.rimNumbers ??= numberRims(this.rims);
    const wanted = new Set();
    const triangles = new Set(faces.flatMap((face) => this.trianglesOf(face, isFirst)));
    this.rims.halves.forEach((half, at) => { if (triangles.has(Math.floor(half / 3))) wanted.add(this.rimNumbers[at]); });
    return [...this.rimNumbers.keys()].filter((at) => wanted.has(this.rimNumbers[at])).flatMap((at) => [...this.edges.open.subarray(at * 6, at * 6 + 6)]);
  }

  // What shows a witness: its rim, its faces, or its place alone.
  partsOf(code, witness, unit, isFirst = false) {
    const indices = witness.faces.map(({ index }) => index);
    const segments = code === "boundary-loop" ? this.rimAt(indices, isFirst) : code === "self-intersection" ? this.crossingOf(indices, isFirst) : [];
    const faces = code === "boundary-loop" && segments.length ? [] : this.facesAt(indices, isFirst);
    const points = !segments.length && !faces.length && witness.position ? this.place(witness.position, unit, indices[0]) ?? [] : [];
    return { segments, faces, points };
  }

  // The line in which two faces pass through each other.
  crossingOf(faces, isFirst) {
    const [one, other] = faces.map((face) => this.facesAt([face], isFirst));
    if (!one?.length || one.length !== other?.length) return [];
    return one.flatMap((_, at) => (at % 9 ? [] : crossing(one.slice(at, at + 9), other.slice(at, at + 9))));
  }

  // All that is known of a kind of defect: all of its edges, or its witnesses.
  overlayOf(defect, unit) {
    const edges = { "boundary-loop": "open", "non-manifold-edge": "crowded", "orientation-conflict": "turned" }[defect.code];
    if (edges && this.edges?.[edges].length) return { segments: this.edges[edges] };
    const all = defect.witnesses.map((witness) => this.partsOf(defect.code, witness, unit));
    // Where there are lines, the faces beside them would only hide the part.
    const faces = all.flatMap((parts) => (parts.segments.length ? [] : parts.faces));
    return { segments: all.flatMap((parts) => parts.segments), faces, points: all.flatMap((parts) => parts.points) };
  }
}

// A number for each open edge; those that share vertices have the same.
function numberRims({ ends, others }) {
  const at = new Map();
  const link = (vertex, edge) => at.set(vertex, [...(at.get(vertex) ?? []), edge]);
  ends.forEach((vertex, edge) => link(vertex, edge));
  others.forEach((vertex, edge) => link(vertex, edge));
  const numbers = new Int32Array(ends.length).fill(-1);
  for (let first = 0; first < ends.length; first += 1) {
    const open = numbers[first] < 0 ? [first] : [];
    while (open.length) {
      const edge = open.pop();
      if (numbers[edge] >= 0) continue;
      numbers[edge] = first;
      open.push(...at.get(ends[edge]), ...at.get(others[edge]));
    }
  }
  return numbers;
}

// Middle, size and mean direction of drawn parts, to fly to.
export function aim({ segments, faces, points }, position) {
  const all = [segments, faces, points].find((list) => list.length) ?? position;
  const middle = [0, 0, 0];
  for (let i = 0; i < all.length; i += 1) middle[i % 3] += (all[i] * 3) / all.length;
  let radius = 0;
  for (let i = 0; i < all.length; i += 3) radius = Math.max(radius, Math.hypot(...middle.map((value, axis) => all[i + axis] - value)));
  const normal = [0, 0, 0];
  for (let i = 0; i < faces.length; i += 9) {
    const [a, b] = [3, 6].map((from) => [0, 1, 2].map((axis) => faces[i + from + axis] - faces[i + axis]));
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]].forEach((value, axis) => { normal[axis] += value; });
  }
  const length = Math.hypot(...normal);
  // Of a rim, outward from the middle of the part.
  return { place: middle, radius, normal: length > 0 ? normal.map((value) => value / length) : middle };
}
