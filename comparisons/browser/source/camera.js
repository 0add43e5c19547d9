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

  // Shows a ball {centre, radius} whole, from where the eye first was.
  reset({ centre, radius }) {
    this.ball = { centre, radius };
    const half = MathUtils.degToRad(this.camera.fov / 2);
    const narrow = Math.atan(Math.tan(half) * Math.min(this.camera.aspect, 1));
    const far = (0.92 * radius) / Math.sin(narrow);
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
      0: () => this.ball && this.reset(this.ball),
      Home: () => this.ball && this.reset(this.ball),
    };
    if (event.ctrlKey || event.metaKey || event.altKey || !deeds[event.key]) return;
    event.preventDefault();
    deeds[event.key]();
  }

  dispose() {
    this.orbit.dispose();
  }
}
