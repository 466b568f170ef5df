// Edges that a solid does not have, with one triangle, with more than two, and with two
// that run through it in the same direction. Each is given by one of its half-edges.

const EMPTY = 0xffffffff;

export function brokenEdges({ corners }) {
  const found = { open: [], crowded: [], turned: [] };
  for (const { half, total, forward } of edges(corners)) {
    if (total === 1) found.open.push(half);
    else if (total > 2) found.crowded.push(half);
    else if (forward !== 1) found.turned.push(half);
  }
  return Object.fromEntries(Object.entries(found).map(([name, halves]) => [name, Uint32Array.from(halves)]));
}

// For each triangle a number of its piece, in which triangles hang together by edges that just two of them have.
export function piecesOf({ corners }) {
  const partner = new Int32Array(corners.length).fill(-1);
  for (const { half, other, total } of edges(corners)) {
    if (total !== 2) continue;
    partner[half] = other;
    partner[other] = half;
  }
  const pieces = new Int32Array(corners.length / 3).fill(-1);
  const isOpen = [];
  for (let first = 0; first < pieces.length; first += 1) {
    if (pieces[first] >= 0) continue;
    const number = isOpen.push(false) - 1;
    const left = [first];
    pieces[first] = number;
    while (left.length) {
      const triangle = left.pop();
      for (let half = triangle * 3; half < triangle * 3 + 3; half += 1) {
        if (partner[half] < 0) {
          isOpen[number] = true;
          continue;
        }
        const beside = (partner[half] / 3) | 0;
        if (pieces[beside] >= 0) continue;
        pieces[beside] = number;
        left.push(beside);
      }
    }
  }
  return { pieces, isOpen };
}

export const next = (half) => (half % 3 === 2 ? half - 2 : half + 1);

// Ends of half-edges as six numbers each.
export function segmentsOf(halves, positions) {
  const segments = new Float32Array(halves.length * 6);
  halves.forEach((half, i) => {
    segments.set(positions.subarray(half * 3, half * 3 + 3), i * 6);
    segments.set(positions.subarray(next(half) * 3, next(half) * 3 + 3), i * 6 + 3);
  });
  return segments;
}

// Every edge once, with the first half-edge and the last one of it, and how many run from its smaller vertex to its larger one.
function* edges(corners) {
  const size = 2 ** Math.ceil(Math.log2(Math.max(16, corners.length * 2)));
  const first = new Uint32Array(size).fill(EMPTY);
  const last = new Uint32Array(size);
  const total = new Uint16Array(size);
  const forward = new Uint16Array(size);
  for (let half = 0; half < corners.length; half += 1) {
    const a = corners[half];
    const b = corners[next(half)];
    if (a === b) continue;
    const [low, high] = a < b ? [a, b] : [b, a];
    let slot = (Math.imul(low, 0x9e3779b1) ^ Math.imul(high, 0x85ebca6b)) >>> 0;
    slot = (slot ^ (slot >>> 15)) & (size - 1);
    while (first[slot] !== EMPTY && !joins(corners, first[slot], low, high)) slot = (slot + 1) & (size - 1);
    if (first[slot] === EMPTY) first[slot] = half;
    last[slot] = half;
    total[slot] += 1;
    if (a < b) forward[slot] += 1;
  }
  for (let slot = 0; slot < size; slot += 1) {
    if (first[slot] !== EMPTY) yield { half: first[slot], other: last[slot], total: total[slot], forward: forward[slot] };
  }
}

function joins(corners, half, low, high) {
  const a = corners[half];
  const b = corners[next(half)];
  return (a === low && b === high) || (a === high && b === low);
}
