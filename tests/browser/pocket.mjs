// A box with a volume inside that may be no material, and a second box behind it, as two kinds of projects note that.

import { stored } from "../../web/src/stored.js";

const TYPES = '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/><Default Extension="config" ContentType="text/plain"/></Types>';
const LINKS = '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="r" Target="/3D/3dmodel.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>';
const SIDES = [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [1, 3, 7], [1, 7, 5], [3, 2, 6], [3, 6, 7], [2, 0, 4], [2, 4, 6]];

const box = (low, high) => [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [0, 1, 2].map((axis) => ((i >> axis) & 1 ? high : low)[axis]));

function mesh(boxes) {
  const vertices = boxes.flat().map(([x, y, z]) => `<vertex x="${x}" y="${y}" z="${z}"/>`);
  const triangles = boxes.flatMap((_, at) => SIDES.map((side) => side.map((corner) => corner + at * 8))).map(([a, b, c]) => `<triangle v1="${a}" v2="${b}" v3="${c}"/>`);
  return `<mesh><vertices>${vertices.join("")}</vertices><triangles>${triangles.join("")}</triangles></mesh>`;
}

function project(objects, item, notes) {
  const model = `<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>${objects}</resources><build><item objectid="${item}"/></build></model>`;
  return stored([["[Content_Types].xml", TYPES], ["_rels/.rels", LINKS], ["3D/3dmodel.model", model], notes]);
}

// `words`: what the second volume is for, in the words of PrusaSlicer and of Bambu Studio; `last`: its last triangle.
// `pocket`: its lowest and highest corner.
export function projectsWithPocket([prusa, bambu], last = 23, pocket = [[4, 4, 4], [6, 6, 6]]) {
  const boxes = [box([0, 0, 0], [10, 10, 10]), box(...pocket), box([20, 0, 0], [30, 10, 10])];
  const volume = (first, end, more = "") => `<volume firstid="${first}" lastid="${end}"><metadata type="volume" key="name" value="volume ${first}"/>${more}</volume>`;
  const ranges = `<config><object id="1">${volume(0, 11)}${volume(12, last, `<metadata type="volume" key="volume_type" value="${prusa}"/>`)}${volume(24, 35)}</object></config>`;
  const parts = `<config><object id="4"><part id="1" subtype="normal_part"/><part id="2" subtype="${bambu}"/><part id="3" subtype="normal_part"/></object></config>`;
  const components = `<object id="4"><components>${[1, 2, 3].map((id) => `<component objectid="${id}"/>`).join("")}</components></object>`;
  return [
    project(`<object id="1">${mesh(boxes)}</object>`, 1, ["Metadata/Slic3r_PE_model.config", ranges]),
    project(boxes.map((one, at) => `<object id="${at + 1}">${mesh([one])}</object>`).join("") + components, 4, ["Metadata/model_settings.config", parts]),
  ];
}
