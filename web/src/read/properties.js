// Colours in a 3MF: of materials, groups, mixtures and layers, and of what a slicer has painted on triangles.

import { between, ofHex } from "./colors.js";

const numbers = (text) => (text ?? "").trim().split(/\s+/).filter(Boolean).map(Number);

// The property groups of a model, as its elements come.
export class Properties {
  groups = new Map();
  isTextured = false;
  group = null;

  take(name, of) {
    if (["basematerials", "colorgroup", "texture2dgroup"].includes(name)) this.open(of, { colors: [] });
    else if (name === "compositematerials") this.open(of, { colors: [], of: of("matid"), members: numbers(of("matindices")) });
    else if (name === "multiproperties") this.open(of, { layers: numbers(of("pids")).map(String), members: [] });
    else if (name === "base") this.group?.colors?.push(ofHex(of("displaycolor")));
    else if (name === "color") this.group?.colors?.push(ofHex(of("color")));
    else if (name === "composite" && this.group?.of) this.group.colors.push(this.mixed(this.group, numbers(of("values"))));
    else if (name === "multi" && this.group?.layers) this.group.members.push(numbers(of("pindices")));
    this.isTextured ||= name === "texture2dgroup";
  }

  open(of, group) {
    this.group = group;
    this.groups.set(of("id"), group);
  }

  mixed({ of, members }, shares) {
    const used = members.slice(0, shares.length).map((member) => this.groups.get(of)?.colors?.[member] ?? 0);
    return between(used, shares.slice(0, used.length));
  }

  // The colour of a member of a group, of layers that of the uppermost; 0: it has none.
  color(id, member) {
    const group = this.groups.get(id);
    if (!group?.layers) return group?.colors[member] ?? 0;
    const colors = group.layers.map((layer, at) => this.groups.get(layer)?.colors?.[group.members[member]?.[at] ?? 0] ?? 0);
    return colors.findLast(Boolean) ?? 0;
  }

  // The colours of the corners of a triangle; a corner without a property is as the first, a triangle without one as its object.
  ofTriangle(of, object) {
    const first = of("p1");
    if (first === null) return object.color;
    const id = of("pid") ?? object.pid;
    const [a, b, c] = [first, of("p2") ?? first, of("p3") ?? first].map((member) => this.color(id, Number(member)));
    return b === a && c === a ? a : [a, b, c];
  }
}

// Colours of a slicer's materials, the first one at 1, as its settings have them in one of these parts.
export async function filaments(zip, bytesMax) {
  const words = async (path, pattern) => (zip.has(path) ? pattern.exec(await zip.text(path, bytesMax))?.[1] : null) ?? "";
  const found = [
    await words("/Metadata/project_settings.config", /"filament_colou?r"\s*:\s*\[([^\]]*)\]/),
    await words("/Metadata/Slic3r_PE.config", /^; extruder_colour = (.*)$/m),
    await words("/Metadata/Slic3r_PE.config", /^; filament_colour = (.*)$/m),
  ].map((text) => text.match(/#[0-9a-f]{6}/gi) ?? []).find((colors) => colors.length > 0);
  return [0, ...(found ?? ANY).map(ofHex)];
}

// Of a project that does not state them.
const ANY = ["#2f7fe0", "#f2a51c", "#1f9e86", "#cf3f36", "#a83ad0", "#8a6d1c", "#0c9ab0", "#e0609a"];
const DEPTH_MAX = 32;

// The number of the material that the largest share of a triangle is painted with; 0: none. The digits are read from the
// last one. Each has the number of divided sides in its lower two bits, and where there is none the material above them.
export function paintOf(text) {
  const shares = new Map();
  let left = text.length;
  const next = () => (left > 0 ? parseInt(text[(left -= 1)], 16) : NaN);
  const walk = (share, depth) => {
    const digit = next();
    if (Number.isNaN(digit) || depth > DEPTH_MAX) return;
    const parts = (digit & 3) + 1;
    if (parts > 1) {
      for (let part = 0; part < parts; part += 1) walk(share / parts, depth + 1);
      return;
    }
    const material = digit >> 2 < 3 ? digit >> 2 : 3 + next();
    shares.set(material, (shares.get(material) ?? 0) + share);
  };
  walk(1, 0);
  return [...shares].reduce((most, one) => (one[1] > most[1] ? one : most), [0, 0])[0];
}
