// The colour bar with the field's name, its unit and ticks.

import { css } from "./colours.js";
import { element } from "./page.js";
import { number, ticks } from "./shown.js";

export class Legend {
  constructor(parent) {
    this.root = element("div", { class: "sv-legend" }, parent);
    this.title = element("span", { class: "sv-legend-title" }, this.root);
    this.bar = element("canvas", { class: "sv-bar", width: 256, height: 1, "aria-hidden": "true" }, this.root);
    this.scale = element("div", { class: "sv-ticks" }, this.root);
  }

  show(field, [low, high]) {
    this.title.textContent = field.unit ? `${field.label} [${field.unit}]` : field.label;
    const brush = this.bar.getContext("2d");
    for (let i = 0; i < 256; i++) {
      brush.fillStyle = css(field.kind, i / 255);
      brush.fillRect(i, 0, 1, 1);
    }
    this.scale.replaceChildren();
    const least = high > low ? 10 ** (Math.floor(Math.log10(high - low)) - 2) : 0; // less is not seen in the bar
    for (const tick of ended(ticks(low, high), low, high)) {
      const mark = element("span", {}, this.scale);
      mark.textContent = number(least ? Math.round(tick / least) * least : tick);
      mark.style.left = `${high > low ? (100 * (tick - low)) / (high - low) : 50}%`;
    }
  }
}

// The ticks with both ends of the bar, but for those that would stand on an end's number.
function ended(marks, low, high) {
  if (!(high > low)) return marks;
  const near = 0.12 * (high - low);
  return [low, ...marks.filter((mark) => mark - low > near && high - mark > near), high];
}
