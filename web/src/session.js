// One file from drop to download: its reports, pictures and choices.

import { Choices } from "./choices.js";

const MILLIMETRES = { um: 0.001, mm: 1, cm: 10, m: 1000, in: 25.4, ft: 304.8 };
export const millimetres = (unit) => MILLIMETRES[unit] ?? 1;

export class Session {
  constructor(name, file = null) {
    this.name = name;
    this.file = file; // null: the service has it, see `inputJob`
    this.inputJob = null; // a job whose upload is this file
    this.job = null; // the one that the page is about
    this.unit = ""; // stated by the person
    this.policy = "";
    this.partCount = 0; // of a project, as far as it is known
    this.solid = "separate"; // what of several parts is one solid
    this.format = null; // of the download
    this.given = null; // the format of the job's result
    this.level = 0; // the level of detail that is drawn
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

  // Millimetres of a unit of the file, and of the lengths and places of its report.
  get fileUnit() {
    return millimetres(this.unit || this.report?.input.units.unit || "mm");
  }

  get reportUnit() {
    return millimetres(this.report.output_units);
  }

  get isRepaired() {
    return this.report?.operation === "repair";
  }

  defect(code) {
    return this.report.before.defects.find((defect) => defect.code === code);
  }

  // What every request about this file has in common. Parts are looked at one by one before they are united, and all at once
  // where they are together.
  options() {
    return { samples: 1000, ...(this.unit ? { units: this.unit } : {}), ...(this.policy ? { policy: this.policy } : {}), ...(this.solid === "together" ? { parts: "together" } : {}) };
  }

  // What a repair is asked for.
  repairOptions() {
    return { ...this.options(), ...(this.solid === "union" ? { parts: "union" } : {}), ...this.choices.options(this.report?.plan) };
  }
}

// The same repair for a terminal.
export function curlOf(session) {
  const options = { ...session.repairOptions(), ...(session.format ? { output_format: session.format } : {}) };
  delete options.samples;
  const params = Object.keys(options).length ? ` -F 'params=${JSON.stringify(options)};type=application/json'` : "";
  const quoted = session.name.replace(/[^\w.\- ]/g, "_");
  const extension = session.format ?? session.report.input.format;
  return `curl --fail-with-body -F 'mesh=@${quoted}'${params} ${location.origin}/v1/repair -o '${session.stem.replace(/[^\w.\- ]/g, "_")}-repaired.${extension}'`;
}
