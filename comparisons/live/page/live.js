// The page of `sheetbench live`: sliders ask, lattice and shell answer, the newest counts.
//
// Every question has a number, and every answer that of its question. Each model has one question at a time; one
// that a newer overtakes before the model is free is not asked. All texts are set as text, never read as markup.

"use strict";

(() => {
  const at = (id) => document.getElementById(id);
  const STEPS = 1000;
  const FACTS = ["Status", "Time to solve, ms", "Unknowns", "Largest |u| at the probes, mm"];
  const sliders = new Map();
  const shown = {}; // the last answer of each model
  const given = {}; // its sheet, as the viewer takes it
  const latencies = []; // ms from the event to the lattice drawn
  const calibration = at("calibration");
  let panel, viewer;
  let number = 0;

  window.live = { latencies, shown, asked: () => number };

  function make(kind, attributes, parent) {
    const found = document.createElement(kind);
    for (const [name, value] of Object.entries(attributes)) found.setAttribute(name, value);
    parent.append(found);
    return found;
  }

  // A number with so many figures, zeros at its end too, and a minus sign.
  function figures(value, digits) {
    if (!Number.isFinite(value)) return "–";
    const size = Math.floor(Math.log10(Math.abs(value) || 1));
    return value.toFixed(Math.max(digits - 1 - size, 0)).replace("-", "−");
  }

  // Units that may be typed, in SI.
  const SCALES = {
    Pa: { of: "pressure", si: 1 }, kPa: { of: "pressure", si: 1e3 }, MPa: { of: "pressure", si: 1e6 }, GPa: { of: "pressure", si: 1e9 },
    "µm": { of: "length", si: 1e-6 }, um: { of: "length", si: 1e-6 }, mm: { of: "length", si: 1e-3 }, cm: { of: "length", si: 1e-2 }, m: { of: "length", si: 1 },
  };

  function refuse(said) {
    at("refused").textContent = said;
    return null;
  }

  // ---- the question

  class Slider {
    constructor(given, parent) {
      Object.assign(this, given);
      this.start = this.value;
      this.root = make("div", { class: "slider" }, parent);
      const id = `slider-${this.name}`;
      make("label", { for: id }, this.root).textContent = this.label;
      const value = make("span", { class: "value" }, this.root);
      this.text = make("input", { type: "text", inputmode: "decimal", "aria-label": `${this.label}, ${this.unit}` }, value);
      make("span", { class: "unit" }, value).textContent = this.unit;
      const [min, max] = this.whole ? [this.low, this.high] : [0, STEPS];
      this.range = make("input", { type: "range", id, min, max, step: 1 }, this.root);
      this.put(this.value);
      this.range.addEventListener("input", (event) => {
        this.value = this.placed(Number(this.range.value));
        this.write();
        ask(event.timeStamp);
      });
      this.text.addEventListener("change", (event) => {
        const value = this.read(this.text.value);
        if (value === null) return this.write(); // the value that the picture is of
        this.put(value);
        ask(event.timeStamp);
      });
    }

    // The value that a text says, in SI units; null, with a sentence, for one that is none or beyond the bounds.
    read(text) {
      const said = text.trim();
      const [, digits, unit] = said.replace("−", "-").replace(",", ".").match(/^([-+]?[\d.]+(?:e[-+]?\d+)?)\s*(.*)$/i) ?? [];
      const factor = unit ? (this.unit in SCALES && SCALES[unit]?.of === SCALES[this.unit].of ? SCALES[unit].si : unit === this.unit ? 1 / this.factor : NaN) : 1 / this.factor;
      const value = Number(digits) * factor;
      const shown = (number) => `${Sheets.number(number * this.factor, 5)}${this.unit ? ` ${this.unit}` : ""}`;
      if (Number.isNaN(value)) {
        const hint = this.unit in SCALES ? `a number in ${this.unit}, or with another unit of ${SCALES[this.unit].of}` : "a number";
        return refuse(`${this.label}: “${said}” cannot be read; write ${hint}. It stays ${shown(this.value)}.`);
      }
      const round = 1e-9 * Math.abs(value);
      if (value < this.low - round || value > this.high + round) {
        return refuse(`${this.label}: ${shown(value)} is beyond this page, which goes from ${shown(this.low)} to ${shown(this.high)}. It stays ${shown(this.value)}.`);
      }
      return Math.min(Math.max(this.whole ? Math.round(value) : value, this.low), this.high);
    }

    // The value at a place of the range: where it starts, exactly the scene's.
    placed(place) {
      if (this.whole) return place;
      if (place === this.place(this.start)) return this.start;
      const share = place / STEPS;
      if (!this.logarithmic) return this.low + share * (this.high - this.low);
      return this.low * (this.high / this.low) ** share;
    }

    place(value) {
      if (this.whole) return value;
      const { low, high } = this;
      const share = this.logarithmic ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
      return Math.round(STEPS * share);
    }

    put(value) {
      this.value = value;
      this.range.value = this.place(value);
      this.write();
    }

    write() {
      const text = Sheets.number(this.value * this.factor, 5);
      this.text.value = text;
      this.range.setAttribute("aria-valuetext", `${text} ${this.unit}`);
    }

    enable(on) {
      this.range.disabled = this.text.disabled = !on;
      this.root.classList.toggle("off", !on);
    }
  }

  function build(message) {
    panel = message;
    at("name").textContent = panel.name;
    at("title").textContent = panel.title;
    document.title = `${panel.name} · sheetbench live`;
    let place = "sliders";
    for (const slider of panel.sliders) {
      if (slider.name === "grid") place = "models"; // from here on
      sliders.set(slider.name, new Slider(slider, at(place)));
    }
    for (const name of Object.keys(panel.calibrations)) make("option", { value: name }, calibration).textContent = name;
    calibration.value = panel.calibration;
    settle();
    const row = (parent, name) => {
      const found = make("tr", { "data-fact": name }, parent);
      make("th", { scope: "row" }, found).textContent = name;
      for (const model of ["lattice", "shell"]) make("td", { "data-model": model }, found).textContent = "–";
    };
    for (const fact of FACTS) row(at("facts"), fact);
    for (const probe of Object.keys(panel.probes)) row(at("probes"), probe);
  }

  // Sliders that the calibration has no use for.
  function settle() {
    const { said, takes } = panel.calibrations[calibration.value];
    at("method").textContent = `How k is found from E, ν and h: ${said}.`;
    sliders.get("grading").enable(takes.includes("grading"));
    sliders.get("k")?.enable(takes.includes("k"));
    sliders.get("grid").enable(calibration.value !== "scene");
  }

  // since: when it was requested, by the event's own clock.
  function ask(since) {
    number += 1;
    at("refused").textContent = "";
    mark();
    const values = {};
    for (const [name, slider] of sliders) values[name] = slider.value;
    if (sliders.get("grading").range.disabled) values.grading = 0;
    lattices.ask({ number, values, calibration: calibration.value, since });
  }

  // ---- what is answered

  const VIEWS = [
    { name: "lattice", label: "Lattice", sheets: ["lattice"], field: "uz" },
    { name: "shell", label: "Shell", sheets: ["shell"], field: "uz" },
    { name: "both", label: "Both", sheets: ["shell", "lattice"], field: "uz" },
    { name: "difference", label: "Difference", sheets: ["lattice"], field: "difference" },
  ];

  function draw(model, message) {
    const { displacement, forces, points } = message.sheet;
    const known = given[model];
    given[model] = message.sheet;
    if (known?.points.float32 === points.float32) return viewer.update(model, { displacement, forces });
    const sheets = Object.values(given);
    const views = given.shell ? VIEWS : VIEWS.slice(0, 1);
    if (viewer) {
      viewer.setSheets(sheets, views);
      if (model === "shell") viewer.setSheet("both"); // its first answer
    } else {
      const { outline, from } = panel;
      viewer = Sheets.createViewer(at("stage"), { sheets, views, outline, from, label: "Lattice and shell", quick: true });
      window.live.viewer = viewer;
    }
  }

  function lattice(message, question) {
    at("state").textContent = "";
    shown.lattice = message;
    draw("lattice", message);
    tell("lattice", message);
    shells.ask(question);
    const { since } = question;
    if (since === undefined) return;
    requestAnimationFrame(() => {
      latencies.push(performance.now() - since);
      at("latency").textContent = `${figures(latencies.at(-1), 3)} ms`;
    });
  }

  function shell(message, { since }) {
    const { difference, error } = message;
    shown.shell = message;
    draw("shell", message);
    const known = given.lattice.fields.at(-1).values; // of a newer lattice perhaps, with other masses
    if (known.float32.length === difference.float32.length) viewer.update("lattice", { values: { difference } });
    tell("shell", message);
    if (since !== undefined) requestAnimationFrame(() => (message.after = performance.now() - since));
    at("error").textContent = error === null ? "–" : `${figures(100 * error, error < 0.1 ? 2 : 3)} %`;
  }

  function tell(model, message) {
    const largest = Math.max(...Object.values(message.probes).map((u) => Math.hypot(...u)));
    const reached = message.load_factor === 1 ? "" : ` at ${figures(100 * message.load_factor, 2)} % of the load`;
    const facts = [message.status + reached, figures(1e3 * message.seconds, 3), message.unknowns, figures(1e3 * largest, 4)];
    FACTS.forEach((fact, i) => (cell("facts", fact, model).textContent = facts[i]));
    cell("facts", "Status", model).title = message.advice;
    for (const [probe, u] of Object.entries(message.probes)) {
      const texts = u.map((value) => (value === null ? "–" : figures(1e3 * value, 4)));
      cell("probes", probe, model).textContent = texts.join(", ");
    }
    const said = ["lattice", "shell"].filter((name) => shown[name]?.said);
    at("said").textContent = said.map((name) => `${name}: ${shown[name].said}.`).join(" ");
    mark();
  }

  function cell(table, row, model) {
    return at(table).querySelector(`[data-fact="${CSS.escape(row)}"] [data-model="${model}"]`);
  }

  // What does not answer the newest question is pale.
  function mark() {
    for (const model of ["lattice", "shell"]) {
      const behind = shown[model]?.number !== number;
      for (const one of document.querySelectorAll(`[data-model="${model}"]`)) one.classList.toggle("behind", behind);
    }
  }

  // ---- the conversation

  async function post(what, { since, ...question }) {
    let answer;
    try {
      answer = await fetch(what, { method: "POST", body: JSON.stringify(question) });
    } catch {
      at("state").textContent = "The server has ended: start sheetbench live again, and open the address that it prints.";
      at("stage").prepend(at("state"));
      return null;
    }
    const message = await answer.json();
    if (answer.ok) return message;
    if (question.number === number) refuse(message.said);
    return null;
  }

  // One question of a model at a time; of those that wait the newest is asked next.
  class Model {
    constructor(name, heard) {
      Object.assign(this, { name, heard, busy: false, waiting: null });
    }

    async ask(question) {
      this.waiting = question;
      if (this.busy) return;
      this.busy = true;
      try {
        while ((question = this.waiting)) {
          this.waiting = null;
          const answer = await post(this.name, question);
          if (answer) this.heard(answer, question);
        }
      } finally {
        this.busy = false;
      }
    }
  }

  const lattices = new Model("lattice", lattice);
  const shells = new Model("shell", shell);

  calibration.addEventListener("change", (event) => {
    settle();
    ask(event.timeStamp);
  });
  at("reset").addEventListener("click", (event) => {
    for (const slider of sliders.values()) slider.put(slider.start);
    calibration.value = panel.calibration;
    settle();
    ask(event.timeStamp);
  });
  at("panel").addEventListener("submit", (event) => event.preventDefault());
  fetch("panel").then((answer) => answer.json()).then((message) => {
    build(message);
    ask(); // the first answer is of no drag
  });
})();
