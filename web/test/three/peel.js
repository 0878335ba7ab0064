// What the test of the three.js package draws: frames of a pass as linear numbers, and a reference of peeled layers.

import * as THREE from "three/webgpu";
import { mrt, output, pass, positionView, screenCoordinate, ivec2, textureLoad, vec4 } from "three/tsl";
import { oitPass } from "three/addons/tsl/display/OITPassNode.js";
import { nmtPass, whyUnsupported } from "neural-moment-transparency";
import { makeCamera, makeScene } from "/node_modules/neural-moment-transparency/example/scene.js";

async function open(width, height, parameters = {}) {
  const renderer = new THREE.WebGPURenderer({ antialias: false, ...parameters });
  await renderer.init();
  renderer.setSize(width, height, false);
  document.body.append(renderer.domElement);
  return renderer;
}

/** Linear colours of a render target, four numbers a pixel, rows from the top. */
async function read(renderer, target, index = 0) {
  const { width, height } = target;
  const found = await renderer.readRenderTargetPixelsAsync(target, 0, 0, width, height, index);
  // Rows are padded to 256 bytes.
  const stride = found.length === 4 * width * height ? 4 * width : (Math.ceil((16 * width) / 256) * 256) / 4;
  const out = new Float32Array(4 * width * height);
  for (let y = 0; y < height; y++) out.set(found.subarray(y * stride, y * stride + 4 * width), 4 * y * width);
  return out;
}

/** A frame of a pass. */
async function frame(renderer, node, width, height, frames = 1) {
  renderer.setSize(width, height, false);
  const target = new THREE.RenderTarget(width, height, { type: THREE.FloatType });
  const pipeline = new THREE.RenderPipeline(renderer, node);
  pipeline.outputColorTransform = false;
  // OITPassNode loses the opaque depth in the first frame of a size: what is measured is the second.
  for (let i = 0; i < frames; i++) {
    await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
    renderer.setRenderTarget(target);
    pipeline.render();
    renderer.setRenderTarget(null);
  }
  const image = await read(renderer, target);
  target.dispose();
  pipeline.dispose();
  return image;
}

/** The over operator on peeled layers: of what lies behind the layer before, the nearest, opaque or not. */
async function peel(renderer, scene, camera, width, height, layers) {
  const targets = [0, 1].map(() => {
    const target = new THREE.RenderTarget(width, height, { count: 2, type: THREE.FloatType });
    target.textures[0].name = "color";
    target.textures[1].name = "distance";
    for (const t of target.textures) t.minFilter = t.magFilter = THREE.NearestFilter;
    return target;
  });
  const { background } = scene;
  scene.background = null;
  renderer.setClearColor(0x000000, 0);
  const materials = new Set();
  scene.traverse((object) => object.material && materials.add(object.material));
  const v = positionView.z.negate();
  const none = new THREE.BlendMode(THREE.NoBlending);
  const sum = new Float32Array(4 * width * height);
  for (let p = 3; p < sum.length; p += 4) sum[p] = 1;
  let deepest = 0;
  for (let layer = 0; layer < layers; layer++) {
    const [now, before] = [targets[layer & 1], targets[1 - (layer & 1)]];
    for (const material of materials) {
      const { depthWrite, forceSinglePass } = material;
      material.userData.kept ??= { depthWrite, forceSinglePass };
      Object.assign(material, { depthWrite: true, forceSinglePass: true });
      // A fragment of the layer before differs by rounding alone.
      material.maskNode =
        layer === 0 ? null : v.greaterThan(textureLoad(before.textures[1], ivec2(screenCoordinate.xy)).x.add(2e-5));
      material.needsUpdate = true;
    }
    const outputs = mrt({ color: output, distance: vec4(v, 0, 0, 1) });
    outputs.setBlendMode("color", none).setBlendMode("distance", none);
    outputs
      .setClearColor("color", new THREE.Color(0, 0, 0), 0)
      .setClearColor("distance", new THREE.Color(1e9, 0, 0), 0);
    renderer.setRenderTarget(now);
    renderer.setMRT(outputs);
    renderer.render(scene, camera);
    renderer.setMRT(null);
    renderer.setRenderTarget(null);
    const color = await read(renderer, now, 0);
    const depth = await read(renderer, now, 1);
    let any = false;
    for (let p = 0; p < sum.length; p += 4) {
      if (depth[p] > 1e8) continue;
      any = true;
      const alpha = Math.min(color[p + 3], 1);
      for (let c = 0; c < 3; c++) sum[p + c] += sum[p + 3] * alpha * color[p + c];
      sum[p + 3] *= 1 - alpha;
    }
    if (!any) break;
    deepest = layer + 1;
  }
  for (const material of materials) {
    Object.assign(material, material.userData.kept, { maskNode: null, needsUpdate: true });
  }
  scene.background = background;
  const behind = background ?? new THREE.Color(0, 0, 0);
  for (let p = 0; p < sum.length; p += 4) {
    [behind.r, behind.g, behind.b].forEach((x, c) => (sum[p + c] += sum[p + 3] * x));
    sum[p + 3] = background ? 1 : 1 - sum[p + 3];
  }
  targets.forEach((t) => t.dispose());
  return { image: sum, layers: deepest };
}

/** Thirty balls that cut through one another, both sides of each drawn. */
function makeDenseScene() {
  const { scene } = makeScene();
  scene.clear();
  scene.add(new THREE.HemisphereLight(0xffffff, 0x444444, 2.5));
  const geometry = new THREE.SphereGeometry(1.5, 32, 16);
  for (let i = 0; i < 30; i++) {
    const color = new THREE.Color().setHSL((i * 0.618) % 1, 0.8, 0.5);
    const opacity = 0.15 + 0.01 * (i % 13);
    const material = new THREE.MeshStandardMaterial({ color, opacity, transparent: true, side: THREE.DoubleSide });
    const ball = new THREE.Mesh(geometry, material);
    ball.position.set(2.4 * Math.sin(1.7 * i), 1.2 * Math.sin(2.9 * i + 1), 2.4 * Math.cos(2.3 * i));
    scene.add(ball);
  }
  return { scene };
}

Object.assign(window, {
  THREE,
  open,
  frame,
  peel,
  pass,
  oitPass,
  nmtPass,
  whyUnsupported,
  makeScene,
  makeDenseScene,
  makeCamera,
  loaded: true,
});
