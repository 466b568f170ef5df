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
