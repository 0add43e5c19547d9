// Steps lattices in WebAssembly, draws them, and plots the far corner beside the shell's stored answer.
"use strict";
const SCENES = { "two-edges-clamped": "two edges clamped", "one-edge-clamped": "one edge clamped" };
const YOUNG = 54.5e6, GRAVITY = 9.81, SIDE = 0.188, POINTS = 5, LAST = POINTS * POINTS - 1;
const STOPS = { young: [0.5, 1, 2], thickness: [2, 3, 4, 6], gravity: [0, 0.5, 1, 2], damping: [0, 1, 4, 12] };
const LOADS = [0.25, 0.5, 1, 2, 4], SPAN = 6; // of g/E; seconds of the plot
const by = id => document.getElementById(id);
const value = name => STOPS[name][+by(name).value];
const SHOWN = {
  young: v => `${(v * YOUNG / 1e6).toFixed(1)} MPa`, thickness: v => `${v} mm`,
  gravity: v => `${(v * GRAVITY).toFixed(1)} m/s²`, damping: v => v ? `${v} 1/s` : "none",
};
let program = null, answers = {}, known = null, track = [], time = 0, left = 0, before = 0, grabbed = null;
let turn = -0.6, tilt = 0.5, frames = 0, spent = 0, wanted = "";

async function load() {
  const name = `${by("scene").value}-${value("thickness")}.wasm`;
  wanted = name;
  try {
    const response = await fetch(name);
    if (!response.ok) throw new Error(`${response.status}`);
    const { instance } = await WebAssembly.instantiate(await response.arrayBuffer(), {});
    if (wanted !== name) return; // another was chosen meanwhile
    program = instance.exports;
    program.reset();
    track = [], time = left = 0, grabbed = null;
    apply();
  } catch (error) {
    by("said").textContent = `${name} is not here (${error.message}): pip install ziglang, then make docs.`;
  }
}

// E in proportion to every spring: gravity and forces over it and time by its root are the same motion
function apply() {
  for (const name of Object.keys(STOPS)) by(name).nextElementSibling.textContent = SHOWN[name](value(name));
  const load = value("gravity") / value("young");
  const stored = answers[`${by("scene").value} ${value("thickness")}`];
  known = load === 0 ? 0 : stored ? stored[LOADS.indexOf(load)] : null;
  if (program) program.gravity(-GRAVITY * load);
}

function advance(seconds) {
  const root = Math.sqrt(value("young")), step = program.steps();
  left = Math.min(left + seconds * root, 40 * root * 1e-3);
  const slower = Math.exp(-value("damping") / root * 4 * step);
  for (; left > 0; left -= 4 * step, time += 4 * step / root) {
    if (grabbed) pull();
    program.step(4);
    program.slow(slower);
  }
}

function pull() { // a soft spring from the point to the finger, in the plane of the screen
  const at = [0, 1, 2].map(axis => rest(grabbed.point)[axis] + program.probe(grabbed.point, axis));
  const [x, y] = project(at), [right, up] = axes();
  const dx = (grabbed.x - x) / scale(), dy = (y - grabbed.y) / scale();
  const k = 15, f = right.map((r, axis) => k * (dx * r + dy * up[axis]));
  program.force(grabbed.point, ...f);
}

const rest = p => [SIDE * (p % POINTS) / (POINTS - 1), SIDE * Math.floor(p / POINTS) / (POINTS - 1), 0];
const scale = () => 0.66 * Math.min(by("sheet").clientWidth, 1.2 * by("sheet").clientHeight) / SIDE;
function axes() { // to the right, up and towards the viewer
  const c = Math.cos(turn), s = Math.sin(turn), d = Math.cos(tilt), t = Math.sin(tilt);
  return [[c, -s, 0], [s * t, c * t, d], [s * -d, c * -d, t]];
}
function project(p) {
  const q = [p[0] - SIDE / 2, p[1] - SIDE / 2, p[2] + SIDE / 20], all = axes();
  const [x, y, z] = all.map(axis => axis[0] * q[0] + axis[1] * q[1] + axis[2] * q[2]);
  return [by("sheet").clientWidth / 2 + scale() * x, by("sheet").clientHeight / 2 - scale() * y, z];
}

function canvas(id) {
  const it = by(id), ratio = window.devicePixelRatio || 1, w = it.clientWidth, h = it.clientHeight;
  if (it.width !== Math.round(w * ratio)) it.width = Math.round(w * ratio);
  if (it.height !== Math.round(h * ratio)) it.height = Math.round(h * ratio);
  const g = it.getContext("2d");
  g.setTransform(ratio, 0, 0, ratio, 0, 0);
  g.clearRect(0, 0, w, h);
  return [g, w, h];
}

function draw() {
  const [g] = canvas("sheet"), n = program.columns(), at = [];
  for (let c = 0; c < n * n; c++) at.push(project([0, 1, 2].map(axis => program.place(c, axis))));
  const cells = [];
  for (let j = 0; j + 1 < n; j++) for (let i = 0; i + 1 < n; i++) {
    const c = [j * n + i, j * n + i + 1, (j + 1) * n + i + 1, (j + 1) * n + i].map(k => at[k]);
    cells.push([c[0][2] + c[1][2] + c[2][2] + c[3][2], c]);
  }
  cells.sort((a, b) => a[0] - b[0]);
  for (const [, c] of cells) {
    const a = [0, 1, 2].map(e => c[2][e] - c[0][e]), b = [0, 1, 2].map(e => c[3][e] - c[1][e]), s = scale();
    const m = [a[1] / s * b[2] - a[2] * b[1] / s, a[2] * b[0] / s - a[0] / s * b[2], (a[0] * b[1] - a[1] * b[0]) / s / s];
    const light = Math.abs(0.25 * m[0] - 0.45 * m[1] + m[2]) / Math.hypot(...m) / 1.12, front = m[2] < 0;
    g.fillStyle = front ? `hsl(208 60% ${25 + 45 * light}%)` : `hsl(28 70% ${25 + 45 * light}%)`;
    g.strokeStyle = "rgb(0 0 0 / 25%)";
    g.beginPath();
    for (const p of c) g.lineTo(p[0], p[1]);
    g.closePath(), g.fill(), g.stroke();
  }
  const end = at[n * n - 1];
  g.fillStyle = "#d22";
  g.beginPath(), g.arc(end[0], end[1], 5, 0, 7), g.fill();
  if (grabbed) {
    const p = project([0, 1, 2].map(axis => rest(grabbed.point)[axis] + program.probe(grabbed.point, axis)));
    g.strokeStyle = "#d22";
    g.beginPath(), g.moveTo(p[0], p[1]), g.lineTo(grabbed.x, grabbed.y), g.stroke();
  }
}

function plot() {
  const [g, w, h] = canvas("plot"), ink = getComputedStyle(document.body).color;
  const levels = track.map(p => p[1]).concat(known ?? 0, 0), low = Math.min(...levels), high = Math.max(...levels);
  const room = Math.max(high - low, 1e-4), first = Math.max(0, time - SPAN);
  const x = t => 46 + (w - 52) * (t - first) / SPAN, y = u => 10 + (h - 24) * (high + 0.05 * room - u) / (1.1 * room);
  g.font = "12px system-ui", g.fillStyle = g.strokeStyle = ink;
  for (const u of [low, high]) g.fillText(`${(1e3 * u).toFixed(1)}`, 2, y(u) + 4);
  g.fillText("corner, u_z [mm]", 50, 12);
  g.lineWidth = 1.5, g.strokeStyle = "#d22";
  g.beginPath();
  for (const [t, u] of track) g.lineTo(x(t), y(u));
  g.stroke();
  if (known !== null) {
    g.strokeStyle = ink, g.setLineDash([6, 4]);
    g.beginPath(), g.moveTo(46, y(known)), g.lineTo(w, y(known)), g.stroke();
    g.setLineDash([]);
  }
}

function say() {
  const u = program.probe(LAST, 2), recent = track.filter(p => p[0] > time - 0.7).map(p => p[1]);
  const still = recent.length > 10 && Math.max(...recent) - Math.min(...recent) < 0.002 * Math.abs(u) && !grabbed;
  const mm = v => `${(1e3 * v).toFixed(2)} mm`, parts = [`Corner at ${mm(u)}`];
  if (known === null) parts.push("no stored answer of the shell here");
  else parts.push(`the shell at rest has ${mm(known)}`);
  if (still && known) parts.push(`the lattice is ${(100 * Math.abs(u / known - 1)).toFixed(1)} % off the shell`);
  else parts.push(grabbed ? "held by you" : value("damping") ? "still moving" : "without damping it does not settle");
  by("said").textContent = `${parts.join("; ")}.`;
}

function frame(now) {
  requestAnimationFrame(frame);
  if (!program) return;
  const began = performance.now();
  advance(Math.min(Math.max(now - before, 0), 40) / 1e3);
  before = now;
  track.push([time, program.probe(LAST, 2)]);
  while (track.length && track[0][0] < time - SPAN) track.shift();
  draw(), plot(), say();
  spent += performance.now() - began, frames += 1;
  window.measured = { frames, milliseconds: spent / frames, time, corner: program.probe(LAST, 2), known };
}

function pointer(event) {
  const box = by("sheet").getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}
let looking = null;
by("sheet").addEventListener("pointerdown", event => {
  const [x, y] = pointer(event);
  by("sheet").setPointerCapture(event.pointerId);
  let best = null, least = 45;
  for (let p = 0; program && p <= LAST; p++) {
    const q = project([0, 1, 2].map(axis => rest(p)[axis] + program.probe(p, axis))), d = Math.hypot(q[0] - x, q[1] - y);
    if (d < least) best = p, least = d;
  }
  if (best === null) looking = [x, y];
  else grabbed = { point: best, x, y };
});
by("sheet").addEventListener("pointermove", event => {
  const [x, y] = pointer(event);
  if (grabbed) grabbed.x = x, grabbed.y = y;
  else if (looking) turn += (x - looking[0]) / 150, tilt = Math.min(1.5, Math.max(-0.3, tilt + (y - looking[1]) / 150)), looking = [x, y];
});
for (const end of ["pointerup", "pointercancel"]) by("sheet").addEventListener(end, () => {
  if (grabbed && program) program.force(grabbed.point, 0, 0, 0);
  grabbed = looking = null;
});
for (const [name, words] of Object.entries(SCENES)) by("scene").add(new Option(words, name));
for (const name of ["young", "gravity", "damping"]) by(name).addEventListener("input", apply);
for (const name of ["scene", "thickness"]) by(name).addEventListener("change", load);
by("thickness").addEventListener("input", apply);
fetch("answers.json").then(response => response.json()).then(found => { answers = found; apply(); });
load(), requestAnimationFrame(frame);
