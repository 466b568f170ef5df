// OBJ: vertices, with their colours where they have some, and polygons. Materials are in files of their own, and not here.

import { Faces, Numbers, lines } from "./bytes.js";
import { Channels, ofCorners } from "./colors.js";

export function readObj(bytes) {
  const vertices = new Numbers(Float64Array);
  const ofVertices = new Channels();
  const count = () => vertices.length / 3;
  const polygons = [];
  let isTextured = false;
  for (const line of joined(lines(bytes))) {
    const parts = line.split(/\s+/);
    if (parts[0] === "v") {
      for (let i = 1; i <= 3; i += 1) vertices.push(Number(parts[i]));
      // One more number would be a weight.
      if (parts.length > 6) ofVertices.add(Number(parts[4]), Number(parts[5]), Number(parts[6]));
      else ofVertices.add();
    } else if (parts[0] === "mtllib") {
      isTextured = true;
    } else if (parts[0] === "f") {
      polygons.push(parts.slice(1).map((part) => index(parseInt(part, 10), count())));
    }
  }
  // Faces may name vertices that come later.
  const faces = new Faces(count);
  for (const polygon of polygons) faces.add(polygon);
  const mesh = faces.mesh(vertices.done());
  return { ...mesh, colors: ofCorners(mesh, ofVertices.done()), isTextured };
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
