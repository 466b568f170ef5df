// The picture: two sides, before and after, under one camera. It is drawn when something changed, and not otherwise.

import { Scene, Vector2, Vector3, WebGLRenderer } from "three";
import { bed } from "./bed.js";
import { Camera } from "./camera.js";
import { rgb, theme } from "./colors.js";
import { dispose, marks } from "./marks.js";
import { modeOf, setValues, surface, surfaceMaterials } from "./surface.js";

const SLOW_MS = 45; // a frame that takes longer makes turning tedious
const STILL_MS = 160; // without a movement, all of it is drawn again
// What is drawn while the view moves, where frames are slow: less and less. A coarse copy is taken where there is one.
const EASINGS = [{ copy: null, pixels: 1 }, { copy: 0, pixels: 1 }, { copy: 1, pixels: 1 }, { copy: 1, pixels: 0.6 }, { copy: 1, pixels: 0.4 }];
// Triangles of the coarse copies, about.
export const COPIES = [120_000, 16_000];
// Triangles from which on a surface is drawn in one pass where no graphics card draws it: two take twice as long.
const ONE_PASS_ABOVE = 300_000;

export class View {
  constructor(canvas, { onDrawn, onEased }) {
    this.canvas = canvas;
    this.onDrawn = onDrawn;
    this.onEased = onEased;
    this.easing = 0;
    this.isSoftware = isSoftware();
    this.renderer = new WebGLRenderer({ canvas, antialias: !this.isSoftware, alpha: true, powerPreference: "high-performance" });
    this.camera = new Camera(canvas, { moved: () => this.moved(), held: (isHeld) => this.hold(isHeld) });
    this.shared = { pixels: { value: new Vector2(1, 1) }, isCut: { value: false }, plane: { value: [0, 0, 1, 0] } };
    this.sides = { before: this.side(), after: this.side() };
    this.settings = { arrangement: "before", divider: 0.5, colors: "plain", smooth: false, edges: false, backs: true, grid: true };
    this.themeName = "light";
    this.isMoving = false;
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  side() {
    return { scene: new Scene(), materials: surfaceMaterials(false), isColored: false, surface: null, coarse: [], marks: new Map() };
  }

  // A mesh for a side; the first one of a file says where the bed is and how far the camera.
  setMesh(name, { drawn, positions: all, normals, colors, bulk: { bounds } }, isFirst) {
    this.clear(name);
    const positions = all.subarray(0, drawn * 9);
    const side = this.sides[name];
    if (side.isColored !== Boolean(colors)) Object.assign(side, { isColored: Boolean(colors), materials: surfaceMaterials(Boolean(colors)) });
    const isQuick = this.isSoftware && positions.length / 9 > ONE_PASS_ABOVE;
    side.surface = surface({ positions, normals, colors }, isQuick ? side.materials.both : side.materials.sides);
    side.scene.add(side.surface);
    if (isFirst) {
      this.easing = 0;
      this.size = bounds.min.map((low, axis) => bounds.max[axis] - low);
      this.camera.setScene(Math.hypot(...this.size) / 2 || 1);
      this.layBed();
    }
    this.applyAll();
  }

  // Coarse copies, the finest first, to draw in its place while the view moves, where whole frames are slow.
  setCoarse(name, copies) {
    const side = this.sides[name];
    if (!side.surface) return;
    side.coarse = copies.map((copy) => surface(copy, side.materials.coarse));
    side.scene.add(...side.coarse);
    this.isMoving = true;
    while (this.easing < EASINGS.length - 1 && this.measure() > SLOW_MS) this.easing += 1;
    this.isMoving = false;
    this.invalidate();
  }

  // Milliseconds of a frame, once what it needs has been loaded.
  measure() {
    this.timed();
    return this.timed();
  }

  timed() {
    const gl = this.renderer.getContext();
    const begin = performance.now();
    this.draw();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits for the card
    return performance.now() - begin;
  }

  // Frames come too slowly while the view moves: the next ones are easier.
  watch(now) {
    const passed = now - this.lastFrame;
    this.lastFrame = this.isMoving ? now : NaN;
    this.slow = passed > SLOW_MS ? (this.slow ?? 0) + 1 : 0;
    if (this.slow < 2 || this.easing === EASINGS.length - 1) return;
    this.slow = 0;
    this.easing += 1;
    this.onEased();
  }

  clear(name) {
    const side = this.sides[name];
    for (const code of [...side.marks.keys()]) this.setMarks(name, code, null);
    for (const mesh of [side.surface, ...side.coarse]) {
      mesh?.geometry.dispose();
      mesh?.removeFromParent();
    }
    Object.assign(side, { surface: null, coarse: [] });
    if (name === "before") {
      this.size = null;
      this.layBed();
    }
    this.invalidate();
  }

  layBed() {
    for (const side of Object.values(this.sides)) {
      dispose(side.bed);
      side.bed = this.size ? bed(this.size, theme(this.themeName).grid) : null;
      if (side.bed) side.scene.add(side.bed);
    }
  }

  // Marks of a kind on a side; `null` takes them away.
  setMarks(name, kind, parts, color, strength) {
    const side = this.sides[name];
    dispose(side.marks.get(kind));
    side.marks.delete(kind);
    if (parts) {
      const group = marks(parts, color, this.shared, strength);
      side.marks.set(kind, group);
      side.scene.add(group);
    }
    this.invalidate();
  }

  showMarks(name, kind, isShown) {
    const group = this.sides[name].marks.get(kind);
    if (group) group.visible = isShown;
    this.invalidate();
  }

  // Bytes to colour the corners of a side by.
  setValues(name, bytes) {
    const { surface: mesh } = this.sides[name];
    if (mesh) setValues(mesh, bytes);
    this.invalidate();
  }

  set(changes) {
    Object.assign(this.settings, changes);
    this.applyAll();
  }

  setTheme(name) {
    this.themeName = name;
    this.layBed();
    this.applyAll();
  }

  // `at`: from 0 to 1 along `axis`; null: no section.
  setSection(axis, at) {
    // The side towards the viewer goes, and stays away while the plane is moved.
    const isSame = this.section?.axis === axis;
    const sign = isSame ? this.section.sign : Math.sign(this.camera.direction().getComponent(axis)) || 1;
    this.section = at === null ? null : { axis, at, sign };
    this.applyAll();
  }

  applyAll() {
    const { section, settings } = this;
    const colors = theme(this.themeName);
    const plane = [0, 0, 0, 0];
    if (section && this.size) {
      plane[section.axis] = section.sign;
      plane[3] = section.sign * (section.at - 0.5) * this.size[section.axis] * 1.002;
    }
    this.shared.plane.value = plane;
    this.shared.isCut.value = Boolean(section);
    for (const [name, side] of Object.entries(this.sides)) {
      const values = {
        base: rgb(colors.base), fresh: rgb(name === "before" ? colors.gone : colors.fresh), back: rgb(colors.back), cut: rgb(colors.cut),
        edge: rgb(colors.edge), plane, isCut: Boolean(section), mode: modeOf(settings.colors),
        isSmooth: settings.smooth, hasEdges: settings.edges, hasBacks: settings.backs,
      };
      for (const [key, value] of Object.entries(values)) side.materials.uniforms[key].value = value;
      if (side.bed) side.bed.visible = settings.grid;
    }
    this.invalidate();
  }

  fly(place, normal, radius) {
    this.camera.fly(new Vector3(...place), new Vector3(...normal), radius);
  }

  comeBack() {
    this.setAspect();
    this.camera.comeBack();
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2) * this.ease.pixels);
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.setAspect();
    this.invalidate();
  }

  // What is drawn now.
  get ease() {
    return EASINGS[this.isMoving ? this.easing : 0];
  }

  setAspect() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    const width = this.settings.arrangement === "beside" ? clientWidth / 2 : clientWidth;
    this.camera.camera.aspect = width / clientHeight;
    this.camera.camera.updateProjectionMatrix();
  }

  moved() {
    this.isMoving = true;
    this.waitForRest();
    this.invalidate();
  }

  // While the view is held it moves: after a slow frame, the next movement is still on its way.
  hold(isHeld) {
    this.isHeld = isHeld;
    this.waitForRest();
  }

  waitForRest() {
    clearTimeout(this.rest);
    if (!this.isHeld) this.rest = setTimeout(() => { this.isMoving = false; this.invalidate(); }, STILL_MS);
  }

  invalidate() {
    if (this.isAsked) return;
    this.isAsked = true;
    requestAnimationFrame((now) => {
      this.isAsked = false;
      this.watch(now);
      this.draw();
    });
  }

  draw() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    const { arrangement, divider } = this.settings;
    const ratio = Math.min(devicePixelRatio, 2) * this.ease.pixels;
    if (this.renderer.getPixelRatio() !== ratio) this.resize();
    this.setAspect();
    this.shared.pixels.value.set(width / (arrangement === "beside" ? 2 : 1), height);
    this.renderer.setScissorTest(true);
    if (arrangement === "beside") {
      this.drawSide("before", [0, width / 2], [0, width / 2], height);
      this.drawSide("after", [width / 2, width], [width / 2, width], height);
    } else if (arrangement === "slider") {
      const border = Math.round(width * divider);
      this.drawSide("before", [0, width], [0, border], height);
      this.drawSide("after", [0, width], [border, width], height);
    } else {
      this.drawSide(arrangement, [0, width], [0, width], height);
    }
    this.onDrawn();
  }

  // The copy of a side that is drawn while the view moves; undefined: none.
  easedCopy(name) {
    const { copy } = EASINGS[this.easing];
    const { coarse } = this.sides[name];
    return copy === null ? undefined : coarse[Math.min(copy, coarse.length - 1)];
  }

  drawSide(name, [left, right], [from, to], height) {
    const side = this.sides[name];
    const drawn = (this.isMoving && this.easedCopy(name)) || side.surface;
    for (const mesh of [side.surface, ...side.coarse]) if (mesh) mesh.visible = mesh === drawn;
    for (const { hidden } of side.marks.values()) hidden.visible = this.ease === EASINGS[0];
    this.renderer.setViewport(left, 0, right - left, height);
    this.renderer.setScissor(from, 0, to - from, height);
    this.renderer.render(side.scene, this.camera.camera);
  }

  // Where a place is in the picture, in pixels; null behind the camera.
  project(place) {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    const point = new Vector3(...place).project(this.camera.camera);
    const share = this.settings.arrangement === "beside" ? 0.5 : 1;
    return point.z > 1 ? null : [((point.x + 1) / 2) * width * share, ((1 - point.y) / 2) * height];
  }
}

// True where no graphics card draws: smooth edges cost too much there.
function isSoftware() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}
