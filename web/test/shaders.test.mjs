// The files of shaders/ as browsers read them: WGSL by Tint, GLSL ES 3.00 by ANGLE; and the sample in WebGL 2 against a
// sorted image.

import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { after, before, test } from "node:test";
import { link } from "wesl";
import { ROOT, compare, launch, open, serve } from "./browser.mjs";

const SHADERS = path.join(ROOT, "shaders");
const NETWORKS = fs.readdirSync(SHADERS).filter((name) => fs.statSync(path.join(SHADERS, name)).isDirectory());
let browser, server;

before(async () => {
  server = await serve(ROOT);
  browser = await launch();
});
after(async () => {
  await browser.close();
  server.close();
});

const text = (...parts) => fs.readFileSync(path.join(SHADERS, ...parts), "utf8");

/** Files of a kind, of every network; there must be some. */
function files(kind, test) {
  const found = NETWORKS.flatMap((network) => {
    const folder = path.join(SHADERS, network, kind);
    const names = fs.existsSync(folder) ? fs.readdirSync(folder, { withFileTypes: true }) : [];
    return names.filter((entry) => entry.isFile() && test(entry.name)).map((entry) => [network, kind, entry.name]);
  });
  assert.ok(found.length >= 4, `${found.length} files of ${kind || "include files"}`);
  return found;
}

test("Tint reads every WGSL file, and no broken one", async () => {
  const page = await open(browser, `${server.url}/shaders/README.md`);
  const sources = [...files("", (name) => name.endsWith(".wgsl")), ...files("webgpu", () => true)];
  const broken = text("recommended", "webgpu", "pass2.wgsl").replace("fn nmt_share", "fn nmt_shares");
  const all = [...sources.map((parts) => [parts.join("/"), text(...parts)]), ["broken", broken]];
  const messages = await page.evaluate(async (all) => {
    const adapter = await navigator.gpu.requestAdapter();
    const device = await adapter.requestDevice();
    const out = {};
    for (const [name, code] of all) {
      device.pushErrorScope("validation");
      const info = await device.createShaderModule({ code }).getCompilationInfo();
      await device.popErrorScope();
      out[name] = info.messages.filter((m) => m.type === "error").map((m) => `${m.lineNum}: ${m.message}`);
    }
    return out;
  }, all);
  assert.ok(messages.broken.length > 0, "the control: a missing function is an error");
  delete messages.broken;
  assert.deepEqual(Object.entries(messages).filter(([, errors]) => errors.length > 0), []);
});

test("ANGLE compiles and links every pass in GLSL ES 3.00, and no broken one", async () => {
  const page = await open(browser, `${server.url}/shaders/README.md`);
  const surface =
    "#version 300 es\nin vec4 p;out float v;out vec4 color;void main(){gl_Position=p;v=p.w;color=p;}";
  const pairs = files("opengl-es-300", (name) => name.endsWith(".frag")).map((parts) => {
    const fullscreen = parts[2] === "resolve.frag";
    return [parts.join("/"), fullscreen ? text(parts[0], parts[1], "fullscreen.vert") : surface, text(...parts)];
  });
  const broken = text("recommended", "opengl-es-300", "pass1.frag").replace("precision highp float;", "");
  const errors = await page.evaluate(
    (pairs) => {
      const gl = document.createElement("canvas").getContext("webgl2");
      return pairs.map(([name, ...sources]) => {
        const program = gl.createProgram();
        const logs = sources.map((source, i) => {
          const shader = gl.createShader(i === 0 ? gl.VERTEX_SHADER : gl.FRAGMENT_SHADER);
          gl.shaderSource(shader, source);
          gl.compileShader(shader);
          gl.attachShader(program, shader);
          return gl.getShaderInfoLog(shader);
        });
        gl.linkProgram(program);
        const linked = gl.getProgramParameter(program, gl.LINK_STATUS);
        return linked ? "" : `${name}: ${logs} ${gl.getProgramInfoLog(program)}`;
      });
    },
    [...pairs, ["broken", surface, broken]],
  );
  assert.ok(errors.pop().length > 0, "the control: no precision is an error");
  assert.deepEqual(errors.filter((e) => e !== ""), []);
});

test("WESL links networks by their names, two into one module, and Tint reads the result", async () => {
  const module = (network) => text(network, `${network}.wgsl`);
  const linked = async (main) => {
    const modules = { "./recommended.wgsl": module("recommended"), "./small.wgsl": module("small") };
    const weslSrc = { "./main.wesl": main, ...modules };
    return (await link({ weslSrc, rootModuleName: "main" })).dest;
  };
  const main = `
    import package::recommended::{nmt_pass1, nmt_pass2};
    import package::small::nmt_pass2 as small_pass2;
    @fragment fn f(@location(0) v: f32) -> @location(0) vec4<f32> {
        let s = nmt_pass1(v, 1.0, 2.0, 0.5);
        let T = nmt_pass2(v, 1.0, 2.0, 0.5, s.sums0, s.sums1, s.range);
        return vec4<f32>(T, small_pass2(v, 1.0, 2.0, 0.5, s.sums0, s.sums1, s.range), 0.0, 1.0);
    }`;
  const code = await linked(main);
  assert.equal(code.match(/^fn \w*nmt_share\d*\(/gm).length, 2, "both networks");
  assert.ok(!code.includes("nmt_hidden_weight"), "what is not called is left out");
  const page = await open(browser, `${server.url}/shaders/README.md`);
  const errors = await page.evaluate(async (code) => {
    const device = await (await navigator.gpu.requestAdapter()).requestDevice();
    const info = await device.createShaderModule({ code }).getCompilationInfo();
    return info.messages.filter((m) => m.type === "error").map((m) => m.message);
  }, code);
  assert.deepEqual(errors, []);
  const wrong = linked(main.replace("small::nmt_pass2", "small::nmt_pass3"));
  await assert.rejects(wrong, "the control: a function that is not there");
});

/** Which pixels an edge goes through, rasterisers may see otherwise by a 256th of a pixel; here, by four of them. */
const SLACK = 4 / 256;

/** Twice the area of a triangle in the image, and the lengths of its edges with their sum. */
function measures([[ax, ay], [bx, by], [cx, cy]]) {
  const lengths = [Math.hypot(bx - ax, by - ay), Math.hypot(cx - bx, cy - by), Math.hypot(ax - cx, ay - cy)];
  return [(bx - ax) * (cy - ay) - (by - ay) * (cx - ax), [...lengths, lengths[0] + lengths[1] + lengths[2]]];
}

/**
 * The image of the sample's scene by the over operator, row by row from the bottom, how many fragments a pixel has, and
 * whether it is clear what they are.
 */
function sorted({ scene, matrix, background }, width, height, order) {
  const image = new Float32Array(3 * width * height);
  const counts = new Uint32Array(width * height);
  const clear = new Uint8Array(width * height).fill(1);
  const row = (r, [x, y, z]) => matrix[r] * x + matrix[4 + r] * y + matrix[8 + r] * z + matrix[12 + r];
  const clip = (p) => [0, 1, 2, 3].map((r) => row(r, p));
  const triangles = scene.map(({ corners, paint }) => {
    const q = corners.map(clip);
    const at = q.map((c) => [(c[0] / c[3] / 2 + 0.5) * width, (c[1] / c[3] / 2 + 0.5) * height, 1 / c[3]]);
    const [area, lengths] = measures(at);
    // What lies further off is neither inside nor near an edge.
    const reach = 2 + (SLACK * lengths[3]) / Math.min(...lengths.slice(0, 3));
    const box = [0, 1].map((k) => [Math.min(...at.map((p) => p[k])) - reach, Math.max(...at.map((p) => p[k])) + reach]);
    return { at, paint, area, slack: (SLACK * lengths[3]) / Math.abs(area), box };
  });
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const [px, py] = [x + 0.5, y + 0.5];
      const hits = [];
      for (const { at, paint, area, slack, box } of triangles) {
        if (px < box[0][0] || px > box[0][1] || py < box[1][0] || py > box[1][1]) continue;
        const edge = (a, b) => (b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0]);
        const parts = [edge(at[1], at[2]), edge(at[2], at[0]), edge(at[0], at[1])].map((e) => e / area);
        const least = Math.min(...parts);
        if (Math.abs(least) < slack) clear[y * width + x] = 0;
        const inverse = parts.reduce((sum, part, i) => sum + part * at[i][2], 0);
        if (least > 0) hits.push({ v: 1 / inverse, paint });
      }
      // Nor which of two surfaces lies in front where one goes through the other.
      const depths = hits.map((hit) => hit.v).sort((a, b) => a - b);
      if (depths.some((v, i) => i > 0 && v - depths[i - 1] < 2e-3 * v)) clear[y * width + x] = 0;
      if (order === "sorted") hits.sort((a, b) => b.v - a.v);
      let color = background;
      for (const { paint } of hits) color = color.map((c, i) => paint[3] * paint[i] + (1 - paint[3]) * c);
      image.set(color, 3 * (y * width + x));
      counts[y * width + x] = hits.length;
    }
  }
  return { image, counts, clear };
}

test("the sample in WebGL 2 is the sorted image where closed forms are exact, and near it elsewhere", async () => {
  const page = await open(browser, `${server.url}/examples/webgl2.html`, { width: 660, height: 520 });
  await page.waitForFunction(() => window.sample);
  const [width, height] = [640, 480];
  for (const angle of [0, 2.1]) {
    const shown = await page.evaluate((angle) => {
      window.stopped = true;
      const { scene, camera, frame, background, gl } = window.sample;
      frame(angle);
      const bytes = new Uint8Array(4 * gl.canvas.width * gl.canvas.height);
      gl.readPixels(0, 0, gl.canvas.width, gl.canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
      return { scene, matrix: [...camera(angle)], background, bytes: [...bytes] };
    }, angle);
    const channel = (i) => shown.bytes[4 * Math.floor(i / 3) + (i % 3)] / 255;
    const image = Float32Array.from({ length: 3 * width * height }, (_, i) => channel(i));
    const truth = sorted(shown, width, height, "sorted");
    const unsorted = sorted(shown, width, height, "as drawn").image;
    // Pixels that no edge goes through: of up to three fragments, and of more.
    const of = (source, kept) => {
      const indices = [...truth.counts.keys()].filter((p) => truth.clear[p] && kept(truth.counts[p]));
      assert.ok(indices.length > 1000, `${indices.length} pixels`);
      return Float32Array.from(indices.flatMap((p) => [source[3 * p], source[3 * p + 1], source[3 * p + 2]]));
    };
    const few = (n) => n <= 3;
    const many = (n) => n > 3;
    const exact = compare(of(image, few), of(truth.image, few), 1.5 / 255);
    const near = compare(of(image, many), of(truth.image, many), 8 / 255);
    const control = compare(of(unsorted, many), of(truth.image, many), 8 / 255);
    const [mse, unsortedMse] = [near.mse, control.mse].map((e) => e.toExponential(2));
    console.log(`${angle}: up to three, worst ${exact.worst.toFixed(4)}; more, MSE ${mse}, unsorted ${unsortedMse}`);
    assert.equal(exact.share, 1, `worst ${exact.worst}`);
    assert.ok(near.mse < control.mse / 20, `${near.mse} against ${control.mse} unsorted`);
  }
  assert.deepEqual(page.errors, []);
  await page.screenshot({ path: path.join(ROOT, "target", "web-tests", "webgl2.png") });
});
