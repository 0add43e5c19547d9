// Where the eye is: turned and zoomed by mouse, touch and keys about the middle of what is shown, z upwards.

import { MathUtils, PerspectiveCamera, Spherical, Vector3 } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

const TURN = MathUtils.degToRad(6);
const ZOOM = 1.12;
const UP = new Vector3(0, 0, 1);

export class Eye {
  constructor(canvas, from, changed) {
    this.camera = new PerspectiveCamera(28, 1, 0.001, 100);
    this.camera.up.copy(UP);
    this.from = new Vector3(...from).normalize();
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.enableZoom = false; // until the view has the focus: a page scrolls past it
    this.orbit.minPolarAngle = 0.01;
    this.orbit.maxPolarAngle = Math.PI - 0.01;
    this.orbit.addEventListener("change", changed);
    canvas.style.touchAction = "pan-y"; // a finger moved up or down scrolls the page, sideways it turns
    canvas.addEventListener("focus", () => (this.orbit.enableZoom = true));
    canvas.addEventListener("blur", () => (this.orbit.enableZoom = false));
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  // Shows a box whole, from where the eye first was.
  reset(box) {
    const centre = box.getCenter(new Vector3());
    const radius = box.getSize(new Vector3()).length() / 2 || 1;
    this.ball = { centre, radius };
    this.box = box;
    const right = new Vector3().crossVectors(UP, this.from).normalize();
    const above = new Vector3().crossVectors(this.from, right);
    const up = Math.tan(MathUtils.degToRad(this.camera.fov / 2));
    const aside = up * this.camera.aspect;
    let far = radius;
    for (let corner = 0; corner < 8; corner++) {
      const [x, y, z] = [1, 2, 4].map((bit) => (corner & bit ? box.max : box.min));
      const at = new Vector3(x.x, y.y, z.z).sub(centre);
      const wide = Math.max(Math.abs(at.dot(right)) / aside, Math.abs(at.dot(above)) / up);
      far = Math.max(far, 1.08 * (at.dot(this.from) + wide));
    }
    this.camera.near = far / 200;
    this.camera.far = 20 * far;
    this.camera.position.copy(centre).addScaledVector(this.from, far);
    this.camera.updateProjectionMatrix();
    this.orbit.target.copy(centre);
    this.orbit.update();
  }

  turn(aside, up) {
    const toUp = (v) => v.set(v.x, v.z, -v.y); // three.js measures from y
    const offset = toUp(this.camera.position.clone().sub(this.orbit.target));
    const at = new Spherical().setFromVector3(offset);
    at.theta += aside;
    at.phi = MathUtils.clamp(at.phi - up, 0.01, Math.PI - 0.01);
    offset.setFromSpherical(at);
    this.camera.position.set(offset.x, -offset.z, offset.y).add(this.orbit.target);
    this.orbit.update();
  }

  zoom(factor) {
    const offset = this.camera.position.clone().sub(this.orbit.target);
    const length = offset.length() / factor;
    const { radius } = this.ball ?? { radius: length };
    offset.setLength(MathUtils.clamp(length, 0.3 * radius, 12 * radius));
    this.camera.position.copy(this.orbit.target).add(offset);
    this.orbit.update();
  }

  key(event) {
    const deeds = {
      ArrowLeft: () => this.turn(-TURN, 0),
      ArrowRight: () => this.turn(TURN, 0),
      ArrowUp: () => this.turn(0, TURN),
      ArrowDown: () => this.turn(0, -TURN),
      "+": () => this.zoom(ZOOM),
      "=": () => this.zoom(ZOOM),
      "-": () => this.zoom(1 / ZOOM),
      0: () => this.box && this.reset(this.box),
      Home: () => this.box && this.reset(this.box),
    };
    if (event.ctrlKey || event.metaKey || event.altKey || !deeds[event.key]) return;
    event.preventDefault();
    deeds[event.key]();
  }

  dispose() {
    this.orbit.dispose();
  }
}
