// OFF text. The variants with colours and normals have more numbers a line; a face may have a colour after its corners.

import { Faces, FileProblem, lines } from "./bytes.js";
import { Channels, ofCorners } from "./colors.js";

export function readOff(bytes) {
  const all = lines(bytes);
  const next = () => {
    const { value, done } = all.next();
    if (done) throw new FileProblem("truncated");
    return value.split(/\s+/);
  };
  let words = next();
  const head = /^(ST)?(C)?(N)?(4)?OFF$/i.exec(words[0]);
  if (/binary/i.test(words[1] ?? "") || head?.[4]) throw new FileProblem("not-drawn-here");
  if (head) words = words.length > 1 ? words.slice(1) : next();
  const [vertexCount, faceCount] = words.map(Number);
  if (!Number.isSafeInteger(vertexCount) || !Number.isSafeInteger(faceCount) || vertexCount * 2 > bytes.length) {
    throw new FileProblem("unreadable");
  }
  const vertices = new Float64Array(vertexCount * 3);
  const [ofVertices, ofFaces] = [new Channels(), new Channels()];
  const colorAt = head?.[2] ? (head[3] ? 6 : 3) : Infinity;
  for (let i = 0; i < vertexCount; i += 1) {
    const numbers = next();
    for (let axis = 0; axis < 3; axis += 1) vertices[i * 3 + axis] = Number(numbers[axis]);
    if (colorAt < numbers.length) ofVertices.add(...numbers.slice(colorAt, colorAt + 3).map(Number));
    else ofVertices.add();
  }
  const faces = new Faces(() => vertexCount);
  for (let i = 0; i < faceCount; i += 1) {
    const numbers = next().map(Number);
    faces.add(numbers.slice(1, 1 + numbers[0]));
    // One number would be a place in a table that is not there.
    ofFaces.add(...numbers.slice(1 + numbers[0], 4 + numbers[0]));
  }
  const mesh = faces.mesh(vertices);
  return { ...mesh, colors: ofCorners(mesh, ofVertices.done(), ofFaces.done()) };
}
