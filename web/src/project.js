// The parts of a 3MF in the picture: reports number faces through all parts, each part once and in its own coordinates;
// where they take all parts together, as the build has them.

import { moved } from "./read/threemf.js";

export class Project {
  // As the reader of 3MF tells it.
  constructor({ objects, order }) {
    this.objects = objects;
    this.order = order;
    this.parts = [];
    this.count = order.reduce((sum, at) => sum + objects[at].count, 0);
    this.isWhole = true; // not so where a report is about other faces than those of all material
  }

  // Takes the parts of a report about so many `faces`. Volumes are ranges of the faces of one object, one after the other; the
  // picture may have them apart.
  setParts(parts, faces = this.count) {
    this.isWhole = faces === this.count;
    this.parts = parts.map((part, at) => {
      const face = part.first_face - parts.find((other) => other.path === part.path && other.object === part.object).first_face;
      const object = this.objects.find(({ path, id, from, count }) => path.toLowerCase() === part.path.toLowerCase() && id === part.object && from <= face && face < from + count);
      return { object, from: part.first_face, until: parts[at + 1]?.first_face ?? Infinity, inObject: face - object?.from };
    });
  }

  partOf(face) {
    return this.parts.length === 1 ? this.parts[0] : this.parts.find(({ from, until }) => from <= face && face < until);
  }

  // The number in the picture of a face that a report names; -1: it is not there.
  face(named) {
    if (this.parts.length) {
      const part = this.partOf(named);
      return part?.object ? part.object.first + part.inObject + named - part.from : -1;
    }
    if (!this.isWhole) return -1;
    let left = named;
    for (const at of this.order) {
      const { first, count } = this.objects[at];
      if (left < count) return first + left;
      left -= count;
    }
    return -1;
  }

  // A place that a report names, where the build has it first; null: it is not in the picture.
  placed(position, face) {
    if (this.parts.length === 0) return position;
    const matrix = this.partOf(face)?.object?.places[0];
    return matrix ? moved(position, matrix) : null;
  }

  // Triangles of the picture that are the part number `part`, at the first of its places.
  trianglesOf(part, faceOf) {
    const { object, from, until, inObject } = this.parts[part];
    if (!object) return [];
    const begin = object.first + inObject;
    const end = Math.min(object.first + object.count, begin + until - from);
    const found = [];
    faceOf.forEach((face, at) => { if (face >= begin && face < end && faceOf[at - 1] !== face) found.push(at); });
    return found;
  }
}

// Of a mesh that does not say which face is which part's.
export const NO_PARTS = new Project({ objects: [], order: [] });
