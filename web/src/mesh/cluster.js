// Coarse copies to draw while the view moves: vertices in one cell of a grid become one (Rossignac and Borrel 1993).

export const COARSE_ABOVE = 30_000; // triangles

// A surface in a grid of n cells a side meets about 2 n^2 of them, with two triangles each. `positions` are those of
// corners, `corners` their vertices. Each vertex of the copy has the mean direction of the triangles around it, and where there are
// colours that of one of its corners.
export function coarse({ positions, corners, flat, colors }, bounds, triangles) {
  const size = [0, 1, 2].map((axis) => bounds.max[axis] - bounds.min[axis]);
  const cell = Math.max(...size) / Math.sqrt(triangles / 6) || 1;
  const columns = size.map((length) => Math.ceil(length / cell) + 2);
  const { cellOf, sums } = cells(positions, corners, ([x, y, z]) =>
    Math.floor((x + size[0] / 2) / cell) + columns[0] * (Math.floor((y + size[1] / 2) / cell) + columns[1] * Math.floor((z + size[2] / 2) / cell)));
  const count = sums.length / 7;
  const kept = [];
  const seen = new Set();
  for (let i = 0; i < corners.length; i += 3) {
    const [a, b, c] = [cellOf[corners[i]], cellOf[corners[i + 1]], cellOf[corners[i + 2]]];
    for (const at of [a, b, c]) for (let axis = 0; axis < 3; axis += 1) sums[at * 7 + 4 + axis] += flat[i + axis];
    if (a === b || b === c || a === c) continue;
    const [low, high] = [Math.min(a, b, c), Math.max(a, b, c)];
    const key = (low * count + (a + b + c - low - high)) * count + high;
    if (seen.has(key)) continue;
    seen.add(key);
    kept.push(a, b, c);
  }
  const copy = { positions: new Float32Array(count * 3), normals: new Int8Array(count * 4), index: Uint32Array.from(kept) };
  for (let at = 0; at < count; at += 1) {
    const [x, y, z, total, ...normal] = sums.slice(at * 7, at * 7 + 7);
    copy.positions.set([x / total, y / total, z / total], at * 3);
    const length = Math.hypot(...normal) || 1;
    copy.normals.set(normal.map((value) => (127 * value) / length), at * 4);
  }
  if (colors) copy.colors = colorsOf(colors, corners, cellOf, count);
  return copy;
}

function colorsOf(colors, corners, cellOf, count) {
  const [own, all] = [new Uint32Array(count), new Uint32Array(colors.buffer, colors.byteOffset, corners.length)];
  corners.forEach((corner, at) => { own[cellOf[corner]] ||= all[at]; });
  return new Uint8Array(own.buffer);
}

// The cell of each vertex, numbered as they come, and of each cell the sum of its places, their number, and room for a direction.
function cells(positions, corners, keyOf) {
  const cellOf = new Int32Array(corners.reduce((most, corner) => Math.max(most, corner), 0) + 1).fill(-1);
  const numbers = new Map();
  const sums = [];
  for (let i = 0; i < corners.length; i += 1) {
    if (cellOf[corners[i]] >= 0) continue;
    const place = [positions[i * 3], positions[i * 3 + 1], positions[i * 3 + 2]];
    const key = keyOf(place);
    let number = numbers.get(key);
    if (number === undefined) {
      number = numbers.size;
      numbers.set(key, number);
      sums.push(0, 0, 0, 0, 0, 0, 0);
    }
    cellOf[corners[i]] = number;
    for (let axis = 0; axis < 3; axis += 1) sums[number * 7 + axis] += place[axis];
    sums[number * 7 + 3] += 1;
  }
  return { cellOf, sums };
}
