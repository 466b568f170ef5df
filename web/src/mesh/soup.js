// What the graphics card gets: triangles one by one, in millimetres around the middle of the part.

const SHARP = Math.cos((40 * Math.PI) / 180); // neighbours that bend more keep a crease when shaded smoothly

export function boundsOf({ vertices, corners }) {
  const min = [Infinity, Infinity, Infinity];
  const max = [-Infinity, -Infinity, -Infinity];
  for (const corner of corners) {
    for (let axis = 0; axis < 3; axis += 1) {
      const value = vertices[corner * 3 + axis];
      if (value < min[axis]) min[axis] = value;
      if (value > max[axis]) max[axis] = value;
    }
  }
  return { min, max };
}

const BINS = 1024; // along an axis, to find gaps
const FEW = 0.15; // of the triangles may be far away
const FAR = 10; // times the size of the part

// Bounds of the part without the few triangles that lie far away from it, and how many these are.
export function bulkOf({ vertices, corners }, bounds) {
  const isFar = new Uint8Array(corners.length / 3);
  const first = new Uint16Array(isFar.length);
  let far = 0;
  for (let axis = 0; axis < 3; axis += 1) {
    const low = bounds.min[axis];
    const scale = (BINS - 1) / (bounds.max[axis] - low);
    if (!(scale < Infinity)) continue;
    const [begins, ends] = [new Uint32Array(BINS), new Uint32Array(BINS)];
    for (let at = 0; at < isFar.length; at += 1) {
      const a = vertices[corners[at * 3] * 3 + axis];
      const b = vertices[corners[at * 3 + 1] * 3 + axis];
      const c = vertices[corners[at * 3 + 2] * 3 + axis];
      first[at] = ((a < b ? (a < c ? a : c) : b < c ? b : c) - low) * scale;
      begins[first[at]] += 1;
      ends[Math.floor(((a > b ? (a > c ? a : c) : b > c ? b : c) - low) * scale)] += 1;
    }
    const { from, to, count } = crowd(begins, ends);
    if (count === isFar.length || count < isFar.length * (1 - FEW) || (to - from + 1) * FAR > BINS) continue;
    for (let at = 0; at < isFar.length; at += 1) {
      if (isFar[at] || (first[at] >= from && first[at] <= to)) continue;
      isFar[at] = 1;
      far += 1;
    }
  }
  return { far, bounds: far ? boundsOf({ vertices, corners: corners.filter((_, at) => !isFar[(at / 3) | 0]) }) : bounds };
}

// The bins from one gap to the next in which most triangles begin.
function crowd(begins, ends) {
  let most = { count: 0 };
  let now = null;
  let open = 0;
  begins.forEach((count, at) => {
    if (open === 0 && count > 0) now = { from: at, count: 0 };
    open += count;
    if (now) now.count += count;
    open -= ends[at];
    if (open > 0 || !now) return;
    now.to = at;
    if (now.count > most.count) most = now;
    now = null;
  });
  return most;
}

export function positionsOf({ vertices, corners }, origin) {
  const positions = new Float32Array(corners.length * 3);
  for (let i = 0; i < corners.length; i += 1) {
    for (let axis = 0; axis < 3; axis += 1) {
      const value = vertices[corners[i] * 3 + axis] - origin[axis];
      positions[i * 3 + axis] = Number.isFinite(value) ? value : 0;
    }
  }
  return positions;
}

// Unit normals of triangles; zero where there is none.
export function faceNormals(positions) {
  const normals = new Float32Array(positions.length / 3);
  for (let p = 0; p < positions.length; p += 9) {
    const [ax, ay, az] = [positions[p + 3] - positions[p], positions[p + 4] - positions[p + 1], positions[p + 5] - positions[p + 2]];
    const [bx, by, bz] = [positions[p + 6] - positions[p], positions[p + 7] - positions[p + 1], positions[p + 8] - positions[p + 2]];
    const [x, y, z] = [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];
    const length = Math.hypot(x, y, z) || 1;
    normals.set([x / length, y / length, z / length], p / 3);
  }
  return normals;
}

// Normals of corners as bytes: the mean of those triangles at the vertex that bend little against the corner's own.
export function cornerNormals({ corners }, flat, vertexCount) {
  const begin = new Uint32Array(vertexCount + 1);
  for (const corner of corners) begin[corner + 1] += 1;
  for (let i = 0; i < vertexCount; i += 1) begin[i + 1] += begin[i];
  const fill = begin.slice();
  const around = new Uint32Array(corners.length);
  corners.forEach((corner, at) => { around[fill[corner]] = (at / 3) | 0; fill[corner] += 1; });
  const result = new Int8Array(corners.length * 4);
  for (let i = 0; i < corners.length; i += 1) {
    const own = ((i / 3) | 0) * 3;
    let [x, y, z] = [0, 0, 0];
    for (let k = begin[corners[i]]; k < begin[corners[i] + 1]; k += 1) {
      const n = around[k] * 3;
      if (flat[n] * flat[own] + flat[n + 1] * flat[own + 1] + flat[n + 2] * flat[own + 2] < SHARP) continue;
      x += flat[n];
      y += flat[n + 1];
      z += flat[n + 2];
    }
    const scale = 127 / (Math.hypot(x, y, z) || 1);
    result[i * 4] = x * scale;
    result[i * 4 + 1] = y * scale;
    result[i * 4 + 2] = z * scale;
  }
  return result;
}
