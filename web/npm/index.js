// A three.js render pass for order-independent transparency by a tiny network.
//
// Opaque objects are drawn as ever. Transparent ones are drawn twice, in any order: once to add up absorbance and its
// moments per pixel, once to add up colour by how much light passes in front of each fragment, which a network answers.

import {
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
  screenCoordinate,
  textureLoad,
  uniform,
  vec4,
  wgsl,
  wgslFn,
} from "three/tsl";
import * as networks from "./networks.js";

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
  const source = typeof network === "string" ? networks[network] : network?.wgsl;
  if (typeof source !== "string") {
    const names = Object.keys(networks).join(", ");
    throw new Error(`nmtPass: there is no network "${network}"; there are ${names}, or { wgsl } of an export.`);
  }
  // More moments than four do not fit the 32 bytes that every device writes at once.
  const needs = ["fn nmt_moments(z: f32, absorbance: f32) -> vec4<f32>", "fn nmt_pass2(v: f32,", "fn nmt_resolve("];
  const missing = needs.find((head) => !source.includes(head));
  if (missing !== undefined) {
    throw new Error(
      `nmtPass: the WGSL has no "${missing}"; give it the export of a network of four moments ` +
        "(feature set 'recentred'), without a prefix.",
    );
  }
  return source;
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

function added(equation) {
  const mode = new BlendMode(CustomBlending);
  mode.blendSrc = OneFactor;
  mode.blendDst = OneFactor;
  if (equation !== undefined) mode.blendEquation = equation;
  return mode;
}

/** A target that shaders read texel by texel. */
function plain(texture, name, type, format) {
  Object.assign(texture, { name, type, minFilter: NearestFilter, magFilter: NearestFilter, colorSpace: NoColorSpace });
  if (format !== undefined) texture.format = format;
}

export class NMTPassNode extends PassNode {
  static get type() {
    return "NMTPassNode";
  }

  constructor(scene, camera, { network = "recommended", range = null, ...options } = {}) {
    super(PassNode.COLOR, scene, camera, { ...options, samples: 0 });
    this.isNMTPassNode = true;
    this.range = range;
    const source = sourceOf(network);
    this._source = wgsl(source);
    this._range = uniform(new Vector2(1, 2));

    // Both keep the depth of the opaque objects, which transparent ones are tested against.
    this._sums = new RenderTarget(1, 1, { count: 3 });
    this._sums.depthTexture = this.renderTarget.depthTexture;
    plain(this._sums.textures[0], "sums0", FloatType);
    plain(this._sums.textures[1], "sums1", FloatType, RGFormat);
    plain(this._sums.textures[2], "range", FloatType, RGFormat);
    this._weighted = new RenderTarget(1, 1, { count: 1 });
    this._weighted.depthTexture = this.renderTarget.depthTexture;
    plain(this._weighted.textures[0], "weighted", HalfFloatType);

    // Whether both have not been drawn into since they got their size.
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

  /** What both passes write. */
  get _passes() {
    if (this._outputs === null) {
      const v = positionView.z.negate();
      const alpha = output.a.clamp(0, 1);
      const given = { v, alpha, range: this._range };
      const includes = [this._source];
      const call = (field) => wgslFn(pass1(field), includes)(given);
      const sums = mrt({ sums0: call("sums0"), sums1: call("sums1"), range: call("range") });
      sums.setBlendMode("sums0", added()).setBlendMode("sums1", added()).setBlendMode("range", added(MaxEquation));
      sums.setClearColor("sums0", new Color(0, 0, 0), 0).setClearColor("sums1", new Color(0, 0, 0), 0);
      sums.setClearColor("range", new Color(NOTHING, NOTHING, 0), 0);
      const at = ivec2(screenCoordinate.xy);
      const [sums0, sums1, ends] = this._sums.textures.map((t) => textureLoad(t, at));
      const T = wgslFn(PASS2, includes)({ v0: v, alpha, range: this._range, sums0, sums1, ends });
      const share = alpha.mul(T);
      const weighted = mrt({ weighted: vec4(output.rgb.mul(share), share) });
      weighted.setBlendMode("weighted", added()).setClearColor("weighted", new Color(0, 0, 0), 0);
      this._outputs = { sums, weighted };
    }
    return this._outputs;
  }

  setSize(width, height) {
    super.setSize(width, height);
    const { width: w, height: h } = this.renderTarget;
    this._isNew ||= this._sums.width !== w || this._sums.height !== h;
    this._sums.setSize(w, h);
    this._weighted.setSize(w, h);
  }

  setup(builder) {
    const why = whyUnsupported(builder.renderer);
    if (why !== null) throw new Error(why);
    const opaque = super.setup(builder);
    const at = ivec2(screenCoordinate.xy);
    const weighted = textureLoad(this._weighted.textures[0], at);
    const sums0 = textureLoad(this._sums.textures[0], at);
    return wgslFn(RESOLVE, [this._source])({ background: opaque, weighted, sums0 });
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
      for (const target of [this._sums, this._weighted]) {
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
    for (const [target, outputs] of [
      [this._sums, this._passes.sums],
      [this._weighted, this._passes.weighted],
    ]) {
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
    this._sums.dispose();
    this._weighted.dispose();
  }
}

/** The node of a pass that draws `scene` seen by `camera`, transparent objects in any order. */
export const nmtPass = (scene, camera, options) => new NMTPassNode(scene, camera, options);
