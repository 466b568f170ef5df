// Where one looks from: orbit, standard views, flights to a place.

import { Frustum, PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

const DIRECTIONS = {
  front: [0, -1, 0], back: [0, 1, 0], left: [-1, 0, 0], right: [1, 0, 0], top: [0, -0.0001, 1], bottom: [0, -0.0001, -1], iso: [0.62, -0.95, 0.62],
};
const FLIGHT_MS = 350;
const STEP = Math.PI / 18; // of an arrow key

const isCalm = () => matchMedia("(prefers-reduced-motion: reduce)").matches;

export class Camera {
  constructor(element, { moved, held }) {
    this.changed = moved;
    this.camera = new PerspectiveCamera(35, 1, 0.1, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, element);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("change", () => this.moved());
    this.controls.addEventListener("start", () => held(true));
    this.controls.addEventListener("end", () => held(false));
    this.radius = 1;
  }

  moved() {
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = Math.max(distance - this.radius * 3, distance / 200);
    this.camera.far = distance + this.radius * 6;
    this.camera.updateProjectionMatrix();
    this.changed();
  }

  // `radius`: half the diagonal of what there is to see.
  setScene(radius) {
    this.radius = radius;
    this.controls.minDistance = radius * 0.002;
    this.controls.maxDistance = radius * 20;
    this.look("iso", false);
  }

  // The distance from which a ball is seen whole, also in a narrow picture.
  distanceFor(radius) {
    const upright = (this.camera.fov * Math.PI) / 360;
    const across = Math.atan(Math.tan(upright) * Math.min(1, this.camera.aspect));
    return (radius * 1.02) / Math.sin(across);
  }

  look(name, isFlown = true) {
    this.isAtPlace = false;
    this.go(new Vector3(), new Vector3(...DIRECTIONS[name]), this.distanceFor(this.radius), isFlown);
  }

  fit() {
    this.isAtPlace = false;
    this.go(new Vector3(), this.direction(), this.distanceFor(this.radius));
  }

  // Fits the part again, from the same side, where a flight led into it or where none of it is seen.
  comeBack() {
    this.camera.updateMatrixWorld();
    const { planes } = new Frustum().setFromProjectionMatrix(this.camera.projectionMatrix.clone().multiply(this.camera.matrixWorldInverse));
    const within = Math.min(...planes.map(({ constant }) => constant)); // how far the middle of the part lies within the picture
    if (within < this.radius * (this.isAtPlace ? 1 : -1)) this.fit();
  }

  direction() {
    return this.camera.position.clone().sub(this.controls.target).normalize();
  }

  // Looks at `place` along `normal`, not too steeply from below or above, and not from farther than all is seen from.
  fly(place, normal, radius) {
    const direction = normal.length() > Math.min(0.1, this.radius * 0.01) ? normal.clone().normalize() : this.direction();
    direction.add(this.direction().multiplyScalar(0.35)).normalize();
    this.isAtPlace = true;
    // What is small is seen with what is around it, as long as it is still seen.
    const around = Math.min(this.radius * 0.04, radius > 0 ? radius * 100 : Infinity);
    this.go(place, direction, this.distanceFor(Math.min(this.radius, Math.max(radius * 2.5, around))));
  }

  go(target, direction, distance, isFlown = true) {
    const goal = target.clone().add(direction.clone().normalize().multiplyScalar(distance));
    cancelAnimationFrame(this.flight);
    if (!isFlown || isCalm()) return this.stand(target, goal);
    const [fromTarget, from] = [this.controls.target.clone(), this.camera.position.clone()];
    const begin = performance.now();
    const step = (now) => {
      const share = Math.min(1, Math.max(0, (now - begin) / FLIGHT_MS));
      const eased = share * share * (3 - 2 * share);
      this.stand(fromTarget.clone().lerp(target, eased), from.clone().lerp(goal, eased));
      if (share < 1) this.flight = requestAnimationFrame(step);
    };
    this.flight = requestAnimationFrame(step);
    return undefined;
  }

  stand(target, position) {
    this.controls.target.copy(target);
    this.camera.position.copy(position);
    this.controls.update();
    this.moved();
  }

  turn(right, up) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    offset.applyAxisAngle(new Vector3(0, 0, 1), right * STEP);
    const across = new Vector3().crossVectors(this.camera.up, offset).normalize();
    const lifted = offset.clone().applyAxisAngle(across, -up * STEP);
    // Over the pole the picture would jump.
    if (Math.abs(lifted.z) < lifted.length() * 0.999) offset.copy(lifted);
    this.stand(this.controls.target.clone(), this.controls.target.clone().add(offset));
  }

  zoom(factor) {
    const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(factor);
    this.stand(this.controls.target.clone(), this.controls.target.clone().add(offset));
  }
}
