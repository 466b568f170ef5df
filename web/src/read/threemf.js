// 3MF: what the build puts together, each mesh at each of its places. What is not understood here the service draws or refuses.
// What slicers note as no material comes behind what is printed: negative parts, modifiers, blockers and enforcers of supports.

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
  const notes = await notesOf(zip).catch(() => ({ parts: new Set(), volumes: new Map() })); // where a note cannot be read, all is drawn
  const models = new Map();
  const modelOf = async (path) => {
    if (!models.has(path)) models.set(path, modelFrom(await zip.text(path, MODEL_BYTES_MAX), path));
    return models.get(path);
  };
  const model = await modelOf(root);
  const pieces = []; // ranges of triangles of an object, at a place
  const put = async (reference, from, matrix, above) => {
    const path = reference.path ?? from;
    const object = (await modelOf(path)).objects.get(reference.id);
    if (!object || above.length > LEVELS_MAX || pieces.length > PLACES_MAX) throw new FileProblem("not-drawn-here");
    const own = times(reference.matrix, matrix);
    const way = [...above, reference.id];
    for (const part of object.components) await put(part, path, own, way);
    if (!object.corners.length || !DRAWN.includes(object.kind)) return;
    const place = { matrix: own };
    const isAside = notes.parts.has(way.slice(0, 2).join());
    for (const range of rangesOf(object, path === root && notes.volumes.get(object.id))) pieces.push({ object, place, ...range, isAside: isAside || range.isAside });
  };
  for (const item of model.items) await put(item, root, UNMOVED, []);
  const all = await Promise.all(models.values());
  const materials = all.some(({ isPainted }) => isPainted) ? await filaments(zip, MODEL_BYTES_MAX) : [];
  return { ...sceneOf(pieces, materials), millimetres: model.millimetres, isTextured: all.some(({ properties }) => properties.isTextured) };
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

// What slicers note of objects: `parts`, the ids of an item's object and of a component of it that is no material; and
// `volumes`, the ranges of an object's triangles.
async function notesOf(zip) {
  const [parts, volumes] = [new Set(), new Map()];
  const isAside = (word) => /^((negative|modifier)_part|support_(blocker|enforcer)|NegativeVolume|ParameterModifier|Support(Blocker|Enforcer))$/.test(word);
  for (const path of ["/Metadata/Slic3r_PE_model.config", "/Metadata/model_settings.config"]) {
    let [object, volume] = [null, null];
    for (const { name, of } of zip.has(path) ? elements(await zip.text(path, MODEL_BYTES_MAX)) : []) {
      if (name === "object") {
        object = of("id");
        volume = null;
      } else if (name === "part" && isAside(of("subtype"))) parts.add(`${object},${of("id")}`);
      else if (name === "volume") {
        volume = { from: Number(of("firstid")), until: Number(of("lastid")) + 1, isAside: false };
        if (!volumes.has(object)) volumes.set(object, []);
        volumes.get(object).push(volume);
      } else if (volume && ["volume_type", "modifier"].includes(of("key"))) volume.isAside ||= of("value") === "1" || isAside(of("value"));
    }
  }
  return { parts, volumes };
}

// The volumes of an object where some are no material and they are all of it; otherwise the whole object.
function rangesOf(object, volumes) {
  const count = object.corners.length / 3;
  let end = 0;
  const isApart = volumes && volumes.some((volume) => volume.isAside) && volumes.every(({ from, until }) => from === end && (end = until) > from);
  return isApart && end === count ? volumes : [{ from: 0, until: count, isAside: false }];
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

// Faces are numbered by ranges of objects, what is printed first; copies of one stand one after the other, so that numbers
// ascend. `objects` says which faces are whose, and `order` in which order the build has what is printed.
function sceneOf(pieces, materials) {
  const named = new Map();
  for (const piece of pieces.toSorted((a, b) => a.isAside - b.isAside)) {
    const name = [piece.object.path, piece.object.id, piece.from, piece.isAside].join();
    if (!named.has(name)) named.set(name, { ...piece, count: piece.until - piece.from, places: [] });
    named.get(name).places.push(piece.place);
    piece.name = name;
  }
  const objects = [...named.values()];
  const total = objects.reduce((sum, { count, places }) => sum + count * places.length, 0);
  if (total > TRIANGLES_MAX) throw new FileProblem("not-drawn-here");
  const [vertices, corners, faceOf, colors] = [new Numbers(Float64Array), new Numbers(Uint32Array), new Numbers(Uint32Array), new Numbers(Uint32Array)];
  const told = [];
  let [first, drawn] = [0, 0];
  for (const { object, from, until, isAside, count, places } of objects) {
    const ends = object.vertices.length / 3;
    for (const place of places) {
      if (place.turns) continue; // another range of the object came here
      Object.assign(place, { begin: vertices.length / 3, turns: isMirror(place.matrix) ? [0, 2, 1] : [0, 1, 2] });
      for (let at = 0; at < ends; at += 1) for (const value of moved(object.vertices.items.subarray(at * 3, at * 3 + 3), place.matrix)) vertices.push(value);
    }
    for (let at = from; at < until; at += 1) {
      const triangle = object.corners.items.subarray(at * 3, at * 3 + 3);
      if (!triangle.every((end) => end < ends)) continue;
      const color = materials[object.paints.get(at)] || (object.colors.get(at) ?? object.color);
      for (const { begin, turns } of places) {
        for (const turn of turns) {
          corners.push(begin + triangle[turn]);
          colors.push(color[turn] ?? color);
        }
        faceOf.push(first + at - from);
      }
    }
    if (!isAside) drawn = faceOf.length;
    told.push({ path: object.path, id: Number(object.id), from, first, count, places: places.map(({ matrix }) => matrix) });
    first += count;
  }
  const numbers = new Map([...named.keys()].map((name, at) => [name, at]));
  const shown = colors.done();
  return {
    vertices: vertices.done(), corners: corners.done(), faceOf: faceOf.done(), faceCount: total, drawn,
    project: { objects: told, order: pieces.filter(({ isAside }) => !isAside).map(({ name }) => numbers.get(name)) },
    colors: shown.some(Boolean) ? bytesOf(shown) : null,
  };
}
