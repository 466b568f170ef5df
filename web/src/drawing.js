// What is drawn of a session: the file and its result, marks of defects, and the place that is lit.

import { at } from "./dom.js";
import { Picture, aim } from "./places.js";
import { NO_PARTS } from "./project.js";
import { counted, number, t } from "./text/text.js";
import { ofDefect } from "./view/colors.js";
import { COPIES } from "./view/view.js";

const TEXT_BYTES = 4_000_000; // of a glTF, where its materials stand

export class Drawing {
  view = null; // none where the browser shows no 3D
  tools = null;

  // `current`: the session of now. `sized` hears of a mesh whose size is known.
  constructor({ api, meshes, current, sized }) {
    Object.assign(this, { api, meshes, current, sized });
  }

  get session() {
    return this.current();
  }

  async draw(side, bytes, fileName, unit = this.session.fileUnit) {
    const of = this.session;
    const read = await this.meshes.ask("read", { name: side, bytes, fileName, scale: unit, isFirst: side === "before" }, [bytes]);
    if (of !== this.session) return null;
    const picture = new Picture(read);
    of.pictures[side] = picture;
    this.view?.setMesh(side, picture, side === "before");
    at("view").dataset.drawn = Object.keys(of.pictures).join(" ");
    if (side === "before") this.sized(picture);
    this.tools?.colorsCame(side);
    this.tellFar();
    picture.project?.setParts(of.report?.parts ?? [], of.report?.before.counts.faces);
    if (of.report && side === "before") this.overlays();
    const more = await this.meshes.ask("look", { name: side, sizes: COPIES });
    if (of !== this.session) return null;
    Object.assign(picture, { rims: more.rims, edges: more.edges });
    if (more.coarse.length) this.view?.setCoarse(side, more.coarse);
    this.tellEased();
    if (of.report && side === "before") this.overlays();
    return picture;
  }

  // Says so when less is drawn while the view moves.
  tellEased() {
    at("coarse").hidden = !this.view?.easing;
    if (!this.view?.easing) return;
    const copy = this.view.easedCopy("before");
    at("coarse").textContent = copy ? t("view.coarse", { n: number(copy.geometry.index.count / 3), m: number(this.session.pictures.before.drawn) }) : t("view.rough");
  }

  // Says so when something lies so far away that the part would not be seen beside it.
  tellFar() {
    const far = this.session?.pictures.before?.bulk.far ?? 0;
    at("far").hidden = !far;
    at("far").textContent = counted("view.far", far);
  }

  // The file as the service has it: for jobs that are opened again, and for formats that are not read here.
  async drawFromService() {
    const of = this.session;
    const { input } = of.report;
    const isReadHere = ["stl", "obj", "ply", "off", "3mf"].includes(input.format) && !of.file;
    const format = isReadHere ? input.format : "ply";
    const unit = of.unit || input.units.unit;
    const bytes = await this.converted(format, unit, { input: { job: of.inputJob } });
    if (!bytes || of !== this.session) return;
    const drawn = await this.draw("before", bytes, `mesh.${format}`);
    if (drawn && of.file) await this.seekPictures(drawn, of.file);
    // In one mesh nothing says which face is which part's.
    if (drawn && input.format === "3mf" && !drawn.project) {
      drawn.project = NO_PARTS;
      this.overlays();
    }
  }

  // A mesh as the service writes it in `format`, in its own unit; null: it cannot.
  async converted(format, unit, more, file = null) {
    const job = await this.api.follow(await this.api.create({ operation: "convert", output_format: format, units: unit, output_units: unit, ...more }, file), () => {});
    if (!job.links.result) return null;
    return (await this.api.file(job.links.result)).blob.arrayBuffer();
  }

  // The result beside the file, and what they have in common.
  async drawResult(job, level = 0) {
    const of = this.session;
    delete of.pictures.after;
    const { blob, name } = await this.api.file(levelOf(job, level));
    const bytes = await blob.arrayBuffer();
    if (of !== this.session) return;
    await this.draw("after", bytes, name, of.reportUnit).catch(async (error) => {
      if (error.code !== "not-drawn-here") throw error;
      const ply = await this.converted("ply", of.report.output_units, {}, new File([blob], name));
      const drawn = ply && of === this.session && await this.draw("after", ply, "mesh.ply", of.reportUnit);
      if (drawn) await this.seekPictures(drawn, blob);
    });
    if (!of.pictures.before || !of.pictures.after || of !== this.session) return;
    const kept = await this.meshes.ask("compare");
    if (of !== this.session) return;
    of.pictures.before.kept = kept.before;
    of.pictures.after.kept = kept.after;
    of.maps = {};
    at("colors").value = this.tools?.hasColors ? "file" : "kept";
    this.tools?.offer(true);
  }

  // A mesh that the service made of a glTF says nothing of its pictures; the text of the file does.
  async seekPictures(picture, file) {
    picture.isTextured ||= (await file.slice(0, TEXT_BYTES).text()).includes('"baseColorTexture"');
    this.tools?.tellTextures();
  }

  overlays() {
    const picture = this.session.pictures.before;
    if (!picture || !this.session.report) return;
    picture.project?.setParts(this.session.report.parts ?? [], this.session.report.before.counts.faces);
    for (const defect of this.session.report.before.defects) {
      this.view?.setMarks("before", defect.code, picture.overlayOf(defect, this.session.reportUnit), ofDefect(defect.code), 0.5);
      this.view?.showMarks("before", defect.code, this.session.shown.has(defect.code));
    }
  }

  // Lights what parts show, with a ring around its place.
  light(parts, color, side = "before", position = null) {
    this.session.lit = parts ? { place: parts && aim(parts, position).place, side } : null;
    for (const name of ["before", "after"]) this.view?.setMarks(name, "lit", null);
    if (parts) this.view?.setMarks(side, "lit", parts, color, 1.3);
    this.ring();
  }

  // The ring is an element over the picture, so that it is as wide wherever the place is.
  ring() {
    const place = this.session?.lit && this.view?.project(this.session.lit.place);
    at("ring").hidden = !place;
    if (place) at("ring").style.transform = `translate(${place[0]}px, ${place[1]}px)`;
  }
}

// Where a level of detail of a job is.
export const levelOf = (job, level) => (level ? `${job.links.result}?level=${level + 1}` : job.links.result);
