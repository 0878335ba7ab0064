// The npm package: packed, installed in a fresh folder, and drawn by three.js beside its own OITPassNode.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { after, before, test } from "node:test";
import { ROOT, SCRATCH, launch, open, serve } from "./browser.mjs";

const WEB = path.join(ROOT, "web");
const FRESH = path.join(SCRATCH, "fresh");
let server;
let browser;

before(async () => {
  fs.rmSync(FRESH, { recursive: true, force: true });
  fs.mkdirSync(FRESH, { recursive: true });
  const npm = (cwd, ...args) =>
    execFileSync("npm", [...args, "--no-audit", "--no-fund", "--loglevel=error"], { cwd, encoding: "utf8" });
  const [packed] = JSON.parse(npm(path.join(WEB, "npm"), "pack", "--json", "--pack-destination", FRESH));
  const names = packed.files.map((f) => f.path);
  for (const name of [
    "index.js",
    "index.d.ts",
    "networks.js",
    "README.md",
    "shaders/recommended/recommended.wgsl",
    "example/index.html",
  ]) {
    assert.ok(names.includes(name), `${name} is missing from the package: ${names}`);
  }
  fs.writeFileSync(path.join(FRESH, "package.json"), '{ "private": true, "type": "module" }');
  npm(FRESH, "install", "--prefer-offline", path.join(FRESH, packed.filename), path.join(WEB, "node_modules", "three"));
  for (const name of ["index.html", "peel.js"])
    fs.copyFileSync(path.join(WEB, "test", "three", name), path.join(FRESH, name));
  server = await serve(FRESH);
  browser = await launch();
});
after(async () => {
  await browser?.close();
  server?.close();
});

async function visit() {
  const page = await open(browser, `${server.url}/`);
  await page.waitForFunction(() => window.loaded);
  return page;
}

/** Mean squared difference of the first three of four channels; anything that is no number fails. */
const MSE = `(a, b) => {
  if (a.length === 0 || a.length !== b.length) throw new Error("images of one size, please");
  let sum = 0;
  for (let i = 0; i < a.length; i++) {
    if (i % 4 === 3) continue;
    const d = a[i] - b[i];
    if (!Number.isFinite(d)) throw new Error("a number that is none");
    sum += (d * d) / (0.75 * a.length);
  }
  return sum;
}`;

// The second scene has more layers than have closed forms, so that the networks answer.
for (const [title, dense, layers, factor] of [
  ["three.js's own scene", false, 5, 100],
  ["thirty balls", true, 12, 10],
]) {
  test(`${title}: nearer to peeled layers than OITPassNode, by far`, async () => {
    const page = await visit();
    const found = await page.evaluate(
      async ([mseText, dense]) => {
        const mse = eval(mseText);
        const [width, height] = [200, 150];
        const renderer = await open(width, height);
        const { scene } = dense ? makeDenseScene() : makeScene();
        const camera = makeCamera(width / height);
        const images = {};
        for (const [name, node] of Object.entries({
          sorted: pass(scene, camera),
          oit: oitPass(scene, camera),
          small: nmtPass(scene, camera, { network: "small" }),
          recommended: nmtPass(scene, camera),
          "moments-6": nmtPass(scene, camera, { network: "moments-6" }),
          ends: nmtPass(scene, camera, { network: "ends" }),
          "core-small": nmtPass(scene, camera, { network: "core-small" }),
          core: nmtPass(scene, camera, { network: "core" }),
          "core-large": nmtPass(scene, camera, { network: "core-large" }),
        }))
          images[name] = await frame(renderer, node, width, height, 2);
        const reference = await peel(renderer, scene, camera, width, height, 64);
        const canvas = document.createElement("canvas");
        Object.assign(canvas, { width: 2 * width, height: 2 * height });
        const context = canvas.getContext("2d");
        [reference.image, images.oit, images.recommended, images.sorted].forEach((image, k) => {
          const bytes = Uint8ClampedArray.from(image, (x, i) => 255 * (i % 4 === 3 ? 1 : Math.max(0, x) ** (1 / 2.2)));
          context.putImageData(new ImageData(bytes, width, height), (k % 2) * width, Math.floor(k / 2) * height);
        });
        return {
          why: whyUnsupported(renderer),
          layers: reference.layers,
          errors: Object.fromEntries(
            Object.entries(images).map(([name, image]) => [name, mse(image, reference.image)]),
          ),
          picture: canvas.toDataURL("image/png").split(",")[1],
        };
      },
      [MSE, dense],
    );
    fs.writeFileSync(path.join(SCRATCH, `three-${dense ? "dense" : "own"}.png`), Buffer.from(found.picture, "base64"));
    const { errors } = found;
    console.log(
      `${title}, ${found.layers} layers, image MSE against peeled layers: ` +
        Object.entries(errors)
          .map(([name, e]) => `${name} ${e.toExponential(2)}`)
          .join(", "),
    );
    assert.equal(found.why, null);
    assert.deepEqual(page.errors, []);
    assert.ok(found.layers >= layers, `${found.layers} layers`);
    // The README's row has these numbers.
    const readme = fs.readFileSync(path.join(WEB, "npm", "README.md"), "utf8");
    const row = readme.split("\n").find((line) => line.startsWith(`| ${dense ? "thirty balls" : "its own example"}`));
    const printed = row.split("|").slice(2, -1).map(Number);
    assert.equal(printed.length, Object.keys(errors).length);
    Object.keys(errors).forEach((name, i) => {
      const ratio = errors[name] / printed[i];
      assert.ok(ratio > 0.5 && ratio < 2, `${name}: ${errors[name]}, the README says ${printed[i]}`);
    });
    for (const name of Object.keys(errors).slice(2)) {
      assert.ok(errors[name] < errors.oit / factor && errors[name] < errors.sorted / 2, JSON.stringify(errors));
    }
    await page.close();
  });
}

test("six moments: pass 1 is one draw where the device writes 40 bytes a pixel, else two, the same bits", async () => {
  const page = await visit();
  const found = await page.evaluate(async (mseText) => {
    const mse = eval(mseText);
    const camera = makeCamera(64 / 48);
    const draw = async (network, requiredLimits) => {
      const renderer = await open(64, 48, { requiredLimits });
      renderer.info.autoReset = false;
      const image = await frame(renderer, nmtPass(makeDenseScene().scene, camera, { network }), 64, 48);
      return { image, calls: renderer.info.render.drawCalls };
    };
    const once = await draw("moments-6", { maxColorAttachmentBytesPerSample: 40 });
    const [twice, four] = [await draw("moments-6"), await draw("recommended")];
    const calls = [once, twice, four].map((drawn) => drawn.calls);
    return { calls, six: mse(once.image, twice.image), four: mse(once.image, four.image) };
  }, MSE);
  assert.deepEqual(page.errors, []);
  // Thirty balls, both sides: 60 calls a draw of transparent objects, and the last that fills the screen.
  assert.deepEqual(found.calls, [121, 181, 121]);
  // Control: four moments give another image.
  assert.ok(found.six === 0 && found.four > 1e-8, JSON.stringify(found));
  await page.close();
});

const drawsRightly = async (network) => {
  const page = await visit();
  const found = await page.evaluate(async ([mseText, network]) => {
    const mse = eval(mseText);
    const made = (scene, options) => nmtPass(scene, camera, { network, ...options });
    const renderer = await open(64, 48, { alpha: true });
    const camera = makeCamera(64 / 48);
    const layer = (z, color, opacity) => {
      const material = new THREE.MeshBasicMaterial({ color, opacity, transparent: true });
      const mesh = new THREE.Mesh(new THREE.PlaneGeometry(60, 60), material);
      mesh.quaternion.copy(camera.quaternion);
      mesh.position.copy(new THREE.Vector3(0, 0, z).applyMatrix4(camera.matrixWorld));
      return mesh;
    };
    const draw = async (objects, background, width = 64, height = 48) => {
      const scene = new THREE.Scene();
      scene.background = background === null ? null : new THREE.Color().setRGB(...background);
      scene.add(...objects);
      if (background === null) renderer.setClearColor(0x000000, 0);
      const node = made(scene);
      const image = await frame(renderer, node, width, height);
      node.dispose();
      return image;
    };
    const red = [1, 0, 0];
    const out = {};
    out.single = Array.from(await draw([layer(-5, 0xff0000, 0.3)], [0, 0, 1])).slice(0, 4);
    const rgb = [-4, -6, -8, -9, -12, -15].map((z, i) => layer(z, 0xff0000, 0.15 + 0.1 * i));
    out.oneColor = Array.from(await draw(rgb, [0, 0, 1])).slice(0, 4);
    // Control: six layers of two colours are not that colour.
    out.twoColors = Array.from(await draw([...rgb.slice(0, 3), layer(-5, 0x00ff00, 0.5)], [0, 0, 1])).slice(0, 4);
    const wall = new THREE.Mesh(new THREE.PlaneGeometry(60, 60), new THREE.MeshBasicMaterial({ color: 0xffffff }));
    wall.quaternion.copy(camera.quaternion);
    wall.position.copy(new THREE.Vector3(0, 0, -7).applyMatrix4(camera.matrixWorld));
    out.hidden = Array.from(await draw([wall, layer(-5, 0xff0000, 0.3), layer(-10, 0x00ff00, 0.9)], [0, 0, 1])).slice(
      0,
      4,
    );
    out.clear = Array.from(await draw([layer(-5, 0xff0000, 0.3)], null)).slice(0, 4);
    // A pass that is resized draws what one of that size draws.
    const { scene } = makeScene();
    const node = made(scene);
    await frame(renderer, node, 40, 30);
    const resized = await frame(renderer, node, 64, 48);
    out.resized = mse(resized, await frame(renderer, made(scene), 64, 48));
    out.size = [resized.length];
    // What moves changes the range of depth for what stands still too.
    const balls = makeDenseScene().scene;
    const moved = made(balls);
    await frame(renderer, moved, 64, 48);
    balls.children.at(-1).position.set(-20, -10, -25);
    const later = await frame(renderer, moved, 64, 48);
    out.moved = mse(later, await frame(renderer, made(balls), 64, 48));
    out.shift = mse(later, await frame(renderer, made(balls, { range: [1, 20] }), 64, 48));
    // Disposal gives back what was made.
    const held = () => renderer.info.memory.textures + renderer.info.memory.storageAttributes;
    const before = held();
    for (let i = 0; i < 5; i++) {
      const again = made(scene);
      await frame(renderer, again, 64, 48);
      out.held = held() - before;
      again.dispose();
    }
    out.left = held() - before;
    let message = "";
    try {
      nmtPass(scene, camera, { network: "none" });
    } catch (error) {
      message = error.message;
    }
    out.unknown = message;
    const webgl = await open(16, 16, { forceWebGL: true });
    out.webgl = whyUnsupported(webgl);
    return { ...out, red };
  }, [MSE, network]);
  assert.deepEqual(page.errors, []);
  const near = (a, b, what) => b.forEach((x, i) => assert.ok(Math.abs(a[i] - x) < 2e-3, `${what}: ${a} is not ${b}`));
  near(found.single, [0.3, 0, 0.7, 1], "one layer");
  const behind = [0.15, 0.25, 0.35, 0.45, 0.55, 0.65].reduce((t, a) => t * (1 - a), 1);
  near(found.oneColor, [1 - behind, 0, behind, 1], "one colour");
  assert.throws(() => near(found.twoColors, [1 - 0.85 * 0.75 * 0.65 * 0.5, 0, 0.85 * 0.75 * 0.65 * 0.5, 1], "control"));
  near(found.hidden, [1, 0.7, 0.7, 1], "before a wall");
  near(found.clear, [0.3, 0, 0, 0.3], "before nothing, premultiplied");
  assert.ok(found.resized < 1e-9 && found.size[0] === 4 * 64 * 48, `resized: ${found.resized}`);
  // Control: another range gives another image.
  assert.ok(found.moved === 0 && found.shift > 1e-8, `moved: ${found.moved}, another range: ${found.shift}`);
  assert.ok(found.held > 0 && found.left < found.held, `${found.left} of ${found.held} textures and buffers are left`);
  assert.match(found.unknown, /no network "none"/);
  assert.match(found.webgl, /needs WebGPU/);
  await page.close();
};
for (const network of ["recommended", "moments-6", "ends", "core"]) {
  test(`${network}: one layer, one colour, opaque depth, resizing, a transparent background, disposal`, () =>
    drawsRightly(network));
}

test("core: what is rejected or discarded is not in it, whatever the depth buffer", async () => {
  const page = await visit();
  const found = await page.evaluate(async (mseText) => {
    const mse = eval(mseText);
    const out = {};
    const images = {};
    for (const [name, parameters, options] of [
      ["plain", {}, {}],
      ["reversed", { reversedDepthBuffer: true }, {}],
      ["logarithmic", { logarithmicDepthBuffer: true }, {}],
      ["stencil", {}, { stencilBuffer: true }],
    ]) {
      const renderer = await open(64, 48, parameters);
      const camera = makeCamera(64 / 48);
      const layer = (z, color, more) => {
        const material = new THREE.MeshBasicMaterial({ color, transparent: true, ...more });
        const mesh = new THREE.Mesh(new THREE.PlaneGeometry(60, 60), material);
        mesh.quaternion.copy(camera.quaternion);
        mesh.position.copy(new THREE.Vector3(0, 0, z).applyMatrix4(camera.matrixWorld));
        return mesh;
      };
      const wall = layer(-20, 0xffffff, { transparent: false });
      const hidden = [-21, -22, -23, -24, -25, -26, -27].map((z) => layer(z, 0x00ff00, { opacity: 0.9 }));
      const discarded = layer(-5, 0x0000ff, { opacity: 0.3, alphaTest: 0.5 });
      const draw = (network, { scene }, ...objects) => {
        scene.add(...objects);
        return frame(renderer, nmtPass(scene, camera, { ...options, network, range: [1, 60] }), 64, 48);
      };
      const seen = await draw("core", makeDenseScene(), wall);
      const behind = await draw("core", makeDenseScene(), wall, ...hidden, discarded);
      const without = await draw("core", makeDenseScene(), ...hidden);
      // In the plane of the wall, drawn by an offset; behind it, drawn by no test at all.
      const decal = { opacity: 0.3, polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -4 };
      const few = [layer(-5, 0x0000ff, { opacity: 0.5 }), layer(-20, 0xff0000, decal)];
      const through = layer(-30, 0x00ff00, { opacity: 0.5, depthTest: false });
      const empty = () => ({ scene: new THREE.Scene() });
      images[name] = seen;
      out[name] = {
        buffers: mse(seen, images.plain),
        networks: mse(seen, await draw("recommended", makeDenseScene(), wall)),
        hidden: mse(seen, behind),
        without: mse(seen, without),
        decal: Array.from((await draw("core", empty(), wall, ...few)).slice(0, 4)),
        through: Array.from((await draw("core", empty(), wall, few[0], through)).slice(0, 4)),
      };
    }
    const huge = nmtPass(makeScene().scene, makeCamera(64 / 48), { network: "core-large" });
    huge.setResolutionScale(40);
    try {
      await frame(await open(64, 48), huge, 64, 48);
    } catch (error) {
      out.huge = error.message;
    }
    return out;
  }, MSE);
  assert.deepEqual(page.errors, []);
  const near = (a, b, what) => b.forEach((x, i) => assert.ok(Math.abs(a[i] - x) < 2e-3, `${what}: ${a} is not ${b}`));
  const { huge, ...buffers } = found;
  for (const [name, { hidden, without, networks, decal, through, ...drawn }] of Object.entries(buffers)) {
    // Control: another network gives another image.
    assert.ok(drawn.buffers < 1e-8 && networks > 1e-6, `${name}: ${drawn.buffers}, another network ${networks}`);
    // Control: without the wall the same layers are seen.
    assert.ok(hidden === 0 && without > 1e-3, `${name}: hidden ${hidden}, without a wall ${without}`);
    near(decal, [0.5 * 1, 0.5 * 0.7, 0.5 + 0.5 * 0.7, 1], `${name}, decal`);
    near(through, [0.5 * 0.5, 0.5, 0.5 + 0.5 * 0.5, 1], `${name}, no test`);
    assert.throws(() => near(decal, through, "control"));
  }
  assert.match(huge, /the core of 2560 x 1920 pixels takes 157286400 bytes, the device binds 134217728/);
  await page.close();
});

test("core: steps that differ by one between both passes do no harm", async () => {
  const page = await visit();
  const found = await page.evaluate(async (mseText) => {
    const mse = eval(mseText);
    const { core } = await import("/node_modules/neural-moment-transparency/networks.js");
    const renderer = await open(64, 48);
    const camera = makeCamera(64 / 48);
    // In every second pixel the core holds fragments some steps nearer than pass 2 finds them.
    const draw = (steps) => {
      const wgsl = core.replace(
        "nmt_core_nearest_code(steps))",
        `nmt_core_nearest_code(steps - vec2<u32>(${steps}u * (pixel & 1u), 0u)))`,
      );
      if (wgsl === core) throw new Error("there is no such place");
      return frame(renderer, nmtPass(makeDenseScene().scene, camera, { network: { wgsl } }), 64, 48);
    };
    const plain = await draw(0);
    return { one: mse(await draw(1), plain), three: mse(await draw(3), plain) };
  }, MSE);
  assert.deepEqual(page.errors, []);
  // Control: three steps do.
  assert.ok(found.one < 1e-7 && found.three > 1e-6, JSON.stringify(found));
  await page.close();
});


test("README: its program runs as it stands, order does not matter, other blending is drawn as ever", async () => {
  const readme = fs.readFileSync(path.join(FRESH, "node_modules", "neural-moment-transparency", "README.md"), "utf8");
  const program = readme.match(/```js\n([^]*?)```/)[1];
  assert.match(program, /nmtPass\(scene, camera\)/);
  const page = await visit();
  const found = await page.evaluate(
    async ([mseText, program]) => {
      const mse = eval(mseText);
      // What the reader has: a scene, a camera.
      Object.assign(window, makeScene(), { camera: makeCamera(64 / 48) });
      const module = URL.createObjectURL(
        new Blob([`${program}\nwindow.shown = { renderer, pipeline, why };`], { type: "text/javascript" }),
      );
      await import(module);
      const { renderer, pipeline, why } = window.shown;
      await new Promise((resolve) => setTimeout(resolve, 500));
      renderer.setAnimationLoop(null);
      const out = { why, pass: pipeline.outputNode.isNMTPassNode === true, frames: renderer.info.frame };

      const image = (scene, options) => frame(renderer, nmtPass(scene, camera, options), 64, 48);
      const there = await image(scene);
      scene.children.reverse();
      out.order = mse(await image(scene), there);
      const many = makeDenseScene().scene;
      const before = await image(many, { network: "core" });
      many.children.reverse();
      out.orderOfCore = mse(await image(many, { network: "core" }), before);
      out.otherNetwork = mse(await image(many), before);
      // The export of a network of one's own is that network.
      const { small } = await import("/node_modules/neural-moment-transparency/networks.js");
      out.own = mse(await image(scene, { network: { wgsl: small } }), await image(scene, { network: "small" }));
      out.refused = [{ wgsl: "fn nothing() {}" }, {}, "paper"].map((network) => {
        try {
          nmtPass(scene, camera, { network });
          return "";
        } catch (error) {
          return error.message;
        }
      });
      // Additive glass is drawn as by a plain pass; control: with normal blending, of many balls, the passes differ.
      const lights = new THREE.Scene();
      lights.background = new THREE.Color(0.1, 0.2, 0.3);
      const made = [0xff4030, 0x30d060].map((color, i) => {
        const material = new THREE.MeshBasicMaterial({ color, transparent: true, opacity: 0.5 });
        const ball = new THREE.Mesh(new THREE.SphereGeometry(2, 24, 12), material);
        ball.position.set(i, 0, 2 * i);
        lights.add(ball);
        return material;
      });
      const plainly = (scene) => frame(renderer, pass(scene, camera), 64, 48);
      const dense = makeDenseScene().scene;
      out.normal = mse(await image(dense), await plainly(dense));
      for (const material of made) {
        material.blending = THREE.AdditiveBlending;
        material.needsUpdate = true;
      }
      out.additive = mse(await image(lights), await plainly(lights));
      return out;
    },
    [MSE, program],
  );
  assert.deepEqual(page.errors, []);
  assert.equal(found.why, null);
  assert.ok(found.pass && found.frames > 0, `${found.frames} frames`);
  // Control: another network gives another image.
  assert.ok(found.orderOfCore < 1e-9 && found.otherNetwork > 1e-6, `${found.orderOfCore}, ${found.otherNetwork}`);
  assert.ok(found.order < 1e-9 && found.own === 0, `order ${found.order}, own ${found.own}`);
  assert.match(found.refused[0], /no "fn nmt_moments/);
  assert.match(found.refused[1], /there are recommended, small/);
  assert.match(found.refused[2], /no network "paper"/);
  assert.ok(found.additive < 1e-9 && found.normal > 1e-4, `additive ${found.additive}, normal ${found.normal}`);
  // What the README says of Node and of files.
  const { recommended } = await import(path.join(FRESH, "node_modules/neural-moment-transparency/networks.js"));
  const shaders = path.join(FRESH, "node_modules/neural-moment-transparency/shaders");
  assert.equal(recommended, fs.readFileSync(path.join(shaders, "recommended", "recommended.wgsl"), "utf8"));
  for (const file of ["webgpu/pass1.wgsl", "opengl-es-300/pass2.frag", "direct3d/resolve.hlsl", "metal/pass2.metal"])
    assert.ok(fs.existsSync(path.join(shaders, "small", file)), file);
  await page.close();
});

test("the example runs", async () => {
  const page = await open(browser, `${server.url}/node_modules/neural-moment-transparency/example/`);
  await page.waitForFunction(() => document.querySelectorAll("button").length === 4);
  await page.waitForTimeout(1500);
  assert.deepEqual(page.errors, []);
  await page.screenshot({ path: path.join(SCRATCH, "example.png") });
  await page.close();
});
