// The bed under the part: squares of a power of ten in millimetres, as large as is needed.

import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments } from "three";

export function stepFor(size) {
  return 10 ** Math.floor(Math.log10(Math.max(size[0], size[1], 1e-12) * 0.9));
}

export function bed(size, color) {
  const step = stepFor(size);
  const half = (Math.ceil((Math.max(size[0], size[1]) * 0.75) / step) + 1) * step;
  const z = -size[2] / 2 - Math.max(...size) * 0.001;
  const points = [];
  for (let at = -half; at <= half + step / 2; at += step) {
    points.push(at, -half, z, at, half, z, -half, at, z, half, at, z);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(points), 3));
  const lines = new LineSegments(geometry, new LineBasicMaterial({ color, transparent: true, opacity: 0.45 }));
  lines.frustumCulled = false;
  return lines;
}
