// What the page computes itself, against the service and against brute force.

import assert from "node:assert/strict";
import { createHash, randomBytes } from "node:crypto";
import { Grid, squareTo } from "../../web/src/mesh/grid.js";
import { brokenEdges } from "../../web/src/mesh/edges.js";
import { kept, weld } from "../../web/src/mesh/weld.js";
import { read } from "../../web/src/read/read.js";
import { sha256 } from "../../web/src/read/sha256.js";
import { SAMPLES } from "../../web/src/samples.js";
import { url } from "./browser.mjs";

let seed = 7;
const random = () => { seed = (Math.imul(seed, 1103515245) + 12345) & 0x7fffffff; return seed / 0x7fffffff; };

export async function digests() {
  for (const length of [0, 1, 55, 56, 63, 64, 65, 119, 120, 1000, 100_003]) {
    const bytes = randomBytes(length);
    assert.equal(sha256(bytes), createHash("sha256").update(bytes).digest("hex"), `${length} bytes`);
  }
}

// Each format, as the service writes it, is the same mesh here; edges are counted as the service counts them.
export async function readers() {
  for (const name of ["scan", "bodies"]) {
    const text = SAMPLES[name]();
    const ask = async (path) => (await fetch(`${url}/v1/${path}`, { method: "POST", headers: { "Content-Type": "application/octet-stream" }, body: text })).arrayBuffer();
    const { before } = JSON.parse(Buffer.from(await ask("analyze")).toString());
    const original = weld(read(Buffer.from(text), `${name}.${text.startsWith("OFF") ? "off" : "obj"}`));
    assert.equal(brokenEdges(original).open.length, before.counts.boundary_edges);
    for (const format of ["stl", "obj", "off", "ply"]) {
      const mesh = weld(read(new Uint8Array(await ask(`convert?output_format=${format}`)), `mesh.${format}`));
      assert.equal(mesh.faceOf.length, before.counts.triangles, format);
      assert.ok(kept(original, mesh).every((flag) => flag === 1), `${format}: all triangles are there`);
      assert.ok(kept(mesh, original).every((flag) => flag === 1), `${format}: and no others`);
    }
  }
}

export async function asciiAndPlyText() {
  const facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1e1 0 0\nvertex 0 -1.5E0 +0\nendloop\nendfacet\n";
  const stl = read(Buffer.from(`solid a\n${facet}endsolid a\n`), "a.stl");
  assert.deepEqual([...stl.vertices], [0, 0, 0, 10, 0, 0, 0, -1.5, 0]);
  const ply = read(Buffer.from("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty uchar red\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 9 0 0\n1 9 0 0\n1 9 1 0\n0 9 1 0\n4 0 1 2 3\n"), "a");
  assert.deepEqual([[...ply.corners], [...ply.faceOf], ply.faceCount], [[0, 1, 2, 0, 2, 3], [0, 0], 1]);
  const obj = read(Buffer.from("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3/1 -2//2 \\\n -1\nf 1 2 9\n"), "a.obj");
  assert.deepEqual([[...obj.corners], obj.faceCount], [[0, 1, 2], 2], "a face that names a missing vertex is counted, not drawn");
}

export async function distances() {
  for (let round = 0; round < 30; round += 1) {
    const count = 1 + Math.floor(random() * 60);
    const positions = Float32Array.from({ length: count * 9 }, () => random() * 10);
    // Every other time small triangles: each around its own place.
    if (round % 2) positions.forEach((_, i) => { positions[i] = positions[i - (i % 9) + (i % 3)] + random() * 1.5; });
    const grid = new Grid(positions);
    for (let i = 0; i < 40; i += 1) {
      const point = [random() * 20 - 5, random() * 20 - 5, random() * 20 - 5];
      let least = Infinity;
      for (let triangle = 0; triangle < count; triangle += 1) least = Math.min(least, squareTo(...point, positions, triangle * 9));
      assert.ok(Math.abs(grid.nearest(point) - Math.sqrt(least)) < 1e-9);
    }
    assert.ok(isNearSampled([random() * 10, random() * 10, random() * 10], positions));
  }
}

// The distance to a triangle against that to many points of it.
function isNearSampled(point, p) {
  const STEPS = 60;
  let least = Infinity;
  for (let i = 0; i <= STEPS; i += 1) {
    for (let j = 0; i + j <= STEPS; j += 1) {
      const [u, v] = [i / STEPS, j / STEPS];
      least = Math.min(least, Math.hypot(...[0, 1, 2].map((axis) => u * p[axis] + v * p[3 + axis] + (1 - u - v) * p[6 + axis] - point[axis])));
    }
  }
  const distance = Math.sqrt(squareTo(...point, p, 0));
  return distance <= least + 1e-6 && distance > least - 20 / STEPS;
}
