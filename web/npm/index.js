// A three.js render pass for order-independent transparency by a tiny network.
//
// Opaque objects are drawn as ever. Transparent ones are drawn twice, in any order: once to add up absorbance and its
// moments per pixel, once to add up colour by how much light passes in front of each fragment, which a network answers.

import {
  AddEquation,
  BlendMode,
  Color,
  CustomBlending,
  FloatType,
  HalfFloatType,
  MaxEquation,
  NearestFilter,
  NoColorSpace,
  NormalBlending,
  OneFactor,
  PassNode,
  RGBAFormat,
  RGFormat,
  RenderTarget,
  RendererUtils,
  Scene,
  Sphere,
  Vector2,
} from "three/webgpu";
import {
  ivec2,
  mrt,
  output,
  positionView,
  renderGroup,
  screenCoordinate,
  textureLoad,
  uniform,
  vec4,
  wgsl,
  wgslFn,
} from "three/tsl";
import { moments6, recommended, small } from "./networks.js";

const NETWORKS = { recommended, small, "moments-6": moments6 };

const size = new Vector2();
const sphere = new Sphere();
const nothing = new Scene();
let rendererState;
let sceneState;

/** What stands in a clear pixel of the ends: below -v of any fragment, and above none. */
const NOTHING = -3e38;

/** Why a renderer cannot run the pass, in words; null where it can. */
export function whyUnsupported(renderer) {
  const { backend } = renderer;
  if (backend?.isWebGPUBackend !== true)
    return "nmtPass needs WebGPU, but this renderer draws with WebGL; use oitPass.";
  if (!backend.device) return "nmtPass: call 'await renderer.init()' first.";
  if (!backend.device.features.has("float32-blendable")) {
    return "nmtPass needs 'float32-blendable', which this device lacks; use oitPass.";
  }
  return null;
}

/** Whether this pass draws a material: transparent, blended normally, without looking at what is behind it. */
const isDrawnHere = (material) =>
  material.transparent === true &&
  material.blending === NormalBlending &&
  material.premultipliedAlpha !== true &&
  !(material.transmission > 0) &&
  material.transmissionNode?.isNode !== true &&
  material.backdropNode?.isNode !== true;

/** A network's WGSL. */
function sourceOf(network) {
  const source = typeof network === "string" ? NETWORKS[network] : network?.wgsl;
  if (typeof source !== "string") {
    const names = Object.keys(NETWORKS).join(", ");
    throw new Error(`nmtPass: there is no network "${network}"; there are ${names}, or { wgsl } of an export.`);
  }
  const needs = [
    "fn nmt_moments(z: f32, absorbance: f32)",
    "fn nmt_pass2(v: f32, v0: f32, v1: f32, alpha: f32, sums0: vec4<f32>, sums1: vec4<f32>, range: vec4<f32>)",
    "fn nmt_resolve(weighted: vec4<f32>, sums0: vec4<f32>)",
  ];
  const missing = needs.find((head) => !source.includes(head));
  if (missing !== undefined) {
    throw new Error(
      `nmtPass: the WGSL has no "${missing}"; give it the export of a network of four or six moments ` +
        "(feature set 'recentred' or 'recentred-6'), without a prefix.",
    );
  }
  return source;
}

/** The targets of pass 1, those of each draw: one draw where the device writes all of them at once. */
function drawsOf(source, device) {
  const [sums0, range] = [{ name: "sums0", format: RGBAFormat }, { name: "range", format: RGFormat }];
  const six = source.includes("fn nmt_moments(z: f32, absorbance: f32) -> mat2x4<f32>");
  const sums1 = { name: "sums1", format: six ? RGBAFormat : RGFormat };
  // Six moments take 40 bytes a pixel, four 32, which every device writes.
  const twice = six && device.limits.maxColorAttachmentBytesPerSample < 40;
  return twice ? [[sums0, range], [sums1]] : [[sums0, sums1, range]];
}

// TSL knows vectors, and no structures: a call for each target of pass 1.
const pass1 = (field) => `
fn nmt_three_${field}( v: f32, alpha: f32, range: vec2<f32> ) -> vec4<f32> {
    return nmt_pass1( v, range.x, range.y, alpha ).${field};
}`;
// Both passes are compiled apart, so that v may differ in its last bits: what is next to an end is the end.
const PASS2 = `
fn nmt_three_transmittance(
    v0: f32, alpha: f32, range: vec2<f32>, sums0: vec4<f32>, sums1: vec4<f32>, ends: vec4<f32>
) -> f32 {
    var v = clamp( v0, -ends.x, ends.y );
    if ( ends.y - v < 1e-6 * v ) { v = ends.y; }
    if ( v + ends.x < 1e-6 * v ) { v = -ends.x; }
    return nmt_pass2( v, range.x, range.y, alpha, sums0, sums1, ends );
}`;
const RESOLVE = `
fn nmt_three_resolve( background: vec4<f32>, weighted: vec4<f32>, sums0: vec4<f32> ) -> vec4<f32> {
    let over = nmt_resolve( weighted, sums0 );
    return vec4<f32>( over.rgb + over.a * background.rgb, 1.0 - over.a * ( 1.0 - background.a ) );
}`;

function added(equation = AddEquation) {
  const mode = new BlendMode(CustomBlending);
  mode.blendSrc = OneFactor;
  mode.blendDst = OneFactor;
  mode.blendEquation = equation;
  return mode;
}

/** Targets that shaders read texel by texel. They keep the depth that transparent objects are tested against. */
function targetsWith(depthTexture, type, textures) {
  const target = new RenderTarget(1, 1, { count: textures.length, depthTexture });
  const common = { type, minFilter: NearestFilter, magFilter: NearestFilter, colorSpace: NoColorSpace };
  target.textures.forEach((texture, i) => Object.assign(texture, common, textures[i]));
  return target;
}

export class NMTPassNode extends PassNode {
  static get type() {
    return "NMTPassNode";
  }

  constructor(scene, camera, { network = "recommended", range = null, ...options } = {}) {
    super(PassNode.COLOR, scene, camera, { ...options, samples: 0 });
    this.isNMTPassNode = true;
    this.range = range;
    this._source = wgsl(sourceOf(network));
    // In the group of the frame: what is an object's own is not updated while it stands still.
    this._range = uniform(new Vector2(1, 2)).setGroup(renderGroup);

    // Targets of pass 1, a set for each draw, are made when the device is known.
    this._sums = [];
    this._weighted = targetsWith(this.renderTarget.depthTexture, HalfFloatType, [{ name: "weighted" }]);

    // Whether none has been drawn into since it got its size.
    this._isNew = true;
    this._renderer = null;
    this._outputs = null;
    const draws =
      (here) =>
      (object, scene_, camera_, geometry, material, ...rest) => {
        if (isDrawnHere(material) !== here) return;
        const { depthWrite } = material;
        if (here) material.depthWrite = false;
        this._renderer.renderObject(object, scene_, camera_, geometry, material, ...rest);
        material.depthWrite = depthWrite;
      };
    this._drawOthers = draws(false);
    this._drawTransparent = draws(true);
  }

  /** What draws have left in this pixel of a target. */
  _read(name) {
    const textures = [...this._sums, this._weighted].flatMap((target) => target.textures);
    return textureLoad(
      textures.find((texture) => texture.name === name),
      ivec2(screenCoordinate.xy),
    );
  }

  /** Each draw of transparent objects: where it goes, and what it writes. */
  get _draws() {
    if (this._outputs === null) {
      const v = positionView.z.negate();
      const alpha = output.a.clamp(0, 1);
      const given = { v, alpha, range: this._range };
      const includes = [this._source];
      const sums = this._sums.map((target) => {
        const names = target.textures.map((texture) => texture.name);
        const outputs = mrt(Object.fromEntries(names.map((name) => [name, wgslFn(pass1(name), includes)(given)])));
        for (const name of names) {
          const ends = name === "range";
          outputs.setBlendMode(name, added(ends ? MaxEquation : AddEquation));
          outputs.setClearColor(name, ends ? new Color(NOTHING, NOTHING, 0) : new Color(0, 0, 0), 0);
        }
        return { target, outputs };
      });
      const [sums0, sums1, ends] = ["sums0", "sums1", "range"].map((name) => this._read(name));
      const T = wgslFn(PASS2, includes)({ v0: v, alpha, range: this._range, sums0, sums1, ends });
      const share = alpha.mul(T);
      const weighted = mrt({ weighted: vec4(output.rgb.mul(share), share) });
      weighted.setBlendMode("weighted", added()).setClearColor("weighted", new Color(0, 0, 0), 0);
      this._outputs = [...sums, { target: this._weighted, outputs: weighted }];
    }
    return this._outputs;
  }

  setSize(width, height) {
    super.setSize(width, height);
    const { width: w, height: h } = this.renderTarget;
    this._isNew ||= this._weighted.width !== w || this._weighted.height !== h;
    for (const target of [...this._sums, this._weighted]) target.setSize(w, h);
  }

  setup(builder) {
    const why = whyUnsupported(builder.renderer);
    if (why !== null) throw new Error(why);
    const background = super.setup(builder);
    if (this._sums.length === 0) {
      const draws = drawsOf(this._source.code, builder.renderer.backend.device);
      this._sums = draws.map((textures) => targetsWith(this.renderTarget.depthTexture, FloatType, textures));
    }
    const [weighted, sums0] = [this._read("weighted"), this._read("sums0")];
    return wgslFn(RESOLVE, [this._source])({ background, weighted, sums0 });
  }

  /** View depths that hold every transparent object. */
  _findRange() {
    const { camera } = this;
    if (this.range !== null) return this._range.value.set(this.range[0], this.range[1]);
    let [least, greatest] = [Infinity, 0];
    const take = (object) => {
      const materials = Array.isArray(object.material) ? object.material : [object.material];
      if (!object.geometry || !materials.some((m) => m && isDrawnHere(m))) return;
      if (object.boundingSphere !== undefined) {
        if (object.boundingSphere === null) object.computeBoundingSphere();
        sphere.copy(object.boundingSphere);
      } else {
        if (object.geometry.boundingSphere === null) object.geometry.computeBoundingSphere();
        sphere.copy(object.geometry.boundingSphere);
      }
      sphere.applyMatrix4(object.matrixWorld).applyMatrix4(camera.matrixWorldInverse);
      least = Math.min(least, -sphere.center.z - sphere.radius);
      greatest = Math.max(greatest, -sphere.center.z + sphere.radius);
    };
    this.scene.traverseVisible(take);
    const near = Math.max(camera.near, 1e-6);
    least = Math.max(near, Number.isFinite(least) ? least : near);
    return this._range.value.set(least, Math.max(least * 1.0001, Math.min(greatest, camera.far)));
  }

  updateBefore(frame) {
    const { renderer } = frame;
    const { scene, camera } = this;
    this._renderer = renderer;
    renderer.getDrawingBufferSize(size);
    this.setSize(size.width, size.height);
    rendererState = RendererUtils.saveRendererState(renderer, rendererState);
    const { mask } = camera.layers;
    this._cameraNear.value = camera.near;
    this._cameraFar.value = camera.far;
    if (this._layers !== null) camera.layers.mask = this._layers.mask;
    renderer.autoClear = this.autoClear;
    renderer.autoClearColor = this.autoClearColor;
    renderer.autoClearDepth = this.autoClearDepth;
    renderer.autoClearStencil = this.autoClearStencil;

    // The renderer clears the depth of a target that it has not seen, which would be that of the opaque objects.
    if (this._isNew) {
      renderer.setMRT(null);
      for (const { target } of this._draws) {
        renderer.setRenderTarget(target);
        renderer.render(nothing, camera);
      }
      this._isNew = false;
    }

    renderer.setMRT(this._mrt);
    renderer.setRenderTarget(this.renderTarget);
    renderer.setRenderObjectFunction(this._drawOthers);
    renderer.render(scene, camera);
    this._findRange();

    // The background belongs to the pass before.
    sceneState = RendererUtils.resetSceneState(scene, sceneState);
    renderer.autoClear = true;
    renderer.autoClearColor = true;
    renderer.autoClearDepth = false;
    renderer.opaque = false;
    renderer.transparent = true;
    renderer.setRenderObjectFunction(this._drawTransparent);
    for (const { target, outputs } of this._draws) {
      renderer.setRenderTarget(target);
      renderer.setMRT(outputs);
      renderer.render(scene, camera);
    }
    RendererUtils.restoreSceneState(scene, sceneState);
    RendererUtils.restoreRendererState(renderer, rendererState);
    camera.layers.mask = mask;
    this._renderer = null;
  }

  dispose() {
    super.dispose();
    for (const target of [...this._sums, this._weighted]) target.dispose();
  }
}

/** The node of a pass that draws `scene` seen by `camera`, transparent objects in any order. */
export const nmtPass = (scene, camera, options) => new NMTPassNode(scene, camera, options);
