// The live page in Chromium: methods against the program's own answers, invariants, fallbacks, files, layout.

import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { after, before, test } from "node:test";
import { readNpz } from "../scene/npz.js";
import { ROOT, SCRATCH, compare, floats, launch, nmt, open, serve } from "./browser.mjs";

let server;
let browser;
before(async () => {
  server = await serve(ROOT);
  browser = await launch();
});
after(async () => {
  await browser?.close();
  server?.close();
});

/** The background that every comparison is made before. */
const GREY = 0.5;

/** Opens the page and stops its own frames. */
async function visit(query, viewport) {
  const page = await open(browser, `${server.url}/web/?${query}`, viewport);
  await page.evaluate(() => window.nmt.ready);
  await page.evaluate(() => window.nmt.stop());
  return page;
}

/** Draws a method and answers its image and measurements. */
async function draw(page, overrides) {
  const found = await page.evaluate(async (options) => {
    const measured = await nmt.measure(options);
    const image = await nmt.image();
    const bytes = new Uint8Array(image.buffer);
    let text = "";
    for (let i = 0; i < bytes.length; i += 8192) text += String.fromCharCode(...bytes.subarray(i, i + 8192));
    return { measured, image: btoa(text), errors: nmt.renderer.errors };
  }, overrides);
  assert.deepEqual(found.errors, [], "errors of the renderer");
  assert.deepEqual(page.errors, [], "errors on the console");
  return { ...found.measured, image: floats(found.image) };
}

/** Saves the fragments of a page's view and answers the file's name and its arrays. */
async function fragments(page, name) {
  const base64 = await page.evaluate(async () => {
    const { bytes } = await nmt.fragmentsFile();
    let text = "";
    for (let i = 0; i < bytes.length; i += 8192) text += String.fromCharCode(...bytes.subarray(i, i + 8192));
    return btoa(text);
  });
  const file = path.join(SCRATCH, `${name}.npz`);
  const bytes = Buffer.from(base64, "base64");
  fs.writeFileSync(file, bytes);
  const arrays = await readNpz(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  return { file, arrays };
}

/**
 * What `nmt evaluate` makes of a list: its images as numbers by method, the exact one as "truth", and their errors.
 */
function evaluated(file, methods, models) {
  const out = path.join(SCRATCH, "evaluate");
  const paths = models.map((m) => path.join(ROOT, "models", `${m}.json`));
  const what = ["--fragments", file, "--methods", methods.join(","), "--model", ...paths];
  const how = ["--background", GREY, GREY, GREY, "--float-images", "--out", out, "--force", "--quiet"];
  nmt("evaluate", ...what, ...how);
  const { results } = JSON.parse(fs.readFileSync(path.join(out, "results.json"), "utf8"));
  const folder = path.join(out, path.basename(file, ".npz"));
  const images = { truth: npy(path.join(folder, "truth.npy")) };
  for (const { method, picture } of results) images[method] = npy(path.join(folder, `${picture}.npy`));
  return { images, errors: Object.fromEntries(results.map((r) => [r.method, r.image_mse])) };
}

/** The numbers of an .npy file of f32. */
function npy(file) {
  const bytes = fs.readFileSync(file);
  const start = 10 + bytes.readUInt16LE(8);
  assert.match(bytes.toString("latin1", 10, start), /'descr': '<f4', 'fortran_order': False/);
  return new Float32Array(bytes.buffer.slice(bytes.byteOffset + start, bytes.byteOffset + bytes.length));
}

const NETWORKS = ["small", "recommended", "ends"];
const CORES = ["core-small", "core", "core-large"];
const TOLERANCE = 2e-3;
const SHARE = 0.999;

// Scenes of triangles, strands and splats, one before something opaque; both ways to draw.
for (const [scene, api, detail] of [
  ["glass", "", 1],
  ["splats", "", 0.1],
  ["foliage", "", 0.3],
  ["hair", "", 0.2],
  ["spheres", "no=webgpu&", 1],
]) {
  test(`${scene} ${api}: networks answer as nmt does on the same fragments`, async () => {
    const page = await visit(`${api}scene=${scene}&size=80x72&plain&transparentonly&detail=${detail}`);
    const { file, arrays } = await fragments(page, scene);
    assert.ok(arrays.view_z.data.length > 2000, `${arrays.view_z.data.length} fragments`);
    // WebGL 2 has no atomics.
    const networks = api ? NETWORKS : [...NETWORKS, ...CORES];
    const { images, errors } = evaluated(file, ["weighted-blended", "abuffer"], networks);
    const exact = await draw(page, { method: "exact" });
    for (const name of networks) {
      const found = await draw(page, { method: name });
      const { share, worst } = compare(found.image, images[`neural:${name}`], TOLERANCE);
      console.log(
        `${scene} ${name}: ${(100 * share).toFixed(2)} % within ${TOLERANCE}, worst ${worst.toExponential(1)}, ` +
          `MSE ${found.mse.toExponential(2)} against ${errors[`neural:${name}`].toExponential(2)}`,
      );
      assert.ok(share >= SHARE, `${name}: ${share} within ${TOLERANCE}`);
      // The page measures what nmt evaluate does: to 2 %, and to 1e-8, what images that are 1e-4 apart may differ by.
      // Peeling takes one of two fragments at one depth: one pixel of four thousand is another.
      const expected = errors[`neural:${name}`];
      const apart = api ? 1e-6 : 1e-8;
      assert.ok(Math.abs(found.mse - expected) <= 0.02 * expected + apart, `${found.mse} against ${expected}`);
      // Control: the other network's image is another.
      const other = images[`neural:${name === "small" ? "recommended" : "small"}`];
      assert.ok(compare(found.image, other, TOLERANCE).share < SHARE, "the control passed");
    }
    const blended = await draw(page, { method: "weighted-blended" });
    const expected = errors["weighted-blended:mb13-9"];
    assert.ok(Math.abs(blended.mse / expected - 1) < 0.02, `weighted blended: ${blended.mse} against ${expected}`);
    const truth = compare(exact.image, images.truth, 2e-4);
    // Peeling takes one of two fragments at one depth.
    assert.ok(truth.share >= (api ? SHARE : 1), `exact: ${truth.share} within 2e-4, worst ${truth.worst}`);
    await page.close();
  });
}

test("every method draws every scene without an error", async () => {
  const page = await visit("size=48x40&detail=0.08");
  const { scenes, methods } = await page.evaluate(() => ({ scenes: nmt.scenes, methods: nmt.methods }));
  assert.ok(scenes.length >= 7 && methods.length >= 7);
  for (const scene of scenes) {
    await page.evaluate((name) => nmt.choose("scene", name), scene);
    for (const method of methods) {
      const found = await draw(page, { method });
      assert.ok(found.covered > 50, `${scene}: ${found.covered} pixels covered`);
      assert.ok(found.image.every(Number.isFinite), `${scene}, ${method}: a number that is none`);
      assert.ok(!found.overflow, `${scene}: lists overflow`);
      assert.ok(
        method === "exact" ? found.mse === 0 : found.mse > 0 && found.mse < 0.05,
        `${scene}, ${method}: MSE ${found.mse}`,
      );
    }
  }
  await page.close();
});

/** An .npz of single pixels with these fragments [v, alpha, r, g, b], as base64. */
async function listFile(page, name, pixels) {
  await page.evaluate(
    async ([file, content]) => {
      const { writeNpz } = await import("./scene/npz.js");
      const all = content.flat();
      const offsets = Uint32Array.from([0, ...content.map((_, i) => content.slice(0, i + 1).flat().length)]);
      const column = (i) => Float32Array.from(all, (f) => f[i]);
      const bytes = writeNpz({
        offsets: { data: offsets, shape: [offsets.length] },
        view_z: { data: column(0), shape: [all.length] },
        alpha: { data: column(1), shape: [all.length] },
        color: { data: Float32Array.from(all.flatMap((f) => f.slice(2))), shape: [all.length, 3] },
        width: { data: new Uint32Array([content.length]), shape: [] },
        height: { data: new Uint32Array([1]), shape: [] },
      });
      await nmt.openFiles([new File([bytes], file)]);
    },
    [name, pixels],
  );
}

for (const api of ["", "no=webgpu&"]) {
  test(`invariants ${api}: a single layer is the over operator, one colour stays one colour`, async () => {
    const page = await visit(`${api}scene=spheres&size=64x56&plain&transparentonly`);
    const names = await page.evaluate(() => nmt.methods);
    const supported = await page.evaluate(() => nmt.methods.filter((m) => !nmt.renderer.support(m).reason));
    assert.ok(supported.length >= names.length - CORES.length - 1 && supported.length >= 7, `${supported}`);
    const several = await draw(page, { method: "exact" });
    const one = await draw(page, { method: "exact", oneColor: true });
    for (const method of supported) {
      const found = await draw(page, { method, oneColor: true });
      const { share, worst } = compare(found.image, one.image, TOLERANCE);
      // Sixteen-bit coefficients round the total itself.
      assert.ok(method === "wavelet" ? worst < 1e-2 : share === 1, `${method} in one colour: ${share}, worst ${worst}`);
    }
    // Control: with several colours the order matters.
    const blended = await draw(page, { method: "weighted-blended" });
    assert.ok(compare(blended.image, several.image, TOLERANCE).share < 0.95, "the control passed");

    const single = Array.from({ length: 64 }, (_, i) =>
      i % 5 ? [[1 + i * 0.37, (i + 0.5) / 64, 0.9, 0.2 + i / 100, 0.1]] : [],
    );
    await listFile(page, "single.npz", single);
    const over = Float32Array.from(
      single.flatMap((pixel) =>
        [0, 1, 2].map((c) => {
          const [, a, ...rgb] = pixel[0] ?? [1, 0, 0, 0, 0];
          return a * rgb[c] + (1 - a) * GREY;
        }),
      ),
    );
    const drawn = supported.filter((m) => m !== "sorted");
    for (const method of drawn) {
      const found = await draw(page, { method });
      const { share, worst } = compare(found.image, over, TOLERANCE);
      assert.ok(method === "wavelet" ? worst < 1e-2 : share === 1, `${method}, one layer: ${share}, worst ${worst}`);
    }
    // Control: a second layer of another colour.
    const exactOver = await draw(page, { method: "exact" });
    await listFile(
      page,
      "double.npz",
      single.map((pixel) => [...pixel, [90, 0.6, 0.1, 0.1, 0.9]]),
    );
    const found = await draw(page, { method: "exact" });
    assert.ok(compare(found.image, exactOver.image, TOLERANCE).share < 0.5, "the control passed");
    await page.close();
  });
}

test("cores answer pixels of few fragments exactly, and say where they cannot", async () => {
  const page = await visit("scene=spheres&size=64x56&plain&transparentonly");
  // Depths from 1 to 30, opacities from 0.05 to 0.9, colours that tell fragments apart.
  const pixel = (n, k) =>
    Array.from({ length: n }, (_, i) => {
      const at = (x) => (Math.sin(12.9898 * (k * 31 + i * 7 + x)) * 43758.5453) % 1;
      const share = (x) => Math.abs(at(x));
      return [1 + 29 * share(1), 0.05 + 0.85 * share(2), share(3), share(4), share(5)];
    });
  const draws = async (most) => {
    await listFile(
      page,
      `${most}.npz`,
      Array.from({ length: 60 }, (_, k) => pixel(1 + ((k * 7) % most), k)),
    );
    const exact = await draw(page, { method: "exact" });
    const shares = {};
    for (const method of CORES) shares[method] = compare((await draw(page, { method })).image, exact.image, TOLERANCE);
    return shares;
  };
  // Both ends, 2, 4 and 6 heavy ones, and one in the tail, of which the sums say all.
  for (const [method, most] of CORES.map((name, i) => [name, 5 + 2 * i])) {
    const few = (await draws(most))[method];
    assert.ok(few.share === 1, `${method}, up to ${most}: ${few.share}, worst ${few.worst}`);
  }
  // Control: of forty fragments the tail is a guess.
  const many = await draws(40);
  assert.ok(CORES.every((name) => many[name].share < 0.95), "the control passed");
  const webgl = await visit("scene=spheres&size=64x56&no=webgpu");
  assert.match(await webgl.evaluate(() => nmt.renderer.support("core").reason), /atomics/);
  const half = await visit("scene=spheres&size=64x56&no=float32-blendable");
  assert.match(await half.evaluate(() => nmt.renderer.support("core").reason), /blend/);
  await Promise.all([page, webgl, half].map((p) => p.close()));
});

test("opaque surfaces hide what lies behind them, for every method alike", async () => {
  const page = await visit("scene=hair&size=64x56&detail=0.1");
  const alone = await draw(page, { method: "exact", transparentOnly: true, backdrop: [GREY, GREY, GREY] });
  const hidden = await draw(page, { method: "exact", backdrop: [GREY, GREY, GREY] });
  assert.ok(hidden.fragments < 0.9 * alone.fragments, `${hidden.fragments} of ${alone.fragments}`);
  for (const method of ["recommended", "moment-power-4", "wavelet", "core"]) {
    const found = await draw(page, { method, backdrop: [GREY, GREY, GREY] });
    assert.ok(found.mse < 2e-4, `${method}: ${found.mse}`);
  }
  // Control: the image without them is another.
  assert.ok(compare(alone.image, hidden.image, TOLERANCE).share < 0.95);
  await page.close();
});

test("lists that do not fit at once are made in bands, and the image is the same", async () => {
  const query = "scene=spheres&size=64x56&plain";
  const [whole, banded] = [await visit(query), await visit(`${query}&nodes=6000`)];
  const [a, b] = [await draw(whole, { method: "exact" }), await draw(banded, { method: "exact" })];
  assert.ok(a.bands === 1 && b.bands > 1 && !b.overflow, `${a.bands} and ${b.bands} bands`);
  assert.equal(compare(a.image, b.image, 1e-6).share, 1);
  // Control: where even a row does not fit, the page says so.
  const little = await visit(`${query}&nodes=20`);
  const c = await draw(little, { method: "exact" });
  assert.ok(c.overflow && compare(a.image, c.image, 0.1).share < 1, "overflow");
  await Promise.all([whole, banded, little].map((p) => p.close()));
});

test("fallbacks: each is taken, says why, and its image is right", async () => {
  const query = "scene=spheres&size=64x56&plain&transparentonly";
  const full = await visit(query);
  const reference = await draw(full, { method: "recommended" });
  await full.close();
  const cases = [
    { no: "float32-blendable", api: "WebGPU", says: /float32-blendable/, without: ["moment-power-4"], tolerance: 2e-2 },
    { no: "timestamp-query", api: "WebGPU", says: /timestamp-query/, without: [], tolerance: 1e-6, untimed: true },
    {
      no: "fragment-atomics",
      api: "WebGL 2",
      says: /storage buffers in fragment shaders/,
      without: [],
      tolerance: TOLERANCE,
    },
    { no: "webgpu", api: "WebGL 2", says: /WebGPU is switched off/, without: [], tolerance: TOLERANCE },
    {
      no: "webgpu,OES_draw_buffers_indexed",
      api: "WebGL 2",
      says: /blend equation/,
      without: [],
      tolerance: TOLERANCE,
    },
    {
      no: "webgpu,EXT_float_blend",
      api: "WebGL 2",
      says: /EXT_float_blend/,
      without: ["moment-power-4"],
      tolerance: 2e-2,
    },
  ];
  for (const { no, api, says, without, tolerance, untimed } of cases) {
    const page = await visit(`${query}&no=${no}`);
    const shown = await page.evaluate(() => ({
      api: nmt.renderer.api,
      notes: document.getElementById("notes").textContent,
      reasons: Object.fromEntries(nmt.methods.map((m) => [m, nmt.renderer.support(m).reason ?? ""])),
    }));
    assert.equal(shown.api, api, no);
    assert.match(shown.notes, says);
    for (const method of without) assert.match(shown.reasons[method], /blend/, `${no}: ${method}`);
    const found = await draw(page, { method: "recommended" });
    const { share, worst } = compare(found.image, reference.image, tolerance);
    assert.ok(share >= SHARE, `${no}: ${share} within ${tolerance}, worst ${worst}`);
    if (untimed) assert.ok(found.seconds == null, "no time without timestamps");
    await page.close();
  }
  const none = await open(browser, `${server.url}/web/?no=webgpu,webgl2`);
  await none.waitForFunction(() => !document.getElementById("message").hidden);
  assert.match(await none.textContent("#message"), /neither WebGPU nor WebGL 2/);
  await none.close();
});

/** A glTF binary of a square of two triangles, indices u16; `material` is its material. */
function glb(material) {
  const positions = new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]);
  const indices = new Uint16Array([0, 1, 2, 0, 2, 3]);
  const binary = Buffer.concat([Buffer.from(positions.buffer), Buffer.from(indices.buffer)]);
  const json = JSON.stringify({
    asset: { version: "2.0" },
    scene: 0,
    scenes: [{ nodes: [0, 1] }],
    nodes: [{ mesh: 0 }, { mesh: 0, translation: [0.4, 0.2, -1], scale: [1, 1, 1] }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1, material: 0 }] }],
    materials: [material],
    buffers: [{ byteLength: binary.length }],
    bufferViews: [
      { buffer: 0, byteLength: 48 },
      { buffer: 0, byteOffset: 48, byteLength: 12 },
    ],
    accessors: [
      { bufferView: 0, componentType: 5126, count: 4, type: "VEC3" },
      { bufferView: 1, componentType: 5123, count: 6, type: "SCALAR" },
    ],
  });
  const text = Buffer.from(json.padEnd(Math.ceil(json.length / 4) * 4));
  const chunk = (kind, data) => {
    const head = Buffer.alloc(8);
    head.writeUInt32LE(data.length, 0);
    head.writeUInt32LE(kind, 4);
    return Buffer.concat([head, data]);
  };
  const body = Buffer.concat([chunk(0x4e4f534a, text), chunk(0x004e4942, binary)]);
  const head = Buffer.alloc(12);
  [0x46546c67, 2, 12 + body.length].forEach((word, i) => head.writeUInt32LE(word, 4 * i));
  return Buffer.concat([head, body]);
}

test("files: glTF, .splat and .npz are shown, what is wrong is said", async () => {
  const page = await visit("scene=spheres&size=64x56&plain");
  const drop = (name, bytes) =>
    page.evaluate(
      async ([file, base64]) => {
        const data = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
        await nmt.openFiles([new File([data], file)]);
        const message = document.getElementById("message");
        return {
          title: nmt.state.scene,
          notes: document.getElementById("notes").textContent,
          message: message.hidden ? "" : message.textContent,
        };
      },
      [name, Buffer.from(bytes).toString("base64")],
    );

  const clear = await drop(
    "square.glb",
    glb({ alphaMode: "BLEND", pbrMetallicRoughness: { baseColorFactor: [1, 0, 0, 0.5] } }),
  );
  assert.equal(clear.message, "");
  let found = await draw(page, { method: "recommended" });
  assert.ok(found.covered > 200 && found.most === 2, `${found.covered} pixels, ${found.most} layers`);
  const solid = await drop("solid.glb", glb({ pbrMetallicRoughness: { baseColorTexture: { index: 0 } } }));
  assert.match(solid.notes, /Nothing in this file is transparent/);
  assert.match(solid.notes, /textures/);

  const splats = Buffer.alloc(32 * 200);
  for (let i = 0; i < 200; i++) {
    [Math.sin(i), Math.cos(3 * i), Math.sin(7 * i), 0.2, 0.1, 0.05].forEach((x, k) =>
      splats.writeFloatLE(x, 32 * i + 4 * k),
    );
    [200, 40 + i, 90, 180, 255, 128, 128, 128].forEach((x, k) => splats.writeUInt8(x, 32 * i + 24 + k));
  }
  assert.equal((await drop("cloud.splat", splats)).message, "");
  found = await draw(page, { method: "recommended" });
  assert.ok(found.covered > 200 && found.most > 3, `${found.covered} pixels, ${found.most} layers`);

  // What the page saves it shows again.
  const { arrays } = await fragments(page, "cloud");
  const before = await draw(page, { method: "exact", transparentOnly: true });
  assert.equal((await drop("cloud.npz", fs.readFileSync(path.join(SCRATCH, "cloud.npz")))).message, "");
  found = await draw(page, { method: "exact" });
  assert.equal(found.fragments, arrays.view_z.data.length);
  assert.equal(compare(found.image, before.image, 1e-4).share, 1);
  // A list that NumPy has deflated.
  assert.equal((await drop("teapots.npz", fs.readFileSync(path.join(ROOT, "web", "test", "list.npz")))).message, "");
  found = await draw(page, { method: "recommended" });
  assert.ok(found.fragments > 100, `${found.fragments} fragments`);

  for (const [name, bytes, says] of [
    ["cut.splat", splats.subarray(0, 100), /32 for every splat/],
    ["cut.glb", glb({}).subarray(0, 30), /JSON/],
    ["not.npz", Buffer.from("no zip file at all, but long enough to hold a directory"), /no zip/],
    ["picture.png", Buffer.from([1, 2, 3]), /not a .glb/],
  ]) {
    assert.match((await drop(name, bytes)).message, says, name);
  }
  // Each of the four was told on the console, and nothing else was.
  assert.equal(page.errors.length, 4, page.errors.join("\n"));
  await page.close();
});

test("the page as it is used: views, rows, keys, measuring, desktop and phone", async () => {
  for (const [name, viewport] of [
    ["desktop", { width: 1200, height: 760 }],
    ["phone", { width: 390, height: 844 }],
  ]) {
    const page = await open(browser, `${server.url}/web/?scene=spheres&detail=0.3`, viewport);
    await page.evaluate(() => window.nmt.ready);
    await page.waitForFunction(() => /layers|error/.test(document.getElementById("facts").textContent), null, {
      timeout: 60000,
    });
    for (const view of ["image", "error", "count", "split"]) {
      await page.click(`#modes [data-name="${view}"]`);
      assert.equal(await page.evaluate(() => nmt.state.mode), view);
    }
    await page.click('#methods [data-name="weighted-blended"]');
    await page.waitForFunction(
      () => /·|0\.0/.test(document.querySelector('#methods [data-name="weighted-blended"]').textContent),
      null,
      { timeout: 60000 },
    );
    await page.keyboard.press("ArrowDown");
    assert.equal(await page.evaluate(() => nmt.state.method), "moment-power-4");
    await page.click('#methods [data-name="recommended"]');
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
    assert.ok(wide <= 0, `${name}: ${wide} pixels too wide`);
    const yaw = await page.evaluate(() => nmt.state.camera.yaw);
    const box = await page.locator("#canvas").boundingBox();
    await page.mouse.move(box.x + box.width * 0.25, box.y + box.height * 0.6);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width * 0.35, box.y + box.height * 0.6, { steps: 3 });
    await page.mouse.up();
    assert.ok((await page.evaluate(() => nmt.state.camera.yaw)) !== yaw, "dragging turns the camera");
    await page.evaluate(() => nmt.stop());
    assert.deepEqual(page.errors, []);
    await page.screenshot({ path: path.join(SCRATCH, `${name}.png`) });
    await page.close();
  }
});

test("from a folder without a server the page says what to do", async () => {
  const page = await browser.newPage();
  await page.goto(`file://${path.join(ROOT, "web", "index.html")}`);
  assert.match(await page.textContent("#message"), /python3 -m http.server/);
  await page.close();
});

test("control: a comparison of nothing, and of what is no number, fails", () => {
  assert.throws(() => compare(new Float32Array(0), new Float32Array(0), 1));
  assert.throws(() => compare(new Float32Array(3), new Float32Array(6), 1));
  assert.equal(compare(new Float32Array([NaN, 0, 0]), new Float32Array(3), 1).share, 0);
});
