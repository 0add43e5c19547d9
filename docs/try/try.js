// Steps lattices in WebAssembly, draws them, and plots the far corner beside the shell's stored answer.
"use strict";
const YOUNG = 54.5e6, GRAVITY = 9.81, SIDE = 0.188, SPAN = 6; // Pa, m/s², m, seconds of the plot
const SIDE_COLUMNS = 9, COLUMNS = SIDE_COLUMNS ** 2, ROWS = 3 * COLUMNS; // rows of sheet.h: two layers and their middles
const HELD = 15, LIFT = 3 * COLUMNS + 2; // N/m of the spring to a finger; number of the input gravity.z
const by = id => document.getElementById(id);
const value = name => CHOICES[name].stops[+by(name).value];
const three = of => [0, 1, 2].map(of);
const dot = (x, y) => x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
const CHOICES = { // what can be chosen: its stops, the one it starts with, how it is shown
  scene: { stops: ["two-edges-clamped", "one-edge-clamped"], start: 0, shown: v => v.replaceAll("-", " ") },
  thickness: { stops: [2, 3, 4, 6], start: 1, shown: v => `${v} mm` },
  E: { stops: [0.5, 1, 2], start: 1, shown: v => `${(v * YOUNG / 1e6).toFixed(1)} MPa` },
  gravity: { stops: [0, 0.5, 1, 2], start: 2, shown: v => `${(v * GRAVITY).toFixed(1)} m/s²` },
  damping: { stops: [0, 1, 4, 12], start: 2, shown: v => v ? `${v} 1/s` : "none" },
};
let program = null, answers = {}, known = null, track = [], time = 0, left = 0, before = 0;
let grabbed = null, looking = null, turn = -0.6, tilt = 0.5, frames = 0, spent = 0, wanted = "";

// numbers of the program from an address on; of its sheet, by place as in sheet.h: time, step, inputs, u, v
const numbers = (address, count) => new Float64Array(program.memory.buffer, address, count);
const vectors = number => numbers(program.SHEET.value + 8 * (3 + LIFT + 3 * ROWS * number), 3 * ROWS); // u or v
const set = (number, value) => program.sheet_set(program.SHEET.value, number, value);

async function load(name) {
  try {
    const response = await fetch(`${name.replace(" ", "-")}.wasm`);
    if (!response.ok) throw new Error(`${response.status}`);
    const { instance } = await WebAssembly.instantiate(await response.arrayBuffer(), {});
    if (wanted !== name) return; // another was chosen meanwhile
    program = instance.exports;
    program.sheet_reset(program.SHEET.value);
    track = [], time = left = 0, grabbed = null;
    apply();
  } catch (error) {
    const then = location.protocol === "file:" ? "python -m http.server, for browsers read no files beside a page on a disk" : "pip install ziglang, then make docs";
    by("said").textContent = `${name} is not here (${error.message}): ${then}.`;
  }
}

// E in proportion to every spring: gravity and forces over it and time by its root are the same motion
function apply() {
  for (const name in CHOICES) by(name).ariaValueText = by(name).previousElementSibling.textContent = CHOICES[name].shown(value(name));
  const ratio = value("gravity") / value("E"), sheet = `${value("scene")} ${value("thickness")}`;
  known = ratio === 0 ? 0 : answers[sheet]?.[ratio] ?? null;
  if (wanted !== sheet) load(wanted = sheet);
  if (program) set(LIFT, -GRAVITY * ratio);
}

function advance(seconds) {
  const root = Math.sqrt(value("E")), step = 4 * numbers(program.SHEET.value, 2)[1], v = vectors(1);
  const slower = Math.exp(-value("damping") / root * step);
  left = Math.min(left + seconds * root, 40 * root * 1e-3);
  for (; left > 0; left -= step, time += step / root) {
    if (grabbed) pull(grabbed.point, HELD / scale());
    program.sheet_step(program.SHEET.value, 4);
    for (let i = 0; i < v.length; i++) v[i] *= slower;
  }
}
function pull(point, stiffness) { // a soft spring from the point to the finger, in the plane of the screen
  const [x, y] = project(place(point)), [right, up] = axes();
  three(e => set(3 * point + e, stiffness && stiffness * ((grabbed.x - x) * right[e] + (y - grabbed.y) * up[e])));
}
function place(column) {
  const first = 3 * (2 * COLUMNS + column), rest = numbers(program.SHEET_REST.value, 3 * ROWS), u = vectors(0);
  return three(e => rest[first + e] + u[first + e]);
}
const scale = () => 0.66 * Math.min(by("sheet").clientWidth, 1.2 * by("sheet").clientHeight) / SIDE;
function axes() { // to the right, up and towards the viewer
  const c = Math.cos(turn), s = Math.sin(turn), d = Math.cos(tilt), t = Math.sin(tilt);
  return [[c, -s, 0], [s * t, c * t, d], [s * -d, c * -d, t]];
}
function project([x, y, z]) {
  const [right, up, near] = axes().map(axis => scale() * dot(axis, [x - SIDE / 2, y - SIDE / 2, z + SIDE / 20]));
  return [by("sheet").clientWidth / 2 + right, by("sheet").clientHeight / 2 - up, near];
}
const line = (points, how) => `<polyline points="${points.map(p => p.slice(0, 2)).join(" ")}" ${how}/>`;

function draw() {
  const n = SIDE_COLUMNS, at = [...Array(COLUMNS).keys()].map(k => project(place(k))), cells = [];
  at.forEach((_, k) => k % n && k >= n && cells.push([k - n - 1, k - n, k, k - 1, k - n - 1].map(c => at[c])));
  const far = c => c[0][2] + c[1][2] + c[2][2] + c[3][2];
  const faces = cells.sort((a, b) => far(a) - far(b)).map(c => {
    const [a, b] = [2, 3].map(k => three(e => c[k][e] - c[k - 2][e])); // diagonals
    const m = three(e => a[(e + 1) % 3] * b[(e + 2) % 3] - a[(e + 2) % 3] * b[(e + 1) % 3]);
    const light = Math.abs(dot(m, [0.25, -0.45, 1])) / Math.hypot(...m) / 1.12;
    return line(c, `fill="hsl(${m[2] < 0 ? "208 60%" : "28 70%"} ${25 + 45 * light}%)" stroke="rgb(0 0 0 / 25%)"`);
  });
  faces.push(line([at.at(-1), at.at(-1)], 'class="corner"'));
  if (grabbed) faces.push(line([project(place(grabbed.point)), [grabbed.x, grabbed.y]], 'class="track"'));
  by("sheet").innerHTML = faces.join("");
}

function plot() {
  const { clientWidth: w, clientHeight: h } = by("plot"), levels = track.map(p => p[1]).concat(known ?? 0, 0);
  const low = Math.min(...levels), high = Math.max(...levels), room = Math.max(high - low, 1e-4);
  const first = Math.max(0, time - SPAN), y = u => 10 + (h - 24) * ((high - u) / room + 0.05) / 1.1;
  const texts = [low, high].map(u => `<text x="2" y="${y(u) + 4}">${(1e3 * u).toFixed(1)}</text>`);
  texts.push('<text x="50" y="12">corner, u_z [mm]</text>');
  texts.push(line(track.map(([t, u]) => [46 + (w - 52) * (t - first) / SPAN, y(u)]), 'class="track"'));
  if (known !== null) texts.push(line([[46, y(known)], [w, y(known)]], 'class="known"'));
  by("plot").innerHTML = texts.join("");
}

function say(u) {
  const recent = track.filter(p => p[0] > time - 0.7).map(p => p[1]), mm = v => `${(1e3 * v).toFixed(2)} mm`;
  const still = recent.length > 10 && Math.max(...recent) - Math.min(...recent) < 0.002 * Math.abs(u) && !grabbed;
  const shell = known === null ? "no stored answer of the shell here" : `the shell at rest has ${mm(known)}`;
  const moving = grabbed ? "held by you" : value("damping") ? "still moving" : "without damping it does not settle";
  const off = still && known ? `the lattice is ${(100 * Math.abs(u / known - 1)).toFixed(1)} % off the shell` : moving;
  by("said").textContent = `Corner at ${mm(u)}; ${shell}; ${off}.`;
}

function frame(now) {
  requestAnimationFrame(frame);
  if (!program) return;
  const began = performance.now();
  advance(Math.min(Math.max(now - before, 0), 40) / 1e3);
  before = now;
  const corner = place(COLUMNS - 1)[2];
  track.push([time, corner]);
  while (track[0][0] < time - SPAN) track.shift();
  draw(), plot(), say(corner);
  spent += performance.now() - began, frames += 1;
  window.measured = { frames, milliseconds: spent / frames, time, corner, known };
}

by("sheet").addEventListener("pointerdown", event => {
  const [x, y] = looking = [event.offsetX, event.offsetY];
  by("sheet").setPointerCapture(event.pointerId);
  for (let p = 0, least = 45; program && p < COLUMNS; p++) {
    const q = project(place(p)), d = Math.hypot(q[0] - x, q[1] - y);
    if (d < least) grabbed = { point: p, x, y }, least = d;
  }
});
by("sheet").addEventListener("pointermove", event => {
  const { offsetX: x, offsetY: y } = event;
  if (grabbed) grabbed = { ...grabbed, x, y };
  else if (looking) turn += (x - looking[0]) / 150, tilt = Math.min(1.5, Math.max(-0.3, tilt + (y - looking[1]) / 150)), looking = [x, y];
});
for (const end of ["pointerup", "pointercancel"]) by("sheet").addEventListener(end, () => {
  if (grabbed && program) pull(grabbed.point, 0);
  grabbed = looking = null;
});
for (const [name, { stops, start }] of Object.entries(CHOICES)) {
  const range = `<input id="${name}" type="range" max="${stops.length - 1}" value="${start}" aria-label="${name}">`;
  by("panel").insertAdjacentHTML("beforeend", `<div class="slider"><span>${name}</span><b class="value"></b>${range}</div>`);
  by(name).addEventListener("input", apply);
}
fetch("answers.json").then(response => response.json()).then(found => { answers = found; apply(); });
apply(), requestAnimationFrame(frame);
