// Which format a file has, by its content as the service tells it, and its mesh.

import { FileProblem } from "./bytes.js";
import { readObj } from "./obj.js";
import { readOff } from "./off.js";
import { readPly } from "./ply.js";
import { isWholeStl, looksLikeAsciiStl, readStl } from "./stl.js";
import { readThreemf } from "./threemf.js";

const READERS = { stl: readStl, obj: readObj, off: readOff, ply: readPly, "3mf": readThreemf };

export function sniff(bytes, name) {
  const begin = new TextDecoder("latin1").decode(bytes.subarray(0, 64)).trimStart();
  const extension = name.toLowerCase().split(".").pop();
  if (begin.startsWith("PK\u0003\u0004")) return "3mf";
  if (/^(glTF|\{)/.test(begin)) return null; // glTF: the service makes an STL of it
  if (/^ply\s/.test(begin)) return "ply";
  if (/^(ST)?C?N?4?OFF\b/i.test(begin)) return "off";
  if (looksLikeAsciiStl(bytes)) return "stl";
  if (READERS[extension]) return extension;
  if (isWholeStl(bytes)) return "stl";
  return /^(#|v |f |o |g |mtllib)/.test(begin) ? "obj" : null;
}

// A mesh to draw. `colors`: red, green, blue and 255 of each corner, zeros of one without a colour; null where none has one.
// `drawn`: so many triangles, the first ones, are material. `isTextured`: it has pictures, or materials in other files, that are not read. Files of other formats, and broken ones, are problems: the service says more about them.
export async function read(bytes, name) {
  const format = sniff(bytes, name);
  if (!format) throw new FileProblem("not-drawn-here");
  const mesh = await READERS[format](bytes);
  if (mesh.faceOf.length === 0) throw new FileProblem("no-triangle");
  return { format, colors: null, isTextured: false, drawn: mesh.faceOf.length, ...mesh };
}
