// Files to try the page with, made on the spot.

import { stored } from "./stored.js";

export const SAMPLES = { scan, bodies, project, sound };

export function sample(name) {
  const content = SAMPLES[name]();
  const ending = typeof content !== "string" ? "3mf" : content.startsWith("OFF") ? "off" : "obj";
  return new File([content], `${name}.${ending}`, { type: "application/octet-stream" });
}

// A smooth lump as of a scanner, with holes, a torn strip, scraps that float around it, and some faces turned.
function scan() {
  const [rings, columns] = [56, 96];
  const mesh = new Mesh();
  const point = (row, column) => {
    const [polar, around] = [(Math.PI * row) / rings, (2 * Math.PI * column) / columns];
    const lump = 1 + 0.16 * Math.sin(3 * around) * Math.sin(polar) ** 2 + 0.1 * Math.cos(5 * polar) + 0.05 * Math.sin(7 * around + 4 * polar) * Math.sin(polar);
    const grain = 0.006 * Math.sin(row * 12.9898 + column * 78.233) * Math.sin(polar);
    const radius = 26 * (lump + grain);
    return [radius * Math.sin(polar) * Math.cos(around), radius * Math.sin(polar) * Math.sin(around), 34 * (1 + Math.cos(polar)) + 3 * Math.cos(5 * polar) * Math.sin(polar)];
  };
  const isMissing = (row, column) => {
    const [u, v] = [row - 24, ((column + 60) % columns) - 40];
    const [m, n] = [row - 38, ((column + 20) % columns) - 52];
    return u * u + v * v * 0.6 < 14 || m * m * 1.4 + n * n < 22 || (row === 15 && column > 70 && column < 84) || (row === 44 && column === 12);
  };
  const ids = [mesh.vertex(point(0, 0))];
  for (let row = 1; row < rings; row += 1) for (let column = 0; column < columns; column += 1) ids.push(mesh.vertex(point(row, column)));
  const south = mesh.vertex(point(rings, 0));
  const id = (row, column) => (row === 0 ? ids[0] : row === rings ? south : ids[1 + (row - 1) * columns + (column % columns)]);
  for (let row = 0; row < rings; row += 1) {
    for (let column = 0; column < columns; column += 1) {
      if (isMissing(row, column)) continue;
      const corners = [id(row, column), id(row + 1, column), id(row + 1, column + 1), id(row, column + 1)];
      if (row === 30 && column < 5) corners.reverse();
      mesh.polygon(corners);
    }
  }
  for (let i = 0; i < 5; i += 1) {
    const [x, y, z] = [34 + i * 2.5, -18 + i * 7, 22 + ((i * 17) % 23)];
    mesh.polygon([[0, 0, 0], [1.6, 0.4, 0.3], [0.5, 1.5, 0.8]].map(([a, b, c]) => mesh.vertex([x + a, y + b, z + c])));
  }
  return mesh.off();
}

// A base plate, a block sunk into it, a pipe through the block, and a ball that is inside out.
function bodies() {
  const mesh = new Mesh();
  mesh.box([0, 0, 0], [60, 40, 6]);
  mesh.box([10, 8, 3], [34, 32, 28]);
  mesh.tube([22, 20, 17], 6, 3, 50);
  mesh.ball([49, 20, 12.5], 8, true);
  return mesh.obj();
}

// A project of a slicer: a sound plate, a box without its lid that is there twice, once mirrored, and a ball that is inside
// out and has another colour.
function project() {
  const [plate, cup, ball] = [new Mesh(), new Mesh(), new Mesh()];
  plate.box([0, 0, 0], [80, 40, 4]);
  cup.box([0, 0, 0], [20, 24, 16]);
  cup.faces.splice(2, 2);
  ball.ball([0, 0, 0], 9, true);
  const object = (id, name, mesh, color) => `<object id="${id}" name="${name}" type="model" pid="1" pindex="${color}">${mesh.xml()}</object>`;
  const item = (id, transform) => `<item objectid="${id}" transform="${transform}"/>`;
  const model = `<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>
<basematerials id="1"><base name="Grey" displaycolor="#9AA4AE"/><base name="Yellow" displaycolor="#E3B23C"/><base name="Blue" displaycolor="#2F7FE0"/></basematerials>
${object(2, "Plate", plate, 0)}${object(3, "Cup", cup, 1)}${object(4, "Ball", ball, 2)}
</resources><build>${item(2, "1 0 0 0 1 0 0 0 1 0 0 0")}${item(3, "1 0 0 0 1 0 0 0 1 5 8 5")}${item(3, "-1 0 0 0 1 0 0 0 1 75 8 5")}${item(4, "1 0 0 0 1 0 0 0 1 40 20 14")}</build></model>`;
  return stored([
    ["[Content_Types].xml", '<?xml version="1.0" encoding="UTF-8"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>'],
    ["_rels/.rels", '<?xml version="1.0" encoding="UTF-8"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="r0" Target="/3D/3dmodel.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'],
    ["3D/3dmodel.model", model],
  ]);
}

// A washer: closed, and with nothing to mend.
function sound() {
  const mesh = new Mesh();
  mesh.tube([0, 0, 0], 15, 8, 12);
  return mesh.off();
}

class Mesh {
  vertices = [];
  faces = [];

  vertex(place) {
    this.vertices.push(place.map((value) => Math.round(value * 1e4) / 1e4));
    return this.vertices.length - 1;
  }

  // Split into triangles, from its first corner.
  polygon(corners) {
    const distinct = corners.filter((corner, i) => corner !== corners[(i + 1) % corners.length]);
    for (let i = 2; i < distinct.length; i += 1) this.faces.push([distinct[0], distinct[i - 1], distinct[i]]);
  }

  box(min, max) {
    const ids = [0, 1, 2, 3, 4, 5, 6, 7].map((bits) => this.vertex([0, 1, 2].map((axis) => ((bits >> axis) & 1 ? max : min)[axis])));
    for (const side of [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]) this.polygon(side.map((at) => ids[at]));
  }

  // Along x, around `middle`.
  tube(middle, outer, inner, length, count = 48) {
    const ring = (radius, x) => Array.from({ length: count }, (_, i) => {
      const angle = (2 * Math.PI * i) / count;
      return this.vertex([middle[0] + x, middle[1] + radius * Math.cos(angle), middle[2] + radius * Math.sin(angle)]);
    });
    const [a, b, c, d] = [ring(outer, -length / 2), ring(outer, length / 2), ring(inner, length / 2), ring(inner, -length / 2)];
    for (const [from, to] of [[a, b], [b, c], [c, d], [d, a]]) {
      for (let i = 0; i < count; i += 1) this.polygon([from[i], from[(i + 1) % count], to[(i + 1) % count], to[i]]);
    }
  }

  ball(middle, radius, isInsideOut, rings = 20, columns = 32) {
    const place = (row, column) => {
      const [polar, around] = [(Math.PI * row) / rings, (2 * Math.PI * column) / columns];
      return [middle[0] + radius * Math.sin(polar) * Math.cos(around), middle[1] + radius * Math.sin(polar) * Math.sin(around), middle[2] + radius * Math.cos(polar)];
    };
    const top = this.vertex(place(0, 0));
    const rows = Array.from({ length: rings - 1 }, (_, row) => Array.from({ length: columns }, (__, column) => this.vertex(place(row + 1, column))));
    const bottom = this.vertex(place(rings, 0));
    const id = (row, column) => (row === 0 ? top : row === rings ? bottom : rows[row - 1][column % columns]);
    for (let row = 0; row < rings; row += 1) {
      for (let column = 0; column < columns; column += 1) {
        const corners = [id(row, column), id(row + 1, column), id(row + 1, column + 1), id(row, column + 1)];
        this.polygon(isInsideOut ? corners.reverse() : corners);
      }
    }
  }

  off() {
    return `OFF\n${this.vertices.length} ${this.faces.length} 0\n${this.vertices.map((v) => v.join(" ")).join("\n")}\n${this.faces.map((f) => `3 ${f.join(" ")}`).join("\n")}\n`;
  }

  xml() {
    const vertices = this.vertices.map(([x, y, z]) => `<vertex x="${x}" y="${y}" z="${z}"/>`).join("");
    return `<mesh><vertices>${vertices}</vertices><triangles>${this.faces.map(([a, b, c]) => `<triangle v1="${a}" v2="${b}" v3="${c}"/>`).join("")}</triangles></mesh>`;
  }

  obj() {
    return `${this.vertices.map((v) => `v ${v.join(" ")}`).join("\n")}\n${this.faces.map((f) => `f ${f.map((at) => at + 1).join(" ")}`).join("\n")}\n`;
  }
}
