// Colours as files give them, of vertices, faces or corners. One is a number: red, green and blue, the lowest byte first, and
// 255 above them; 0 is none.

import { Numbers } from "./bytes.js";

const byte = (value) => Math.min(255, Math.max(0, Math.round(value)));

export const colorOf = (red, green, blue) => (byte(red) | (byte(green) << 8) | (byte(blue) << 16) | (255 << 24)) >>> 0;

// `#RRGGBB` or `#RRGGBBAA`; how much shines through is not drawn.
export function ofHex(text) {
  const digits = /^\s*#([0-9a-f]{6})([0-9a-f]{2})?\s*$/i.exec(text ?? "")?.[1];
  return digits ? colorOf(...[0, 2, 4].map((at) => parseInt(digits.slice(at, at + 2), 16))) : 0;
}

// The colour between several; 0 where one of them is none or the shares sum up to nothing.
export function between(colors, shares) {
  const sum = shares.reduce((all, share) => all + share, 0);
  if (!(sum > 0) || colors.some((color) => !color)) return 0;
  return colorOf(...[0, 8, 16].map((shift) => colors.reduce((all, color, at) => all + (((color >>> shift) & 255) * shares[at]) / sum, 0)));
}

// Channels of elements, one after the other. Where none is above 1, all are shares of 1, else of 255.
export class Channels {
  values = new Numbers(Float32Array);
  count = 0;
  most = 0;

  // Anything but three numbers is no colour. Until the first colour nothing is kept.
  add(red, green, blue) {
    const isColor = Number.isFinite(red + green + blue);
    this.count += 1;
    if (!isColor && this.values.length === 0) return;
    while (this.values.length < (this.count - 1) * 3) this.values.push(NaN);
    for (const value of isColor ? [red, green, blue] : [NaN, NaN, NaN]) {
      this.values.push(value);
      if (value > this.most) this.most = value;
    }
  }

  // One number for each element, or null where none has a colour. `scale`: what a channel is to be taken times.
  done(scale = this.most > 1 ? 1 : 255) {
    const { items, length } = this.values;
    if (length === 0) return null;
    return Uint32Array.from({ length: length / 3 }, (_, at) => {
      const [red, green, blue] = items.subarray(at * 3, at * 3 + 3);
      return Number.isNaN(red) ? 0 : colorOf(red * scale, green * scale, blue * scale);
    });
  }
}

// Four bytes for each corner of the triangles: the colour of its face where that has one, else of its vertex; null where no
// element has a colour.
export function ofCorners({ corners, faceOf }, ofVertices, ofFaces) {
  if (!ofVertices && !ofFaces) return null;
  return bytesOf(Uint32Array.from(corners, (corner, at) => ofFaces?.[faceOf[(at / 3) | 0]] || ofVertices?.[corner] || 0));
}

// Numbers as bytes, in the order in which a graphics card wants them.
export const bytesOf = (colors) => new Uint8Array(colors.buffer, colors.byteOffset, colors.byteLength);
