// Puts the shipped networks' shaders into the package: as files, and as strings that a bundler needs no loader for.

import fs from "node:fs";
import { fileURLToPath } from "node:url";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const from = here("../../shaders/");
fs.rmSync(here("shaders"), { recursive: true, force: true });
fs.cpSync(from, here("shaders"), { recursive: true });

const networks = {
  recommended: "recommended/recommended.wgsl",
  small: "small/small.wgsl",
  moments6: "moments-6/moments-6.wgsl",
  ends: "ends/ends.chain.wgsl",
  coreSmall: "core-small/core-small.chain.wgsl",
  core: "core/core.chain.wgsl",
  coreLarge: "core-large/core-large.chain.wgsl",
};
const lines = Object.entries(networks).map(([variable, file]) => {
  const source = fs.readFileSync(from + file, "utf8");
  return `/** shaders/${file} */\nexport const ${variable} = ${JSON.stringify(source)};\n`;
});
fs.writeFileSync(here("networks.js"), `// Made by build.mjs of the files in shaders/.\n\n${lines.join("\n")}`);
for (const name of ["LICENSE-MIT", "LICENSE-APACHE"]) fs.copyFileSync(here(`../../${name}`), here(name));
