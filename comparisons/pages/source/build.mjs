// Bundles the viewer with three.js into ../viewer.js; its first line carries the digest of what it is made of.

import { createHash } from "node:crypto";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { build } from "esbuild";

const names = readdirSync(".").filter((name) => /\.(js|mjs|json)$/.test(name)).sort();
const digest = createHash("sha256");
for (const name of names) digest.update(`${name}\0`).update(readFileSync(name)).update("\0");
const made = await build({
  entryPoints: ["index.js"],
  bundle: true,
  minify: true,
  format: "iife",
  globalName: "Sheets",
  target: "es2022",
  charset: "ascii",
  legalComments: "none",
  write: false,
});
const licence = readFileSync("node_modules/three/LICENSE", "utf8").trim();
const version = JSON.parse(readFileSync("node_modules/three/package.json", "utf8")).version;
const head = `/* source ${digest.digest("hex")} */\n/*! With three.js ${version}.\n${licence}\n*/\n`;
writeFileSync("../viewer.js", head + made.outputFiles[0].text);
