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

// Which triangles of `mesh` are triangles of `other`, with 32-bit coordinates and in any direction: 1 where they are.
export function kept(mesh, other) {
  const ids = new Positions(other.vertices.length / 3 + 1);
  const rounded = Float32Array.from(other.vertices);
  const scaled = Float32Array.from(mesh.vertices);
  const idOf = (from, at, adds) => {
    const [x, y, z] = [from[at * 3] + 0, from[at * 3 + 1] + 0, from[at * 3 + 2] + 0];
    const slot = ids.slot(x, y, z, rounded);
    if (ids.isEmpty(slot)) {
      if (!adds) return -1;
      ids.slots[slot] = at;
    }
    return ids.slots[slot];
  };
  const triangles = new Set();
  each(other, (corners) => triangles.add(key(corners.map((at) => idOf(rounded, at, true)))));
  const result = new Uint8Array(mesh.faceOf.length);
  each(mesh, (corners, triangle) => {
    const found = corners.map((at) => idOf(scaled, at, false));
    result[triangle] = found.every((id) => id >= 0) && triangles.has(key(found)) ? 1 : 0;
  });
  return result;
}

function each({ corners }, visit) {
  for (let at = 0; at < corners.length; at += 3) {
    visit([corners[at], corners[at + 1], corners[at + 2]], at / 3);
  }
}

// Three ids in one key that does not depend on their order.
function key(ids) {
  const [a, b, c] = ids.sort((m, n) => m - n);
  return `${a},${b},${c}`;
}
