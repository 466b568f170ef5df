// Writes small GLB and glTF files with meshopt compression and the same models without it: `node make.mjs FOLDER`, after
// `npm ci` here; `node make.mjs FOLDER torus`: only the torus, of a million triangles. The streams are those of the package meshoptimizer, the documents those of gltfpack or made here; nothing
// is random, so every run of the same versions writes the same bytes.

import { MeshoptEncoder as encoder } from "meshoptimizer";
import { execFileSync } from "node:child_process";
import { statSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";

const [folder, large] = process.argv.slice(2);
const gltfpack = join(dirname(createRequire(import.meta.url).resolve("gltfpack")), "cli.js");
await encoder.ready;

const [BYTE, UBYTE, SHORT, USHORT, UINT, FLOAT] = [5120, 5121, 5122, 5123, 5125, 5126];
const bytesOf = (array) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength);

// --- what a file is made of: views {data, stride, mode, filter}, of which those with a mode hold indices -----------------

/** A view's bytes in a stream: `how` is {name, version, level} of the encoder. */
function compressed(view, how) {
  const count = view.data.byteLength / view.stride;
  const mode = view.mode ?? "ATTRIBUTES";
  const stream =
    mode === "ATTRIBUTES"
      ? encoder.encodeVertexBufferLevel(bytesOf(view.data), count, view.stride, how.level, how.version)
      : encoder.encodeGltfBuffer(bytesOf(view.data), count, view.stride, mode);
  return { stream, members: { byteStride: view.stride, count, mode, ...(view.filter ? { filter: view.filter } : {}) } };
}

/** A file of one mesh: `attributes` and `indices` name accessors {view, type, componentType, count, ...}. */
function file({ views, attributes, indices, node = {}, how, fallback = false, text = false, required = [] }) {
  const parts = [];
  let length = 0;
  const put = (bytes) => {
    const byteOffset = length;
    const padded = Buffer.alloc(Math.ceil(bytes.length / 4) * 4);
    padded.set(bytes);
    parts.push(padded);
    length += padded.length;
    return { buffer: 0, byteOffset, byteLength: bytes.length };
  };
  let room = 0;
  const bufferViews = views.map((view) => {
    const bytes = bytesOf(view.data);
    const strided = view.mode ? {} : { byteStride: view.stride };
    if (!how) return { ...put(bytes), ...strided };
    const { stream, members } = compressed(view, how);
    const parent = fallback ? put(bytes) : { buffer: 1, byteOffset: room, byteLength: bytes.length };
    room += Math.ceil(bytes.length / 4) * 4;
    return { ...parent, ...strided, extensions: { [how.name]: { ...put(stream), ...members } } };
  });
  const accessors = [...Object.values(attributes), ...(indices ? [indices] : [])].map(({ view, ...rest }) => ({
    bufferView: view,
    ...rest,
  }));
  const numbers = Object.fromEntries(Object.keys(attributes).map((name, i) => [name, i]));
  const data = Buffer.concat(parts);
  const extensions = [...required, ...(how && !fallback ? [how.name] : [])];
  const document = {
    asset: { version: "2.0" },
    ...(extensions.length ? { extensionsRequired: extensions } : {}),
    ...(how || extensions.length ? { extensionsUsed: [...required, ...(how ? [how.name] : [])] } : {}),
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0, ...node }],
    meshes: [{ primitives: [{ attributes: numbers, ...(indices ? { indices: accessors.length - 1 } : {}) }] }],
    accessors,
    bufferViews,
    buffers: [
      { byteLength: data.length, ...(text ? { uri: `data:application/octet-stream;base64,${data.toString("base64")}` } : {}) },
      ...(how && !fallback ? [{ byteLength: room, extensions: { [how.name]: { fallback: true } } }] : []),
    ],
  };
  return text ? JSON.stringify(document) : glb(document, data);
}

function glb(document, data) {
  const json = Buffer.from(JSON.stringify(document));
  const text = Buffer.concat([json, Buffer.alloc((4 - (json.length % 4)) % 4, 32)]);
  const head = Buffer.alloc(20);
  head.write("glTF");
  [2, 28 + text.length + data.length, text.length].forEach((word, i) => head.writeUInt32LE(word, 4 + 4 * i));
  head.write("JSON", 16);
  const middle = Buffer.alloc(8);
  middle.writeUInt32LE(data.length);
  middle.write("BIN\0", 4);
  return Buffer.concat([head, text, middle, data]);
}

const made = [];
function write(name, content) {
  writeFileSync(join(folder, name), content);
  made.push(name);
}

// --- a torus of two blocks of vertices, with colours and texture coordinates -----------------------------------------

const EXT = { name: "EXT_meshopt_compression", version: 0, level: 2 };
const KHR = { name: "KHR_meshopt_compression", version: 1, level: 3 };
const [RINGS, SEGMENTS] = large ? [1000, 500] : [20, 15];
const COUNT = RINGS * SEGMENTS;

const grid = (make) => Array.from({ length: COUNT }, (_, i) => make(Math.floor(i / SEGMENTS), i % SEGMENTS)).flat();
const position = (ring, segment) => {
  const [u, v] = [(2 * Math.PI * ring) / RINGS, (2 * Math.PI * segment) / SEGMENTS];
  const distance = 5 + 2 * Math.cos(v);
  return [distance * Math.cos(u), distance * Math.sin(u), 2 * Math.sin(v)];
};
const positions = Float32Array.from(grid(position));
const colors = Uint8Array.from(grid((r, s) => [r * 12, s * 17, 255 - r * 6 - s * 5, 255 - s]));
const points = Float32Array.from(grid((r, s) => [r / RINGS, s / SEGMENTS]));
const vertex = (r, s) => (r % RINGS) * SEGMENTS + (s % SEGMENTS);
const triangles = grid((r, s) => {
  const [a, b, c, d] = [vertex(r, s), vertex(r + 1, s), vertex(r + 1, s + 1), vertex(r, s + 1)];
  return [a, b, c, a, c, d];
});

const of = (view, type, componentType, count, more = {}) => ({ view, type, componentType, count, ...more });
const bounds = (values, size) => {
  const all = (fold) => Array.from({ length: size }, (_, k) => values.filter((_, i) => i % size === k).reduce((a, b) => fold(a, b)));
  return { min: all(Math.min), max: all(Math.max) };
};
const colorsOf = (view, componentType = UBYTE) => of(view, "VEC4", componentType, COUNT, { normalized: true });
const torus = ({ indexed = Uint32Array, mode = "TRIANGLES", ...more } = {}) => ({
  views: [
    { data: positions, stride: 12 },
    { data: colors, stride: 4 },
    { data: points, stride: 8 },
    { data: indexed.from(triangles), stride: indexed.BYTES_PER_ELEMENT, mode },
  ],
  attributes: {
    POSITION: of(0, "VEC3", FLOAT, COUNT, bounds(positions, 3)),
    COLOR_0: colorsOf(1),
    TEXCOORD_0: of(2, "VEC2", FLOAT, COUNT),
  },
  indices: of(3, "SCALAR", indexed === Uint16Array ? USHORT : UINT, triangles.length),
  ...more,
});
const padded = (source, size, stride) => {
  const out = new source.constructor((source.length / size) * stride);
  source.forEach((value, i) => (out[Math.floor(i / size) * stride + (i % size)] = value));
  return out;
};

write("torus.glb", file(torus()));
write("torus-ext.glb", file(torus({ how: EXT })));
write("torus-khr.glb", file(torus({ how: KHR })));

// --- the same in quantized coordinates ---------------------------------------------------------------------------------

const shorts = padded(Int16Array.from(positions, (c) => Math.round((c / 7) * 32767)), 3, 4);
const quantized = (how) => {
  const parts = torus({ how, node: { scale: [7, 7, 7] }, required: ["KHR_mesh_quantization"] });
  parts.views[0] = { data: shorts, stride: 8 };
  parts.attributes.POSITION = of(0, "VEC3", SHORT, COUNT, { normalized: true });
  return parts;
};
write("quantized.glb", file(quantized()));
write("quantized-ext.glb", file(quantized(EXT)));
write("quantized-khr.glb", file(quantized(KHR)));

if (large) process.exit();

// --- the torus in every other way ------------------------------------------------------------------------------------------

write("torus-ext.gltf", file(torus({ how: EXT, text: true })));
write("torus-16-bit.glb", file(torus({ how: EXT, indexed: Uint16Array })));
write("torus-sequence.glb", file(torus({ how: KHR, mode: "INDICES" })));
write("torus-sequence-16-bit.glb", file(torus({ how: EXT, mode: "INDICES", indexed: Uint16Array })));
write("torus-fallback.glb", file(torus({ how: EXT, fallback: true })));

const exponential = torus({ how: EXT });
exponential.views[0] = { data: encoder.encodeFilterExp(positions, COUNT, 12, 15, "SharedVector"), stride: 12, filter: "EXPONENTIAL" };
exponential.views[2] = { data: encoder.encodeFilterExp(points, COUNT, 8, 12, "Separate"), stride: 8, filter: "EXPONENTIAL" };
write("torus-exponential.glb", file(exponential));

const shares = Float32Array.from(colors, (c) => c / 255);
for (const bits of [8, 16]) {
  const colored = torus({ how: KHR });
  colored.views[1] = { data: encoder.encodeFilterColor(shares, COUNT, bits / 2, bits), stride: bits / 2, filter: "COLOR" };
  colored.attributes.COLOR_0 = colorsOf(1, bits === 8 ? UBYTE : USHORT);
  write(`torus-color-${bits}.glb`, file(colored));
}

// All attributes of a vertex in one element, with accessors that begin within it.
const interleaved = torus({ how: KHR });
const whole = new Uint8Array(COUNT * 24);
for (let i = 0; i < COUNT; i++) {
  whole.set(bytesOf(positions).subarray(12 * i, 12 * i + 12), 24 * i);
  whole.set(colors.subarray(4 * i, 4 * i + 4), 24 * i + 12);
  whole.set(bytesOf(points).subarray(8 * i, 8 * i + 8), 24 * i + 16);
}
interleaved.views.splice(0, 3, { data: whole, stride: 24 });
interleaved.attributes.COLOR_0 = { ...colorsOf(0), byteOffset: 12 };
interleaved.attributes.TEXCOORD_0 = { ...interleaved.attributes.TEXCOORD_0, view: 0, byteOffset: 16 };
interleaved.indices.view = 1;
write("torus-interleaved.glb", file(interleaved));

// --- what makes version 1 store shorts and rotated words: ramps of 16 bits, and floats that change in few bits -----------

const ramp = (how) => {
  const count = 100;
  const heights = Uint16Array.from({ length: 4 * count }, (_, i) => (i % 4 < 3 ? (i >> 2) * (i % 4 === 0 ? 300 : 515) + (i >> 2) ** 2 : 0));
  return {
    how,
    required: ["KHR_mesh_quantization"],
    views: [{ data: heights, stride: 8 }],
    attributes: { POSITION: of(0, "VEC3", USHORT, count) },
  };
};
write("ramp.glb", file(ramp()));
write("ramp-khr.glb", file(ramp(KHR)));

const spread = (how) => {
  const count = 250;
  const noise = (i) => (Math.imul(i, 2654435761) >>> 0) / 2 ** 32;
  const values = Float32Array.from({ length: 3 * count }, (_, i) => (i % 3 === 2 ? noise(i) - 0.5 : noise(i) * 2 ** (i % 7)));
  return { how, views: [{ data: values, stride: 12 }], attributes: { POSITION: of(0, "VEC3", FLOAT, count) } };
};
write("spread.glb", file(spread()));
write("spread-ext.glb", file(spread(EXT)));
write("spread-khr.glb", file(spread(KHR)));

// --- unit vectors and quaternions, whose first components are the positions of triangles -------------------------------

const units = 99;
const unit = (size) => Array.from({ length: units }, (_, i) => {
  const raw = Array.from({ length: size }, (_, k) => Math.sin(1 + i * (k + 1.7) + k * k));
  const length = Math.hypot(...raw);
  return raw.map((c) => c / length);
});
const vectors = unit(3);
const quaternions = unit(4).map((q) => {
  // The greatest component is positive: the filter leaves its sign out.
  const greatest = q.reduce((best, c) => (Math.abs(c) > Math.abs(best) ? c : best));
  return q.map((c) => c * Math.sign(greatest));
});
const first = (list) => Float32Array.from(list.flatMap((v) => v.slice(0, 3)));
const cloud = (data, stride, componentType, more) => ({
  views: [{ data, stride, ...more }],
  attributes: { POSITION: of(0, "VEC3", componentType, units, componentType === FLOAT ? {} : { normalized: true }) },
  ...(more ? { required: ["KHR_mesh_quantization"] } : {}),
});
const withW = Float32Array.from(vectors.flatMap((v) => [...v, 1]));
write("vectors.glb", file(cloud(first(vectors), 12, FLOAT)));
for (const [bits, stride] of [[8, 4], [6, 4], [12, 8], [16, 8]]) {
  const data = encoder.encodeFilterOct(withW, units, stride, bits);
  const filtered = cloud(data, stride, stride === 4 ? BYTE : SHORT, { filter: "OCTAHEDRAL" });
  write(`vectors-${bits}-bit.glb`, file({ ...filtered, how: EXT }));
}
write("quaternions.glb", file(cloud(first(quaternions), 12, FLOAT)));
for (const bits of [12, 16]) {
  const data = encoder.encodeFilterQuat(Float32Array.from(quaternions.flat()), units, 8, bits);
  write(`quaternions-${bits}-bit.glb`, file({ ...cloud(data, 8, SHORT, { filter: "QUATERNION" }), how: EXT }));
}

// --- 22,650 vertices in 89 blocks: whole numbers that the test makes again ---------------------------------------

const [WIDTH, HEIGHT] = [150, 151];
const field = Int16Array.from({ length: 4 * WIDTH * HEIGHT }, (_, i) => {
  const [x, y] = [(i >> 2) % WIDTH, Math.floor((i >> 2) / WIDTH)];
  return [100 * x, 100 * y, x * (WIDTH - x) - y * (HEIGHT - y) + ((x * y) % 7), 0][i % 4];
});
const cells = [];
for (let y = 0; y + 1 < HEIGHT; y++) {
  for (let x = 0; x + 1 < WIDTH; x++) {
    const v = y * WIDTH + x;
    cells.push(v, v + 1, v + WIDTH + 1, v, v + WIDTH + 1, v + WIDTH);
  }
}
write("field-khr.glb", file({
  how: KHR,
  required: ["KHR_mesh_quantization"],
  views: [{ data: field, stride: 8 }, { data: Uint32Array.from(cells), stride: 4, mode: "TRIANGLES" }],
  attributes: { POSITION: of(0, "VEC3", SHORT, WIDTH * HEIGHT) },
  indices: of(1, "SCALAR", UINT, cells.length),
}));

// --- the documents of another program ----------------------------------------------------------------------------------------

const torusPath = join(folder, "torus.glb");
for (const [name, ...options] of [["gltfpack-ext.glb", "-cc"], ["gltfpack-floats.glb", "-c", "-vpf", "-vtf"], ["gltfpack-khr.glb", "-ce", "khr", "-cc"]]) {
  execFileSync(process.execPath, [gltfpack, "-i", torusPath, "-o", join(folder, name), ...options], { stdio: ["ignore", "ignore", "inherit"] });
  made.push(name);
}
for (const name of made) console.log(`${statSync(join(folder, name)).size}\t${name}`);
