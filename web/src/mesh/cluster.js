// A coarse copy to draw while the view moves: vertices in one cell of a grid become one (Rossignac and Borrel 1993).

export const COARSE_ABOVE = 300_000; // triangles

export function coarse(positions, bounds, triangles = 120_000) {
  const size = [0, 1, 2].map((axis) => bounds.max[axis] - bounds.min[axis]);
  // A surface in a grid of n cells a side meets about 2 n^2 of them, with two triangles each.
  const cell = Math.max(...size) / Math.sqrt(triangles / 6) || 1;
  const columns = size.map((length) => Math.ceil(length / cell) + 2);
  const cellOf = new Float64Array(positions.length / 3);
  const half = size.map((length) => length / 2);
  const sums = new Map();
  for (let i = 0; i < cellOf.length; i += 1) {
    const at = [0, 1, 2].map((axis) => Math.floor((positions[i * 3 + axis] + half[axis]) / cell));
    const key = at[0] + columns[0] * (at[1] + columns[1] * at[2]);
    cellOf[i] = key;
    let sum = sums.get(key);
    if (!sum) sums.set(key, (sum = [0, 0, 0, 0]));
    for (let axis = 0; axis < 3; axis += 1) sum[axis] += positions[i * 3 + axis];
    sum[3] += 1;
  }
  const kept = [];
  const seen = new Set();
  for (let i = 0; i < cellOf.length; i += 3) {
    const [a, b, c] = [cellOf[i], cellOf[i + 1], cellOf[i + 2]];
    if (a === b || b === c || a === c) continue;
    const key = [a, b, c].sort((m, n) => m - n).join();
    if (seen.has(key)) continue;
    seen.add(key);
    for (const cellKey of [a, b, c]) {
      const [x, y, z, count] = sums.get(cellKey);
      kept.push(x / count, y / count, z / count);
    }
  }
  return Float32Array.from(kept);
}
