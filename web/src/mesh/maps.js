// Figures to colour a surface by, one for each corner of each triangle: approximate and told so.

import { piecesOf } from "./edges.js";
import { Grid } from "./grid.js";

// Distance of each triangle from the surface of the other mesh: the largest at its middle, the middles of its edges and
// its corners. Triangles that both have are on it.
export function deviation({ positions }, kept, grid) {
  const values = new Float32Array(positions.length / 3);
  const changed = kept.reduce((sum, isKept) => sum + 1 - isKept, 0);
  const samples = changed > FEW ? SAMPLES.slice(0, 1) : SAMPLES;
  for (let triangle = 0; triangle < kept.length; triangle += 1) {
    if (kept[triangle]) continue;
    const most = Math.max(...samples.map((weights) => grid.nearest(between(positions, triangle * 9, weights))));
    values.fill(most, triangle * 3, triangle * 3 + 3);
  }
  return values;
}

const FEW = 20_000; // of more triangles, the middle alone is measured
const SAMPLES = [[1, 1, 1], [1, 1, 0], [0, 1, 1], [1, 0, 1], [1, 0, 0], [0, 1, 0], [0, 0, 1]];

function between(positions, at, weights) {
  const sum = weights[0] + weights[1] + weights[2];
  return [0, 1, 2].map((axis) => (weights[0] * positions[at + axis] + weights[1] * positions[at + 3 + axis] + weights[2] * positions[at + 6 + axis]) / sum);
}

// Length of the way inward from the middle of each triangle to the opposite wall; NaN where there is none. Stray pieces are no walls.
export function thickness({ corners, positions, flat }, diagonal) {
  const isStray = strays(corners, positions);
  const grid = new Grid(positions.filter((_, i) => !isStray[(i / 9) | 0]));
  const values = new Float32Array(positions.length / 3);
  for (let at = 0; at < positions.length; at += 9) {
    if (isStray[at / 9]) {
      values.fill(NaN, at / 3, at / 3 + 3);
      continue;
    }
    const middle = between(positions, at, [1, 1, 1]);
    const inward = [0, 1, 2].map((axis) => -flat[at / 3 + axis]);
    const length = grid.ray(middle, inward, diagonal * 1e-6);
    values.fill(length ?? NaN, at / 3, at / 3 + 3);
  }
  return values;
}

const STRAY = 0.01; // of the area of the largest piece: an open piece with less is none of the walls

// Which triangles belong to small open pieces: 1 where they do.
function strays(corners, positions) {
  const { pieces, isOpen } = piecesOf({ corners });
  const areas = new Float64Array(isOpen.length);
  pieces.forEach((piece, triangle) => { areas[piece] += areaOf(positions, triangle * 9); });
  const least = STRAY * areas.reduce((most, area) => Math.max(most, area), 0);
  return Uint8Array.from(pieces, (piece) => (isOpen[piece] && areas[piece] < least ? 1 : 0));
}

function areaOf(p, at) {
  const [ax, ay, az] = [p[at + 3] - p[at], p[at + 4] - p[at + 1], p[at + 5] - p[at + 2]];
  const [bx, by, bz] = [p[at + 6] - p[at], p[at + 7] - p[at + 1], p[at + 8] - p[at + 2]];
  return Math.hypot(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx) / 2;
}
