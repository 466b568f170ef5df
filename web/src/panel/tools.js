// The tools of the picture.

import { at, el } from "../dom.js";
import { length, number, t } from "../text/text.js";
import { NO_VALUE } from "../view/surface.js";

// Buttons that are on or off, and the setting that each is.
const SWITCHES = { smooth: "smooth", edges: "edges", backs: "backs", grid: "grid" };

export class Tools {
  constructor(view, meshes, session) {
    this.view = view;
    this.meshes = meshes;
    this.session = session; // gives the current one
    for (const [id, name] of Object.entries(SWITCHES)) {
      at(id).addEventListener("click", () => {
        const isOn = at(id).getAttribute("aria-pressed") !== "true";
        at(id).setAttribute("aria-pressed", String(isOn));
        view.set({ [name]: isOn });
      });
    }
    at("fit").addEventListener("click", () => view.camera.fit());
    for (const button of document.querySelectorAll("[data-look]")) button.addEventListener("click", () => view.camera.look(button.dataset.look));
    for (const button of document.querySelectorAll("#arrangement [data-arrangement]")) button.addEventListener("click", () => this.arrange(button.dataset.arrangement));
    at("section").addEventListener("click", () => this.section(at("section").getAttribute("aria-pressed") !== "true"));
    for (const id of ["section-axis", "section-at"]) at(id).addEventListener("input", () => this.section(true));
    at("colors").addEventListener("change", () => this.color(at("colors").value));
    this.divider();
    this.keys();
  }

  // Before, after, or both.
  arrange(arrangement) {
    for (const button of document.querySelectorAll("#arrangement [data-arrangement]")) button.setAttribute("aria-pressed", String(button.dataset.arrangement === arrangement));
    at("divider").hidden = arrangement !== "slider";
    at("view").dataset.arrangement = arrangement;
    this.view.set({ arrangement });
  }

  section(isOn) {
    at("section").setAttribute("aria-pressed", String(isOn));
    at("section-tools").hidden = !isOn;
    this.view.setSection(Number(at("section-axis").value), isOn ? Number(at("section-at").value) : null);
  }

  divider() {
    const divider = at("divider");
    const set = (share) => {
      const kept = Math.min(0.98, Math.max(0.02, share));
      divider.style.left = `${kept * 100}%`;
      divider.setAttribute("aria-valuenow", String(Math.round(kept * 100)));
      this.view.set({ divider: kept });
    };
    divider.addEventListener("pointerdown", (event) => divider.setPointerCapture(event.pointerId));
    divider.addEventListener("pointermove", (event) => {
      if (!divider.hasPointerCapture(event.pointerId)) return;
      const box = at("view").getBoundingClientRect();
      set((event.clientX - box.left) / box.width);
    });
    divider.addEventListener("keydown", (event) => {
      const by = { ArrowLeft: -0.02, ArrowDown: -0.02, ArrowRight: 0.02, ArrowUp: 0.02, PageDown: -0.1, PageUp: 0.1, Home: -1, End: 1 }[event.key];
      if (!by) return;
      event.preventDefault();
      set(this.view.settings.divider + by);
    });
  }

  keys() {
    const { camera } = this.view;
    const actions = {
      ArrowLeft: () => camera.turn(-1, 0), ArrowRight: () => camera.turn(1, 0), ArrowUp: () => camera.turn(0, 1), ArrowDown: () => camera.turn(0, -1),
      "+": () => camera.zoom(0.85), "-": () => camera.zoom(1 / 0.85), f: () => camera.fit(), F: () => camera.fit(),
    };
    at("canvas").addEventListener("keydown", (event) => {
      if (!actions[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      actions[event.key]();
    });
  }

  get hasColors() {
    return Object.values(this.session()?.pictures ?? {}).some(({ colors }) => colors);
  }

  // A mesh came: its own colours are shown, unless another way was chosen.
  colorsCame(side) {
    at("colors").options[0].hidden = !this.hasColors;
    at("colors").options[0].disabled = !this.hasColors;
    if (side === "before" && this.hasColors && at("colors").value === "plain") this.color(at("colors").value = "file");
    this.tellTextures();
  }

  tellTextures() {
    at("textured").hidden = !Object.values(this.session()?.pictures ?? {}).some(({ isTextured }) => isTextured);
  }

  // What there is to choose from, now that a mesh or a result came.
  offer(hasResult) {
    at("arrangement").hidden = !hasResult;
    for (const option of at("colors").options) option.disabled = !hasResult && ["kept", "deviation"].includes(option.value);
    if (!hasResult) at("colors").value = this.hasColors ? "file" : "plain";
    this.colorsCame("after");
    this.color(at("colors").value);
    this.arrange(hasResult ? "slider" : "before");
  }

  // Colours the surfaces; the figures for it are computed when they are first wanted.
  async color(name) {
    const session = this.session();
    at("legend").hidden = ["plain", "file"].includes(name);
    this.view.set({ colors: name });
    if (at("legend").hidden) return;
    at("legend").replaceChildren(t("view.working"));
    const maps = await this.maps(session, name);
    if (this.session() !== session || at("colors").value !== name) return;
    for (const [side, bytes] of Object.entries(maps.bytes)) this.view.setValues(side, bytes);
    at("legend").replaceChildren(...maps.legend());
  }

  async maps(session, name) {
    session.maps ??= {};
    session.maps[name] ??= await this[name](session);
    return session.maps[name];
  }

  async kept({ pictures }) {
    const { before, after } = pictures;
    const spread = (flags) => flags && Uint8Array.from({ length: flags.length * 3 }, (_, i) => (flags[(i / 3) | 0] ? NO_VALUE : 0));
    const count = (flags) => number(flags.reduce((sum, flag) => sum + flag, 0));
    const none = (flags) => number(flags.reduce((sum, flag) => sum + 1 - flag, 0));
    const row = (color, key, told) => swatch(color, `${t(key)} ${told}`);
    return {
      bytes: { before: spread(before.kept), after: spread(after.kept) },
      legend: () => [row("kept", "legend.kept", count(after.kept)), row("new", "legend.new", none(after.kept)), row("gone", "legend.gone", none(before.kept))],
    };
  }

  async deviation() {
    const values = await this.meshes.ask("deviation");
    const most = Math.max(...[values.before, values.after].map((side) => side.reduce((max, value) => Math.max(max, value), 0)));
    const bytes = Object.fromEntries(Object.entries(values).map(([side, list]) => [side, Uint8Array.from(list, (value) => (most > 0 ? Math.round((value / most) * 254) : 0))]));
    return { bytes, legend: () => scale("0 mm", length(most)) };
  }

  async thickness({ pictures }) {
    const sides = Object.keys(pictures);
    const lists = await Promise.all(sides.map((name) => this.meshes.ask("thickness", { name })));
    const all = lists.flatMap((list) => [...list.filter((value, i) => i % 3 === 0 && Number.isFinite(value))]).sort((a, b) => a - b);
    const most = all[Math.floor(all.length * 0.9)] ?? 1;
    // Thin walls are what one looks for, so they have the warm end.
    const byte = (value) => (Number.isFinite(value) ? Math.round((1 - Math.min(1, value / most)) * 254) : NO_VALUE);
    const bytes = Object.fromEntries(sides.map((name, i) => [name, Uint8Array.from(lists[i], byte)]));
    const isPart = lists.some((list) => list.some(Number.isNaN));
    return { bytes, legend: () => [...scale(`≥ ${length(most)}`, "0 mm"), ...(isPart ? [swatch("kept", t("legend.unmeasured"))] : [])] };
  }
}

const swatch = (color, text) => el("span", {}, el("i", { className: `swatch ${color}` }), text);
const scale = (low, high) => [el("span", {}, low), el("i", { className: "ramp" }), el("span", {}, high), el("small", {}, t("legend.about"))];
