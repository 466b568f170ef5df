// The list of findings: what is wrong, where, and what is to be done about it.

import { el, field, select } from "../dom.js";
import { counted, knows, length, number, percent, t } from "../text/text.js";
import { ofDefect } from "../view/colors.js";

const METHODS = ["auto", "flat", "minimal", "smooth", "creased", "rbf"];
const RANK = { error: 0, warning: 1, info: 2 };

// `host`: what happens on a click: show(code, isShown), visit(code, number), changed().
export function findingsList(session, host) {
  const defects = [...session.report.before.defects].sort((a, b) => RANK[a.severity] - RANK[b.severity]);
  if (defects.length === 0) return el("p", { className: "calm" }, t("findings.none"));
  return el("ul", { className: "findings" }, defects.map((defect) => finding(defect, session, host)));
}

export const isShownFirst = (defect) => defect.severity === "error";

function finding(defect, session, host) {
  const { code, severity, count, is_at_least: isAtLeast } = defect;
  const name = t(`defect.${code}`);
  const body = el("div", { className: "finding-body", hidden: true, id: `finding-${code}` });
  const title = el("button", {
    type: "button", className: "finding-title", "aria-expanded": "false", "aria-controls": body.id, "data-code": code,
    onclick: () => host.visit(code, 0, title.getAttribute("aria-expanded") === "true"),
  }, el("span", { className: "name" }, name), mended(defect), el("span", { className: "count" }, isAtLeast ? t("or.more", { n: number(count) }) : number(count)));
  const shown = el("input", {
    type: "checkbox", checked: session.shown.has(code), "aria-label": t("show.in.view", { x: name }), title: t("show.in.view", { x: name }),
    onchange: (event) => host.show(code, event.target.checked),
  });
  shown.style.setProperty("--swatch", ofDefect(code));
  return el("li", { className: `finding ${severity}`, "data-code": code }, el("div", { className: "finding-row" }, shown, title), body);
}

function mended({ fixed, count }) {
  if (fixed === null || fixed === undefined) return null;
  const isDone = fixed >= count;
  return el("span", { className: isDone ? "tag good" : "tag" }, isDone ? t("fixed") : counted("left", count - fixed));
}

// Opens the finding of `code` at its place `at`, and closes the others.
export function openFinding(list, session, host, code, at) {
  for (const item of list.querySelectorAll(".finding")) {
    const isThis = item.dataset.code === code;
    const body = item.querySelector(".finding-body");
    item.querySelector(".finding-title").setAttribute("aria-expanded", String(isThis));
    body.hidden = !isThis;
    if (!isThis) body.replaceChildren();
    else fill(body, session, host, code, at);
  }
}

function fill(body, session, host, code, at) {
  const defect = session.defect(code);
  const proposal = session.plan?.findings.find((finding) => finding.code === code);
  const isEdited = body.contains(document.activeElement);
  const focused = isEdited ? document.activeElement.dataset.role : null;
  body.replaceChildren(...[
    el("p", { className: "severity" }, t(`severity.${defect.severity}`)),
    proposal && remedyOfAll(proposal, session, host, at),
    defect.witnesses.length > 0 && places(defect, proposal, session, host, at),
  ].filter(Boolean));
  if (focused) body.querySelector(`[data-role="${focused}"]`)?.focus();
  body.querySelector("[aria-current]")?.scrollIntoView({ block: "nearest" });
}

function remedyOfAll(proposal, session, host, at) {
  const { code, remedy, choices, confidence, reason } = proposal;
  const current = session.choices.remedies.get(code) ?? remedy;
  const control = choices.length > 1
    ? select(choices.map((choice) => [choice, t(`remedy.${choice}`)]), current, (value) => { session.choices.setRemedy(code, value); host.changed(); }, { "data-role": "remedy" })
    : el("span", {}, t(`remedy.${remedy}`));
  return el("div", { className: "remedy" }, field(t("what.to.do"), control), el("small", { title: reason }, t("sure", { p: percent(proposal.elements[at]?.confidence ?? confidence) })));
}

function places(defect, proposal, session, host, at) {
  const { code, count, witnesses } = defect;
  const step = (by) => () => host.step(by);
  return el("div", { className: "places" },
    el("div", { className: "stepper" },
      el("button", { type: "button", className: "quiet", "data-role": "previous", onclick: step(-1) }, `‹ ${t("previous")}`),
      el("span", { "aria-live": "polite" }, t("place.told", { x: t("places"), n: number(at + 1), m: number(witnesses.length) })),
      el("button", { type: "button", className: "quiet", "data-role": "next", onclick: step(1) }, `${t("next")} ›`)),
    witnesses.length < count && el("p", { className: "note" }, t("findings.first", { n: number(witnesses.length), m: number(count) })),
    el("ol", { className: "place-list" }, witnesses.map((witness, i) => el("li", {},
      el("button", { type: "button", className: "place", "aria-current": i === at ? "true" : undefined, "data-role": `place-${i}`, onclick: () => host.visit(code, i) }, nameOf(witness, i, session)),
      i === at && proposal?.elements[i] && ofElement(proposal, i, session, host)))));
}

function nameOf(witness, i, session) {
  const figure = (name) => witness.figures.find((figure) => figure.name === name)?.value;
  const size = figure("diameter");
  const told = size ? `, ${length(size * session.reportUnit)}` : "";
  const name = witness.hole && knows(`hole.${witness.hole}`) ? t("hole", { n: i + 1, x: t(`hole.${witness.hole}`) }) : t("place", { n: i + 1 });
  return name + told;
}

// The choice for one hole, shell or face.
function ofElement(proposal, at, session, host) {
  const { code, choices, elements } = proposal;
  const { number: id, remedy } = elements[at];
  const own = session.choices.element(code, id);
  const ofAll = session.choices.remedies.get(code) ?? remedy;
  const choose = (change) => { session.choices.setElement(code, id, change); host.changed(); host.refresh(); };
  const rows = [["", t("as.all", { x: t(`remedy.${ofAll}`) })], ...choices.map((choice) => [choice, t(`remedy.${choice}`)])];
  const isFilled = code === "boundary-loop" && (own.remedy || ofAll) === "fill";
  const method = isFilled && field(t("how"), select(METHODS.map((word) => [word === "auto" ? "" : word, t(`method.${word}`)]), own.method ?? "", (value) => choose({ method: value }), { "data-role": "method" }));
  return el("div", { className: "element" }, field(t("what.to.do"), select(rows, own.remedy ?? "", (value) => choose({ remedy: value }), { "data-role": "element" })), method);
}
