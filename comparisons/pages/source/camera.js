// Where the eye is: turned and zoomed by mouse, touch and keys about the middle of what is shown, z upwards.

import { Box3, MathUtils, PerspectiveCamera, Sphere, Spherical, Vector3 } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

const TURN = MathUtils.degToRad(6);
const ZOOM = 1.12;
const MARGIN = 1.06; // of the view, around what is shown
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

  // Shows points whole and as large as they go, from the direction where the eye first was.
  reset(points) {
    const ball = new Box3().setFromPoints(points).getBoundingSphere(new Sphere());
    const radius = ball.radius || 1;
    const middle = ball.center.clone();
    const right = new Vector3().crossVectors(UP, this.from).normalize();
    const above = new Vector3().crossVectors(this.from, right);
    const up = Math.tan(MathUtils.degToRad(this.camera.fov / 2)) / MARGIN;
    let far = 0.1 * radius;
    // a point at `a` along an axis of the view and `d` towards the eye is in sight if |a - middle| <= slope (far - d)
    for (const [axis, slope] of [[right, up * this.camera.aspect], [above, up]]) {
      let [most, least] = [-Infinity, -Infinity];
      for (const point of points) {
        const at = point.clone().sub(ball.center);
        const [a, d] = [at.dot(axis), slope * at.dot(this.from)];
        most = Math.max(most, d + a);
        least = Math.max(least, d - a);
      }
      far = Math.max(far, (most + least) / (2 * slope));
      middle.addScaledVector(axis, (most - least) / 2);
    }
    this.ball = { centre: middle, radius };
    this.points = points;
    this.camera.near = far / 200;
    this.camera.far = 20 * far;
    this.camera.position.copy(middle).addScaledVector(this.from, far);
    this.camera.updateProjectionMatrix();
    this.orbit.target.copy(middle);
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
      0: () => this.points && this.reset(this.points),
      Home: () => this.points && this.reset(this.points),
    };
    if (event.ctrlKey || event.metaKey || event.altKey || !deeds[event.key]) return;
    event.preventDefault();
    deeds[event.key]();
  }

  dispose() {
    this.orbit.dispose();
  }
}
