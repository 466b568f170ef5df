// What came of a repair: verdict, changes, checks, downloads, certificate.

import { copyButton, el, field, save, select } from "../dom.js";
import { counted, digits, knows, length, number, percent, t } from "../text/text.js";
import { verifier } from "./verify.js";

const FORMATS = ["stl", "obj", "ply", "off", "3mf", "glb", "gltf"];

export function verdictCard({ report, policy }) {
  const { verdict, operation, certificate, before } = report;
  const isRepair = operation === "repair";
  const isRefused = isRepair && !certificate;
  const good = isRepair ? !isRefused && verdict.printable : verdict.printable;
  const errors = before.defects.filter(({ severity }) => severity === "error").length;
  const title = isRepair ? t(isRefused ? "verdict.refused" : good ? "verdict.repaired" : "verdict.partial") : t(good ? "verdict.good" : "verdict.bad");
  const more = isRepair ? t(`outcome.${verdict.outcome ?? "refused"}`) : good ? t("verdict.good.more") : counted("verdict.bad.more", errors);
  return el("div", { className: `card ${good ? "good" : "bad"}` },
    el("h2", {}, el("span", { className: "icon", "aria-hidden": "true" }, good ? "✓" : "!"), title),
    el("p", {}, more),
    verdict.fidelity && el("p", { className: `fidelity ${verdict.fidelity}` }, t(`fidelity.${verdict.fidelity}`)),
    verdict.changes.length > 0 && el("ul", {}, verdict.changes.map((change) => el("li", { title: change.message }, changeText(change, report)))),
    isRefused && verdict.reasons.length > 0 && el("details", {}, el("summary", {}, t("detail")), el("ul", { lang: "en" }, verdict.reasons.map(({ message }) => el("li", {}, message)))),
    report.printing && policyLine(verdict, policy));
}

function changeText({ reason, measured, limit }, report) {
  const isShare = ["lost", "invented", "volume"].includes(reason);
  const told = (value) => (isShare ? percent(value) : reason === "moved" ? `${digits(value, 3)} ${report.output_units}` : number(value));
  return counted(`change.${reason}`, measured, { a: told(measured), b: limit === null ? "" : told(limit) });
}

function policyLine({ p3_holds: holds }, policy) {
  const key = holds === null ? "policy.unknown" : holds ? "policy.holds" : "policy.breaks";
  return el("p", { className: `policy ${holds === null ? "" : holds ? "good" : "bad"}` }, t(key, { p: policy.toUpperCase() }));
}

// The checks of a process; those with a place fly there.
export function checksList({ printing, parts = [] }, host) {
  const hasPlaces = parts.length < 2;
  if (!printing) return null;
  const row = (check) => {
    const text = [el("span", { className: "name" }, t(`check.${check.code}`)), el("span", { className: "count" }, figure(check))];
    // Of several parts it is not said which one was measured.
    const place = hasPlaces && check.witnesses[0]?.position;
    return el("li", { className: `check ${check.status ?? "unknown"}`, title: check.message },
      place ? el("button", { type: "button", className: "finding-title", onclick: () => host.flyToCheck(check) }, text) : el("span", { className: "finding-title" }, text));
  };
  return el("section", {}, el("h3", {}, t("process")), el("ul", { className: "findings checks" }, printing.checks.map(row)));
}

function figure({ measured, unit, error, warning }) {
  const told = { mm: length, degrees: (value) => `${digits(value, 3)}°`, share: percent, count: number }[unit] ?? number;
  const limit = error ?? warning;
  return measured === null ? "–" : limit === null ? told(measured) : `${told(measured)} / ${told(limit)}`;
}

// Figures, downloads, certificate and the check of any file.
export function resultSection(session, host) {
  const { report } = session;
  const { certificate, deviation, actions } = report;
  if (!certificate) return null;
  // Of the best there is, nothing is certified.
  const of = (key) => t(report.verdict.printable ? key : `${key}.partial`);
  const original = report.input.format;
  // Another format is made with the same choices, so they have to be known.
  const formats = session.isAskedKnown ? FORMATS : [session.given];
  const format = select(formats.map((name) => [name, name === original ? t("format.same", { f: name.toUpperCase() }) : name.toUpperCase()]), session.format ?? original, (value) => { session.format = value; }, { id: "format" });
  const steps = actions.flatMap((action) => action.changes.filter(({ count }) => count > 0).map(stepRow));
  return el("section", { className: "result" },
    el("h3", {}, t("result")),
    el("dl", { className: "figures" },
      ...pair(t("triangles"), `${number(report.before.counts.triangles)} → ${number(certificate.triangles)}`),
      ...(deviation.hausdorff_max === null ? [] : pair(t("deviation"), length(deviation.hausdorff_max * session.reportUnit))),
      ...volume(report, session.reportUnit)),
    report.levels.length > 1 && levelsList(session, host),
    el("div", { className: "row" }, field(t("format"), format),
      el("button", { type: "button", className: "primary", id: "download", onclick: () => host.download(session.format ?? original) }, t("download"))),
    el("div", { className: "row links" },
      el("button", { type: "button", className: "quiet", onclick: () => host.openReport() }, t("report")),
      el("button", { type: "button", className: "quiet", onclick: () => saveJson(report, `${session.downloadStem}.report.json`) }, t("report.json")),
      copyButton(t("copy.curl"), () => host.curl())),
    steps.length > 0 && el("details", {}, el("summary", {}, t("changed.steps")), el("ul", { className: "steps" }, steps)),
    el("h3", {}, of("certificate")),
    el("p", { className: "hash" }, el("span", {}, of("hash")), el("code", { id: "hash" }, certificate.sha256), el("span", { className: "ends" }, copyButton(t("copy"), () => certificate.sha256),
      el("button", { type: "button", className: "quiet", id: "certificate", onclick: () => saveJson(certificate, `${session.downloadStem}.certificate.json`) }, t("certificate.save")))),
    verifier([certificate, ...report.levels.map((level) => level.certificate)].map(({ sha256 }) => sha256), of, host));
}

// What a step did, as far as there are words for it.
function stepRow({ name, count }) {
  const key = `done.${name}`;
  return el("li", { lang: knows(key) ? undefined : "en" }, t("done", { x: knows(key) ? t(key) : name.replaceAll("_", " "), n: number(count) }));
}

// Levels of detail: each can be drawn, and is a file with a certificate of its own.
function levelsList(session, host) {
  const { levels } = session.report;
  const row = (level, at) => el("li", {},
    el("button", { type: "button", className: "finding-title", "data-level": String(at), "aria-pressed": String(at === session.level), title: `SHA-256 ${level.certificate.sha256}`, onclick: () => host.showLevel(at) },
      el("span", { className: "name" }, t("level.told", { n: number(level.faces_after) }), level.distance && el("small", {}, t("level.away", { d: length(farthest(level) * session.reportUnit) }))),
      !level.is_reached && el("span", { className: "tag" }, t("level.short"))),
    el("button", { type: "button", className: "quiet", "data-level-file": String(at), "aria-label": `${t("download")}: ${t("level.told", { n: number(level.faces_after) })}`, onclick: () => host.downloadLevel(at) }, "⤓"));
  return el("div", {}, el("h3", {}, t("levels")), el("ol", { className: "findings levels" }, levels.map(row)));
}

const farthest = ({ distance }) => Math.max(distance.input_to_result.max, distance.result_to_input.max);

const pair = (name, value) => [el("dt", {}, name), el("dd", {}, value)];
const saveJson = (value, name) => save(new Blob([JSON.stringify(value, null, 2)], { type: "application/json" }), name);

function volume(report, unit) {
  const cubic = (report.after ?? report.before).measures.volume;
  return cubic === null ? [] : pair(t("volume"), `${digits((cubic * unit ** 3) / 1000)} cm³`);
}
