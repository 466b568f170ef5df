// Writes glTF files with the built binary and has the Khronos validator judge each: no error and no warning.
//
//   node run.mjs path/to/meshmend folder [file...]
//
// What is written: meshes made here as PLY, OBJ and GLB, with colours of vertices and of faces, materials, textures and holes,
// converted and repaired, as GLB and as glTF; and the files named, repaired or, where that is refused, converted.

import { execFileSync } from "node:child_process";
import { createRequire } from "node:module";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";

// The validator lies beside the lock file's copy, not beside this script.
const require = createRequire(join(process.cwd(), process.env.GLTF_VALIDATOR ?? ".", "package.json"));
const validator = require("gltf-validator");

const [binary, folder, ...files] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });

const corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
const quads = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
const triangles = quads.flatMap(([a, b, c, d]) => [[a, b, c], [a, c, d]]);

/** A cube as PLY text, with colours on vertices or faces, whole or without its last triangle. */
function ply(colors, isOpen) {
  const rgb = (i) => (colors === "none" ? "" : ` ${(i * 37) % 256} ${(i * 91) % 256} ${(i * 13) % 256}`);
  const names = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const faces = isOpen ? triangles.slice(1) : triangles;
  return [
    "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n",
    colors === "vertices" ? names : "",
    `element face ${faces.length}\nproperty list uchar int vertex_indices\n`,
    colors === "faces" ? names : "",
    "end_header\n",
    ...corners.map((p, i) => `${p.join(" ")}${colors === "vertices" ? rgb(i) : ""}\n`),
    ...faces.map((f, i) => `3 ${f.join(" ")}${colors === "faces" ? rgb(i % 4) : ""}\n`),
  ].join("");
}

/** The same as OBJ with texture coordinates and two materials. */
function obj(isOpen) {
  const points = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0.25 0.75\n";
  const faces = (isOpen ? triangles.slice(1) : triangles).map(
    (f, i) => `usemtl ${i % 2 ? "oak" : "tin"}\nf ${f.map((v, k) => (i === 3 ? `${v + 1}` : `${v + 1}/${k + 1}`)).join(" ")}\n`,
  );
  return corners.map((p) => `v ${p.join(" ")}\n`).join("") + points + faces.join("");
}

/** Two cubes that cross each other as OBJ, in two objects of which one has two groups. */
function objects() {
  const faces = (from) => triangles.map((f) => `f ${f.map((v) => v + from).join(" ")}\n`);
  const moved = corners.map((p) => p.map((x) => x + 0.5));
  const points = [...corners, ...moved].map((p) => `v ${p.join(" ")}\n`).join("");
  const [low, high] = [faces(1), faces(9)];
  return `${points}o low\n${low.slice(0, 5).join("")}g top\n${low.slice(5).join("")}o high \u00e9\ng\n${high.join("")}`;
}

/** A GLB of the cube with a picture, a plain material and an extension; all vertices split. */
function glb(isOpen) {
  const list = (isOpen ? triangles.slice(1) : triangles).flat();
  const positions = Float32Array.from(list.flatMap((v) => corners[v]));
  const points = Float32Array.from(list.flatMap((_, i) => [(i % 3) / 2, (i % 5) / 4]));
  const png = Buffer.from(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4z8AAAAMBAQDJ/pLvAAAAAElFTkSuQmCC",
    "base64",
  );
  const parts = [Buffer.from(positions.buffer), Buffer.from(points.buffer), png];
  const offsets = parts.map((_, i) => parts.slice(0, i).reduce((sum, part) => sum + part.length, 0));
  const half = Math.floor(list.length / 6) * 3;
  const accessor = (bufferView, type, from, count) => ({
    bufferView, type, count, componentType: 5126, byteOffset: from * (type === "VEC3" ? 12 : 8),
    ...(type === "VEC3" ? { min: [0, 0, 0], max: [1, 1, 1] } : {}),
  });
  const document = {
    asset: { version: "2.0" },
    extensionsUsed: ["KHR_materials_unlit"],
    scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0, scale: [0.1, 0.1, 0.1] }],
    meshes: [{ primitives: [
      { attributes: { POSITION: 0, TEXCOORD_0: 1 }, material: 0 },
      { attributes: { POSITION: 2 }, material: 1 },
    ] }],
    materials: [
      { name: "skin", pbrMetallicRoughness: { baseColorTexture: { index: 0 } } },
      { pbrMetallicRoughness: { baseColorFactor: [1, 0.5, 0, 1] }, extensions: { KHR_materials_unlit: {} } },
    ],
    textures: [{ source: 0, sampler: 0 }], samplers: [{ wrapS: 33071 }],
    images: [{ bufferView: 2, mimeType: "image/png" }],
    accessors: [
      accessor(0, "VEC3", 0, half), accessor(1, "VEC2", 0, half),
      accessor(0, "VEC3", half, list.length - half),
    ],
    bufferViews: parts.map((part, i) => ({
      buffer: 0, byteOffset: offsets[i], byteLength: part.length, ...(i < 2 ? { byteStride: [12, 8][i] } : {}),
    })),
    buffers: [{ byteLength: parts.reduce((sum, part) => sum + part.length, 0) }],
  };
  const padded = (buffer, fill) => Buffer.concat([buffer, Buffer.alloc((4 - (buffer.length % 4)) % 4, fill)]);
  const text = padded(Buffer.from(JSON.stringify(document)), 32);
  const data = padded(Buffer.concat(parts), 0);
  const word = (value) => { const b = Buffer.alloc(4); b.writeUInt32LE(value); return b; };
  return Buffer.concat([
    Buffer.from("glTF"), word(2), word(28 + text.length + data.length),
    word(text.length), Buffer.from("JSON"), text, word(data.length), Buffer.from("BIN\0"), data,
  ]);
}

function inputs() {
  const made = { "objects.obj": objects(), "textured.obj": obj(false), "open-textured.obj": obj(true), "skin.glb": glb(false), "open-skin.glb": glb(true) };
  for (const colors of ["none", "vertices", "faces"]) {
    made[`${colors}.ply`] = ply(colors, false);
    made[`open-${colors}.ply`] = ply(colors, true);
  }
  for (const [name, content] of Object.entries(made)) {
    writeFileSync(join(folder, name), content);
  }
  return Object.keys(made).map((name) => join(folder, name));
}

/** Runs the binary; true if it wrote a file. Outcomes that are no success are told by its exit code. */
function runs(...args) {
  try {
    execFileSync(binary, args, { stdio: ["ignore", "ignore", "pipe"] });
    return true;
  } catch (error) {
    if (error.status === null || error.status > 100) throw error;
    return false;
  }
}

let judged = 0;
const bad = [];
const judge = async (path) => {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(path)), { uri: basename(path) });
  judged += 1;
  const { numErrors, numWarnings, messages } = report.issues;
  if (numErrors + numWarnings > 0) {
    bad.push(`${path}: ${JSON.stringify(messages.filter((m) => m.severity < 2).slice(0, 5))}`);
  }
};

for (const input of [...inputs(), ...files]) {
  const name = basename(input).replaceAll(".", "-");
  for (const format of ["glb", "gltf"]) {
    for (const command of ["convert", "repair"]) {
      const output = join(folder, `${name}-${command}.${format}`);
      // A solid GLB comes back as it was, which is no file of ours.
      if (basename(input) === `skin.${format}`) continue;
      if (runs(command, input, "-o", output)) await judge(output);
    }
  }
}
console.log(`${judged} files judged by gltf-validator ${validator.version()}`);
if (bad.length > 0 || judged === 0) {
  console.error(bad.join("\n"));
  process.exit(1);
}
