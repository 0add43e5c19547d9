// Colour maps that the colour-blind read too: viridis for magnitudes, ColorBrewer's blue to red through
// white for what has a sign, magma from its end for differences. Matplotlib's maps at 17 equal steps, linear between.

const MAPS = {
  magnitude:
    "440154 48186a 472d7b 424086 3b528b 33638d 2c728e 26828e 21918c 1fa088 28ae80 3fbc73 5ec962 84d44b addc30 d8e219 fde725",
  signed:
    "053061 175290 2a71b2 3f8ec0 6bacd1 9bc9e0 c2ddec e0ecf3 f7f6f6 fbe5d8 fbccb4 f5aa89 e48066 d05548 ba2832 930e26 67001f",
  difference:
    "fcfdbf fde0a1 fec287 fea571 fb8761 f4695c e55064 cf4070 b5367a 9b2e7f 812581 681c81 4f127b 341069 1c1044 090720 000004",
};

const linear = (c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);

const STEPS = Object.fromEntries(
  Object.entries(MAPS).map(([name, text]) => [
    name,
    text.split(" ").map((hex) => [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255)),
  ]),
);
const TABLE = 256;
const TABLES = Object.fromEntries(
  Object.keys(STEPS).map((name) => [
    name,
    Float32Array.from({ length: 3 * TABLE }, (_, i) => linear(at(name, Math.floor(i / 3) / (TABLE - 1))[i % 3])),
  ]),
);

// The colour [r, g, b] in sRGB, 0 to 1, at a share of the way through a map.
export function at(name, share) {
  const steps = STEPS[name];
  const place = Math.min(Math.max(share, 0), 1) * (steps.length - 1);
  const below = Math.min(Math.floor(place), steps.length - 2);
  const part = place - below;
  return steps[below].map((c, i) => c + part * (steps[below + 1][i] - c));
}

export const css = (name, share) => `rgb(${at(name, share).map((c) => Math.round(255 * c)).join(" ")})`;

// Fills `colours` (3 n), linear light as three.js mixes it, with those of `values` (n) within [low, high].
export function paint(colours, values, [low, high], name) {
  const table = TABLES[name];
  const factor = high > low ? (TABLE - 1) / (high - low) : 0;
  for (let i = 0; i < values.length; i++) {
    const share = Math.round((values[i] - low) * factor);
    const entry = 3 * (share > 0 ? Math.min(share, TABLE - 1) : 0);
    colours[3 * i] = table[entry];
    colours[3 * i + 1] = table[entry + 1];
    colours[3 * i + 2] = table[entry + 2];
  }
}
