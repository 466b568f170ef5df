// What the page computes itself, against the service and against brute force.

import assert from "node:assert/strict";
import { createHash, randomBytes } from "node:crypto";
import { deflateRawSync } from "node:zlib";
import { Grid, squareTo } from "../../web/src/mesh/grid.js";
import { coarse } from "../../web/src/mesh/cluster.js";
import { brokenEdges } from "../../web/src/mesh/edges.js";
import { boundsOf, bulkOf, faceNormals, positionsOf } from "../../web/src/mesh/soup.js";
import { kept, weld } from "../../web/src/mesh/weld.js";
import { paintOf } from "../../web/src/read/properties.js";
import { read } from "../../web/src/read/read.js";
import { sha256 } from "../../web/src/read/sha256.js";
import { Picture } from "../../web/src/places.js";
import { SAMPLES } from "../../web/src/samples.js";
import { stored } from "../../web/src/stored.js";
import { url } from "./browser.mjs";
import { projectsWithPocket } from "./pocket.mjs";

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
    const original = weld(await read(Buffer.from(text), `${name}.${text.startsWith("OFF") ? "off" : "obj"}`));
    assert.equal(brokenEdges(original).open.length, before.counts.boundary_edges);
    for (const format of ["stl", "obj", "off", "ply", "3mf"]) {
      const mesh = weld(await read(new Uint8Array(await ask(`convert?output_format=${format}`)), `mesh.${format}`));
      assert.equal(mesh.faceOf.length, before.counts.triangles, format);
      assert.ok(kept(original, mesh).every((flag) => flag === 1), `${format}: all triangles are there`);
      assert.ok(kept(mesh, original).every((flag) => flag === 1), `${format}: and no others`);
    }
  }
}

export async function asciiAndPlyText() {
  const facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1e1 0 0\nvertex 0 -1.5E0 +0\nendloop\nendfacet\n";
  const stl = await read(Buffer.from(`solid a\n${facet}endsolid a\n`), "a.stl");
  assert.deepEqual([...stl.vertices], [0, 0, 0, 10, 0, 0, 0, -1.5, 0]);
  const ply = await read(Buffer.from("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty uchar red\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 9 0 0\n1 9 0 0\n1 9 1 0\n0 9 1 0\n4 0 1 2 3\n"), "a");
  assert.deepEqual([[...ply.corners], [...ply.faceOf], ply.faceCount], [[0, 1, 2, 0, 2, 3], [0, 0], 1]);
  const obj = await read(Buffer.from("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3/1 -2//2 \\\n -1\nf 1 2 9\n"), "a.obj");
  assert.deepEqual([[...obj.corners], obj.faceCount], [[0, 1, 2], 2], "a face that names a missing vertex is counted, not drawn");
}

// Each part of a 3MF is read where the build has it, and faces of reports are found in it: of parts by themselves, and of
// the same file as one mesh.
export async function projects() {
  const bytes = SAMPLES.project();
  const ask = async (path) => Buffer.from(await (await fetch(`${url}/v1/${path}`, { method: "POST", headers: { "Content-Type": "application/octet-stream" }, body: bytes })).arrayBuffer());
  const mesh = await read(new Uint8Array(bytes), "project.3mf");
  const scene = await read(new Uint8Array(await ask("convert?output_format=stl")), "scene.stl");
  const [own, others] = [mesh, scene].map((one) => weld({ ...one, vertices: one.vertices.map(Math.fround) }));
  assert.equal(own.faceOf.length, others.faceOf.length);
  assert.ok(kept(own, others).every((flag) => flag === 1) && kept(others, own).every((flag) => flag === 1), "the scene of the service");

  const { parts, before } = JSON.parse((await ask("analyze")).toString());
  assert.deepEqual(parts.map(({ name, instances }) => [name, instances]), [["Plate", 1], ["Cup", 2], ["Ball", 1]]);
  const corner = (triangle, at) => [0, 1, 2].map((axis) => mesh.vertices[mesh.corners[triangle * 3 + at] * 3 + axis]);
  const places = (triangle) => [0, 1, 2].map((at) => corner(triangle, at));
  const picture = new Picture({ ...mesh, origin: [0, 0, 0] });
  picture.project.setParts(parts);
  const rim = before.defects.find(({ code }) => code === "boundary-loop").witnesses[0];
  for (const { index } of rim.faces) {
    assert.equal(picture.trianglesOf(index).length, 2, "the cup is there twice");
    assert.equal(picture.trianglesOf(index, true).length, 1);
  }
  const place = picture.place(rim.position, 1, rim.faces[0].index);
  assert.ok(rim.faces.some(({ index }) => places(picture.trianglesOf(index, true)[0]).some((point) => point.every((value, axis) => Math.abs(value - place[axis]) < 1e-9))), "a witness lies on its face");

  picture.project.setParts([]);
  for (let face = 0; face < mesh.faceCount; face += 1) {
    const wanted = [0, 1, 2].map((at) => [0, 1, 2].map((axis) => scene.vertices[face * 9 + at * 3 + axis]).join());
    const found = picture.trianglesOf(face).map((triangle) => places(triangle).map((point) => point.map(Math.fround).join()));
    assert.ok(found.some((points) => points.join(";") === wanted.join(";")), `face ${face} of the whole`);
  }
  assert.equal(picture.place([1, 2, 3], 1, 0).join(), "1,2,3", "as one mesh, places are those of the build");

  // Without parts that are not printed, such as negative ones, faces have other numbers: none is lit rather than a wrong one.
  picture.project.setParts([], mesh.faceCount - 12);
  assert.deepEqual(picture.trianglesOf(3), []);
  assert.equal(picture.place([1, 2, 3], 1, 3).join(), "1,2,3");
}

// What is no material, as two kinds of slicers note it, is not drawn, as the service leaves it out of one mesh; places in it are
// found nevertheless. Faces of one mesh of all parts are those of what is printed.
export async function notPrinted() {
  const ask = async (path, bytes) => Buffer.from(await (await fetch(`${url}/v1/${path}`, { method: "POST", headers: { "Content-Type": "application/octet-stream" }, body: bytes })).arrayBuffer());
  const kinds = [["NegativeVolume", "negative_part"], ["ParameterModifier", "modifier_part"], ["SupportBlocker", "support_enforcer"]];
  for (const [purpose, bytes] of kinds.flatMap((words) => projectsWithPocket(words).map((one) => [words[0], one]))) {
    const mesh = await read(new Uint8Array(bytes), "pocket.3mf");
    const scene = await read(new Uint8Array(await ask("convert?output_format=stl", bytes)), "scene.stl");
    assert.deepEqual([mesh.drawn, mesh.faceOf.length, scene.faceOf.length], [24, 36, 24], purpose);
    const printed = weld({ ...mesh, corners: mesh.corners.subarray(0, mesh.drawn * 3), faceOf: mesh.faceOf.subarray(0, mesh.drawn) });
    assert.ok(kept(printed, weld(scene)).every((flag) => flag === 1), purpose);

    const picture = new Picture({ ...mesh, positions: positionsOf(mesh, [0, 0, 0]), origin: [0, 0, 0] });
    const { parts, before } = JSON.parse((await ask("analyze", bytes)).toString());
    picture.project.setParts(parts, before.counts.faces);
    assert.deepEqual(picture.trianglesOf(parts[1].first_face).map((triangle) => triangle >= mesh.drawn), [true], "of the pocket");
    assert.deepEqual(picture.trianglesOf(parts[2].first_face).map((triangle) => triangle < mesh.drawn), [true], "of what comes behind it");
    assert.equal(picture.whereIs(1).place.join(), "5,5,5");
    assert.equal(picture.whereIs(1).undrawn.faces.length, 12 * 9);
    assert.equal(picture.whereIs(2).undrawn, null);
    picture.project.setParts([], scene.faceCount);
    for (let face = 0; face < scene.faceCount; face += 1) {
      const [triangle] = picture.trianglesOf(face);
      assert.deepEqual([...picture.positions.subarray(triangle * 9, triangle * 9 + 9)], [...scene.vertices.subarray(face * 9, face * 9 + 9)], `${purpose}: face ${face}`);
    }
  }
  // Notes that do not fit the triangles say nothing, and neither do words that are not known.
  for (const [words, last] of [[["ModelPart", "normal_part"], 23], [["NegativeVolume", "normal_part"], 22]]) {
    for (const bytes of projectsWithPocket(words, last)) assert.equal((await read(new Uint8Array(bytes), "pocket.3mf")).drawn, 36, words.join());
  }
}

// Archives that are broken are left to the service; deflated ones, components, another unit and prefixes are read.
export async function packages() {
  const model = (inside) => `<?xml version="1.0"?><!-- <m:object id="9"> --><m:model xmlns:m="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" unit='inch'>${inside}</m:model>`;
  const tetra = "<m:mesh><m:vertices><m:vertex x='0' y='0' z='0'/><m:vertex x='1' y='0' z='0'/><m:vertex x='0' y='1' z='0'/><m:vertex x='0' y='0' z='1'/></m:vertices><m:triangles><m:triangle v1='0' v2='2' v3='1'/><m:triangle v1='0' v2='1' v3='9'/></m:triangles></m:mesh>";
  const text = model(`<m:resources><m:object id="1" name="a > b">${tetra}</m:object><m:object id="2"><m:components><m:component objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/></m:components></m:object></m:resources><m:build><m:item objectid="2" transform="0 1 0 -1 0 0 0 0 1 0 0 7"/></m:build>`);
  const plain = stored([["3D/3dmodel.model", text]]);
  const mesh = await read(plain, "a.3mf");
  assert.deepEqual([mesh.millimetres, [...mesh.faceOf], mesh.faceCount], [25.4, [0], 2]);
  assert.deepEqual([...mesh.vertices.subarray(0, 6)].map((value) => value + 0), [0, 5, 7, 0, 6, 7], "first the component's place, then the item's");
  const packed = deflateRawSync(Buffer.from(text));
  const zip = Buffer.from(stored([["3D/3dmodel.model", packed.toString("latin1").replace(/[^]/g, "x")]]));
  const head = 30 + "3D/3dmodel.model".length;
  packed.copy(zip, head);
  for (const at of [0, zip.length - 22 - 46 - "3D/3dmodel.model".length + 2]) {
    zip.writeUInt16LE(8, at + 8);
    zip.writeUInt32LE(text.length, at + 22);
  }
  assert.deepEqual([...(await read(zip, "a.3mf")).vertices], [...mesh.vertices], "deflated");
  zip.fill(255, head, head + 40);
  const loop = model('<m:resources><m:object id="1"><m:components><m:component objectid="1"/></m:components></m:object></m:resources><m:build><m:item objectid="1"/></m:build>');
  for (const broken of [zip, plain.subarray(0, plain.length - 30), stored([["3D/3dmodel.model", loop]]), stored([["a.txt", ""]])]) {
    await assert.rejects(read(broken, "a.3mf"), /not-drawn-here/);
  }
}

// Faces with notches are divided where the service divides them: nothing is new in a picture of what stayed as it was.
export async function polygons() {
  const shapes = [
    [[0, 0], [20, 0], [20, 5], [5, 5], [5, 20], [0, 20]],
    [[0, 0], [4, 0], [8, 0], [8, 8], [4, 8], [4, 4], [0, 8]],
    [[0, 0], [3, 1], [6, 0], [5, 3], [6, 6], [3, 5], [0, 6], [1, 3]],
    [[0, 0], [9, 0], [9, 9], [0, 9], [0, 6], [6, 6], [6, 3], [0, 3]],
  ];
  for (let round = 0; round < 40; round += 1) {
    const count = 5 + Math.floor(random() * 20);
    shapes.push(Array.from({ length: count }, (_, at) => [Math.cos, Math.sin].map((of) => Math.round(of((at * 2 * Math.PI) / count) * (200 + random() * 800)))));
  }
  const spaces = [([x, y]) => [x, y, 0], ([x, y]) => [y, x, 0], ([x, y]) => [7, x, y], ([x, y]) => [x, x + y, y]];
  for (const [at, shape] of shapes.entries()) {
    const points = shape.map(spaces[at % 4]);
    const text = `OFF\n${points.length} 1 0\n${points.map((point) => point.join(" ")).join("\n")}\n${points.length} ${points.map((_, i) => i).join(" ")}\n`;
    const answer = await fetch(`${url}/v1/convert?output_format=stl`, { method: "POST", headers: { "Content-Type": "application/octet-stream" }, body: text });
    const wanted = weld(await read(new Uint8Array(await answer.arrayBuffer()), "face.stl"));
    const own = weld(await read(Buffer.from(text), "face.off"));
    assert.equal(own.faceOf.length, points.length - 2);
    assert.ok(kept(own, wanted).every((flag) => flag === 1), text);
  }
}

// What lies far away from a part is not what is looked at; bodies that are apart are.
export async function partsFarAway() {
  const cube = (x) => Array.from({ length: 8 }, (_, at) => [x + (at & 1), (at >> 1) & 1, at >> 2]).flat();
  const sides = [0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 1, 3, 7, 1, 7, 5, 3, 2, 6, 3, 6, 7, 2, 0, 4, 2, 4, 6];
  const seen = (vertices, corners) => {
    const { far, bounds } = bulkOf({ vertices, corners: Uint32Array.from(corners) }, boundsOf({ vertices, corners }));
    return [far, bounds.min[0], bounds.max[0]];
  };
  assert.deepEqual(seen([...cube(0), 1e6, 1e6, 1e6, 1e6 + 1, 1e6, 1e6, 1e6, 1e6 + 1, 1e6], [...sides, 8, 9, 10]), [1, 0, 1]);
  assert.deepEqual(seen([...cube(0), ...cube(1000)], [...sides, ...sides.map((at) => at + 8)]), [0, 0, 1001]);
  assert.deepEqual(seen([...cube(0), 5, 0, 0, 6, 0, 0, 5, 1, 0], [...sides, 8, 9, 10]), [0, 0, 6], "near enough");
  assert.deepEqual(seen([...cube(0), 1e6, 0, 0], [...sides, 0, 1, 8]), [0, 0, 1e6], "what hangs together");
}

// The colours of corners, as each format states them.
export async function shades() {
  const colors = async (text, name) => Buffer.from((await read(Buffer.from(text), name)).colors ?? "").toString("hex").match(/.{8}/g);
  const places = [[0, 0, 0], [1, 0, 0], [0, 1, 0]];
  const rows = (more) => places.map((place, at) => `${place.join(" ")}${more[at] ?? ""}`).join("\n");
  const [red, green, blue, none] = ["ff0000ff", "00ff00ff", "0000ffff", "00000000"];
  assert.deepEqual(await colors(`OFF\n3 2 0\n${rows([])}\n3 0 1 2 255 0 0\n3 0 1 2 7\n`, "a.off"), [red, red, red, none, none, none], "one number is no colour");
  assert.deepEqual(await colors(`CNOFF\n3 1 0\n${rows([" 0 0 1 1 0 0 1", " 0 0 1 0 1 0 1", " 0 0 1 0 0 1 1"])}\n3 0 1 2\n`, "a.off"), [red, green, blue], "behind the normal");
  assert.equal(await colors(`NOFF\n3 1 0\n${rows([" 0 0 1", " 0 0 1", " 0 0 1"])}\n3 0 1 2\n`, "a.off"), null);
  assert.deepEqual(await colors(`v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0 0 0 1 0.5\nf 1 2 3\n`, "a.obj"), [red, none, blue]);
  const ply = (type, one) => `ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n${["red", "green", "blue"].map((name) => `property ${type} ${name}\n`).join("")}element face 1\nproperty list uchar int vertex_indices\nend_header\n${rows([` ${one} 0 0`, ` 0 ${one} 0`, ` 0 0 ${one}`])}\n3 0 1 2\n`;
  assert.deepEqual(await colors(ply("uchar", 255), "a.ply"), [red, green, blue]);
  assert.deepEqual(await colors(ply("uchar", 1), "a.ply"), ["010000ff", "000100ff", "000001ff"], "bytes are bytes");
  assert.deepEqual(await colors(ply("float", 1), "a.ply"), [red, green, blue]);

  const groups = `<basematerials id="1"><base name="a" displaycolor="#FF0000"/><base name="b" displaycolor="#0000FF80"/><base name="c"/></basematerials>
    <m:colorgroup id="2"><m:color color="#FF0000"/><m:color color="#00FF00"/><m:color color="#0000FF"/></m:colorgroup><m:compositematerials id="3" matid="1" matindices="0 1"><m:composite values="1 3"/></m:compositematerials>
    <m:texture2dgroup id="4" texid="9"><m:tex2coord u="0" v="0"/></m:texture2dgroup><m:multiproperties id="5" pids="1 2 4"><m:multi pindices="0 1 0"/></m:multiproperties>`;
  const project = async (object, triangle, settings = "") => {
    const model = `<model unit="millimeter"><resources>${groups}<object id="8" ${object}><mesh><vertices>${places.map(([x, y, z]) => `<vertex x="${x}" y="${y}" z="${z}"/>`).join("")}</vertices><triangles><triangle v1="0" v2="1" v3="2" ${triangle}/></triangles></mesh></object></resources><build><item objectid="8"/></build></model>`;
    return colors(stored([["3D/3dmodel.model", model], ["Metadata/project_settings.config", settings]]), "a.3mf");
  };
  assert.deepEqual(await project('pid="1" pindex="1"', ""), [blue, blue, blue], "of the object");
  assert.deepEqual(await project('pid="1" pindex="1"', 'pid="2" p1="0" p2="1" p3="2"'), [red, green, blue], "of its corners");
  assert.deepEqual(await project('pid="2" pindex="1"', 'p1="0"'), [red, red, red], "of its object's group");
  assert.deepEqual(await project("", 'pid="3" p1="0"'), Array(3).fill("4000bfff"), "a mixture");
  assert.deepEqual(await project("", 'pid="5" p1="0"'), [green, green, green], "the uppermost layer with a colour");
  for (const [object, triangle] of [["", ""], ["", 'pid="1" p1="2"'], ["", 'pid="4" p1="0"'], ["", 'pid="7" p1="0"'], ["", 'pid="2" p1="9"']]) assert.equal(await project(object, triangle), null, triangle);
  const settings = '{"filament_colour": ["#FF0000", "#00FF00", "#0000FF"], "more": ["#123456"]}';
  assert.deepEqual(await project("", 'paint_color="8"', settings), [green, green, green]);
  assert.deepEqual(await project("", 'paint_color="0C"', settings), [blue, blue, blue], "a number of two digits");
  // Divided in four, of which one has another material; it is read from the end.
  assert.deepEqual(await project("", 'paint_color="48443"', settings), [red, red, red], "the largest share");
  assert.deepEqual(await project('pid="1" pindex="1"', 'paint_color=""', settings), [blue, blue, blue], "not painted");
  for (const wrong of ["3", "xyz", "3".repeat(9999)]) assert.deepEqual(await project('pid="1" pindex="1"', `paint_color="${wrong}"`, settings), [blue, blue, blue], wrong.slice(0, 9));
  for (let round = 0; round < 200; round += 1) paintOf(randomBytes(20).toString("hex"));
}

// A coarse copy has no triangle twice, none without area in its numbers, lies within the part, and faces outward.
export async function copies() {
  const mesh = weld(await read(Buffer.from(SAMPLES.sound()), "sound.off"));
  const bounds = boundsOf(mesh);
  const positions = positionsOf(mesh, bounds.min.map((low, axis) => (low + bounds.max[axis]) / 2));
  const copy = coarse({ ...mesh, positions, flat: faceNormals(positions) }, bounds, 2000);
  const triangles = Array.from({ length: copy.index.length / 3 }, (_, at) => [...copy.index.subarray(at * 3, at * 3 + 3)]);
  assert.ok(triangles.length > 100 && triangles.length <= mesh.faceOf.length, `${triangles.length}`);
  assert.equal(new Set(triangles.map((corners) => corners.toSorted((a, b) => a - b).join())).size, triangles.length);
  assert.ok(triangles.every(([a, b, c]) => a !== b && b !== c && a !== c));
  const half = [0, 1, 2].map((axis) => (bounds.max[axis] - bounds.min[axis]) / 2 + 1e-3);
  assert.ok(copy.positions.every((value, at) => Math.abs(value) <= half[at % 3]));
  for (let at = 0; at < copy.positions.length / 3; at += 1) {
    const [, y, z] = copy.positions.subarray(at * 3);
    const [, ny, nz] = copy.normals.subarray(at * 4);
    // Of the ring's outer side, along its axis x, normals point away from the axis; of the inner side, towards it.
    if (Math.hypot(ny, nz) > 60) assert.equal(Math.sign(y * ny + z * nz), Math.hypot(y, z) > 11.5 ? 1 : -1);
  }
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
