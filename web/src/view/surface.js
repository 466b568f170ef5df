// The surface of a mesh: one shader for all ways to colour it.

import { BackSide, BufferAttribute, BufferGeometry, DoubleSide, FrontSide, GLSL3, Group, Mesh, RawShaderMaterial, Sphere, Vector3 } from "three";
import { RAMP, rgb } from "./colors.js";

export const NO_VALUE = 255;
const MODES = { plain: 0, kept: 1, deviation: 2, thickness: 2, file: 3 };

const vertexShader = `
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform mat3 normalMatrix;
in vec3 position;
in vec4 normal;
out vec3 seen;
out vec3 turned;
out vec3 place;
#ifdef COLORED
in vec4 tint;
out vec4 own;
#endif
#ifndef COARSE
in float value;
out vec3 share;
out float shown;
#endif
void main() {
#ifndef COARSE
  int corner = gl_VertexID % 3;
  share = vec3(corner == 0, corner == 1, corner == 2);
  shown = value;
#endif
#ifdef COLORED
  own = tint;
#endif
  place = position;
  turned = normalMatrix * normal.xyz;
  vec4 view = modelViewMatrix * vec4(position, 1.0);
  seen = view.xyz;
  gl_Position = projectionMatrix * view;
}`;

const fragmentShader = `
precision highp float;
uniform vec3 base, fresh, back, cut, edge;
uniform vec3 ramp[4];
uniform vec4 plane;
uniform int mode;
uniform bool isSmooth, hasEdges, hasBacks, isCut;
in vec3 seen, turned, place;
#ifdef COLORED
in vec4 own;
#endif
#ifndef COARSE
in vec3 share;
in float shown;
#endif
out vec4 color;

vec3 ofRamp(float t) {
  t = clamp(t, 0.0, 1.0) * 3.0;
  if (t < 1.0) return mix(ramp[0], ramp[1], t);
  return t < 2.0 ? mix(ramp[1], ramp[2], t - 1.0) : mix(ramp[2], ramp[3], t - 2.0);
}

void main() {
  if (isCut && dot(plane.xyz, place) > plane.w) discard;
#ifdef ONLY_BACKS
  bool isBack = true; // the library turns what is in front for such a material
#else
  bool isBack = !gl_FrontFacing;
#endif
  // What is seen through a section from behind lies inside of the part: the place where it is cut.
  if (isCut && isBack) {
    float stripe = step(0.5, fract((gl_FragCoord.x + gl_FragCoord.y) / 9.0));
    color = vec4(mix(cut, cut * 1.12, stripe), 1.0);
    return;
  }
  vec3 tint = base;
#ifdef COLORED
  // Between a corner with a colour and one without, as much of it as there is.
  if (mode == 3) tint = mix(base, own.rgb / max(own.a, 0.001), own.a);
#endif
#ifdef COARSE
  vec3 n = normalize(turned);
  if (dot(n, seen) > 0.0) n = -n;
#else
  vec3 flatNormal = normalize(cross(dFdx(seen), dFdy(seen)));
  vec3 n = isSmooth && length(turned) > 0.1 ? normalize(turned) : flatNormal;
  if (dot(n, seen) > 0.0 && (isBack || !isSmooth)) n = -n;
  if (mode == 1 && shown < 0.5) tint = fresh;
  if (mode == 2 && shown < 0.999) tint = ofRamp(shown * 255.0 / 254.0);
#endif
  // In a map red is a figure.
  if (isBack && hasBacks) tint = mode == 2 ? base * 0.6 : back;
  float key = max(dot(n, normalize(vec3(-0.35, 0.55, 0.75))), 0.0);
  float rim = max(dot(n, normalize(vec3(0.6, -0.3, 0.5))), 0.0);
  vec3 lit = tint * (0.5 + 0.5 * key + 0.22 * rim);
  lit += 0.10 * pow(max(dot(reflect(normalize(seen), n), normalize(vec3(-0.35, 0.55, 0.75))), 0.0), 24.0);
#ifndef COARSE
  if (hasEdges) {
    vec3 width = fwidth(share);
    vec3 near = smoothstep(width * 0.2, width * 1.1, share);
    lit = mix(edge, lit, 0.45 + 0.55 * min(near.x, min(near.y, near.z)));
  }
#endif
  color = vec4(lit, 1.0);
}`;

// Materials of one set of uniforms. Of two sides, the back faces lie a little deeper, so that they do not shine out along
// edges; `both` is the quicker way. A coarse copy is smooth, without edges and values. `isColored`: corners have colours.
export function surfaceMaterials(isColored) {
  const uniforms = {
    base: { value: [1, 1, 1] }, fresh: { value: [0, 1, 0] }, back: { value: [1, 0, 0] }, cut: { value: [0, 0, 0] },
    edge: { value: [0, 0, 0] }, ramp: { value: RAMP.map((hex) => new Vector3(...rgb(hex))) },
    plane: { value: [0, 0, 1, 0] }, mode: { value: 0 },
    isSmooth: { value: false }, hasEdges: { value: false }, hasBacks: { value: true }, isCut: { value: false },
  };
  const make = ({ defines, ...values }) => new RawShaderMaterial({ vertexShader, fragmentShader, uniforms, glslVersion: GLSL3, defines: { ...defines, ...(isColored ? { COLORED: "" } : {}) }, ...values });
  const back = { side: BackSide, defines: { ONLY_BACKS: "" }, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 8 };
  return { uniforms, sides: [make({ side: FrontSide }), make(back)], both: [make({ side: DoubleSide })], coarse: [make({ side: DoubleSide, defines: { COARSE: "" } })] };
}

// Triangles one by one, which have values; or of a coarse copy, by `index`.
export function surface({ positions, normals, colors, index }, materials) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setAttribute("normal", new BufferAttribute(normals, 4, true));
  if (colors) geometry.setAttribute("tint", new BufferAttribute(colors, 4, true));
  if (index) geometry.setIndex(new BufferAttribute(index, 1));
  else geometry.setAttribute("value", new BufferAttribute(new Uint8Array(positions.length / 3).fill(NO_VALUE), 1, true));
  geometry.boundingSphere = new Sphere(new Vector3(), 1);
  const group = new Group();
  for (const material of materials) {
    const mesh = new Mesh(geometry, material);
    mesh.frustumCulled = false;
    group.add(mesh);
  }
  group.geometry = geometry;
  return group;
}

// Values of corners, as bytes; `null`: none.
export function setValues(mesh, bytes) {
  const value = mesh.geometry.getAttribute("value");
  if (bytes) value.array.set(bytes);
  else value.array.fill(NO_VALUE);
  value.needsUpdate = true;
}

export const modeOf = (colors) => MODES[colors];
