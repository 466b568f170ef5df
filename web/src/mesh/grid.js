// Triangles in the cells of a grid, to find the nearest one and the first one on a ray.

export class Grid {
  constructor(positions) {
    this.positions = positions;
    const count = positions.length / 9;
    this.min = [Infinity, Infinity, Infinity];
    const max = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < positions.length; i += 1) {
      this.min[i % 3] = Math.min(this.min[i % 3], positions[i]);
      max[i % 3] = Math.max(max[i % 3], positions[i]);
    }
    const size = max.map((value, axis) => value - this.min[axis]);
    // About as many cells along the surface as there are triangles, and a bounded number in all.
    this.cell = Math.max(...size) / Math.min(256, Math.max(4, Math.sqrt(count / 2))) || 1;
    this.columns = size.map((length) => Math.floor(length / this.cell) + 1);
    this.cells = new Map();
    for (let triangle = 0; triangle < count; triangle += 1) this.insert(triangle);
    this.seen = new Uint32Array(count);
    this.search = 0;
  }

  at(value, axis) {
    return Math.min(this.columns[axis] - 1, Math.max(0, Math.floor((value - this.min[axis]) / this.cell)));
  }

  key(x, y, z) {
    return x + this.columns[0] * (y + this.columns[1] * z);
  }

  insert(triangle) {
    const p = this.positions;
    const from = triangle * 9;
    const range = [0, 1, 2].map((axis) => {
      const values = [p[from + axis], p[from + 3 + axis], p[from + 6 + axis]];
      return [this.at(Math.min(...values), axis), this.at(Math.max(...values), axis)];
    });
    const corners = [corner(p, from), corner(p, from + 3), corner(p, from + 6)];
    const normal = cross(minus(corners[1], corners[0]), minus(corners[2], corners[0]));
    const reach = 0.87 * this.cell * Math.hypot(...normal); // half of a cell's diagonal
    for (let x = range[0][0]; x <= range[0][1]; x += 1) {
      for (let y = range[1][0]; y <= range[1][1]; y += 1) {
        for (let z = range[2][0]; z <= range[2][1]; z += 1) {
          const middle = [x, y, z].map((column, axis) => this.min[axis] + (column + 0.5) * this.cell);
          if (Math.abs(dot(minus(middle, corners[0]), normal)) > reach * 1.01) continue;
          const key = this.key(x, y, z);
          const cell = this.cells.get(key);
          if (cell) cell.push(triangle);
          else this.cells.set(key, [triangle]);
        }
      }
    }
  }

  // Distance from a point to the nearest triangle: shells of cells from the inside out, until no nearer one can come.
  nearest(point) {
    const middle = point.map((value, axis) => this.at(value, axis));
    // From outside of the grid the shells begin at its nearest cell, which is farther than they count.
    const outside = Math.hypot(...point.map((value, axis) => Math.max(0, this.min[axis] - value, value - this.min[axis] - this.columns[axis] * this.cell)));
    const reach = Math.max(...this.columns);
    this.search += 1;
    const [x, y, z] = point;
    let best = Infinity; // a square
    for (let ring = 0; ring <= reach; ring += 1) {
      if (best <= Math.max(outside, (ring - 1) * this.cell) ** 2) break;
      this.shell(middle, ring, (triangle) => {
        const square = squareTo(x, y, z, this.positions, triangle * 9);
        if (square < best) best = square;
      });
    }
    return Math.sqrt(best);
  }

  shell([cx, cy, cz], ring, visit) {
    for (let x = cx - ring; x <= cx + ring; x += 1) {
      for (let y = cy - ring; y <= cy + ring; y += 1) {
        const isFace = Math.abs(x - cx) === ring || Math.abs(y - cy) === ring;
        for (let z = cz - ring; z <= cz + ring; z += isFace ? 1 : Math.max(1, ring * 2)) this.visit(x, y, z, visit);
      }
    }
  }

  visit(x, y, z, visit) {
    if (x < 0 || y < 0 || z < 0 || x >= this.columns[0] || y >= this.columns[1] || z >= this.columns[2]) return;
    for (const triangle of this.cells.get(this.key(x, y, z)) ?? []) {
      if (this.seen[triangle] === this.search) continue;
      this.seen[triangle] = this.search;
      visit(triangle);
    }
  }

  // Length of the ray, beyond `least`, to the first triangle, where it passes through its back; null where it meets none, or its front.
  ray(from, direction, least) {
    this.search += 1;
    let [best, front] = [Infinity, Infinity];
    const cell = from.map((value, axis) => this.at(value, axis));
    const step = direction.map(Math.sign);
    const along = direction.map((d, axis) => {
      const border = this.min[axis] + (cell[axis] + (d > 0 ? 1 : 0)) * this.cell;
      return d === 0 ? Infinity : (border - from[axis]) / d;
    });
    const each = direction.map((d) => (d === 0 ? Infinity : this.cell / Math.abs(d)));
    while (cell.every((value, axis) => value >= 0 && value < this.columns[axis])) {
      const axis = along.indexOf(Math.min(...along));
      this.visit(...cell, (triangle) => {
        const length = hit(from, direction, this.positions, triangle * 9);
        if (!(length > least && length < Infinity)) return;
        if (isBack(direction, this.positions, triangle * 9)) best = Math.min(best, length);
        else front = Math.min(front, length);
      });
      if (Math.min(best, front) + least <= along[axis] || along[axis] === Infinity) break;
      cell[axis] += step[axis];
      along[axis] += each[axis];
    }
    // Bodies that touch have a front and a back at one place.
    return best < Infinity && best <= front + least ? best : null;
  }
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const corner = (positions, at) => [positions[at], positions[at + 1], positions[at + 2]];

// Square of the distance from a point to a triangle: to its inside where the point is over it, else to the nearest
// edge. Without arrays, because this is what a comparison spends its time on.
export function squareTo(x, y, z, p, at) {
  const [abx, aby, abz] = [p[at + 3] - p[at], p[at + 4] - p[at + 1], p[at + 5] - p[at + 2]];
  const [acx, acy, acz] = [p[at + 6] - p[at], p[at + 7] - p[at + 1], p[at + 8] - p[at + 2]];
  const [nx, ny, nz] = [aby * acz - abz * acy, abz * acx - abx * acz, abx * acy - aby * acx];
  const area = nx * nx + ny * ny + nz * nz;
  let isOver = area > 0;
  let best = Infinity;
  for (let i = 0; i < 9; i += 3) {
    const from = at + i;
    const to = at + (i === 6 ? 0 : i + 3);
    const [ex, ey, ez] = [p[to] - p[from], p[to + 1] - p[from + 1], p[to + 2] - p[from + 2]];
    const [wx, wy, wz] = [x - p[from], y - p[from + 1], z - p[from + 2]];
    if ((ey * wz - ez * wy) * nx + (ez * wx - ex * wz) * ny + (ex * wy - ey * wx) * nz < 0) isOver = false;
    const along = (wx * ex + wy * ey + wz * ez) / (ex * ex + ey * ey + ez * ez || 1);
    const share = along < 0 ? 0 : along > 1 ? 1 : along;
    const [dx, dy, dz] = [wx - share * ex, wy - share * ey, wz - share * ez];
    const square = dx * dx + dy * dy + dz * dz;
    if (square < best) best = square;
  }
  if (!isOver) return best;
  const height = (x - p[at]) * nx + (y - p[at + 1]) * ny + (z - p[at + 2]) * nz;
  return (height * height) / area;
}

function isBack(direction, positions, at) {
  const a = corner(positions, at);
  return dot(direction, cross(minus(corner(positions, at + 3), a), minus(corner(positions, at + 6), a))) > 0;
}

// Lengths of the direction until a ray passes through a triangle (Möller and Trumbore 1997).
export function hit(from, direction, positions, at) {
  const a = corner(positions, at);
  const e1 = minus(corner(positions, at + 3), a);
  const e2 = minus(corner(positions, at + 6), a);
  const p = cross(direction, e2);
  const determinant = dot(e1, p);
  if (determinant === 0) return Infinity;
  const t = minus(from, a);
  const u = dot(t, p) / determinant;
  if (u < 0 || u > 1) return Infinity;
  const q = cross(t, e1);
  const v = dot(direction, q) / determinant;
  return v < 0 || u + v > 1 ? Infinity : dot(e2, q) / determinant;
}
