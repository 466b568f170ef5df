// The parts of a 3MF: what each is, whether it is sound, and what became of it. And what there is to remark on the file.

import { el } from "../dom.js";
import { number, percent, t } from "../text/text.js";

export const nameOfPart = ({ name, object, volume }) => name || (volume === null ? t("part.object", { n: object }) : t("part.volume", { n: object, m: volume + 1 }));

// `host.visitPart`: flies there.
export function partsList(report, host) {
  const { parts = [], remarks = [] } = report;
  if (parts.length === 0 && remarks.length === 0) return null;
  return el("section", { id: "parts" },
    parts.length > 0 && el("h3", {}, t("parts")),
    parts.length > 0 && el("ul", { className: "findings parts" }, parts.map((part, at) => row(part, at, host))),
    remarks.length > 0 && el("details", {}, el("summary", {}, t("remarks", { n: number(remarks.length) })), el("ul", { lang: "en", className: "steps" }, remarks.map((remark) => el("li", {}, remark)))));
}

function row(part, at, host) {
  const { verdict, instances, triangles_before: before, triangles_after: after, attributes } = part;
  const count = after === null || after === before ? number(before) : `${number(before)} → ${number(after)}`;
  const times = instances === 1 ? "" : instances === 0 ? t("part.unused") : t("part.times", { n: number(instances) });
  const told = [times, after !== null && verdict.outcome && t(`outcome.${verdict.outcome}`), attributes && attributes.kept_area_share !== null && t("part.attributes", { p: percent(attributes.kept_area_share) })].filter(Boolean);
  return el("li", { className: "part" },
    el("button", { type: "button", className: "finding-title", "data-part": String(at), onclick: () => host.visitPart(at) },
      el("span", { className: "name" }, nameOfPart(part), told.length > 0 && el("small", {}, told.join(" "))),
      el("span", { className: verdict.printable ? "tag good" : "tag" }, t(verdict.printable ? "part.sound" : "part.broken")),
      el("span", { className: "count" }, count)));
}
