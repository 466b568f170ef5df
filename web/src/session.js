// One file from drop to download: its reports, pictures and choices.

import { Choices } from "./choices.js";

const MILLIMETRES = { um: 0.001, mm: 1, cm: 10, m: 1000, in: 25.4, ft: 304.8 };
const UNNAMABLE = /[\u0000-\u001f\u007f\\/:*?"<>|]/g;
export const millimetres = (unit) => MILLIMETRES[unit] ?? 1;

export class Session {
  constructor(name, file = null, isNamed = true) {
    this.name = name;
    this.isNamed = isNamed; // not so of a job of another browser
    this.file = file; // null: the service has it, see `inputJob`
    this.inputJob = null; // a job whose upload is this file
    this.job = null; // the one that the page is about
    this.unit = ""; // stated by the person
    this.policy = "";
    this.partCount = 0; // of a project, as far as it is known
    this.solid = "separate"; // what of several parts is one solid
    this.asked = null; // the choices of the job's request
    this.isAskedKnown = true; // not so of a job of another browser
    this.format = null; // of the download
    this.given = null; // the format of the job's result
    this.level = 0; // the level of detail that is drawn
    this.looks = 0; // how often it was asked what is wrong with it
    this.report = null;
    this.pictures = {}; // before, after
    this.size = null; // in millimetres, along each axis
    this.choices = new Choices();
    this.shown = new Set(); // kinds of defects with their overlay on
    this.place = null; // { code, number } that is lit
  }

  get stem() {
    return this.name.replace(/\.[^.]*$/, "") || "mesh";
  }

  // The name of a download: the service has `_` where the file's name has marks; those that names have on all systems come back.
  named(told) {
    const [own, letters] = [[...this.stem.replaceAll('"', "%22")], [...told]]; // as forms have that mark
    if (!this.isNamed || !own.every((letter, at) => [letter, "_"].includes(letters[at]))) return told;
    return this.downloadStem + letters.slice(own.length).join("");
  }

  get downloadStem() {
    return this.stem.replace(UNNAMABLE, "_");
  }

  // Millimetres of a unit of the file, and of the lengths and places of its report.
  get fileUnit() {
    return millimetres(this.unit || this.report?.input.units.unit || "mm");
  }

  get reportUnit() {
    return millimetres(this.report.output_units);
  }

  // What can be chosen of each finding: of several parts one by one there is none. One of all together does not fit them.
  get plan() {
    return this.partCount < 2 || this.solid === "together" ? this.report?.plan : null;
  }

  get isRepaired() {
    return this.report?.operation === "repair";
  }

  defect(code) {
    return this.report.before.defects.find((defect) => defect.code === code);
  }

  // What every request about this file has in common. Parts are looked at one by one before they are united, and all at once
  // where they are together.
  options({ unit, policy } = this) {
    return { samples: 1000, ...(unit ? { units: unit } : {}), ...(policy ? { policy } : {}), ...(this.solid === "together" ? { parts: "together" } : {}) };
  }

  // Takes the choices of a request.
  take(asked) {
    this.unit = asked.units ?? "";
    this.policy = asked.policy ?? "";
    this.solid = asked.parts ?? "separate";
    if (asked.parts) this.partCount = 2;
    this.format = asked.output_format ?? null;
    this.choices = Choices.of(asked);
  }

  // What a repair is asked for, perhaps with another unit and process than what is shown.
  repairOptions(chosen = this) {
    return { ...this.options(chosen), ...(this.solid === "union" ? { parts: "union" } : {}), ...this.choices.options(this.plan) };
  }
}

// What a report tells of the choices of its job: not what was done about each finding.
export function toldBy({ input, printing, levels, verdict, certificate }) {
  const ratios = levels.map(({ target }) => target.ratio).filter(Boolean);
  return {
    ...(input.units.is_stated && !["3mf", "glb", "gltf"].includes(input.format) ? { units: input.units.unit } : {}),
    ...(printing ? { policy: printing.policy } : {}),
    ...(verdict.outcome === "partial" ? { require: "best_effort" } : {}),
    ...(ratios.length > 1 ? { targets: ratios.map((ratio) => ({ ratio })) } : { ratio: ratios[0] }),
    ...(certificate ? { output_format: formatOf(certificate) } : {}),
  };
}

export const formatOf = (certificate) => certificate.encoding.split("-")[0];

// The same repair for a terminal.
export function curlOf(session) {
  const options = { ...session.asked, ...(session.format ? { output_format: session.format } : {}) };
  delete options.samples;
  const params = Object.keys(options).length ? ` -F ${quoted(`params=${JSON.stringify(options)};type=application/json`)}` : "";
  // Within quotes of its own, a name may have the marks that curl reads.
  const mesh = `mesh=@"${session.name.replace(/[\\"]/g, "\\$&")}"`;
  const result = `${session.stem}-repaired.${session.format ?? session.report.input.format}`;
  return `curl --fail-with-body -F ${quoted(mesh)}${params} ${location.origin}/v1/repair -o ${quoted(result)}`;
}

// For a shell.
const quoted = (text) => `'${text.replaceAll("'", "'\\''")}'`;
