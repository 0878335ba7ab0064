// A web server for the repository, a Chromium with WebGPU on the CPU, and comparisons of images that cannot pass by
// accident.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import http from "node:http";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

export const ROOT = fileURLToPath(new URL("../../", import.meta.url));
/** Where tests leave what they write. */
export const SCRATCH = path.join(ROOT, "target", "web-tests");
fs.mkdirSync(SCRATCH, { recursive: true });

// WebGPU and WebGL by SwiftShader. Without the flag of Vulkan the first canvas frame ends the GPU process.
const FLAGS = [
  "--no-sandbox",
  "--enable-unsafe-webgpu",
  "--enable-features=Vulkan",
  "--use-vulkan=swiftshader",
  "--use-angle=swiftshader",
  "--enable-gpu",
];
const TYPES = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".mjs": "text/javascript",
  ".css": "text/css",
  ".json": "application/json",
};

/** Serves a folder of this machine on a free port. */
export async function serve(folder) {
  const server = http.createServer((request, response) => {
    const name = path.normalize(decodeURIComponent(request.url.split("?")[0]));
    const file = path.join(folder, name.endsWith("/") ? `${name}index.html` : name);
    if (!file.startsWith(folder)) return void response.writeHead(403).end();
    fs.readFile(file, (error, data) => {
      if (error) return void response.writeHead(404).end();
      response.writeHead(200, { "content-type": TYPES[path.extname(file)] ?? "text/plain" });
      response.end(data);
    });
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return { url: `http://localhost:${server.address().port}`, close: () => server.close() };
}

export const launch = () =>
  chromium.launch({ executablePath: process.env.NMT_CHROMIUM || "/usr/bin/chromium", args: FLAGS });

/** Opens an address; what the console reports as an error is kept in `page.errors`. */
export async function open(browser, url, viewport = { width: 480, height: 360 }) {
  const page = await browser.newPage({ viewport });
  page.errors = [];
  page.on("console", (message) => message.type() === "error" && page.errors.push(message.text()));
  page.on("pageerror", (error) => page.errors.push(error.message));
  await page.goto(url);
  return page;
}

/** The nmt program: NMT_BIN, or what cargo has built. */
export function nmt(...args) {
  const program = process.env.NMT_BIN || path.join(ROOT, "target", "release", "nmt");
  return execFileSync(program, args, { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
}

/** Numbers that came out of a page as base64 of little-endian f32. */
export const floats = (base64) => {
  const bytes = Buffer.from(base64, "base64");
  return new Float32Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
};

/**
 * How far images are apart: `share` is that of the pixels whose channels all lie within the tolerance, `worst` the
 * greatest difference, `mse` over all channels. Empty and unequal images fail; what is not a number counts as 9.
 */
export function compare(image, reference, tolerance) {
  assert.ok(image.length > 0 && image.length % 3 === 0, "an image must have pixels");
  assert.equal(image.length, reference.length, "images of one size");
  let [near, worst, mse] = [0, 0, 0];
  for (let p = 0; p < image.length; p += 3) {
    let most = 0;
    for (let c = p; c < p + 3; c++) {
      const d = Math.abs(image[c] - reference[c]);
      const distance = Number.isFinite(d) ? d : 9;
      most = Math.max(most, distance);
      mse += (distance * distance) / image.length;
    }
    worst = Math.max(worst, most);
    near += most <= tolerance ? 1 : 0;
  }
  return { share: near / (image.length / 3), worst, mse };
}
