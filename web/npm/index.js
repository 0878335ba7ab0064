// A three.js render pass for order-independent transparency by a tiny network.
//
// Opaque objects are drawn as ever. Transparent ones are drawn twice, in any order: once to add up absorbance and its
// moments per pixel, once to add up colour by how much light passes in front of each fragment, which a network answers.

import {
  AddEquation,
  BlendMode,
  Color,
  CustomBlending,
  DepthTexture,
  FloatType,
  HalfFloatType,
  LessEqualDepth,
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
  StorageBufferAttribute,
  Vector2,
} from "three/webgpu";
import {
  Fn,
  bool,
  expression,
  instanceIndex,
  mrt,
  output,
  positionView,
  renderGroup,
  screenCoordinate,
  storage,
  textureLoad,
  uniform,
  uvec2,
  uvec4,
  vec4,
  wgsl,
  wgslFn,
} from "three/tsl";
import { core, coreLarge, coreSmall, ends, moments6, recommended, small } from "./networks.js";

const NETWORKS = {
  recommended,
  small,
  "moments-6": moments6,
  ends,
  "core-small": coreSmall,
  core,
  "core-large": coreLarge,
};

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

const hasCore = (source) => source.includes("fn nmt_core_insert(");
/** Whether its core is both ends, which blending keeps. */
const hasEnds = (source) => source.includes("fn nmt_core_ends(");

const PASS2_HEAD =
  "fn nmt_pass2(v: f32, v0: f32, v1: f32, alpha: f32, sums0: vec4<f32>, sums1: vec4<f32>, range: vec4<f32>)";

/** A network's WGSL. */
function sourceOf(network) {
  const source = typeof network === "string" ? NETWORKS[network] : network?.wgsl;
  if (typeof source !== "string") {
    const names = Object.keys(NETWORKS).join(", ");
    throw new Error(`nmtPass: there is no network "${network}"; there are ${names}, or { wgsl } of an export.`);
  }
  const needs = hasCore(source)
    ? [
        "var<storage, read_write> nmt_core: array<atomic<u32>>;",
        "fn nmt_core_moments(steps: vec2<u32>) -> vec4<f32>",
        "fn nmt_core_transmittance(",
      ]
    : [hasEnds(source) ? "fn nmt_core_transmittance(" : "fn nmt_moments(z: f32, absorbance: f32)", PASS2_HEAD];
  needs.push("fn nmt_resolve(weighted: vec4<f32>, sums0: vec4<f32>)");
  const missing = needs.find((head) => !source.includes(head));
  if (missing !== undefined) {
    throw new Error(
      `nmtPass: the WGSL has no "${missing}"; give it the export of a network of four or six moments (feature set ` +
        "'recentred' or 'recentred-6') or the chain of one with ends or a core, without a prefix.",
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
    v: f32, alpha: f32, range: vec2<f32>, sums0: vec4<f32>, sums1: vec4<f32>, ends: vec4<f32>
) -> f32 {
    var at = clamp( v, -ends.x, ends.y );
    if ( ends.y - at < 1e-6 * at ) { at = ends.y; }
    if ( at + ends.x < 1e-6 * at ) { at = -ends.x; }
    return nmt_pass2( at, range.x, range.y, alpha, sums0, sums1, ends );
}`;
// The same of networks with a core. The first target of pass 1 is the one call that also writes the core.
const STEPS = `
    let codes = nmt_core_codes( range.x, range.y );
    let steps = nmt_core_steps( v, nmt_core_absorbance_of( alpha ), codes );`;
const CORE_PASS1 = {
  sums0: `
fn nmt_three_sums0( v: f32, alpha: f32, range: vec2<f32>, pixel: u32, inFront: bool ) -> vec4<f32> {${STEPS}
    if ( inFront ) { nmt_core_insert( pixel, steps, codes ); }
    return vec4<f32>( nmt_core_absorbance( steps ), nmt_core_moments( steps ).xyz );
}`,
  sums1: `
fn nmt_three_sums1( v: f32, alpha: f32, range: vec2<f32> ) -> vec4<f32> {${STEPS}
    return vec4<f32>( nmt_core_moments( steps ).w, select( 0.0, 1.0, steps.y > 0u ), 0.0, 0.0 );
}`,
};
// What is within a step of a fragment of the core is that fragment, for the same reason. The core is given as vectors
// of four words, or `made` of what is given.
const corePass2 = (cores, given = cores.map((name) => `${name}: vec4<u32>`).join(", "), made = "") => `
fn nmt_three_transmittance(
    v: f32, alpha: f32, range: vec2<f32>, sums0: vec4<f32>, sums1: vec4<f32>, ${given}
) -> f32 {${STEPS}${made}
    let words = array<vec4<u32>, ${cores.length}>( ${cores.join(", ")} );
    var own = steps;
    for ( var slot = 0u; slot < NMT_HEAVY + 2u; slot++ ) {
        let code = words[ slot / 4u ][ slot % 4u ];
        var kept = nmt_core_heavy_steps( code, codes );
        if ( slot == 0u ) { kept = nmt_core_nearest_steps( code ); }
        if ( slot == 1u ) { kept = nmt_core_farthest_steps( code ); }
        let apart = max( kept, steps ) - min( kept, steps );
        if ( code > 0u && all( apart <= vec2<u32>( 1u ) ) ) { own = kept; }
        if ( code > 0u && all( kept == steps ) ) { break; }
    }
    let moments = vec4<f32>( sums0.yzw, sums1.x );
    return nmt_core_transmittance( own, codes, ${cores.join(", ")}, sums1.y, sums0.x, moments );
}`;
const ENDS_PASS2 = corePass2(
  ["core0"],
  "ends: vec4<f32>",
  "\n    let core0 = vec4<u32>( nmt_core_ends( ends.xy ), 0u, 0u );",
);
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

/** Targets that shaders read texel by texel. They share the depth of opaque objects. */
function targetsBeside({ depthTexture, stencilBuffer }, type, textures) {
  const target = new RenderTarget(1, 1, { count: textures.length, depthTexture, stencilBuffer });
  const common = { type, minFilter: NearestFilter, magFilter: NearestFilter, colorSpace: NoColorSpace };
  target.textures.forEach((texture, i) => Object.assign(texture, common, textures[i]));
  return target;
}

/**
 * Whether a fragment passes the depth test for sure. Its shader runs before the test, so that it must find out itself
 * whether the core may hold it; what is left out of the core is known by the sums alone.
 */
const isInFront = Fn(([opaque], builder) => {
  const { material, renderer } = builder;
  if (material.stencilWrite) return bool(false);
  if (material.depthTest === false) return bool(true);
  if (material.depthFunc !== LessEqualDepth || material.polygonOffset) return bool(false);
  const isWritten = material.depthNode?.isNode === true || renderer.logarithmicDepthBuffer === true;
  const own = isWritten ? builder.getFragDepth() : `${builder.getBuiltin("position", "fragCoord", "vec4<f32>")}.z`;
  const depth = expression(own, "float");
  // Depths of 24 bits are rounded.
  return renderer.reversedDepthBuffer === true ? depth.greaterThan(opaque) : depth.lessThan(opaque.sub(6e-8));
});

/** The pixel that is drawn, in a target of the pass. */
const texel = () => uvec2(screenCoordinate.xy);
const [SUMS0, RANGE] = [{ name: "sums0", format: RGBAFormat }, { name: "range", format: RGFormat }];
const sums1Of = (format) => ({ name: "sums1", format });

/** A network fed by moments and both ends, all of it blended: the targets and the shaders of its passes. */
class Moments {
  constructor(source) {
    this.source = wgsl(source);
    this.isOfSix = source.includes("fn nmt_moments(z: f32, absorbance: f32) -> mat2x4<f32>");
    this.pass2 = hasEnds(source) ? ENDS_PASS2 : PASS2;
  }

  /** The targets of pass 1, those of each draw: one draw where the device writes all of them at once. */
  draws(device) {
    if (!this.isOfSix) return [[SUMS0, sums1Of(RGFormat), RANGE]];
    const sums1 = sums1Of(RGBAFormat);
    // 40 bytes a pixel, where four moments take the 32 that every device writes.
    return device.limits.maxColorAttachmentBytesPerSample < 40 ? [[SUMS0, RANGE], [sums1]] : [[SUMS0, sums1, RANGE]];
  }

  /** What a fragment writes to a target of pass 1. */
  sum(name, given) {
    return wgslFn(pass1(name), [this.source])(given);
  }

  /** What passes in front of a fragment; `read` gives its pixel of a target. */
  transmittance(given, read) {
    const left = { sums0: read("sums0"), sums1: read("sums1"), ends: read("range") };
    return wgslFn(this.pass2, [this.source])({ ...given, ...left });
  }

  /** At the start of a frame. */
  begin() {}

  /** When opaque objects are drawn. */
  keepDepth() {}

  dispose() {}
}

/** A network with a core, a buffer that pass 1 writes by atomic maxima and pass 2 reads in pairs of words. */
class Core {
  constructor(source) {
    const [insertion, inserts] = /.*read_write> nmt_core: .*\n([^]*?fn nmt_core_insert\([^]*?\n}\n)/.exec(source);
    this.pairs = Number(/const NMT_SLOTS: u32 = (\d+)u;/.exec(source)[1]) / 2;
    this.source = wgsl(source.replace(insertion, ""));
    const buffer = new StorageBufferAttribute(1, 2, Uint32Array);
    this.written = storage(buffer, "uint").toAtomic().setName("nmt_three_core").setGroup(renderGroup);
    this.read = storage(buffer, "uvec2").setGroup(renderGroup);
    this.inserts = wgsl(inserts.replaceAll("&nmt_core[", "&nmt_three_core.value["), [this.source, this.written]);
    this.columns = uniform(0, "uint").setGroup(renderGroup);
    // A copy of that of opaque objects: what a draw tests against it cannot read.
    this.depth = new DepthTexture(1, 1);
    this.clear = Fn(() => {
      this.read.element(instanceIndex).assign(uvec2(0));
    })().compute(1);
  }

  get pixel() {
    const at = texel();
    return at.y.mul(this.columns).add(at.x);
  }

  draws() {
    return [[SUMS0, sums1Of(RGFormat)]];
  }

  sum(name, given) {
    const { pixel, inserts } = this;
    const inFront = isInFront(textureLoad(this.depth, texel()));
    return wgslFn(CORE_PASS1[name], [inserts])({ ...given, pixel, inFront });
  }

  transmittance(given, read) {
    const first = this.pixel.mul(this.pairs);
    const pair = (i) => (i < this.pairs ? this.read.element(first.add(i)) : uvec2(0));
    const vectors = Math.ceil(this.pairs / 2);
    const cores = Array.from({ length: vectors }, (_, i) => [`core${i}`, uvec4(pair(2 * i), pair(2 * i + 1))]);
    const left = { sums0: read("sums0"), sums1: read("sums1"), ...Object.fromEntries(cores) };
    return wgslFn(corePass2(cores.map(([name]) => name)), [this.source])({ ...given, ...left });
  }

  begin(renderer, { width, height, depthTexture }) {
    const { type, format } = depthTexture;
    const count = width * height * this.pairs;
    if (this.columns.value !== width || this.clear.count !== count) {
      const most = renderer.backend.device.limits.maxStorageBufferBindingSize;
      if (8 * count > most) {
        const pixels = `${width} x ${height} pixels`;
        throw new Error(`nmtPass: the core of ${pixels} takes ${8 * count} bytes, the device binds ${most}.`);
      }
      this.free();
      this.written.value = this.read.value = new StorageBufferAttribute(count, 2, Uint32Array);
      this.clear.count = count;
      this.columns.value = width;
      Object.assign(this.depth, { type, format });
      Object.assign(this.depth.image, { width, height });
    }
    renderer.compute(this.clear);
  }

  keepDepth(renderer, { depthTexture }) {
    renderer.copyTextureToTexture(depthTexture, this.depth);
  }

  /** Gives back what has the size of the pass. */
  free() {
    this.read.value.dispose();
    this.depth.dispose();
  }

  dispose() {
    this.free();
    this.clear.dispose();
  }
}

export class NMTPassNode extends PassNode {
  static get type() {
    return "NMTPassNode";
  }

  constructor(scene, camera, { network = "recommended", range = null, ...options } = {}) {
    super(PassNode.COLOR, scene, camera, { ...options, samples: 0, depthBuffer: true });
    this.isNMTPassNode = true;
    this.range = range;
    const source = sourceOf(network);
    this._network = hasCore(source) ? new Core(source) : new Moments(source);
    // In the group of the frame: what is an object's own is not updated while it stands still.
    this._range = uniform(new Vector2(1, 2)).setGroup(renderGroup);

    // Targets of pass 1, a set for each draw, are made when the device is known.
    this._sums = [];
    this._weighted = targetsBeside(this.renderTarget, HalfFloatType, [{ name: "weighted" }]);

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
    const found = textures.find((texture) => texture.name === name);
    return textureLoad(found, texel());
  }

  /** Each draw of transparent objects: where it goes, and what it writes. */
  get _draws() {
    if (this._outputs === null) {
      const v = positionView.z.negate();
      const alpha = output.a.clamp(0, 1);
      const given = { v, alpha, range: this._range };
      const sums = this._sums.map((target) => {
        const names = target.textures.map((texture) => texture.name);
        const outputs = mrt(Object.fromEntries(names.map((name) => [name, this._network.sum(name, given)])));
        for (const name of names) {
          const ends = name === "range";
          outputs.setBlendMode(name, added(ends ? MaxEquation : AddEquation));
          outputs.setClearColor(name, ends ? new Color(NOTHING, NOTHING, 0) : new Color(0, 0, 0), 0);
        }
        return { target, outputs };
      });
      const T = this._network.transmittance(given, (name) => this._read(name));
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
      const draws = this._network.draws(builder.renderer.backend.device);
      this._sums = draws.map((textures) => targetsBeside(this.renderTarget, FloatType, textures));
    }
    const [weighted, sums0] = [this._read("weighted"), this._read("sums0")];
    return wgslFn(RESOLVE, [this._network.source])({ background, weighted, sums0 });
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
    this._network.begin(renderer, this.renderTarget);
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
    this._network.keepDepth(renderer, this.renderTarget);

    // The background belongs to the pass before.
    sceneState = RendererUtils.resetSceneState(scene, sceneState);
    renderer.autoClear = true;
    renderer.autoClearColor = true;
    renderer.autoClearDepth = false;
    renderer.autoClearStencil = false;
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
    this._network.dispose();
  }
}

/** The node of a pass that draws `scene` seen by `camera`, transparent objects in any order. */
export const nmtPass = (scene, camera, options) => new NMTPassNode(scene, camera, options);
