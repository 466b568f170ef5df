// How large the mesh is, and in which unit.

import { at } from "../dom.js";
import { millimetres } from "../session.js";
import { digits, number, t } from "../text/text.js";

// In millimetres, and in the unit of the file once that is known.
export function sizeText({ size, triangleCount, fileUnit, unit, report }) {
  const told = (scale, name) => `${size.map((value) => digits(value / scale)).join(" × ")} ${name}`;
  const own = fileUnit === 1 ? "" : ` (${told(fileUnit, unit || report.input.units.unit)})`;
  at("size").textContent = told(1, "mm") + own;
  at("dimensions").textContent = at("size").textContent;
  at("triangles").textContent = number(triangleCount);
}

// Which size is meant, where it could be several.
export function question(report) {
  const { unit_hypothesis: hypothesis, measures } = report.before;
  const isOpen = hypothesis && !report.input.units.is_stated && hypothesis.plausible.length > 1;
  at("unit-question").hidden = !isOpen;
  if (!isOpen) return;
  const { min, max } = measures.bounds;
  const longest = Math.max(...max.map((high, axis) => high - min[axis]));
  const told = hypothesis.plausible.map((unit) => t("unit.as", { a: `${digits(longest * millimetres(unit), 3)} mm`, u: unit }));
  at("unit-question").textContent = t("unit.question", { a: told.join(", ") });
}
