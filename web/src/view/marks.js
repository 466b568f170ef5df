// What is drawn over a surface: lines some pixels wide, faces, and points. What is hidden shines through faintly.

import {
  BufferAttribute, BufferGeometry, DoubleSide, GLSL3, Group, InstancedBufferAttribute, InstancedBufferGeometry, Mesh, Points,
  RawShaderMaterial, Sphere,
} from "three";
import { rgb } from "./colors.js";

const head = `
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform vec2 pixels;
uniform float width;
out vec3 place;`;

const lineShader = `${head}
in vec2 position;
in vec3 from;
in vec3 to;
vec4 clip(vec3 at) {
  vec4 view = modelViewMatrix * vec4(at, 1.0);
  view.xyz *= 0.9985; // in front of the surface that it lies on
  return projectionMatrix * view;
}
void main() {
  vec4 a = clip(from);
  vec4 b = clip(to);
  place = mix(from, to, position.x);
  if (a.w < 0.001 || b.w < 0.001) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  vec2 along = (b.xy / b.w - a.xy / a.w) * pixels;
  float size = length(along);
  vec2 unit = size > 0.0001 ? along / size : vec2(1.0, 0.0);
  vec4 end = mix(a, b, position.x);
  vec2 aside = vec2(-unit.y, unit.x) * position.y + unit * (position.x - 0.5);
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

// `shared`: uniforms that all marks of a view have in common.
export function marks({ segments, faces, points }, color, shared, strength = 1) {
  const group = new Group();
  const add = (make, shader, values) => {
    for (const [depthTest, opacity] of [[true, values.opacity], [false, values.opacity * 0.22]]) {
      const uniforms = { ...shared, tint: { value: rgb(color) }, width: { value: values.width }, opacity: { value: opacity }, isPoint: { value: Boolean(values.isPoint) } };
      const material = new RawShaderMaterial({
        vertexShader: shader, fragmentShader, uniforms, glslVersion: GLSL3, side: DoubleSide, transparent: true, depthTest, depthWrite: false,
      });
      const object = make(material);
      object.geometry.boundingSphere = new Sphere(); // its own would be sought in vain
      object.frustumCulled = false;
      object.renderOrder = depthTest ? 2 : 1;
      group.add(object);
    }
  };
  if (faces?.length) add((material) => new Mesh(plain(faces), material), plainShader, { opacity: 0.4 * strength + 0.05, width: 1 });
  if (segments?.length) add((material) => new Mesh(lines(segments), material), lineShader, { opacity: 0.95, width: 1.6 + 1.6 * strength });
  if (points?.length) add((material) => new Points(plain(points), material), plainShader, { opacity: 0.95, width: 5 + 4 * strength, isPoint: true });
  return group;
}

function plain(positions) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(positions), 3));
  return geometry;
}

function lines(segments) {
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array([0, -1, 1, -1, 1, 1, 0, 1]), 2));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  const ends = Float32Array.from(segments);
  const half = (offset) => Float32Array.from({ length: ends.length / 2 }, (_, i) => ends[((i / 3) | 0) * 6 + offset + (i % 3)]);
  geometry.setAttribute("from", new InstancedBufferAttribute(half(0), 3));
  geometry.setAttribute("to", new InstancedBufferAttribute(half(3), 3));
  geometry.instanceCount = ends.length / 6;
  return geometry;
}

export function dispose(object) {
  object?.traverse((part) => {
    part.geometry?.dispose();
    part.material?.dispose();
  });
  object?.removeFromParent();
}
