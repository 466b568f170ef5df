// 3MF: what the build puts together, each mesh at each of its places. What is not understood here the service draws or refuses.

import { FileProblem, Numbers } from "./bytes.js";
import { bytesOf } from "./colors.js";
import { Properties, filaments, paintOf } from "./properties.js";
import { Zip } from "./zip.js";

const MILLIMETRES = { micron: 0.001, millimeter: 1, centimeter: 10, inch: 25.4, foot: 304.8, meter: 1000 };
const MODEL_BYTES_MAX = 400_000_000; // near the longest string of a browser
const PLACES_MAX = 20_000;
const TRIANGLES_MAX = 20_000_000; // at all places
const LEVELS_MAX = 64;
const DRAWN = ["model", "solidsupport", "surface"];
const UNMOVED = [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0];

export async function readThreemf(bytes) {
  const zip = new Zip(bytes);
  const root = await startOf(zip);
  const models = new Map();
  const modelOf = async (path) => {
    if (!models.has(path)) models.set(path, modelFrom(await zip.text(path, MODEL_BYTES_MAX), path));
    return models.get(path);
  };
  const model = await modelOf(root);
  const places = [];
  const put = async (reference, from, matrix, level) => {
    const path = reference.path ?? from;
    const object = (await modelOf(path)).objects.get(reference.id);
    if (!object || level > LEVELS_MAX || places.length > PLACES_MAX) throw new FileProblem("not-drawn-here");
    const own = times(reference.matrix, matrix);
    for (const part of object.components) await put(part, path, own, level + 1);
    if (object.corners.length && DRAWN.includes(object.kind)) places.push({ object, matrix: own });
  };
  for (const item of model.items) await put(item, root, UNMOVED, 0);
  const all = await Promise.all(models.values());
  const materials = all.some(({ isPainted }) => isPainted) ? await filaments(zip, MODEL_BYTES_MAX) : [];
  return { ...sceneOf(places, materials), millimetres: model.millimetres, isTextured: all.some(({ properties }) => properties.isTextured) };
}

// The model that the relationships of the package name.
async function startOf(zip) {
  if (zip.has("/_rels/.rels")) {
    for (const { name, of } of elements(await zip.text("/_rels/.rels", MODEL_BYTES_MAX))) {
      if (name === "Relationship" && /\/3dmodel$/i.test(of("Type") ?? "")) return `/${(of("Target") ?? "").replace(/^\/+/, "")}`;
    }
  }
  return "/3D/3dmodel.model";
}

// Opening tags, with their attributes by local name.
function* elements(text) {
  const plain = text.includes("<!--") ? text.replace(/<!--[^]*?-->/g, "") : text;
  for (const [, name, inside] of plain.matchAll(/<(?:[\w.-]+:)?([\w.-]+)((?:[^>"']|"[^"]*"|'[^']*')*)>/g)) {
    yield { name, inside, of: (wanted) => attribute(inside, wanted) };
  }
}

const PATTERNS = new Map();

function attribute(inside, name) {
  if (!PATTERNS.has(name)) PATTERNS.set(name, new RegExp(`(?:^|[\\s:])${name}\\s*=\\s*(?:"([^"]*)"|'([^']*)')`));
  const found = PATTERNS.get(name).exec(inside);
  return found ? found[1] ?? found[2] : null;
}

function modelFrom(text, path) {
  const properties = new Properties();
  const model = { millimetres: 1, objects: new Map(), items: [], properties, isPainted: false };
  let object = null;
  const reference = (of) => ({ id: of("objectid"), path: of("path"), matrix: matrixOf(of("transform")) });
  for (const { name, inside, of } of elements(text)) {
    if (name === "model") model.millimetres = MILLIMETRES[of("unit") ?? "millimeter"] ?? 1;
    else if (name === "object") {
      object = { path, id: of("id"), kind: of("type") ?? "model", vertices: new Numbers(Float64Array), corners: new Numbers(Uint32Array), components: [], colors: new Map(), paints: new Map() };
      object.pid = of("pid");
      object.color = object.pid === null ? 0 : properties.color(object.pid, Number(of("pindex") ?? 0));
      model.objects.set(object.id, object);
    } else if (name === "vertex") for (const axis of ["x", "y", "z"]) object?.vertices.push(Number(of(axis)));
    else if (name === "triangle" && object) {
      const at = object.corners.length / 3;
      for (const corner of ["v1", "v2", "v3"]) object.corners.push(Number(of(corner)));
      if (inside.includes("p1")) object.colors.set(at, properties.ofTriangle(of, object));
      const painted = inside.includes("_color") || inside.includes("mmu_segmentation") ? of("paint_color") ?? of("mmu_segmentation") : null;
      if (painted) object.paints.set(at, paintOf(painted));
      model.isPainted ||= Boolean(painted);
    } else if (name === "component") object?.components.push(reference(of));
    else if (name === "item") model.items.push(reference(of));
    else properties.take(name, of);
  }
  return model;
}

function matrixOf(text) {
  if (!text) return UNMOVED;
  const matrix = text.trim().split(/\s+/).map(Number);
  if (matrix.length !== 12 || !matrix.every(Number.isFinite)) throw new FileProblem("not-drawn-here");
  return matrix;
}

// Points are rows: first `a`, then `b`.
function times(a, b) {
  if (a === UNMOVED) return b;
  const rows = [0, 1, 2, 3].map((row) => [0, 1, 2].map((column) =>
    a[row * 3] * b[column] + a[row * 3 + 1] * b[3 + column] + a[row * 3 + 2] * b[6 + column] + (row === 3 ? b[9 + column] : 0)));
  return rows.flat();
}

export const moved = ([x, y, z], m) => [0, 1, 2].map((axis) => x * m[axis] + y * m[3 + axis] + z * m[6 + axis] + m[9 + axis]);

const isMirror = (m) => m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]) < 0;

// Faces are numbered by objects; copies of one stand one after the other, so that numbers ascend. `objects` says which
// faces are whose, and `order` in which order the build has them.
function sceneOf(places, materials) {
  const objects = [...new Set(places.map(({ object }) => object))].map((object) => ({ object, places: places.filter((place) => place.object === object).map(({ matrix }) => matrix) }));
  const total = objects.reduce((sum, { object, places: own }) => sum + (object.corners.length / 3) * own.length, 0);
  if (total > TRIANGLES_MAX) throw new FileProblem("not-drawn-here");
  const [vertices, corners, faceOf, colors] = [new Numbers(Float64Array), new Numbers(Uint32Array), new Numbers(Uint32Array), new Numbers(Uint32Array)];
  const told = [];
  let first = 0;
  for (const { object, places: own } of objects) {
    const count = object.vertices.length / 3;
    const begins = own.map((matrix) => {
      const begin = vertices.length / 3;
      for (let at = 0; at < count; at += 1) for (const value of moved(object.vertices.items.subarray(at * 3, at * 3 + 3), matrix)) vertices.push(value);
      return { begin, turns: isMirror(matrix) ? [0, 2, 1] : [0, 1, 2] };
    });
    for (let at = 0; at < object.corners.length; at += 3) {
      const ends = object.corners.items.subarray(at, at + 3);
      if (!ends.every((end) => end < count)) continue;
      const color = materials[object.paints.get(at / 3)] || (object.colors.get(at / 3) ?? object.color);
      for (const { begin, turns } of begins) {
        for (const turn of turns) {
          corners.push(begin + ends[turn]);
          colors.push(color[turn] ?? color);
        }
        faceOf.push(first + at / 3);
      }
    }
    told.push({ path: object.path, id: Number(object.id), first, count: object.corners.length / 3, places: own });
    first += object.corners.length / 3;
  }
  const order = places.map(({ object }) => objects.findIndex((one) => one.object === object));
  const shown = colors.done();
  return {
    vertices: vertices.done(), corners: corners.done(), faceOf: faceOf.done(), faceCount: total, project: { objects: told, order },
    colors: shown.some(Boolean) ? bytesOf(shown) : null,
  };
}
