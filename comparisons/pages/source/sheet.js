// One sheet on the stage: points, what joins them, displacement and fields over it, and its moments in time.
//
// A surface has faces, smooth and coloured, and a few lines to show its shape; a lattice has links and a
// ball a mass. All share one set of positions, points + exaggeration * displacement, in metres.

import {
  BufferAttribute,
  BufferGeometry,
  CatmullRomCurve3,
  Color,
  DoubleSide,
  Group,
  IcosahedronGeometry,
  InstancedMesh,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  TubeGeometry,
  Vector3,
} from "three";
import { floats, indices } from "./arrays.js";
import { Arrow } from "./arrow.js";
import { paint } from "./colours.js";

const COMPONENTS = { x: 0, y: 1, z: 2 };

export class Sheet {
  constructor(given) {
    this.name = given.name;
    this.label = given.label ?? given.name;
    this.points = floats(given.points);
    this.count = this.points.length / 3;
    this.displacement = given.displacement ? floats(given.displacement) : new Float32Array(3 * this.count);
    this.fields = (given.fields ?? []).map((field) => ({
      unit: "",
      scale: 1,
      kind: "magnitude",
      ...field,
      values: field.values ? floats(field.values) : null,
    }));
    this.frames = (given.frames ?? []).map((frame) => ({
      time: frame.time,
      displacement: floats(frame.displacement),
    }));
    this.held = (given.held ?? []).map(({ points, firm }) => ({ points: indices(points), firm: firm !== false }));
    this.exaggeration = 1;
    this.colours = new Float32Array(3 * this.count);
    this.build(given);
    this.setForces(given.forces ?? []);
    this.place();
  }

  build(given) {
    const size = this.size();
    const shared = new BufferAttribute(new Float32Array(this.points), 3);
    this.positions = shared;
    this.group = new Group();
    const triangles = corners(indices(given.quads), indices(given.triangles));
    if (triangles.length) {
      const geometry = new BufferGeometry().setAttribute("position", shared);
      geometry.setAttribute("color", new BufferAttribute(this.colours, 3));
      geometry.setIndex(new BufferAttribute(triangles, 1));
      const material = new MeshLambertMaterial({ vertexColors: true, side: DoubleSide });
      Object.assign(material, { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
      this.surface = new Mesh(geometry, material);
      this.group.add(this.surface);
    }
    this.inked = [];
    const ends = [given.lines, given.faint, given.strong].flatMap((pairs) => Array.from(indices(pairs)));
    this.linked = new Set(given.style === "lattice" ? ends : Array(this.count).keys()); // masses in holes have no link
    for (const [pairs, ink, opacity] of [
      [indices(given.lines), given.style === "lattice" ? "link" : "line", given.style === "lattice" ? 0.8 : 0.4],
      [indices(given.faint), "link", 0.25],
      [indices(given.strong), "strong", 1],
    ]) {
      if (!pairs.length) continue;
      const geometry = new BufferGeometry().setAttribute("position", shared);
      geometry.setIndex(new BufferAttribute(pairs, 1));
      const material = new LineBasicMaterial({ opacity, transparent: true });
      this.inked.push([material, ink]);
      this.group.add(new LineSegments(geometry, material));
    }
    if (given.style === "lattice") {
      const radius = Math.min((0.15 * size) / Math.sqrt(this.count), 0.011 * size);
      const ball = new IcosahedronGeometry(radius, 2);
      this.masses = new InstancedMesh(ball, new MeshLambertMaterial(), this.count);
      this.masses.setColorAt(0, new Color());
      this.masses.frustumCulled = false;
      this.group.add(this.masses);
    }
    this.tubes = this.held.map(({ firm }) => {
      const material = new MeshLambertMaterial();
      this.inked.push([material, firm ? "firm" : "loose"]);
      const tube = new Mesh(new BufferGeometry(), material);
      this.group.add(tube);
      return tube;
    });
    this.group.traverse((part) => (part.frustumCulled = false));
    this.radius = 0.006 * size;
  }

  // Puts other arrows of forces there.
  setForces(forces) {
    for (const arrow of this.arrows ?? []) {
      this.group.remove(arrow.group);
      release(arrow.group);
      this.inked = this.inked.filter(([material]) => material !== arrow.material);
    }
    this.arrows = forces.map((given) => new Arrow(given));
    for (const arrow of this.arrows) {
      this.group.add(arrow.group);
      this.inked.push([arrow.material, "load"]);
    }
  }

  // Every point as it is drawn, and the ends of its arrows.
  drawn() {
    const at = (i) => new Vector3().fromBufferAttribute(this.positions, i);
    return [...Array.from(this.linked, at), ...this.arrows.flatMap((arrow) => arrow.ends())];
  }

  // The longest side of the box around the points, as they are at rest.
  size() {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    this.points.forEach((value, i) => {
      low[i % 3] = Math.min(low[i % 3], value);
      high[i % 3] = Math.max(high[i % 3], value);
    });
    return Math.max(...high.map((value, i) => value - low[i])) || 1;
  }

  // Moves every part to where the displacement has it.
  place() {
    const to = this.positions.array;
    for (let i = 0; i < to.length; i++) to[i] = this.points[i] + this.exaggeration * this.displacement[i];
    this.positions.needsUpdate = true;
    if (this.surface) {
      this.surface.geometry.computeVertexNormals();
      this.surface.geometry.computeBoundingSphere();
    }
    if (this.masses) {
      const matrix = new Matrix4();
      for (let i = 0; i < this.count; i++) {
        if (this.linked.has(i)) matrix.makeTranslation(to[3 * i], to[3 * i + 1], to[3 * i + 2]);
        else matrix.makeScale(0, 0, 0);
        this.masses.setMatrixAt(i, matrix);
      }
      this.masses.instanceMatrix.needsUpdate = true;
      this.masses.computeBoundingSphere();
    }
    for (const arrow of this.arrows) arrow.place(this.displacement, this.exaggeration);
    this.held.forEach(({ points, firm }, number) => {
      const path = Array.from(points, (i) => new Vector3(to[3 * i], to[3 * i + 1], to[3 * i + 2]));
      this.tubes[number].geometry.dispose();
      const along = new CatmullRomCurve3(path, false, "centripetal");
      this.tubes[number].geometry = new TubeGeometry(along, Math.max(points.length, 2), firm ? this.radius : this.radius / 2, 8);
    });
  }

  field(name) {
    return this.fields.find((field) => field.name === name) ?? this.fields[0];
  }

  // Values (n) of a field, as it is shown: those given, or a component or the length of the displacement.
  values(field, displacement = this.displacement) {
    const shown = new Float32Array(this.count);
    const axis = COMPONENTS[field.component];
    for (let i = 0; i < this.count; i++) {
      if (field.values) shown[i] = field.scale * field.values[i];
      else if (axis !== undefined) shown[i] = field.scale * displacement[3 * i + axis];
      else shown[i] = field.scale * Math.hypot(displacement[3 * i], displacement[3 * i + 1], displacement[3 * i + 2]);
    }
    return shown;
  }

  // The least and the largest value of a field, over all frames: colours keep their meaning as time goes on.
  limits(field) {
    if (field.limits) return field.limits.map((limit) => field.scale * limit);
    if (!field.values && this.frames.length) {
      this.ranges ??= {};
      return (this.ranges[field.name] ??= range(this.frames.map((f) => range([this.values(field, f.displacement)]))));
    }
    return range([this.values(field)]);
  }

  paint(field, limits) {
    paint(this.colours, this.values(field), limits, field.kind);
    if (this.surface) this.surface.geometry.attributes.color.needsUpdate = true;
    if (this.masses) {
      this.masses.instanceColor.array.set(this.colours);
      this.masses.instanceColor.needsUpdate = true;
    }
  }

  // Colours lines and supports by name: link, line, strong, load, firm, loose.
  ink(colours) {
    for (const [material, name] of this.inked) material.color.set(colours(name));
  }

  dispose() {
    release(this.group);
  }
}

function release(group) {
  group.traverse((part) => {
    part.geometry?.dispose();
    part.material?.dispose();
    part.dispose?.();
  });
}

// Two triangles a quadrilateral.
function corners(quads, triangles) {
  const found = new Uint32Array((quads.length / 4) * 6 + triangles.length);
  for (let i = 0; i < quads.length / 4; i++) {
    const [a, b, c, d] = quads.subarray(4 * i, 4 * i + 4);
    found.set([a, b, c, a, c, d], 6 * i);
  }
  found.set(triangles, (quads.length / 4) * 6);
  return found;
}

function range(arrays) {
  let [low, high] = [Infinity, -Infinity];
  for (const values of arrays) {
    for (const value of values) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  return low <= high ? [low, high] : [0, 0];
}
