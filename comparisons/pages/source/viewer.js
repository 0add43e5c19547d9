// The view of deformed sheets: stage, toolbar, legend and what is under the pointer.

import {
  BufferGeometry,
  DirectionalLight,
  HemisphereLight,
  LineDashedMaterial,
  LineLoop,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { floats } from "./arrays.js";
import { Eye } from "./camera.js";
import { Legend } from "./legend.js";
import { choices, element, labelled, unique } from "./page.js";
import { Play } from "./play.js";
import { Sheet } from "./sheet.js";
import { number } from "./shown.js";

const KEYS = "Arrow keys turn the view, + and − zoom, 0 resets it.";
const FROM = [0.75, -1, 0.55];

export class Viewer {
  constructor(parent, options) {
    this.options = { from: FROM, label: "Deformed sheet", controls: true, exaggeration: 1, ...options };
    this.field = null;
    this.shape(parent);
    const antialias = !(this.options.quick && drawnByProcessor());
    this.renderer = new WebGLRenderer({ canvas: this.canvas, antialias, alpha: true });
    this.scene = new Scene();
    this.scene.add(new HemisphereLight("#ffffff", "#9aa0a8", 2.2));
    this.lamp = new DirectionalLight("#ffffff", 1.4);
    this.scene.add(this.lamp, this.lamp.target);
    this.eye = new Eye(this.canvas, this.options.from, () => this.request());
    if (this.options.outline) this.drawOutline(floats(this.options.outline));
    this.setSheets(this.options.sheets, this.options.views);
    this.watch = new ResizeObserver(() => this.resize());
    this.watch.observe(this.stage);
    this.dark = matchMedia("(prefers-color-scheme: dark)");
    this.shade = () => this.ink();
    this.dark.addEventListener("change", this.shade);
    this.resize();
    this.reset();
  }

  // The elements of the page.
  shape(parent) {
    const keys = unique("keys");
    this.root = element("div", { class: "sv" }, parent);
    this.bar = element("div", { class: "sv-toolbar", role: "group" }, this.root);
    this.bar.setAttribute("aria-label", "View");
    this.pick = labelled(this.bar, "Show", "select");
    this.pick.addEventListener("change", () => this.setSheet(this.pick.value));
    this.colour = labelled(this.bar, "Colour", "select");
    this.colour.addEventListener("change", () => this.setField(this.colour.value));
    this.times = labelled(this.bar, "Exaggerate", "select");
    choices(this.times, [1, 2, 5, 10, 20, 50, 100].map((times) => [times, `× ${times}`]));
    this.times.addEventListener("change", () => this.setExaggeration(Number(this.times.value)));
    const flat = labelled(this.bar, "Undeformed", "input", { type: "checkbox" });
    flat.checked = true;
    flat.addEventListener("change", () => this.setOutline(flat.checked));
    flat.parentElement.hidden = !this.options.outline;
    const home = element("button", { type: "button" }, this.bar);
    home.textContent = "Reset view";
    home.addEventListener("click", () => this.reset());
    this.bar.hidden = !this.options.controls;
    this.stage = element("div", { class: "sv-stage" }, this.root);
    this.canvas = element("canvas", { tabindex: 0, role: "application", "aria-describedby": keys }, this.stage);
    this.canvas.setAttribute("aria-label", this.options.label);
    this.canvas.setAttribute("aria-roledescription", "3D view");
    this.legend = new Legend(this.root);
    this.play = new Play(this.root, (time) => this.setTime(time));
    this.under = element("p", { class: "sv-under", id: keys }, this.root);
    this.under.textContent = KEYS;
    this.canvas.addEventListener("pointermove", (event) => event.buttons || this.point(event));
    this.canvas.addEventListener("pointerleave", () => (this.under.textContent = KEYS));
  }

  // Puts other sheets on the stage; the eye stays. views: what can be chosen; one a sheet unless given.
  setSheets(sheets, views) {
    for (const sheet of this.sheets?.values() ?? []) {
      this.scene.remove(sheet.group);
      sheet.dispose();
    }
    this.sheets = new Map(sheets.map((given) => [given.name, new Sheet(given)]));
    for (const sheet of this.sheets.values()) this.scene.add(sheet.group);
    const alone = (s) => ({ name: s.name, label: s.label, sheets: [s.name] });
    this.views = views ?? Array.from(this.sheets.values(), alone);
    choices(this.pick, this.views.map((view) => [view.name, view.label ?? view.name]));
    this.pick.parentElement.hidden = this.views.length < 2;
    this.setExaggeration(this.options.exaggeration);
    this.ink();
    this.setSheet((this.views.find((view) => view.name === this.view?.name) ?? this.views[0]).name);
  }

  // Shows a view by its name.
  setSheet(name) {
    this.view = this.views.find((view) => view.name === name);
    this.pick.value = name;
    for (const sheet of this.sheets.values()) sheet.group.visible = this.view.sheets.includes(sheet.name);
    const fields = new Map(this.shown().flatMap((s) => s.fields.map((field) => [field.name, field.label])));
    choices(this.colour, fields.entries());
    this.colour.parentElement.hidden = fields.size < 2;
    const wanted = this.view.field ?? this.field;
    this.play.of([...new Set(this.shown().flatMap((s) => s.frames.map((frame) => frame.time)))].sort((a, b) => a - b));
    this.setField(fields.has(wanted) ? wanted : fields.keys().next().value);
  }

  // Colours what is shown by a field, by its name; sheets without it by their first.
  setField(name) {
    this.field = name;
    this.colour.value = name;
    this.repaint();
  }

  // Moves a sheet: displacement (3 n) [m], values (n) of fields by name, forces. For live use, at any rate.
  update(name, { displacement, values = {}, forces }) {
    const sheet = this.sheets.get(name);
    if (forces) {
      sheet.setForces(forces);
      this.ink();
    }
    if (displacement) {
      sheet.displacement = floats(displacement);
      sheet.place();
    }
    for (const field of sheet.fields) if (values[field.name]) field.values = floats(values[field.name]);
    this.repaint();
  }

  // Shows every sheet that moves as it is at a time [s].
  setTime(time) {
    for (const sheet of this.sheets.values()) {
      const frame = sheet.frames.findLast((at) => at.time <= time) ?? sheet.frames[0];
      if (!frame) continue;
      sheet.displacement = frame.displacement;
      sheet.place();
    }
    this.repaint();
  }

  setExaggeration(times) {
    this.options.exaggeration = times;
    this.times.value = times;
    for (const sheet of this.sheets.values()) {
      sheet.exaggeration = times;
      sheet.place();
    }
    this.request();
  }

  setOutline(visible) {
    if (this.flat) this.flat.visible = visible;
    this.request();
  }

  // Looks at all of what is shown from where the eye first was.
  reset() {
    const flat = this.options.outline ? places(floats(this.options.outline)) : [];
    this.eye.reset([...this.shown().flatMap((sheet) => sheet.drawn()), ...flat]);
    this.request();
  }

  // A picture of the view as a data address.
  picture(kind = "image/png") {
    this.render();
    return this.canvas.toDataURL(kind);
  }

  dispose() {
    this.play.stop();
    this.watch.disconnect();
    this.dark.removeEventListener("change", this.shade);
    this.eye.dispose();
    for (const sheet of this.sheets.values()) sheet.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.root.remove();
    this.gone = true;
  }

  shown() {
    return this.view.sheets.map((name) => this.sheets.get(name));
  }

  // One scale for all that is shown by one field: equal colours are equal values.
  repaint() {
    const painted = this.shown().filter((sheet) => sheet.fields.length);
    const chosen = painted.map((sheet) => [sheet, sheet.field(this.field)]);
    const main = chosen.find(([, field]) => field.name === this.field)?.[1];
    const same = chosen.filter(([, field]) => field.name === this.field);
    let [low, high] = [Infinity, -Infinity];
    for (const [sheet, field] of same) {
      const limits = sheet.limits(field);
      low = Math.min(low, limits[0]);
      high = Math.max(high, limits[1]);
    }
    if (main) {
      if (main.kind === "signed") [low, high] = [-Math.max(-low, high, 0), Math.max(-low, high, 0)];
      else if (main.component === undefined && low > 0) low = 0;
      this.legend.show(main, [low, high]);
      for (const [sheet, field] of same) sheet.paint(field, [low, high]);
    }
    for (const [sheet, field] of chosen) if (field !== main && field.name !== this.field) sheet.paint(field, sheet.limits(field));
    this.legend.root.hidden = !main;
    this.request();
  }

  // Lines and supports in the colours of the style sheet, which knows of light and dark.
  ink() {
    const style = getComputedStyle(this.root);
    const colours = (name) => style.getPropertyValue(`--sv-${name}`).trim() || "#80868e";
    for (const sheet of this.sheets.values()) sheet.ink(colours);
    this.flat?.material.color.set(colours("flat"));
    this.request();
  }

  drawOutline(points) {
    const geometry = new BufferGeometry().setFromPoints(places(points));
    geometry.computeBoundingSphere();
    const dash = geometry.boundingSphere.radius / 30;
    this.flat = new LineLoop(geometry, new LineDashedMaterial({ dashSize: dash, gapSize: dash }));
    this.flat.computeLineDistances();
    this.scene.add(this.flat);
  }

  // Says what is under the pointer: where, and how far it has moved.
  point(event) {
    const box = this.canvas.getBoundingClientRect();
    const at = new Vector2((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2(2 * at.x - 1, 1 - 2 * at.y), this.eye.camera);
    for (const sheet of this.shown()) {
      const hit = ray.intersectObjects([sheet.masses, sheet.surface].filter(Boolean))[0];
      if (!hit) continue;
      const node = hit.instanceId ?? this.nearest(sheet, hit);
      const three = (values) => Array.from(values.subarray(3 * node, 3 * node + 3), (value) => number(1e3 * value, 4));
      const field = sheet.field(this.field);
      const value = field ? `, ${field.label.toLowerCase()} ${number(sheet.values(field)[node], 4)} ${field.unit}` : "";
      const [at, moved] = [three(sheet.points), three(sheet.displacement)];
      this.under.textContent = `${sheet.label} at ${at.slice(0, 2).join(", ")} mm: moved ${moved.join(", ")} mm${value}`;
      return;
    }
    this.under.textContent = KEYS;
  }

  nearest(sheet, hit) {
    const far = (i) => hit.point.distanceToSquared(new Vector3().fromBufferAttribute(sheet.positions, i));
    return [hit.face.a, hit.face.b, hit.face.c].reduce((best, i) => (far(i) < far(best) ? i : best));
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.stage;
    if (!width || !height) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.eye.camera.aspect = width / height;
    this.eye.camera.updateProjectionMatrix();
    this.request();
  }

  request() {
    if (this.waiting || this.gone) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      if (!this.gone) this.render();
    });
  }

  render() {
    this.lamp.position.copy(this.eye.camera.position).add(new Vector3(0, 0, this.eye.ball?.radius ?? 1));
    this.lamp.target.position.copy(this.eye.orbit.target);
    this.renderer.render(this.scene, this.eye.camera);
  }
}

const places = (points) =>
  Array.from({ length: points.length / 3 }, (_, i) => new Vector3(...points.subarray(3 * i, 3 * i + 3)));

// Whether there is no graphics card: smooth edges take half the time of a frame then.
function drawnByProcessor() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const told = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = told ? gl.getParameter(told.UNMASKED_RENDERER_WEBGL) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}
