// An arrow from a place along a vector, for a force.

import { ConeGeometry, CylinderGeometry, Group, Mesh, MeshLambertMaterial, Vector3 } from "three";

const Y = new Vector3(0, 1, 0); // along which three.js makes cylinders and cones
const HEAD = 0.3; // of the arrow

export class Arrow {
  // given: {point, at: [x, y, z], along: [x, y, z]}; at: its place while the sheet is flat, moved as `point` is.
  constructor(given) {
    Object.assign(this, given);
    const along = new Vector3(...given.along);
    const length = along.length();
    this.material = new MeshLambertMaterial();
    this.group = new Group();
    const shaft = new Mesh(new CylinderGeometry(0.025 * length, 0.025 * length, (1 - HEAD) * length, 12), this.material);
    shaft.position.y = 0.5 * (1 - HEAD) * length;
    const head = new Mesh(new ConeGeometry(0.075 * length, HEAD * length, 16), this.material);
    head.position.y = (1 - 0.5 * HEAD) * length;
    this.group.add(shaft, head);
    this.group.quaternion.setFromUnitVectors(Y, along.normalize());
  }

  // Moves it by exaggeration times the displacement (3 n) of its point.
  place(displacement, exaggeration) {
    const at = this.at.map((value, axis) => value + exaggeration * displacement[3 * this.point + axis]);
    this.group.position.set(...at);
  }

  // Where it starts and ends.
  ends() {
    const start = this.group.position.clone();
    return [start, start.clone().add(new Vector3(...this.along))];
  }
}
