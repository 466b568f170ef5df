// Entries of a zip archive, stored or deflated, as 3MF has them.

import { FileProblem } from "./bytes.js";

const [LOCAL, CENTRAL, END] = [0x04034b50, 0x02014b50, 0x06054b50];
const END_BYTES = 22;
const COMMENT_MAX = 65_535;

export class Zip {
  constructor(bytes) {
    this.bytes = bytes;
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.entries = new Map(); // by name, as of parts: in lower case, with a slash before
    this.list();
  }

  // Sizes of more than 32 bits are left to the service, which reads them.
  list() {
    const { view } = this;
    let end = view.byteLength - END_BYTES;
    while (end >= 0 && view.byteLength - end <= END_BYTES + COMMENT_MAX && view.getUint32(end, true) !== END) end -= 1;
    if (end < 0 || view.byteLength < END_BYTES || view.getUint32(end, true) !== END) throw new FileProblem("not-drawn-here");
    const decoder = new TextDecoder();
    let at = view.getUint32(end + 16, true);
    for (let left = view.getUint16(end + 10, true); left > 0; left -= 1) {
      if (at + 46 > end || view.getUint32(at, true) !== CENTRAL) throw new FileProblem("not-drawn-here");
      const [method, packed, size, place] = [view.getUint16(at + 10, true), view.getUint32(at + 20, true), view.getUint32(at + 24, true), view.getUint32(at + 42, true)];
      const [nameLength, more, comment] = [28, 30, 32].map((field) => view.getUint16(at + field, true));
      const name = decoder.decode(this.bytes.subarray(at + 46, at + 46 + nameLength));
      this.entries.set(`/${name.replaceAll("\\", "/").replace(/^\/+/, "")}`.toLowerCase(), { method, packed, size, place });
      at += 46 + nameLength + more + comment;
    }
  }

  has(name) {
    return this.entries.has(name.toLowerCase());
  }

  // An entry as text; at most `most` bytes of it.
  async text(name, most) {
    const entry = this.entries.get(name.toLowerCase());
    if (!entry || entry.size > most) throw new FileProblem("not-drawn-here");
    const { method, packed, place, size } = entry;
    if (place + 30 > this.bytes.length || this.view.getUint32(place, true) !== LOCAL) throw new FileProblem("not-drawn-here");
    const from = place + 30 + this.view.getUint16(place + 26, true) + this.view.getUint16(place + 28, true);
    const bytes = this.bytes.subarray(from, from + packed);
    if (method === 0) return new TextDecoder().decode(bytes);
    if (method !== 8) throw new FileProblem("not-drawn-here");
    return inflated(bytes, size);
  }
}

// No more than the archive states is taken, whatever comes out.
async function inflated(bytes, size) {
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw")).getReader();
  const decoder = new TextDecoder();
  let [text, total] = ["", 0];
  for (;;) {
    const { value, done } = await reader.read().catch(() => { throw new FileProblem("not-drawn-here"); });
    if (done) return text + decoder.decode();
    total += value.length;
    if (total > size) throw new FileProblem("not-drawn-here");
    text += decoder.decode(value, { stream: true });
  }
}
