// What is drawn over a surface: lines some pixels wide, faces, and points. What is hidden shines through faintly.

import { BufferAttribute, BufferGeometry, DoubleSide, GLSL3, Group, Mesh, Points, RawShaderMaterial, Sphere } from "three";
import { rgb } from "./colors.js";

const head = `
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform vec2 pixels;
uniform float width;
out vec3 place;`;

const lineShader = `${head}
in vec3 position;
in vec3 to;
vec4 clip(vec3 at) {
  vec4 view = modelViewMatrix * vec4(at, 1.0);
  view.xyz *= 0.9985; // in front of the surface that it lies on
  return projectionMatrix * view;
}
void main() {
  int number = gl_VertexID % 4;
  vec2 corner = vec2(number == 1 || number == 2, number < 2 ? -1.0 : 1.0);
  vec4 a = clip(position);
  vec4 b = clip(to);
  place = mix(position, to, corner.x);
  float least = 0.01 * projectionMatrix[3][2] / (projectionMatrix[2][2] - 1.0); // of the way to what is near
  if (a.w < least || b.w < least) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  vec2 along = (b.xy / b.w - a.xy / a.w) * pixels;
  float size = length(along);
  vec2 unit = size > 0.0001 ? along / size : vec2(1.0, 0.0);
  vec4 end = mix(a, b, corner.x);
  vec2 aside = vec2(-unit.y, unit.x) * corner.y + unit * (corner.x - 0.5);
  end.xy += aside * width / pixels * end.w;
  gl_Position = end;
}`;

const plainShader = `${head}
in vec3 position;
void main() {
  place = position;
  vec4 view = modelViewMatrix * vec4(position, 1.0);
  view.xyz *= 0.999;
  gl_Position = projectionMatrix * view;
  gl_PointSize = width;
}`;

const fragmentShader = `
precision highp float;
uniform vec3 tint;
uniform float opacity;
uniform bool isPoint, isCut;
uniform vec4 plane;
in vec3 place;
out vec4 color;
void main() {
  if (isCut && dot(plane.xyz, place) > plane.w) discard;
  if (isPoint && distance(gl_PointCoord, vec2(0.5)) > 0.5) discard;
  color = vec4(tint, opacity);
}`;

// `shared`: uniforms that all marks of a view have in common. What is behind the surface is in a group of its own, `hidden`.
export function marks({ segments, faces, points }, color, shared, strength = 1) {
  const group = new Group();
  const hidden = new Group();
  group.add(hidden);
  group.hidden = hidden;
  const add = (Kind, geometry, shader, values) => {
    geometry.boundingSphere = new Sphere(); // its own would be sought in vain
    for (const [depthTest, opacity] of [[true, values.opacity], [false, values.opacity * 0.22]]) {
      const uniforms = { ...shared, tint: { value: rgb(color) }, width: { value: values.width }, opacity: { value: opacity }, isPoint: { value: Boolean(values.isPoint) } };
      const material = new RawShaderMaterial({
        vertexShader: shader, fragmentShader, uniforms, glslVersion: GLSL3, side: DoubleSide, transparent: true, depthTest, depthWrite: false,
      });
      const object = new Kind(geometry, material);
      object.frustumCulled = false;
      object.renderOrder = depthTest ? 2 : 1;
      (depthTest ? group : hidden).add(object);
    }
  };
  if (faces?.length) add(Mesh, plain(faces), plainShader, { opacity: 0.4 * strength + 0.05, width: 1 });
  if (segments?.length) add(Mesh, lines(segments), lineShader, { opacity: 0.95, width: 1.6 + 1.6 * strength });
  if (points?.length) add(Points, plain(points), plainShader, { opacity: 0.95, width: 5 + 4 * strength, isPoint: true });
  return group;
}

function plain(positions) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(positions), 3));
  return geometry;
}

// Four corners for each segment, each with both ends. Instances would be fewer bytes, but each is a call of its own where
// no graphics card draws.
function lines(segments) {
  const count = segments.length / 6;
  const [from, to] = [new Float32Array(count * 12), new Float32Array(count * 12)];
  const index = new Uint32Array(count * 6);
  for (let at = 0; at < count; at += 1) {
    for (let i = 0; i < 12; i += 1) {
      from[at * 12 + i] = segments[at * 6 + (i % 3)];
      to[at * 12 + i] = segments[at * 6 + 3 + (i % 3)];
    }
    for (let i = 0; i < 6; i += 1) index[at * 6 + i] = at * 4 + [0, 1, 2, 0, 2, 3][i];
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(from, 3));
  geometry.setAttribute("to", new BufferAttribute(to, 3));
  geometry.setIndex(new BufferAttribute(index, 1));
  return geometry;
}

export function dispose(object) {
  object?.traverse((part) => {
    part.geometry?.dispose();
    part.material?.dispose();
  });
  object?.removeFromParent();
}
