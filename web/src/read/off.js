// OFF text. The variants with colours and normals have more numbers a line; what follows the corners is skipped.

import { Faces, FileProblem, lines } from "./bytes.js";

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
  for (let i = 0; i < vertexCount; i += 1) {
    const numbers = next();
    for (let axis = 0; axis < 3; axis += 1) vertices[i * 3 + axis] = Number(numbers[axis]);
  }
  const faces = new Faces(() => vertexCount);
  for (let i = 0; i < faceCount; i += 1) {
    const numbers = next().map(Number);
    faces.add(numbers.slice(1, 1 + numbers[0]));
  }
  return { vertices, corners: faces.corners.done(), faceOf: faces.faceOf.done(), faceCount: faces.count };
}
