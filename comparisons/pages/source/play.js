// The time slider and the button that lets a motion run in its own time, slowed down where it is short.

import { element, labelled } from "./page.js";
import { number } from "./shown.js";

const SHORTEST = 4; // seconds that a motion takes to watch, at least

export class Play {
  constructor(parent, show) {
    this.root = element("div", { class: "sv-play", hidden: "" }, parent);
    this.button = element("button", { type: "button" }, this.root);
    this.button.addEventListener("click", () => (this.running ? this.stop() : this.start()));
    this.slider = labelled(this.root, "Time", "input", { type: "range", min: 0, value: 0, step: 1 });
    this.slider.addEventListener("input", () => {
      this.stop();
      this.show(Number(this.slider.value));
    });
    this.said = element("output", {}, this.root);
    this.call = show;
    this.stop();
  }

  // times: of the frames [s], rising.
  of(times) {
    const same = times.length === this.times?.length && times.every((time, i) => time === this.times[i]);
    if (same) return;
    this.stop();
    this.times = times;
    this.root.hidden = times.length < 2;
    this.slider.max = Math.max(times.length - 1, 0);
    if (times.length > 1) this.show(times.length - 1);
  }

  show(index) {
    this.index = index;
    this.slider.value = index;
    this.said.textContent = `${number(this.times[index], 4)} s`;
    this.slider.setAttribute("aria-valuetext", this.said.textContent);
    this.call(this.times[index]);
  }

  start() {
    const [first, last] = [this.times[0], this.times.at(-1)];
    const pace = (last - first) / Math.max(last - first, SHORTEST);
    const begun = this.index >= this.times.length - 1 ? first : this.times[this.index];
    const since = performance.now();
    this.running = true;
    this.button.textContent = "Pause";
    const step = (now) => {
      if (!this.running) return;
      const time = begun + (pace * Math.max(now - since, 0)) / 1000;
      const index = this.times.findLastIndex((at) => at <= time);
      if (index !== this.index) this.show(Math.max(index, 0));
      if (time >= last) this.stop();
      else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  stop() {
    this.running = false;
    this.button.textContent = "Play";
  }
}
