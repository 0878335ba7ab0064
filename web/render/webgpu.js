// The scene by WebGPU: exact lists, sorted objects, and the blended methods in two passes and a resolve.

import {
  FAR,
  FRAME_FLOATS,
  KINDS,
  NEAR,
  SHADOW,
  exactKey,
  farToNear,
  frameData,
  shadowOf,
  sortedSplats,
  viewOf,
  rounded,
} from "./shared.js";
import { method } from "./methods.js";
import { text, texts } from "./text.js";

const NODE_BYTES = 20;
const MAX_BANDS = 64;
const ADD = { srcFactor: "one", dstFactor: "one", operation: "add" };
const OVER = { srcFactor: "one", dstFactor: "one-minus-src-alpha", operation: "add" };

/** Why WebGPU cannot be used here, in words; nothing where it can. */
export async function whyNotWebGpu(without) {
  if (without.has("webgpu")) return "WebGPU is switched off by the address (no=webgpu).";
  if (!navigator.gpu) {
    return isSecureContext
      ? "This browser has no WebGPU."
      : "WebGPU is only there on https:// and on localhost, and this page came over plain http.";
  }
  return null;
}

export class WebGpuRenderer {
  /** Opens the adapter; `without` names features to do without. Throws where there is none. */
  static async create(canvas, { without = new Set() } = {}) {
    const why = await whyNotWebGpu(without);
    if (why) throw new Error(why);
    const adapter = await navigator.gpu.requestAdapter({ powerPreference: "high-performance" });
    if (!adapter) throw new Error("The browser has WebGPU, but found no adapter for it.");
    const has = (feature) => adapter.features.has(feature) && !without.has(feature);
    const features = ["float32-blendable", "timestamp-query"].filter(has);
    const limits = adapter.limits;
    const inFragments = limits.maxStorageBuffersInFragmentStage ?? limits.maxStorageBuffersPerShaderStage;
    if (inFragments < 4 || without.has("fragment-atomics")) {
      throw new Error(
        "This adapter has no storage buffers in fragment shaders, which exact lists and stored fragments need.",
      );
    }
    const bytes = Math.min(limits.maxStorageBufferBindingSize, limits.maxBufferSize, 1 << 28);
    const device = await adapter.requestDevice({
      requiredFeatures: features,
      requiredLimits: { maxStorageBufferBindingSize: bytes, maxBufferSize: Math.max(bytes, 1 << 28) },
    });
    return new WebGpuRenderer(canvas, adapter, device, bytes);
  }

  constructor(canvas, adapter, device, listBytes) {
    this.api = "WebGPU";
    this.canvas = canvas;
    this.device = device;
    this.listBytes = listBytes;
    this.blends32 = device.features.has("float32-blendable");
    this.timed = device.features.has("timestamp-query");
    const info = adapter.info ?? {};
    this.adapter =
      info.description || [info.vendor, info.architecture, info.device].filter(Boolean).join(" ") || "unnamed adapter";
    this.software =
      /swiftshader|llvmpipe|lavapipe|software|basic render/i.test(
        `${this.adapter} ${info.vendor} ${info.architecture}`,
      ) || adapter.info?.isFallbackAdapter === true;
    this.format = navigator.gpu.getPreferredCanvasFormat();
    this.context = canvas.getContext("webgpu");
    this.context.configure({ device, format: this.format, alphaMode: "opaque" });
    this.errors = [];
    device.addEventListener("uncapturederror", (event) => this.errors.push(event.error.message));
    this.lost = device.lost;
    this.pipelines = new Map();
    this.frame = this.buffer("frame", FRAME_FLOATS * 4, GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST);
    this.viewData = this.buffer("view", 16, GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST);
    this.color = this.blends32 ? "rgba32float" : "rgba16float";
    this.bands = 1;
    if (this.timed) {
      this.queries = device.createQuerySet({ type: "timestamp", count: 4 });
      this.queryBuffer = this.buffer("times", 32, GPUBufferUsage.QUERY_RESOLVE | GPUBufferUsage.COPY_SRC);
    }
    this.makeLayouts();
  }

  /** Reasons for what is not as it would be on a better adapter. */
  get notes() {
    const notes = [];
    if (!this.blends32) {
      notes.push(
        "This adapter cannot blend 32-bit float targets (float32-blendable): networks keep their sums in 16 bits and " +
          "both ends in depth buffers, and MBOIT is left out.",
      );
    }
    if (!this.timed) notes.push("This adapter gives no GPU times (timestamp-query).");
    if (this.software) notes.push(`${this.adapter} draws on the CPU: its times are not those of a graphics card.`);
    return notes;
  }

  /** Whether a method can be drawn here, why not, and the bits that it keeps of a pixel. */
  support(name) {
    const m = method(name);
    const kind = this.scene?.transparent.kind;
    if (m.kind === "objects" && kind === "fragments") return { reason: "a fragment list has no objects to sort" };
    if (m.kind === "blended" && !this.blends32) {
      return m.half
        ? { bits: m.half.bits }
        : { reason: "needs blending into 32-bit float targets (float32-blendable), which this adapter lacks" };
    }
    return { bits: m.bits };
  }

  buffer(label, size, usage) {
    return this.device.createBuffer({ label, size: Math.max(16, Math.ceil(size / 4) * 4), usage });
  }

  makeLayouts() {
    const { device } = this;
    const stages = GPUShaderStage.VERTEX | GPUShaderStage.FRAGMENT;
    const FRAGMENT = GPUShaderStage.FRAGMENT;
    const layout = (label, entries) => device.createBindGroupLayout({ label, entries });
    const texture = (binding, sampleType = "unfilterable-float") => ({
      binding,
      visibility: FRAGMENT,
      texture: { sampleType },
    });
    const storage = (binding, type) => ({ binding, visibility: FRAGMENT, buffer: { type } });
    this.frameLayout = layout("frame", [{ binding: 0, visibility: stages, buffer: { type: "uniform" } }]);
    this.frameGroup = device.createBindGroup({
      layout: this.frameLayout,
      entries: [{ binding: 0, resource: { buffer: this.frame } }],
    });
    this.layouts = {
      backdrop: layout("backdrop", [texture(0, "float"), { binding: 1, visibility: FRAGMENT, sampler: {} }]),
      list: layout("list", [storage(0, "storage"), storage(1, "storage"), storage(2, "storage"), texture(3, "depth")]),
      sort: layout("sort", [
        storage(0, "read-only-storage"),
        storage(1, "read-only-storage"),
        storage(2, "read-only-storage"),
        texture(3),
      ]),
      end: layout("end", [texture(9, "depth")]),
      slots: layout("slots", [storage(8, "storage"), texture(9, "depth")]),
      result: layout("result", [texture(0), texture(1)]),
      present: layout("present", [
        { binding: 0, visibility: FRAGMENT, buffer: { type: "uniform" } },
        texture(1),
        texture(2),
        storage(3, "read-only-storage"),
      ]),
      copy: layout("copy", [texture(1)]),
    };
    this.sampler = device.createSampler({ minFilter: "linear", magFilter: "linear" });
  }

  /** Layout of what pass 1 left, for a method. */
  stateLayout(m) {
    const plan = this.plan(m);
    const key = `state ${plan.targets.length} ${plan.ends} ${plan.slots}`;
    if (!this.layouts[key]) {
      const FRAGMENT = GPUShaderStage.FRAGMENT;
      const entries = plan.targets.map((_, binding) => ({
        binding,
        visibility: FRAGMENT,
        texture: { sampleType: "unfilterable-float" },
      }));
      entries.push(...this.endsEntries(plan));
      if (plan.slots) entries.push({ binding: 8, visibility: FRAGMENT, buffer: { type: "read-only-storage" } });
      this.layouts[key] = this.device.createBindGroupLayout({ label: key, entries });
    }
    return this.layouts[key];
  }

  /** Layout entries of ends that have textures of their own. */
  endsEntries({ ends }) {
    const entry = (binding, sampleType) => ({ binding, visibility: GPUShaderStage.FRAGMENT, texture: { sampleType } });
    if (ends === "depth") return [entry(6, "depth"), entry(7, "depth")];
    return ends === "before" ? [entry(5, "unfilterable-float")] : [];
  }

  /** Layout of the ends alone, for methods whose pass 1 looks at them. */
  endsLayout(plan) {
    const key = `ends ${plan.ends}`;
    this.layouts[key] ??= this.device.createBindGroupLayout({ label: key, entries: this.endsEntries(plan) });
    return this.layouts[key];
  }

  /**
   * How a blended method is laid out here: its targets, number of slots in memory, and where the ends of a pixel are:
   * in the last target, in a target that is drawn before pass 1, or in two depth buffers.
   */
  plan(m) {
    const wide = this.blends32;
    const blended = m.targets.some((t) => t.operation === "max") ? "blended" : "none";
    const ends = !wide && (m.prepass || blended === "blended") ? "depth" : m.prepass ? "before" : blended;
    return { targets: wide ? m.targets : m.half.targets, ends, slots: m.slots ?? 0 };
  }

  /** WGSL of a method's state: textures, the ends, the slots. */
  stateText(m) {
    const plan = this.plan(m);
    let out = plan.targets.map((_, i) => `@group(1) @binding(${i}) var target${i}: texture_2d<f32>;\n`).join("");
    out += this.endsText(plan);
    if (plan.slots) out += "@group(1) @binding(8) var<storage, read> slots: array<u32>;\n";
    return out;
  }

  endsText(plan) {
    let out = "";
    if (plan.ends === "blended" || plan.ends === "before") {
      const texture = plan.ends === "before" ? "ends" : `target${plan.targets.length - 1}`;
      if (plan.ends === "before") out += "@group(1) @binding(5) var ends: texture_2d<f32>;\n";
      out += "fn ends_of(at: vec2<i32>) -> vec2<f32> {\n";
      out += `    return textureLoad(${texture}, at, 0).xy * vec2<f32>(-1.0, 1.0);\n}\n`;
    } else if (plan.ends === "depth") {
      out +=
        "@group(1) @binding(6) var nearest: texture_depth_2d;\n" +
        "@group(1) @binding(7) var farthest: texture_depth_2d;\n" +
        "fn ends_of(at: vec2<i32>) -> vec2<f32> {\n" +
        "    return vec2<f32>(textureLoad(nearest, at, 0), textureLoad(farthest, at, 0)) / frame.depth_scale;\n}\n";
    }
    return out;
  }

  /** Files of a method. */
  async functions(m) {
    let source = await texts(m.functions);
    for (const [word, value] of Object.entries(m.fill ?? {})) source = source.replaceAll(word, value);
    return this.blends32 || !m.rounds ? source : rounded(source, /(const \w*NMT_ROUNDING: f32 = )[^;]+;/);
  }

  /** Compiles WGSL; what the compiler says goes into the errors. */
  async module(label, code) {
    const module = this.device.createShaderModule({ label, code });
    const info = await module.getCompilationInfo?.();
    for (const message of info?.messages ?? []) {
      if (message.type === "error") this.errors.push(`${label}:${message.lineNum}: ${message.message}`);
    }
    return module;
  }

  vertexState(module, kind) {
    const { stride, attributes } = KINDS[kind];
    return {
      module,
      entryPoint: "place",
      buffers: [
        {
          arrayStride: stride,
          stepMode: kind === "splats" ? "instance" : "vertex",
          attributes: attributes.map(([offset, format], shaderLocation) => ({ offset, format, shaderLocation })),
        },
      ],
    };
  }

  async pipeline(key, make) {
    if (!this.pipelines.has(key)) this.pipelines.set(key, make());
    return this.pipelines.get(key);
  }

  render2(label, groups, vertex, fragment, extra = {}) {
    return this.device.createRenderPipelineAsync({
      label,
      layout: this.device.createPipelineLayout({ bindGroupLayouts: groups }),
      vertex,
      fragment,
      ...extra,
    });
  }

  /** Compiles what a method and the present scene need. */
  async prepare(name) {
    const m = method(name);
    const support = this.support(name);
    if (support.reason) throw new Error(`${m.title} ${support.reason}.`);
    const kind = this.scene.transparent.kind;
    return this.pipeline(`${name} ${kind}`, async () => {
      const geometry = `${await text("web/wgsl/frame.wgsl")}\n${await text(`web/wgsl/${kind}.wgsl`)}`;
      const primitive = { topology: { splats: "triangle-strip", fragments: "point-list" }[kind] ?? "triangle-list" };
      const depth = { format: "depth32float", depthWriteEnabled: false, depthCompare: "less-equal" };
      if (m.kind === "lists") return this.prepareLists(geometry, kind, primitive);
      if (m.kind === "objects") {
        const module = await this.module(
          name,
          `${geometry}
@fragment
fn over(f: Varying) -> @location(0) vec4<f32> {
    let found = surface(f);
    if (found.alpha < 0.0) {
        discard;
    }
    return vec4<f32>(found.alpha * found.color, found.alpha);
}`,
        );
        const targets = [{ format: this.color, blend: { color: OVER, alpha: OVER } }];
        return {
          draw: await this.render2(
            name,
            [this.frameLayout],
            this.vertexState(module, kind),
            { module, entryPoint: "over", targets },
            { primitive, depthStencil: depth },
          ),
        };
      }
      return this.prepareBlended(m, geometry, kind, primitive, depth);
    });
  }

  async prepareLists(geometry, kind, primitive) {
    const listing = await this.module("list", `${geometry}\n${await text("web/wgsl/list.wgsl")}`);
    const sorting = await this.module(
      "sort",
      `${await text("web/wgsl/frame.wgsl")}\n${await text("web/wgsl/sort.wgsl")}`,
    );
    return {
      list: await this.render2(
        "list",
        [this.frameLayout, this.layouts.list],
        this.vertexState(listing, kind),
        { module: listing, entryPoint: "list", targets: [] },
        { primitive, depthStencil: { format: "depth32float", depthWriteEnabled: false, depthCompare: "always" } },
      ),
      sort: await this.render2(
        "sort",
        [this.frameLayout, this.layouts.sort],
        { module: sorting, entryPoint: "everywhere" },
        { module: sorting, entryPoint: "composite", targets: [{ format: "rgba32float" }] },
      ),
    };
  }

  async prepareBlended(m, geometry, kind, primitive, depthStencil) {
    const plan = this.plan(m);
    const state = this.stateText(m);
    const layout = this.stateLayout(m);
    const frame = await text("web/wgsl/frame.wgsl");
    const [pass2, resolve] = [await text("web/wgsl/pass2.wgsl"), await text("web/wgsl/resolve.wgsl")];
    const pass1 = await text(plan.slots ? "web/wgsl/pass1-slots.wgsl" : "web/wgsl/pass1.wgsl");
    const prepass = m.prepass ? this.endsText(plan) : "";
    const before = m.prepass ? [this.endsLayout(plan)] : plan.slots ? [this.layouts.slots] : [];
    const first = await this.module(
      `${m.name} pass 1`,
      `${geometry}\n${prepass}${await this.functions(m)}\n${m.accumulate}\n${pass1}`,
    );
    const second = await this.module(
      `${m.name} pass 2`,
      `${geometry}\n${state}${await this.functions(m)}\n${m.accumulate}\n${m.weight}\n${pass2}`,
    );
    const third = await this.module(
      `${m.name} resolve`,
      `${frame}\n${state}${await this.functions(m)}\n${m.total}\n${resolve}`,
    );
    const targets = plan.targets.map((t) => {
      const both = { srcFactor: "one", dstFactor: "one", operation: t.operation };
      return { format: t.format, blend: { color: both, alpha: both } };
    });
    const out = {
      pass1: await this.render2(
        `${m.name} pass 1`,
        [this.frameLayout, ...before],
        this.vertexState(first, kind),
        { module: first, entryPoint: "pass1", targets },
        { primitive, depthStencil },
      ),
      pass2: await this.render2(
        `${m.name} pass 2`,
        [this.frameLayout, layout],
        this.vertexState(second, kind),
        { module: second, entryPoint: "pass2", targets: [{ format: this.color, blend: { color: ADD, alpha: ADD } }] },
        { primitive, depthStencil },
      ),
      resolve: await this.render2(
        `${m.name} resolve`,
        [this.frameLayout, layout, this.layouts.result],
        { module: third, entryPoint: "everywhere" },
        { module: third, entryPoint: "resolve", targets: [{ format: "rgba32float" }] },
      ),
    };
    if (plan.ends === "before") {
      const module = await this.module("ends", `${geometry}\n${await text("web/wgsl/ends.wgsl")}`);
      const both = { srcFactor: "one", dstFactor: "one", operation: "max" };
      const ends = [{ format: "rg32float", blend: { color: both, alpha: both } }];
      out.ends = [
        await this.render2(
          "ends",
          [this.frameLayout],
          this.vertexState(module, kind),
          { module, entryPoint: "ends", targets: ends },
          { primitive, depthStencil },
        ),
      ];
    } else if (plan.ends === "depth") {
      const module = await this.module("end", `${geometry}\n${await text("web/wgsl/end.wgsl")}`);
      out.ends = await Promise.all(
        ["less", "greater"].map((depthCompare) =>
          this.render2(
            `end ${depthCompare}`,
            [this.frameLayout, this.layouts.end],
            this.vertexState(module, kind),
            { module, entryPoint: "end", targets: [] },
            { primitive, depthStencil: { format: "depth32float", depthWriteEnabled: true, depthCompare } },
          ),
        ),
      );
    }
    return out;
  }

  /** Pipelines that every scene needs. */
  async prepareCommon() {
    return this.pipeline("common", async () => {
      const module = await this.module(
        "backdrop",
        `${await text("web/wgsl/frame.wgsl")}\n${await text("web/wgsl/backdrop.wgsl")}`,
      );
      const presenting = await this.module("present", await text("web/wgsl/present.wgsl"));
      const counting = await this.module("statistics", await text("web/wgsl/statistics.wgsl"));
      const copying = await this.module(
        "copy",
        `
@group(0) @binding(1) var image: texture_2d<f32>;
@vertex
fn everywhere(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}
@fragment
fn copy(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return textureLoad(image, vec2<u32>(position.xy), 0);
}`,
      );
      const groups = [this.frameLayout, this.layouts.backdrop];
      const depthStencil = { format: "depth32float", depthWriteEnabled: true, depthCompare: "less" };
      const targets = [{ format: "rgba32float" }];
      const strip = { topology: "triangle-strip" };
      const draw = (label, vertex, entryPoint, extra) =>
        this.render2(label, groups, vertex, { module, entryPoint, targets }, extra);
      const opaque = { ...this.vertexState(module, "triangles"), entryPoint: "opaque_place" };
      const copy = (format) =>
        this.render2(
          "copy",
          [this.layouts.copy],
          { module: copying, entryPoint: "everywhere" },
          { module: copying, entryPoint: "copy", targets: [{ format }] },
        );
      return {
        backdrop: await draw("backdrop", { module, entryPoint: "everywhere" }, "backdrop", {
          depthStencil: { ...depthStencil, depthCompare: "always", depthWriteEnabled: false },
        }),
        floor: await draw("floor", { module, entryPoint: "floor_place" }, "floor_color", {
          primitive: strip,
          depthStencil,
        }),
        opaque: await draw("opaque", opaque, "opaque_color", { depthStencil }),
        present: await this.render2(
          "present",
          [this.layouts.present],
          { module: presenting, entryPoint: "everywhere" },
          { module: presenting, entryPoint: "present", targets: [{ format: this.format }] },
        ),
        copyIn: await copy(this.color),
        copyOut: await copy("rgba32float"),
        statistics: await this.device.createComputePipelineAsync({
          label: "statistics",
          layout: "auto",
          compute: { module: counting, entryPoint: "statistics" },
        }),
      };
    });
  }

  /** Takes a scene; what was there is released. */
  setScene(scene) {
    for (const buffer of this.sceneBuffers ?? []) buffer.destroy();
    this.sceneBuffers = [];
    this.exactKey = null;
    const upload = (data, usage) => {
      const buffer = this.buffer("scene", data.byteLength, usage | GPUBufferUsage.COPY_DST);
      this.device.queue.writeBuffer(buffer, 0, data);
      this.sceneBuffers.push(buffer);
      return buffer;
    };
    const mesh = (geometry) =>
      geometry && {
        vertices: upload(geometry.vertices, GPUBufferUsage.VERTEX),
        indices: geometry.indices && upload(geometry.indices, GPUBufferUsage.INDEX),
      };
    this.scene = scene;
    this.transparent = mesh(scene.transparent);
    this.opaque = mesh(scene.opaque);
    this.bands = 1;
    if (scene.transparent.kind === "splats") this.sorted = upload(scene.transparent.vertices, GPUBufferUsage.VERTEX);
    this.shadow?.destroy();
    const size = scene.floor > 0 ? SHADOW : 1;
    this.shadow = this.device.createTexture({
      label: "shadow",
      size: [size, size],
      format: "rgba8unorm",
      usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST,
    });
    const data = scene.floor > 0 ? shadowOf(scene) : new Uint8Array(4);
    this.device.queue.writeTexture({ texture: this.shadow }, data, { bytesPerRow: 4 * size }, [size, size]);
    this.backdropGroup = this.device.createBindGroup({
      layout: this.layouts.backdrop,
      entries: [
        { binding: 0, resource: this.shadow.createView() },
        { binding: 1, resource: this.sampler },
      ],
    });
  }

  /** Makes textures and lists for an image of this size. */
  resize(width, height) {
    if (this.width === width && this.height === height) return;
    for (const resource of this.sized ?? []) resource.destroy();
    this.sized = [];
    this.exactKey = null;
    [this.width, this.height] = [width, height];
    this.canvas.width = width;
    this.canvas.height = height;
    this.textures = new Map();
    this.groups = new Map();
    this.pixels = this.keep(
      this.buffer(
        "pixels",
        8 * width * height,
        GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST | GPUBufferUsage.COPY_SRC,
      ),
    );
    this.taken = this.keep(
      this.buffer("taken", 16, GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST | GPUBufferUsage.COPY_SRC),
    );
    const most = Math.floor(this.listBytes / NODE_BYTES);
    this.capacity = Math.max(1 << 16, Math.min(this.maxNodes ?? most, most, 64 * width * height));
    if (this.maxNodes) this.capacity = Math.min(this.capacity, this.maxNodes);
    this.nodes = this.keep(
      this.buffer("nodes", NODE_BYTES * this.capacity, GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC),
    );
    this.bands = 1;
    const workgroups = Math.ceil(width / 16) * Math.ceil(height / 16);
    this.results = this.keep(this.buffer("results", 32 * workgroups, GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC));
  }

  keep(resource) {
    this.sized.push(resource);
    return resource;
  }

  texture(
    name,
    format,
    usage = GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_SRC,
  ) {
    const key = `${name} ${format}`;
    if (!this.textures.has(key)) {
      const texture = this.keep(
        this.device.createTexture({ label: name, size: [this.width, this.height], format, usage }),
      );
      this.textures.set(key, { texture, view: texture.createView() });
    }
    return this.textures.get(key).view;
  }

  group(layout, entries) {
    const resource = (r) => (r instanceof GPUBuffer ? { buffer: r } : r);
    return this.device.createBindGroup({
      layout,
      entries: entries.map(([binding, r]) => ({ binding, resource: resource(r) })),
    });
  }

  drawTransparent(pass, ordered) {
    const { transparent: geometry } = this.scene;
    const sorted = ordered && geometry.kind === "splats";
    pass.setVertexBuffer(0, sorted ? this.sorted : this.transparent.vertices);
    if (geometry.kind === "splats") return void pass.draw(4, geometry.count);
    if (geometry.kind === "fragments") return void pass.draw(geometry.count);
    pass.setIndexBuffer(this.transparent.indices, "uint32");
    if (!ordered) return void pass.drawIndexed(geometry.indices.length);
    for (const g of farToNear(geometry, this.view)) pass.drawIndexed(g.count, 1, g.first);
  }

  drawOpaque(encoder, common) {
    const pass = encoder.beginRenderPass({
      label: "opaque",
      colorAttachments: [{ view: this.texture("background", "rgba32float"), loadOp: "clear", storeOp: "store" }],
      depthStencilAttachment: {
        view: this.texture("depth", "depth32float"),
        depthLoadOp: "clear",
        depthStoreOp: "store",
        depthClearValue: 1,
      },
    });
    pass.setBindGroup(0, this.frameGroup);
    pass.setBindGroup(1, this.backdropGroup);
    pass.setPipeline(common.backdrop);
    pass.draw(3);
    if (this.scene.floor > 0 && !this.options.backdrop) {
      pass.setPipeline(common.floor);
      pass.draw(4);
    }
    if (this.opaque && !this.options.transparentOnly) {
      pass.setPipeline(common.opaque);
      pass.setVertexBuffer(0, this.opaque.vertices);
      pass.setIndexBuffer(this.opaque.indices, "uint32");
      pass.drawIndexed(this.scene.opaque.indices.length);
    }
    pass.end();
  }

  /** Timestamps of the first and the last of so many passes. */
  times(first, last, at) {
    if (!this.timed || !(first || last)) return {};
    const writes = { querySet: this.queries };
    if (first) writes.beginningOfPassWriteIndex = at;
    if (last) writes.endOfPassWriteIndex = at + 1;
    return { timestampWrites: writes };
  }

  get readOnlyDepth() {
    return { view: this.texture("depth", "depth32float"), depthReadOnly: true };
  }

  drawExact(encoder, pipelines) {
    encoder.clearBuffer(this.pixels);
    for (let band = 0; band < this.bands; band++) {
      const y0 = Math.floor((this.height * band) / this.bands);
      const y1 = Math.floor((this.height * (band + 1)) / this.bands);
      if (y1 === y0) continue;
      encoder.clearBuffer(this.taken);
      const listing = encoder.beginRenderPass({
        label: "list",
        colorAttachments: [],
        depthStencilAttachment: this.readOnlyDepth,
        ...this.times(band === 0, false, 2),
      });
      listing.setScissorRect(0, y0, this.width, y1 - y0);
      listing.setPipeline(pipelines.list);
      listing.setBindGroup(0, this.frameGroup);
      listing.setBindGroup(
        1,
        this.group(this.layouts.list, [
          [0, this.taken],
          [1, this.pixels],
          [2, this.nodes],
          [3, this.texture("depth", "depth32float")],
        ]),
      );
      this.drawTransparent(listing);
      listing.end();
      const sorting = encoder.beginRenderPass({
        label: "sort",
        colorAttachments: [
          { view: this.texture("exact", "rgba32float"), loadOp: band ? "load" : "clear", storeOp: "store" },
        ],
        ...this.times(false, band === this.bands - 1, 2),
      });
      sorting.setScissorRect(0, y0, this.width, y1 - y0);
      sorting.setPipeline(pipelines.sort);
      sorting.setBindGroup(0, this.frameGroup);
      sorting.setBindGroup(
        1,
        this.group(this.layouts.sort, [
          [0, this.taken],
          [1, this.pixels],
          [2, this.nodes],
          [3, this.texture("background", "rgba32float")],
        ]),
      );
      sorting.draw(3);
      sorting.end();
      if (this.takenLog) encoder.copyBufferToBuffer(this.taken, 0, this.takenLog, 4 * band, 4);
    }
  }

  drawObjects(encoder, common, pipelines) {
    if (this.scene.transparent.kind === "splats") {
      this.device.queue.writeBuffer(this.sorted, 0, sortedSplats(this.scene.transparent, this.view));
    }
    const color = this.texture("over", this.color);
    const blit = (label, pipeline, from, to, times) => {
      const pass = encoder.beginRenderPass({
        label,
        colorAttachments: [{ view: to, loadOp: "clear", storeOp: "store" }],
        ...times,
      });
      pass.setPipeline(pipeline);
      pass.setBindGroup(0, this.group(this.layouts.copy, [[1, from]]));
      pass.draw(3);
      pass.end();
    };
    blit("copy in", common.copyIn, this.texture("background", "rgba32float"), color, this.times(true, false, 0));
    const pass = encoder.beginRenderPass({
      label: "objects",
      colorAttachments: [{ view: color, loadOp: "load", storeOp: "store" }],
      depthStencilAttachment: this.readOnlyDepth,
    });
    pass.setPipeline(pipelines.draw);
    pass.setBindGroup(0, this.frameGroup);
    this.drawTransparent(pass, true);
    pass.end();
    blit("copy out", common.copyOut, color, this.texture("method", "rgba32float"), this.times(false, true, 0));
  }

  /** Draws ends that have textures of their own; answers their bindings. */
  drawEnds(encoder, plan, pipelines, begin) {
    if (plan.ends === "before") {
      const view = this.texture("ends", "rg32float");
      const pass = encoder.beginRenderPass({
        label: "ends",
        colorAttachments: [{ view, loadOp: "clear", storeOp: "store", clearValue: [-3e38, -3e38, 0, 0] }],
        depthStencilAttachment: this.readOnlyDepth,
        ...begin(),
      });
      pass.setPipeline(pipelines.ends[0]);
      pass.setBindGroup(0, this.frameGroup);
      this.drawTransparent(pass);
      pass.end();
      return [[5, view]];
    }
    if (plan.ends !== "depth") return [];
    return ["nearest", "farthest"].map((name, i) => {
      const view = this.texture(name, "depth32float");
      const pass = encoder.beginRenderPass({
        label: name,
        colorAttachments: [],
        depthStencilAttachment: { view, depthLoadOp: "clear", depthStoreOp: "store", depthClearValue: 1 - i },
        ...begin(),
      });
      pass.setPipeline(pipelines.ends[i]);
      pass.setBindGroup(0, this.frameGroup);
      pass.setBindGroup(1, this.group(this.layouts.end, [[9, this.texture("depth", "depth32float")]]));
      this.drawTransparent(pass);
      pass.end();
      return [6 + i, view];
    });
  }

  drawBlended(encoder, m, pipelines) {
    const plan = this.plan(m);
    let slots = null;
    if (plan.slots) {
      const key = `slots ${plan.slots}`;
      if (!this.groups.has(key)) {
        const bytes = 4 * plan.slots * this.width * this.height;
        this.groups.set(key, this.keep(this.buffer("slots", bytes, GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST)));
      }
      slots = this.groups.get(key);
      encoder.clearBuffer(slots);
    }
    let begun = false;
    const begin = () => {
      const times = this.times(!begun, false, 0);
      begun = true;
      return times;
    };
    const ends = this.drawEnds(encoder, plan, pipelines, begin);
    const views = plan.targets.map((t, i) => this.texture(`target ${i}`, t.format));
    const first = encoder.beginRenderPass({
      label: "pass 1",
      colorAttachments: views.map((view, i) => ({
        view,
        loadOp: "clear",
        storeOp: "store",
        clearValue: plan.targets[i].clear,
      })),
      depthStencilAttachment: this.readOnlyDepth,
      ...begin(),
    });
    first.setPipeline(pipelines.pass1);
    first.setBindGroup(0, this.frameGroup);
    if (slots) {
      const depth = this.texture("depth", "depth32float");
      first.setBindGroup(
        1,
        this.group(this.layouts.slots, [
          [8, slots],
          [9, depth],
        ]),
      );
    }
    if (m.prepass) first.setBindGroup(1, this.group(this.endsLayout(plan), ends));
    this.drawTransparent(first);
    first.end();
    const state = [...views.map((view, i) => [i, view]), ...ends];
    if (slots) state.push([8, slots]);
    const stateGroup = this.group(this.stateLayout(m), state);
    const weighted = this.texture("weighted", this.color);
    const second = encoder.beginRenderPass({
      label: "pass 2",
      colorAttachments: [{ view: weighted, loadOp: "clear", storeOp: "store" }],
      depthStencilAttachment: this.readOnlyDepth,
    });
    second.setPipeline(pipelines.pass2);
    second.setBindGroup(0, this.frameGroup);
    second.setBindGroup(1, stateGroup);
    this.drawTransparent(second);
    second.end();
    const third = encoder.beginRenderPass({
      label: "resolve",
      colorAttachments: [{ view: this.texture("method", "rgba32float"), loadOp: "clear", storeOp: "store" }],
      ...this.times(false, true, 0),
    });
    third.setPipeline(pipelines.resolve);
    third.setBindGroup(0, this.frameGroup);
    third.setBindGroup(1, stateGroup);
    third.setBindGroup(
      2,
      this.group(this.layouts.result, [
        [0, weighted],
        [1, this.texture("background", "rgba32float")],
      ]),
    );
    third.draw(3);
    third.end();
  }

  /**
   * Draws a frame.
   *
   * `options`: camera, method, mode ("image", "split", "error", "count"), split in [0, 1], scale of the colours,
   * measure (whether to compare with the exact image), opacity, backdrop (linear colour or nothing for the studio),
   * oneColor, transparentOnly. Resolves, where `measure` is on, to { mse, worst, fragments, most, covered, overflow,
   * seconds, exactSeconds }.
   */
  async draw(options) {
    this.options = options;
    const common = await this.prepareCommon();
    const exactNeeded = options.measure || options.mode !== "image" || options.method === "exact";
    const m = method(options.method);
    const pipelines = await this.prepare(options.method);
    const lists = exactNeeded ? await this.prepare("exact") : null;
    const { device, width, height } = this;
    this.view = viewOf(options.camera, this.scene.transparent, width, height, false);
    frameData((this.frameFloats ??= new Float32Array(FRAME_FLOATS)), this.view, width, height, this.scene, options, {
      firstRow: 0,
      capacity: this.capacity,
    });
    device.queue.writeBuffer(this.frame, 0, this.frameFloats);
    const modes = { image: 0, split: 1, error: 2, count: 3 };
    const data = new ArrayBuffer(16);
    new Uint32Array(data)[0] = modes[options.mode];
    new Float32Array(data).set([(options.split ?? 0.5) * width, options.scale ?? 0.1], 1);
    new Uint32Array(data)[3] = width;
    device.queue.writeBuffer(this.viewData, 0, data);

    const encoder = device.createCommandEncoder();
    if (options.measure && !this.takenLog)
      this.takenLog = this.buffer("log", 4 * MAX_BANDS, GPUBufferUsage.COPY_DST | GPUBufferUsage.COPY_SRC);
    this.drawOpaque(encoder, common);
    // While neither view nor scene changes, the exact image stays what it is.
    const key = exactKey(this, options);
    if (exactNeeded && this.exactKey !== key) this.drawExact(encoder, lists);
    if (exactNeeded) this.exactKey = key;
    if (m.kind === "objects") this.drawObjects(encoder, common, pipelines);
    if (m.kind === "blended") this.drawBlended(encoder, m, pipelines);
    const exact = exactNeeded ? this.texture("exact", "rgba32float") : null;
    const image = m.kind === "lists" ? exact : this.texture("method", "rgba32float");
    this.lastImage = m.kind === "lists" ? "exact" : "method";
    let staging = null;
    if (options.measure) staging = this.measure(encoder, common, image, exact);
    const pass = encoder.beginRenderPass({
      label: "present",
      colorAttachments: [{ view: this.context.getCurrentTexture().createView(), loadOp: "clear", storeOp: "store" }],
    });
    pass.setPipeline(common.present);
    pass.setBindGroup(
      0,
      this.group(this.layouts.present, [
        [0, this.viewData],
        [1, image],
        [2, exact ?? image],
        [3, this.pixels],
      ]),
    );
    pass.draw(3);
    pass.end();
    device.queue.submit([encoder.finish()]);
    if (!staging) return null;
    const found = await this.readStatistics(staging, m.kind === "lists");
    if (found.overflow && this.bands < MAX_BANDS) {
      // What does not fit at once is listed in bands.
      this.bands = Math.min(MAX_BANDS, this.bands * 2);
      this.exactKey = null;
      return this.draw(options);
    }
    return found;
  }

  measure(encoder, common, image, exact) {
    const pass = encoder.beginComputePass({ label: "statistics" });
    pass.setPipeline(common.statistics);
    pass.setBindGroup(
      0,
      this.group(common.statistics.getBindGroupLayout(0), [
        [0, image],
        [1, exact],
        [2, this.pixels],
        [3, this.results],
      ]),
    );
    pass.dispatchWorkgroups(Math.ceil(this.width / 16), Math.ceil(this.height / 16));
    pass.end();
    const bytes = this.results.size;
    const staging = this.buffer(
      "staging",
      bytes + 4 * MAX_BANDS + 32,
      GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST,
    );
    encoder.copyBufferToBuffer(this.results, 0, staging, 0, bytes);
    encoder.copyBufferToBuffer(this.takenLog, 0, staging, bytes, 4 * MAX_BANDS);
    if (this.timed) {
      encoder.resolveQuerySet(this.queries, 0, 4, this.queryBuffer, 0);
      encoder.copyBufferToBuffer(this.queryBuffer, 0, staging, bytes + 4 * MAX_BANDS, 32);
    }
    return staging;
  }

  async readStatistics(staging, isExact) {
    const bytes = this.results.size;
    const { bands, capacity } = this;
    const values = 3 * this.width * this.height;
    await staging.mapAsync(GPUMapMode.READ);
    const data = staging.getMappedRange();
    const rows = new Float32Array(data, 0, bytes / 4);
    const found = { mse: 0, worst: 0, fragments: 0, most: 0, covered: 0 };
    for (let i = 0; i < rows.length; i += 8) {
      found.mse += rows[i] / values;
      found.worst = Math.max(found.worst, rows[i + 1]);
      found.fragments += rows[i + 2];
      found.most = Math.max(found.most, rows[i + 3]);
      found.covered += rows[i + 4];
    }
    const taken = new Uint32Array(data, bytes, bands);
    found.overflow = taken.some((n) => n > capacity);
    found.bands = bands;
    if (this.timed) {
      const [a, b, c, d] = new BigUint64Array(data.slice(bytes + 4 * MAX_BANDS));
      const seconds = (from, to) => (to > from ? Number(to - from) * 1e-9 : null);
      found.exactSeconds = seconds(c, d);
      found.seconds = isExact ? found.exactSeconds : seconds(a, b);
    }
    staging.unmap();
    staging.destroy();
    return found;
  }

  /** Linear colours of the last frame, three a pixel, rows from the top: "method" as it was drawn, or "exact". */
  async readImage(which = this.lastImage) {
    const { texture } = this.textures.get(`${which} rgba32float`);
    const stride = Math.ceil((16 * this.width) / 256) * 256;
    const staging = this.buffer("image", stride * this.height, GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST);
    const encoder = this.device.createCommandEncoder();
    encoder.copyTextureToBuffer({ texture }, { buffer: staging, bytesPerRow: stride }, [this.width, this.height]);
    this.device.queue.submit([encoder.finish()]);
    await staging.mapAsync(GPUMapMode.READ);
    const rows = new Float32Array(staging.getMappedRange());
    const out = new Float32Array(3 * this.width * this.height);
    for (let y = 0; y < this.height; y++) {
      for (let x = 0; x < this.width; x++) {
        for (let c = 0; c < 3; c++) out[3 * (y * this.width + x) + c] = rows[(y * stride) / 4 + 4 * x + c];
      }
    }
    staging.destroy();
    return out;
  }

  /** The fragments of the last exact frame: { offsets, view_z, alpha, color, width, height, near, far, range }. */
  async fragments() {
    if (this.bands > 1)
      throw new Error("The frame has more fragments than the lists hold at once; make the window smaller.");
    const { width, height } = this;
    const bytes = [8 * width * height, 16, NODE_BYTES * this.capacity];
    const sources = [this.pixels, this.taken];
    const encoder = this.device.createCommandEncoder();
    const stagings = sources.map((source, i) => {
      const staging = this.buffer("fragments", bytes[i], GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST);
      encoder.copyBufferToBuffer(source, 0, staging, 0, bytes[i]);
      return staging;
    });
    this.device.queue.submit([encoder.finish()]);
    await Promise.all(stagings.map((s) => s.mapAsync(GPUMapMode.READ)));
    const [pixels, taken] = stagings.map((s) => new Uint32Array(s.getMappedRange().slice(0)));
    const count = Math.min(taken[0], this.capacity);
    if (taken[0] > this.capacity)
      throw new Error("The frame has more fragments than the lists hold; make the window smaller.");
    const staging = this.buffer("nodes", NODE_BYTES * count, GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST);
    const again = this.device.createCommandEncoder();
    if (count) again.copyBufferToBuffer(this.nodes, 0, staging, 0, NODE_BYTES * count);
    this.device.queue.submit([again.finish()]);
    await staging.mapAsync(GPUMapMode.READ);
    const words = new Uint32Array(staging.getMappedRange().slice(0));
    const floats = new Float32Array(words.buffer);
    [...stagings, staging].forEach((s) => s.destroy());
    const offsets = new Uint32Array(width * height + 1);
    const [viewZ, alpha, color] = [new Float32Array(count), new Float32Array(count), new Float32Array(3 * count)];
    let k = 0;
    for (let p = 0; p < width * height; p++) {
      // A list holds the last fragment first; among fragments of one depth the exact image takes the first first.
      k += pixels[2 * p + 1];
      offsets[p + 1] = k;
      let to = k;
      for (let node = pixels[2 * p]; node !== 0; node = words[5 * (node - 1)]) {
        const i = 5 * (node - 1);
        to -= 1;
        viewZ[to] = floats[i + 1];
        alpha[to] = floats[i + 2];
        color.set(
          [words[i + 3] & 65535, words[i + 3] >>> 16, words[i + 4] & 65535].map((x) => x / 65535),
          3 * to,
        );
      }
    }
    return { offsets, view_z: viewZ, alpha, color, width, height, near: NEAR, far: FAR, range: this.view.range };
  }

  /** Releases the device. */
  destroy() {
    this.device.destroy();
  }
}
