// OBJ: vertices and polygons; the rest is not needed for a picture.

import { Faces, Numbers, lines } from "./bytes.js";

export function readObj(bytes) {
  const vertices = new Numbers(Float64Array);
  const count = () => vertices.length / 3;
  const polygons = [];
  for (const line of joined(lines(bytes))) {
    const parts = line.split(/\s+/);
    if (parts[0] === "v") {
      for (let i = 1; i <= 3; i += 1) vertices.push(Number(parts[i]));
    } else if (parts[0] === "f") {
      polygons.push(parts.slice(1).map((part) => index(parseInt(part, 10), count())));
    }
  }
  // Faces may name vertices that come later.
  const faces = new Faces(count);
  for (const polygon of polygons) faces.add(polygon);
  return { vertices: vertices.done(), corners: faces.corners.done(), faceOf: faces.faceOf.done(), faceCount: faces.count };
}

// From 1 forward, or backward from the last vertex so far.
const index = (stated, count) => (stated < 0 ? count + stated : stated - 1);

// A backslash at the end of a line joins it to the next.
function* joined(all) {
  let begun = "";
  for (const line of all) {
    if (line.endsWith("\\")) {
      begun += `${line.slice(0, -1)} `;
    } else {
      yield begun + line;
      begun = "";
    }
  }
  if (begun) yield begun;
}
