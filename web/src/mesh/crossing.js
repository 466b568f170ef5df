// Where two triangles pass through each other: the line between the outermost points in which an edge of one meets the
// other. Six numbers, or none where they meet in one point or one plane.

import { hit } from "./grid.js";

export function crossing(one, other) {
  const points = [...piercings(one, other), ...piercings(other, one)];
  let best = [];
  let most = 0;
  for (const a of points) {
    for (const b of points) {
      const distance = Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
      if (distance > most) [most, best] = [distance, [...a, ...b]];
    }
  }
  return best;
}

function* piercings(edges, face) {
  for (let i = 0; i < 9; i += 3) {
    const from = [0, 1, 2].map((axis) => edges[i + axis]);
    const along = [0, 1, 2].map((axis) => edges[((i + 3) % 9) + axis] - from[axis]);
    const share = hit(from, along, face, 0);
    if (share >= 0 && share <= 1) yield from.map((value, axis) => value + share * along[axis]);
  }
}
