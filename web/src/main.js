// The page: one file at a time, from drop to download.

import { Api, Problem, isOver } from "./api.js";
import { Choices } from "./choices.js";
import { at, el, holdFocus, keepFocus, save } from "./dom.js";
import { Drawing, levelOf } from "./drawing.js";
import { Meshes } from "./meshes.js";
import { question, sizeText } from "./panel/facts.js";
import { findingsList, isShownFirst, openFinding } from "./panel/findings.js";
import { calm, complain, rest, told, wordsOf, working } from "./panel/progress.js";
import { partsList } from "./panel/parts.js";
import { checksList, resultSection, verdictCard } from "./panel/result.js";
import { SEVERAL_MAX, askAboutSeveral } from "./panel/several.js";
import { Tools } from "./panel/tools.js";
import { droppable } from "./panel/verify.js";
import { aim } from "./places.js";
import * as jobs from "./recent.js";
import { SAMPLES, sample } from "./samples.js";
import { Session, curlOf, formatOf, toldBy } from "./session.js";
import { LANGUAGES, current, number, percent, speak, t, translate } from "./text/text.js";
import { ofDefect } from "./view/colors.js";
import { View } from "./view/view.js";

const api = new Api();
const meshes = new Meshes();
const drawing = new Drawing({ api, meshes, current: () => session, sized: (picture) => factsOf(picture) });
let session = null;
let running = null; // the job that is followed
let view = null;
let tools = null;
let list = null; // the findings

// --- a file ----------------------------------------------------------------------------------------------------

// A problem of the current file is told; one of a file that was left is not.
async function guarded(action, of = session) {
  try {
    calm();
    return await action();
  } catch (error) {
    if (of !== session) return undefined;
    rest();
    at("repair").disabled = false;
    if (!session?.report && !session?.pictures.before) document.body.dataset.state = "failed";
    complain(error instanceof Error ? error : new Problem({ code: "other" }), canLookAgain(error) && (() => guarded(lookAgain)));
    if (error.code === "unauthenticated") at("key-form").hidden = false;
    keepFocus(at("repair"));
    return undefined;
  }
}

// Whether there is something to look at that may do better another time.
function canLookAgain({ code }) {
  return session && !session.report && (session.file || session.inputJob) && !/^(mesh|archive|body|unsupported|unauth)/.test(code);
}

function begin(name, file, isNamed) {
  session = new Session(name, file, isNamed);
  holdFocus();
  document.body.dataset.state = "open";
  at("units").options[0].textContent = "–";
  at("repair").disabled = false;
  at("repair").classList.remove("wanted");
  for (const id of ["verdict", "earlier", "findings", "parts-list", "checks", "result"]) at(id).replaceChildren();
  for (const id of ["facts", "findings-section", "repair-section", "solid-field"]) at(id).hidden = true;
  showChoices();
  at("file-name").textContent = name;
  document.title = `${name} – Meshmend`;
  delete at("view").dataset.drawn;
  view?.clear("before");
  view?.clear("after");
  tools?.offer(false);
  drawing.light(null);
  calm();
  keepFocus(at("canvas"));
  jobs.name(null);
}

function showChoices() {
  const { unit, policy, solid, choices } = session;
  for (const [id, value] of Object.entries({ units: unit, policy, solid, levels: choices.levels, share: Math.round(choices.share * 100) })) at(id).value = value;
  at("best").checked = choices.takesBest;
  shareText();
}

// One file is opened; several become one, if they shall.
function openFiles(files) {
  const chosen = [...files];
  const isEmpty = chosen.some(({ size }) => size === 0);
  if (chosen.length < 2 && !isEmpty) return openFile(chosen[0]);
  if (document.body.dataset.state === "start") document.body.dataset.state = "failed";
  if (isEmpty) return complain(new Problem({ code: "file-empty" }));
  if (chosen.length > SEVERAL_MAX) return complain(new Problem({ code: "too-many-files" }));
  return askAboutSeveral(chosen, { combine: (operation) => combine(chosen, operation), openFirst: () => openFile(chosen[0]) });
}

// The result of a set operation is opened as a file of its own.
async function combine(files, operation) {
  begin(t(`several.${operation}`));
  const of = session;
  await guarded(async () => {
    const job = await run({ operation: "boolean", set_operation: operation }, files);
    if (of !== session) return;
    // The reason says more than that there is no result.
    if (job.problem) throw new Problem({ ...job.problem, code: (await api.report(job)).verdict.reasons[0]?.code ?? job.problem.code });
    await openResult(job, operation);
  }, of);
}

async function openResult(job, stem) {
  const of = session;
  const { name, blob } = await api.file(job.links.result);
  if (of === session) openFile(new File([blob], name.replace(/^.*(?=\.)/, stem)));
}

async function openFile(file) {
  if (!file) return;
  begin(file.name, file);
  const of = session;
  working(t("status.reading"));
  await guarded(() => look(drawFile(of)), of);
}

// Draws the file as far as it is read here.
async function drawFile(of) {
  try {
    await drawing.draw("before", await of.file.arrayBuffer(), of.name);
    if (of === session) document.body.dataset.state = "open";
    return null;
  } catch (error) {
    return { error };
  }
}

// Asks what is wrong with the file, and what can be done about it. Only what was asked last is told.
async function look(picture) {
  const of = session;
  const count = of.looks += 1;
  const request = { operation: "plan", ...of.options(), ...(of.inputJob ? { input: { job: of.inputJob } } : {}) };
  const job = await run(request, of.inputJob ? null : of.file);
  if (of !== session || count !== of.looks) return;
  of.inputJob ??= job.id;
  await show(job);
  await drawnSomehow(picture);
}

// What is not drawn here, the service draws.
async function drawnSomehow(picture) {
  const of = session;
  const drawn = await picture;
  if (of === session && drawn?.error?.code === "too-vast") return complain(drawn.error);
  if (drawn?.error && of === session) await drawing.drawFromService();
}

// Makes a job and follows it to its end; one that failed without a report is a problem.
async function run(request, file) {
  const of = session;
  working(t(file ? "status.sending" : "status.queued"));
  const job = await api.create(request, file);
  const { operation, input, thumbnail, ...asked } = request;
  jobs.remember(job, of.name, asked);
  if (of !== session) return job;
  return follow(job);
}

async function follow(job) {
  const of = session;
  jobs.name(job.id);
  running = job;
  at("cancel").hidden = isOver(job);
  if (!at("cancel").hidden) keepFocus(at("cancel"));
  const ended = await api.follow(job, (event) => { if (of === session) told(event); });
  if (running === job) {
    running = null;
    at("cancel").hidden = true;
  }
  if (ended.problem && !ended.links.report) throw new Problem(ended.problem);
  if (ended.state === "cancelled" || ended.state === "expired") throw new Problem({ code: ended.state });
  return ended;
}

// --- the panel -------------------------------------------------------------------------------------------------

function factsOf({ bounds, faceCount, faceOf }) {
  session.size = bounds.max.map((high, axis) => high - bounds.min[axis]);
  session.triangleCount = Math.max(faceCount, faceOf?.length ?? 0); // faces of more corners are several triangles
  sizeText(session);
  at("facts").hidden = false;
  shareText();
}

// What a report says, wherever it belongs.
async function show(job) {
  const of = session;
  const report = await api.report(job);
  if (of !== session) return;
  Object.assign(of, { job, given: report.certificate && formatOf(report.certificate) });
  const isFirst = !of.report;
  of.report = report;
  if (isFirst) for (const defect of report.before.defects) if (isShownFirst(defect)) of.shown.add(defect.code);
  of.checked = report.printing?.policy ?? "";
  of.partCount = Math.max(of.partCount, report.parts?.length ?? 0);
  rest();
  panel();
  drawing.overlays();
}

function panel() {
  const { report } = session;
  const focused = document.activeElement.id;
  if (focused) holdFocus();
  at("verdict").replaceChildren(verdictCard({ report, policy: session.checked }));
  list = findingsList(session, host);
  at("findings").replaceChildren(list);
  at("parts-list").replaceChildren(...[partsList(report, host)].filter(Boolean));
  at("checks").replaceChildren(...[checksList(report, host)].filter(Boolean));
  at("result").replaceChildren(...[session.isRepaired && resultSection(session, host)].filter(Boolean));
  at("findings-section").hidden = false;
  at("repair-section").hidden = false;
  at("solid-field").hidden = session.partCount < 2;
  at("repair").textContent = t(session.isRepaired ? "repair.again" : report.verdict.printable ? "certify" : "repair");
  at("repair").disabled = false;
  const { unit, is_stated: isStated } = report.input.units;
  at("units").options[0].textContent = isStated ? (session.unit ? "–" : unit) : t("unit.assumed", { u: unit });
  // A 3MF is right about its own unit.
  at("units").disabled = report.input.format === "3mf";
  question(report);
  tellEarlier();
  if (!session.pictures.before && report.before.measures.bounds) {
    const { min, max } = report.before.measures.bounds;
    factsOf({ bounds: { min: min.map((v) => v * session.reportUnit), max: max.map((v) => v * session.reportUnit) }, faceCount: report.before.counts.triangles });
  }
  if (session.size) sizeText(session);
  at("panel").dataset.operation = report.operation;
  if (session.place) openFinding(list, session, host, session.place.code, session.place.number);
  if (focused) keepFocus(at(focused));
}

// What lists ask for.
const host = {
  show(code, isShown) {
    if (isShown) session.shown.add(code);
    else session.shown.delete(code);
    view?.showMarks("before", code, isShown);
  },

  // Flies to a place, or closes its list when it is open.
  visit(code, at_, isOpen = false) {
    if (isOpen) {
      session.place = null;
      drawing.light(null);
      openFinding(list, session, host, null, 0);
      return;
    }
    session.place = { code, number: at_ };
    openFinding(list, session, host, code, at_);
    const witness = session.defect(code).witnesses[at_];
    const picture = session.pictures.before;
    at("view").dataset.place = `${code} ${at_}`;
    if (!witness || !picture || !view) return;
    const parts = picture.partsOf(code, witness, session.reportUnit, true);
    const position = witness.position && picture.place(witness.position, session.reportUnit, witness.faces[0]?.index);
    if (view.settings.arrangement === "after") tools.arrange("before");
    drawing.light(parts, ofDefect(code), "before", position ?? [0, 0, 0]);
    const { place, normal, radius } = aim(parts, position ?? [0, 0, 0]);
    view.fly(place, normal, radius);
  },

  // From place to place, over the borders of the lists.
  step(by) {
    const all = [...list.querySelectorAll(".finding")].map(({ dataset }) => dataset.code).flatMap((code) => session.defect(code).witnesses.map((_, i) => [code, i]));
    if (all.length === 0) return;
    const { code, number: from } = session.place ?? { code: null, number: 0 };
    const found = all.findIndex(([name, i]) => name === code && i === from);
    host.visit(...all[found < 0 ? (by > 0 ? 0 : all.length - 1) : (found + by + all.length) % all.length]);
  },

  changed() {
    at("repair").classList.add("wanted");
  },

  refresh() {
    if (session.place) openFinding(list, session, host, session.place.code, session.place.number);
  },

  flyToCheck({ witnesses }) {
    const side = session.report.printing.about === "result" ? "after" : "before";
    const picture = session.pictures[side];
    if (!picture || !view) return;
    const place = picture.place(witnesses[0].position, session.reportUnit, witnesses[0].face);
    if (!place) return;
    const parts = { segments: [], faces: picture.facesAt([witnesses[0].face]), points: place };
    if (view.settings.arrangement !== "beside") tools.arrange(side);
    drawing.light({ ...parts, faces: [] }, "#f2a51c", side);
    const { normal } = aim(parts, place);
    view.fly(place, normal, Math.hypot(...view.size) * 0.06);
  },

  visitPart(number_) {
    const where = session.pictures.before?.whereIs(number_);
    at("view").dataset.place = `part ${number_}`;
    if (!where || !view) return;
    if (view.settings.arrangement === "after") tools.arrange("before");
    session.place = null;
    drawing.light(where.undrawn, "#8a97a4");
    openFinding(list, session, host, null, 0);
    view.fly(where.place, [0, 0, 0], where.radius / 2);
  },

  showLevel: (level) => guarded(async () => {
    const of = session;
    working(t("status.fetching"));
    await drawing.drawResult(of.job, level);
    if (of !== session) return;
    of.level = level;
    rest();
    panel();
    at("result").querySelector(`[data-level="${level}"]`).focus();
  }),

  downloadLevel: (level) => guarded(async () => {
    const of = session;
    const { name, blob } = await api.file(levelOf(of.job, level));
    save(blob, of.named(name));
  }),

  // Another format is another file, so it is made and certified anew.
  download: (format) => guarded(async () => {
    const of = session;
    let { job } = of;
    if (format !== of.given) {
      job = await run({ operation: "repair", input: { job: of.inputJob }, ...of.asked, output_format: format }, null);
      if (of !== session) return;
      if (job.problem) throw new Problem(job.problem);
      Object.assign(of, { report: await api.report(job), job, given: format });
      rest();
      panel();
      drawing.overlays();
    }
    const { name, blob } = await api.file(job.links.result);
    save(blob, of.named(name));
  }),

  openReport: () => guarded(async () => {
    // A tab of its own cannot bring the key, so then it is a download.
    if (!api.key) return void window.open(session.job.links.report, "_blank", "noopener");
    const { downloadStem, job } = session;
    const { blob } = await api.file(job.links.report, "text/html");
    return save(blob, `${downloadStem}.report.html`);
  }),

  curl: () => curlOf(session),
  words: wordsOf,

  async verify(file) {
    const [digest, job] = await Promise.all([
      file.arrayBuffer().then((bytes) => meshes.ask("digest", { bytes }, [bytes])),
      api.create({ operation: "verify" }, file).then((made) => api.follow(made, () => {})),
    ]);
    if (job.problem) throw new Problem(job.problem);
    return { digest, isValid: (await api.report(job)).verdict.printable };
  },
};

// --- repair ----------------------------------------------------------------------------------------------------

async function repair() {
  const of = session;
  of.looks += 1; // what is still looked at is not told any more
  holdFocus();
  at("repair").disabled = true;
  of.choices.takesBest = at("best").checked;
  of.choices.share = Number(at("share").value) / 100;
  of.choices.levels = Number(at("levels").value);
  const chosen = { unit: at("units").value, policy: at("policy").value };
  const asked = of.repairOptions(chosen);
  const job = await run({ operation: "repair", thumbnail: true, input: { job: of.inputJob }, ...asked }, null);
  if (of !== session) return;
  const before = of.fileUnit;
  Object.assign(of, { asked, isAskedKnown: true }, chosen);
  at("repair").classList.remove("wanted");
  if (of.fileUnit !== before) await drawnSomehow(redraw());
  await showRepair(job);
}

async function showRepair(job) {
  const of = session;
  if (job.links.result) working(t("status.fetching"));
  await show(job);
  if (of !== session) return;
  of.level = 0;
  drawing.light(null);
  of.place = null;
  openFinding(list, of, host, null, 0);
  if (job.links.result) {
    await drawing.drawResult(job);
    if (of !== session) return;
    view?.comeBack();
  } else {
    delete of.pictures.after;
    tools?.offer(false);
  }
  at("panel").scrollTop = 0;
  window.scrollTo(0, 0);
  keepFocus(at("verdict"));
}

function shareText() {
  const share = Number(at("share").value) / 100;
  at("share-text").textContent = share === 1 ? t("simplify.all") : t("simplify.share", { p: percent(share), n: number((session?.triangleCount ?? 0) * share) });
  at("share").setAttribute("aria-valuetext", at("share-text").textContent);
}

// A unit or a process changes what is said of the file, not the file. A result stays as it was made until the next repair.
async function chooseUnitOrProcess() {
  if (!session.isRepaired && !at("repair").disabled) return lookAgain();
  host.changed();
  return tellEarlier();
}

function tellEarlier() {
  const { isRepaired, unit, policy, asked } = session;
  const isOther = (id, made) => at(id).value !== made;
  const isEarlier = isRepaired && (isOther("units", unit) || isOther("policy", policy) || isOther("solid", asked?.parts ?? "separate"));
  at("earlier").textContent = isEarlier ? t("earlier") : "";
}

async function lookAgain() {
  if (!session.inputJob && !session.file) return;
  const of = session;
  document.body.dataset.state = "open";
  const before = of.fileUnit;
  of.unit = at("units").value;
  of.policy = at("policy").value;
  tools?.offer(false);
  view?.clear("after");
  delete of.pictures.after;
  const isDrawn = of.pictures.before && before === of.fileUnit;
  await look(isDrawn ? null : redraw());
}

// What of several parts is one solid. Together they have other findings than one by one; those of a result stay with it.
async function chooseSolid() {
  const isOfOthers = [session.solid, at("solid").value].includes("together");
  session.solid = at("solid").value;
  host.changed();
  tellEarlier();
  if (!isOfOthers) return;
  session.choices = new Choices();
  if (session.isRepaired || at("repair").disabled) return host.refresh();
  session.place = null;
  drawing.light(null);
  await lookAgain();
}

async function redraw() {
  if (session.file) return drawFile(session);
  return session.report ? drawing.drawFromService().catch((error) => ({ error })) : { error: true };
}

// --- jobs of this browser --------------------------------------------------------------------------------------

// Opens a job again, at whatever it has come to.
async function openJob(id) {
  const known = jobs.known(id);
  begin(known?.name ?? id.slice(0, 8), null, Boolean(known));
  const of = session;
  jobs.name(id);
  await guarded(async () => {
    working(t("status.queued"));
    const job = await follow(await api.job(id));
    if (of !== session) return;
    if (job.operation === "boolean" && job.links.result) return void openResult(job, of.name);
    of.inputJob = id;
    if (!["plan", "repair"].includes(job.operation)) throw new Problem({ code: "not-found" });
    await takeChoices(job, known?.asked);
    if (of !== session) return;
    await show(job);
    if (of !== session) return;
    await drawing.drawFromService();
    if (of !== session) return;
    rest();
    if (job.operation === "repair") await showRepair(job);
  }, of);
}

// What the page shows and asks for is what the job was made with.
async function takeChoices(job, asked) {
  const of = session;
  const taken = asked ?? toldBy(await api.report(job));
  if (of !== session) return;
  of.take(taken);
  showChoices();
  // What the lists do not offer was not chosen here.
  of.take({ ...taken, units: at("units").value, policy: at("policy").value });
  Object.assign(of, { asked: taken, isAskedKnown: Boolean(asked) });
}

function showJobs() {
  const rows = jobs.recent().map(({ id, name, operation, at: when }) => el("li", {},
    el("a", { href: `#job=${id}`, onclick: () => { at("jobs").open = false; } },
      el("strong", {}, name), el("span", {}, `${t(`operation.${operation}`)}, ${new Date(when).toLocaleString(current())}`))));
  at("jobs-list").replaceChildren(...(rows.length ? rows : [el("li", { className: "note" }, t("jobs.none"))]));
  at("jobs-forget").hidden = rows.length === 0;
}

// --- the page itself -------------------------------------------------------------------------------------------

function showPicture() {
  try {
    view = new View(at("canvas"), { onDrawn: () => { drawing.ring(); at("view").dataset.frames = String(Number(at("view").dataset.frames ?? 0) + 1); }, onEased: () => drawing.tellEased() });
    drawing.view = view;
  } catch {
    at("no-webgl").hidden = false;
    document.body.classList.add("flat");
    return;
  }
  tools = new Tools(view, meshes, () => session);
  drawing.tools = tools;
}

const dark = matchMedia("(prefers-color-scheme: dark)");
const themeNow = () => document.documentElement.dataset.theme ?? (dark.matches ? "dark" : "light");
const useTheme = () => view?.setTheme(themeNow());

function chooseTheme(name) {
  document.documentElement.dataset.theme = name;
  try { localStorage.setItem("theme", name); } catch { /* not kept, then */ }
  useTheme();
}

function restoreTheme() {
  try {
    const name = localStorage.getItem("theme");
    if (name) document.documentElement.dataset.theme = name;
  } catch { /* as the system has it, then */ }
}

// On a phone there is no room in the picture.
const phone = matchMedia("(max-width: 760px)");
const placeNotes = () => at(phone.matches ? "facts" : "corner").append(at("textured"), at("far"), at("coarse"));

function texts() {
  document.documentElement.lang = current();
  translate(document);
  shareText();
  if (session?.report) panel();
  drawing.tellEased();
  drawing.tellFar();
  tools?.color(at("colors").value);
}

function listen() {
  droppable(document.body, openFiles);
  at("file").addEventListener("change", () => { openFiles(at("file").files); at("file").value = ""; });
  for (const name of Object.keys(SAMPLES)) at(`sample-${name}`).addEventListener("click", () => openFile(sample(name)));
  at("repair").addEventListener("click", () => guarded(repair));
  at("cancel").addEventListener("click", () => running && guarded(() => api.cancel(running)));
  at("share").addEventListener("input", () => { shareText(); host.changed(); });
  for (const id of ["best", "levels"]) at(id).addEventListener("change", host.changed);
  for (const id of ["units", "policy"]) at(id).addEventListener("change", () => guarded(chooseUnitOrProcess));
  at("solid").addEventListener("change", () => guarded(chooseSolid));
  at("jobs").addEventListener("toggle", showJobs);
  document.addEventListener("pointerdown", (event) => { if (!at("jobs").contains(event.target)) at("jobs").open = false; });
  at("jobs").addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    at("jobs").open = false;
    at("jobs").querySelector("summary").focus();
  });
  at("jobs-forget").addEventListener("click", () => { jobs.forgetAll(); showJobs(); });
  at("language").value = current();
  at("language").addEventListener("change", () => { speak(at("language").value); texts(); });
  at("theme").addEventListener("click", () => chooseTheme(themeNow() === "dark" ? "light" : "dark"));
  dark.addEventListener("change", useTheme);
  phone.addEventListener("change", placeNotes);
  at("key-form").addEventListener("submit", (event) => {
    event.preventDefault();
    api.useKey(at("key").value);
    at("key-form").hidden = true;
    if (session?.file) openFile(session.file);
    else if (jobs.named()) openJob(jobs.named());
  });
  window.addEventListener("hashchange", () => { if (jobs.named() && jobs.named() !== session?.job?.id) openJob(jobs.named()); });
  document.addEventListener("keydown", (event) => {
    const isTyping = event.target.closest("input:not([type=checkbox]), select, textarea") || event.ctrlKey || event.metaKey || event.altKey;
    const by = { n: 1, N: 1, p: -1, P: -1 }[event.key];
    if (isTyping || !by || !session?.report) return;
    event.preventDefault();
    host.step(by);
  });
}

if (!LANGUAGES.includes(current())) speak("en");
showPicture();
listen();
texts();
restoreTheme();
useTheme();
placeNotes();
if (jobs.named()) openJob(jobs.named());
document.body.dataset.ready = "true";
