// Vertices at one position become one, exactly, as the service welds.

const EMPTY = 0xffffffff;

// A hash of three numbers by their bits.
export class Positions {
  constructor(count) {
    this.size = 2 ** Math.ceil(Math.log2(Math.max(16, count * 2)));
    this.slots = new Uint32Array(this.size).fill(EMPTY);
    this.numbers = new Float64Array(3);
    this.bits = new Uint32Array(this.numbers.buffer);
  }

  // The slot of this position: one that holds it, or the empty one where it belongs.
  slot(x, y, z, vertices) {
    // Minus zero is where zero is.
    this.numbers[0] = x + 0;
    this.numbers[1] = y + 0;
    this.numbers[2] = z + 0;
    let hash = 0;
    for (let i = 0; i < 6; i += 1) hash = Math.imul(hash ^ this.bits[i], 0x9e3779b1) ^ (hash >>> 15);
    let slot = (hash ^ (hash >>> 16)) & (this.size - 1);
    for (; this.slots[slot] !== EMPTY; slot = (slot + 1) & (this.size - 1)) {
      const at = this.slots[slot] * 3;
      if (vertices[at] === x && vertices[at + 1] === y && vertices[at + 2] === z) break;
    }
    return slot;
  }

  isEmpty(slot) {
    return this.slots[slot] === EMPTY;
  }
}

export function weld(mesh) {
  const { vertices } = mesh;
  const count = vertices.length / 3;
  const seen = new Positions(count);
  const first = new Uint32Array(count);
  for (let i = 0; i < count; i += 1) {
    const slot = seen.slot(vertices[i * 3], vertices[i * 3 + 1], vertices[i * 3 + 2], vertices);
    if (seen.isEmpty(slot)) seen.slots[slot] = i;
    first[i] = seen.slots[slot];
  }
  return { ...mesh, corners: mesh.corners.map((corner) => first[corner]) };
}

// Which triangles of `mesh` are triangles of `other`, with 32-bit coordinates in `unit` and in any direction: 1 where they are.
export function kept(mesh, other, unit = 1) {
  const [own, others] = [mesh, other].map(({ vertices }) => Float32Array.from(vertices, (value) => value / unit));
  const ids = new Positions(other.vertices.length / 3);
  const ofOther = numbered(other.vertices.length / 3, (at) => {
    const slot = slotOf(ids, others, at, others);
    if (ids.isEmpty(slot)) ids.slots[slot] = at;
    return ids.slots[slot];
  });
  const ofOwn = numbered(mesh.vertices.length / 3, (at) => {
    const slot = slotOf(ids, own, at, others);
    return ids.isEmpty(slot) ? -1 : ids.slots[slot];
  });
  const wanted = sortedCorners(other, ofOther);
  const triangles = new Positions(wanted.length / 3);
  for (let at = 0; at < wanted.length / 3; at += 1) {
    const slot = slotOf(triangles, wanted, at, wanted);
    if (triangles.isEmpty(slot)) triangles.slots[slot] = at;
  }
  const asked = sortedCorners(mesh, ofOwn);
  return Uint8Array.from(mesh.faceOf, (_, at) => (asked[at * 3] >= 0 && !triangles.isEmpty(slotOf(triangles, asked, at, wanted)) ? 1 : 0));
}

const numbered = (count, of) => Float64Array.from({ length: count }, (_, at) => of(at));
const slotOf = (positions, from, at, vertices) => positions.slot(from[at * 3], from[at * 3 + 1], from[at * 3 + 2], vertices);

// The numbers of the corners of each triangle, the smallest first.
function sortedCorners({ corners }, numbers) {
  const sorted = Float64Array.from(corners, (corner) => numbers[corner]);
  for (let at = 0; at < sorted.length; at += 3) sorted.subarray(at, at + 3).sort();
  return sorted;
}
