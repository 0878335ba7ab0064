// The scene by WebGL 2: exact images by depth peeling, sorted objects, and the methods that only blend.

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
import { GL_METHODS } from "./methods-gl.js";
import { method } from "./methods.js";
import { text, texts } from "./text.js";

const PASSES = [
  "COUNT",
  "PEEL",
  "LAYER",
  "UNDER",
  "OVER",
  "COPY",
  "ENDS",
  "END_DEPTH",
  "FIRST",
  "SECOND",
  "RESOLVE",
  "PRESENT",
];
/** Layers that an exact image is peeled into; what lies deeper is left out, and said. */
const MAX_LAYERS = 256;

const FORMATS = {
  rgba32f: ["RGBA32F", "RGBA", "FLOAT"],
  rg32f: ["RG32F", "RG", "FLOAT"],
  r32f: ["R32F", "RED", "FLOAT"],
  rgba16f: ["RGBA16F", "RGBA", "HALF_FLOAT"],
  rg16f: ["RG16F", "RG", "HALF_FLOAT"],
  r16f: ["R16F", "RED", "HALF_FLOAT"],
  depth: ["DEPTH_COMPONENT32F", "DEPTH_COMPONENT", "FLOAT"],
};
const TYPES = {
  float32: [1, "FLOAT", false],
  float32x3: [3, "FLOAT", false],
  float32x4: [4, "FLOAT", false],
  snorm8x4: [4, "BYTE", true],
  unorm8x4: [4, "UNSIGNED_BYTE", true],
  uint32: [1, "UNSIGNED_INT", false],
};

export class WebGlRenderer {
  /** Opens WebGL 2; `without` names extensions to do without. Throws where there is none. */
  static create(canvas, { without = new Set() } = {}) {
    const gl = canvas.getContext("webgl2", {
      antialias: false,
      alpha: false,
      preserveDrawingBuffer: true,
      powerPreference: "high-performance",
    });
    if (!gl || without.has("webgl2")) {
      throw new Error(
        "This browser has neither WebGPU nor WebGL 2. A current Chrome, Edge, Safari or Firefox has both.",
      );
    }
    const has = (name) => !without.has(name) && gl.getExtension(name);
    if (!has("EXT_color_buffer_float")) {
      throw new Error(
        "This device's WebGL 2 does not draw into float textures (EXT_color_buffer_float), " +
          "which every method here needs.",
      );
    }
    return new WebGlRenderer(canvas, gl, has);
  }

  constructor(canvas, gl, has) {
    this.api = "WebGL 2";
    this.canvas = canvas;
    this.gl = gl;
    this.blends32 = !!has("EXT_float_blend");
    this.indexed = has("OES_draw_buffers_indexed");
    this.timer = has("EXT_disjoint_timer_query_webgl2");
    const info = gl.getExtension("WEBGL_debug_renderer_info");
    const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
    this.software = /swiftshader|llvmpipe|software|basic render/i.test(name);
    // ANGLE (vendor, device and driver, API)
    this.adapter = /^ANGLE \([^,]+, (.+?)(?: \(0x[0-9a-f]+\)|\), |, |\)$)/i.exec(name)?.[1] ?? name;
    this.errors = [];
    this.programs = new Map();
    this.frame = gl.createBuffer();
    this.empty = gl.createVertexArray();
    this.color = this.blends32 ? "rgba32f" : "rgba16f";
    this.lost = new Promise((resolve) =>
      canvas.addEventListener("webglcontextlost", () => resolve({ reason: "lost", message: "" })),
    );
  }

  get notes() {
    const notes = [];
    if (!this.blends32) {
      notes.push(
        "This device cannot blend 32-bit float targets (EXT_float_blend): networks keep their sums in 16 bits " +
          "and both ends in depth buffers, and MBOIT is left out.",
      );
    } else if (!this.indexed) {
      notes.push(
        "This device has one blend equation for all targets (no OES_draw_buffers_indexed): both ends are drawn in " +
          "a pass of their own.",
      );
    }
    if (!this.timer) notes.push("This browser gives no GPU times (EXT_disjoint_timer_query_webgl2).");
    if (this.software) notes.push("WebGL is drawn on the CPU here: its times are not those of a graphics card.");
    return notes;
  }

  support(name) {
    const [m, gl] = [method(name), GL_METHODS[name]];
    if (!gl) return { reason: "stores single fragments by atomics, which WebGL 2 has not" };
    if (m.kind === "objects" && this.scene?.transparent.kind === "fragments")
      return { reason: "a fragment list has no objects to sort" };
    if (m.kind === "blended" && !this.blends32) {
      return gl.half
        ? { bits: m.half.bits }
        : { reason: "needs blending into 32-bit float targets (EXT_float_blend), which this device lacks" };
    }
    return { bits: m.bits };
  }

  // --- Programs ----------------------------------------------------------------------------------------------------

  shader(type, source, label) {
    const { gl } = this;
    const shader = gl.createShader(type);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) {
      const log = gl.getShaderInfoLog(shader);
      this.errors.push(`${label}: ${log}`);
      throw new Error(`The shader of ${label} was refused: ${log}`);
    }
    return shader;
  }

  link(label, vertex, fragment) {
    const { gl } = this;
    const program = gl.createProgram();
    gl.attachShader(program, this.shader(gl.VERTEX_SHADER, vertex, label));
    gl.attachShader(program, this.shader(gl.FRAGMENT_SHADER, fragment, label));
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
      this.errors.push(`${label}: ${gl.getProgramInfoLog(program)}`);
      throw new Error(`The program of ${label} was refused: ${gl.getProgramInfoLog(program)}`);
    }
    const block = gl.getUniformBlockIndex(program, "Frame");
    if (block !== gl.INVALID_INDEX) gl.uniformBlockBinding(program, block, 0);
    return program;
  }

  /** A program of a pass: over the whole image, or of the scene's geometry; `method` gives it a method's functions. */
  async program(pass, { kind = null, name = null, part = 0 } = {}) {
    const key = `${pass} ${kind} ${name} ${part}`;
    if (!this.programs.has(key)) {
      this.programs.set(
        key,
        (async () => {
          const m = name ? GL_METHODS[name] : null;
          const head = (stage) =>
            "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n" +
            `#define ${stage}\n#define PART ${part}\n${PASSES.map((p, i) => `#define ${p} ${i}\n`).join("")}` +
            `#define PASS ${PASSES.indexOf(pass)}\n`;
          const frame = await text("web/glsl/frame.glsl");
          if (pass === "BACKDROP") {
            const source = `${frame}\n${await text("web/glsl/backdrop.glsl")}`;
            const vertex = part === 0 ? await text("web/glsl/everywhere.glsl") : source;
            return this.link(key, head("VERTEX") + vertex, head("FRAGMENT") + source);
          }
          const geometry = kind ? await text(`web/glsl/${kind}.glsl`) : "";
          const vertex = kind ? `${frame}\n${geometry}` : await text("web/glsl/everywhere.glsl");
          let functions = "";
          if (m?.functions) {
            functions = await texts(m.functions);
            if (!this.blends32)
              functions = functions.replace(/(const float \w*NMT_ROUNDING = )[^;]+;/, "$19.765625e-4;");
            if (pass === "ENDS") functions += m.writtenEnds;
            else if (pass === "FIRST") functions += (m.prepass ? this.endsText(m) : "") + m.accumulate;
            else functions += this.stateText(m) + (pass === "SECOND" ? m.weight : m.total);
          }
          if (pass === "ENDS" && !m) functions = "vec2 written_ends(Surface s) {\n    return vec2(-s.v, s.v);\n}\n";
          const source = `${frame}\n${geometry}\n${functions}\n${await text("web/glsl/passes.glsl")}`;
          return this.link(key, head("VERTEX") + vertex, head("FRAGMENT") + source);
        })(),
      );
    }
    return this.programs.get(key);
  }

  stateText(m) {
    let out = m.formats.map((_, i) => `uniform sampler2D target${i};\n`).join("");
    return out + this.endsText(m);
  }

  endsText(m) {
    let out = "";
    if (m.ends && this.blends32) {
      out +=
        "uniform sampler2D ends;\n" +
        "vec2 ends_of(ivec2 at) {\n    return texelFetch(ends, at, 0).xy * vec2(-1.0, 1.0);\n}\n";
    } else if (m.ends) {
      out +=
        "uniform sampler2D nearest;\nuniform sampler2D farthest;\nvec2 ends_of(ivec2 at) {\n" +
        "    return vec2(texelFetch(nearest, at, 0).x, texelFetch(farthest, at, 0).x) / frame.depth_scale;\n}\n";
    }
    return out;
  }

  // --- Scene and targets -------------------------------------------------------------------------------------------

  setScene(scene) {
    const { gl } = this;
    for (const buffer of this.sceneBuffers ?? []) gl.deleteBuffer(buffer);
    for (const array of this.arrays ?? []) gl.deleteVertexArray(array);
    this.sceneBuffers = [];
    this.exactKey = null;
    this.arrays = [];
    const mesh = (geometry) => {
      if (!geometry) return null;
      const array = gl.createVertexArray();
      gl.bindVertexArray(array);
      const vertices = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, vertices);
      gl.bufferData(gl.ARRAY_BUFFER, geometry.vertices, gl.STATIC_DRAW);
      const { stride, attributes } = KINDS[geometry.kind];
      attributes.forEach(([offset, format], location) => {
        const [size, type, normalized] = TYPES[format];
        gl.enableVertexAttribArray(location);
        if (format === "uint32") gl.vertexAttribIPointer(location, size, gl[type], stride, offset);
        else gl.vertexAttribPointer(location, size, gl[type], normalized, stride, offset);
        if (geometry.kind === "splats") gl.vertexAttribDivisor(location, 1);
      });
      this.sceneBuffers.push(vertices);
      this.arrays.push(array);
      if (geometry.indices) {
        const indices = gl.createBuffer();
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices);
        gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, geometry.indices, gl.STATIC_DRAW);
        this.sceneBuffers.push(indices);
      }
      gl.bindVertexArray(null);
      return { array, vertices };
    };
    this.scene = scene;
    this.transparent = mesh(scene.transparent);
    this.opaque = mesh(scene.opaque);
    if (this.shadow) gl.deleteTexture(this.shadow);
    this.shadow = gl.createTexture();
    const size = scene.floor > 0 ? SHADOW : 1;
    gl.bindTexture(gl.TEXTURE_2D, this.shadow);
    gl.texImage2D(
      gl.TEXTURE_2D,
      0,
      gl.RGBA8,
      size,
      size,
      0,
      gl.RGBA,
      gl.UNSIGNED_BYTE,
      scene.floor > 0 ? shadowOf(scene) : new Uint8Array(4),
    );
    for (const [name, value] of [
      ["MIN_FILTER", "LINEAR"],
      ["MAG_FILTER", "LINEAR"],
      ["WRAP_S", "CLAMP_TO_EDGE"],
      ["WRAP_T", "CLAMP_TO_EDGE"],
    ]) {
      gl.texParameteri(gl.TEXTURE_2D, gl[`TEXTURE_${name}`], gl[value]);
    }
  }

  resize(width, height) {
    if (this.width === width && this.height === height) return;
    const { gl } = this;
    for (const texture of this.textures?.values() ?? []) gl.deleteTexture(texture);
    for (const framebuffer of this.framebuffers?.values() ?? []) gl.deleteFramebuffer(framebuffer);
    this.textures = new Map();
    this.exactKey = null;
    this.framebuffers = new Map();
    [this.width, this.height] = [width, height];
    this.canvas.width = width;
    this.canvas.height = height;
  }

  texture(name, format) {
    const key = `${name} ${format}`;
    const { gl } = this;
    if (!this.textures.has(key)) {
      const [internal] = FORMATS[format];
      const texture = gl.createTexture();
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texStorage2D(gl.TEXTURE_2D, 1, gl[internal], this.width, this.height);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
      this.textures.set(key, texture);
    }
    return this.textures.get(key);
  }

  /** Draws go into these colours [name, format] and this depth texture. */
  into(colors, depth = null) {
    const { gl } = this;
    const key = JSON.stringify([colors, depth]);
    if (!this.framebuffers.has(key)) {
      const framebuffer = gl.createFramebuffer();
      gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
      colors.forEach(([name, format], i) => {
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + i, gl.TEXTURE_2D, this.texture(name, format), 0);
      });
      if (depth)
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.texture(depth, "depth"), 0);
      gl.drawBuffers(colors.length ? colors.map((_, i) => gl.COLOR_ATTACHMENT0 + i) : [gl.NONE]);
      const status = gl.checkFramebufferStatus(gl.FRAMEBUFFER);
      if (status !== gl.FRAMEBUFFER_COMPLETE) throw new Error(`Targets ${key} are refused (0x${status.toString(16)}).`);
      this.framebuffers.set(key, framebuffer);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.framebuffers.get(key));
    gl.viewport(0, 0, this.width, this.height);
  }

  clear(index, values) {
    this.gl.clearBufferfv(this.gl.COLOR, index, values);
  }

  /** Depth test against opaque surfaces without writing; blending as given, or none. */
  state({ blend = null, depth = "LEQUAL", write = false } = {}) {
    const { gl } = this;
    if (depth) {
      gl.enable(gl.DEPTH_TEST);
      gl.depthFunc(gl[depth]);
    } else gl.disable(gl.DEPTH_TEST);
    gl.depthMask(write);
    if (blend) {
      gl.enable(gl.BLEND);
      gl.blendEquation(gl[blend.equation ?? "FUNC_ADD"]);
      gl.blendFuncSeparate(...(blend.factors ?? ["ONE", "ONE", "ONE", "ONE"]).map((f) => gl[f]));
    } else gl.disable(gl.BLEND);
  }

  use(program, textures = {}) {
    const { gl } = this;
    gl.useProgram(program);
    Object.entries(textures).forEach(([name, texture], unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.uniform1i(gl.getUniformLocation(program, name), unit);
    });
  }

  everywhere() {
    const { gl } = this;
    gl.bindVertexArray(this.empty);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  drawTransparent(ordered) {
    const { gl } = this;
    const { transparent: geometry } = this.scene;
    gl.bindVertexArray(this.transparent.array);
    if (geometry.kind === "splats") {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.transparent.vertices);
      if (ordered) gl.bufferData(gl.ARRAY_BUFFER, sortedSplats(geometry, this.view), gl.STREAM_DRAW);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, geometry.count);
    } else if (geometry.kind === "fragments") {
      gl.drawArrays(gl.POINTS, 0, geometry.count);
    } else if (!ordered) {
      gl.drawElements(gl.TRIANGLES, geometry.indices.length, gl.UNSIGNED_INT, 0);
    } else {
      for (const g of farToNear(geometry, this.view))
        gl.drawElements(gl.TRIANGLES, g.count, gl.UNSIGNED_INT, 4 * g.first);
    }
  }

  // --- Passes ------------------------------------------------------------------------------------------------------

  async drawOpaque() {
    const { gl } = this;
    const programs = await Promise.all([0, 1, 2].map((part) => this.program("BACKDROP", { part })));
    this.into([["background", "rgba32f"]], "depth");
    this.state({ depth: "ALWAYS", write: true });
    gl.clearBufferfv(gl.DEPTH, 0, [1]);
    gl.depthMask(false);
    this.use(programs[0]);
    this.everywhere();
    this.state({ depth: "LESS", write: true });
    if (this.scene.floor > 0 && !this.options.backdrop) {
      this.use(programs[1], { shadow: this.shadow });
      gl.bindVertexArray(this.empty);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    }
    if (this.opaque && !this.options.transparentOnly) {
      this.use(programs[2]);
      gl.bindVertexArray(this.opaque.array);
      gl.drawElements(gl.TRIANGLES, this.scene.opaque.indices.length, gl.UNSIGNED_INT, 0);
    }
  }

  /** Counts fragments and peels layer after layer; `sink` takes every layer's colours and depths. */
  async drawExact(sink = null) {
    const { gl } = this;
    const { kind } = this.scene.transparent;
    const [count, peel, layer, under] = await Promise.all([
      this.program("COUNT", { kind }),
      this.program("PEEL", { kind }),
      this.program("LAYER"),
      this.program("UNDER"),
    ]);
    this.into([["counts", "r16f"]], "depth");
    this.clear(0, [0, 0, 0, 0]);
    this.state({ blend: {} });
    this.use(count);
    this.drawTransparent();
    const counts = this.read([["counts", "r16f"]], 0);
    this.counts = Float32Array.from({ length: this.width * this.height }, (_, i) => counts[4 * i]);
    this.most = this.counts.reduce((a, b) => Math.max(a, b), 0);
    this.into([["layers", this.color]]);
    this.clear(0, [0, 0, 0, 1]);
    this.into([["before 1", "r32f"]]);
    this.clear(0, [-1, 0, 0, 0]);
    for (let i = 0; i < Math.min(this.most, MAX_LAYERS); i++) {
      const now = [
        ["layer", "rgba32f"],
        [`before ${i & 1}`, "r32f"],
      ];
      this.into(now, "peeled");
      this.state({ depth: "LESS", write: true });
      this.clear(0, [0, 0, 0, 0]);
      this.clear(1, [3e38, 0, 0, 0]);
      gl.clearBufferfv(gl.DEPTH, 0, [1]);
      this.use(peel, {
        layer_before: this.texture(`before ${1 - (i & 1)}`, "r32f"),
        opaque_depth: this.texture("depth", "depth"),
      });
      this.drawTransparent();
      sink?.(this.read(now, 0), this.read(now, 1));
      this.into([["layers", this.color]]);
      this.state({ depth: null, blend: { factors: ["DST_ALPHA", "ONE", "ZERO", "ONE_MINUS_SRC_ALPHA"] } });
      this.use(layer, { layer: this.texture("layer", "rgba32f") });
      this.everywhere();
      // A long list must not keep the browser from answering.
      if (i % 16 === 15) await new Promise((resolve) => setTimeout(resolve, 0));
    }
    this.into([["exact", "rgba32f"]]);
    this.state({ depth: null });
    this.use(under, { layers: this.texture("layers", this.color), background: this.texture("background", "rgba32f") });
    this.everywhere();
  }

  async drawObjects() {
    const { kind } = this.scene.transparent;
    const [over, copy] = await Promise.all([this.program("OVER", { kind }), this.program("COPY")]);
    this.into([["over", this.color]], "depth");
    this.state({ depth: null });
    this.use(copy, { image: this.texture("background", "rgba32f") });
    this.everywhere();
    this.state({ blend: { factors: ["ONE", "ONE_MINUS_SRC_ALPHA", "ONE", "ONE_MINUS_SRC_ALPHA"] } });
    this.use(over);
    this.drawTransparent(true);
    this.into([["method", "rgba32f"]]);
    this.state({ depth: null });
    this.use(copy, { image: this.texture("over", this.color) });
    this.everywhere();
  }

  async prepareBlended(name) {
    const { kind } = this.scene.transparent;
    const m = GL_METHODS[name];
    const ends = m.ends ? (this.blends32 ? "ENDS" : "END_DEPTH") : null;
    return Promise.all([
      this.program("FIRST", { kind, name }),
      this.program("SECOND", { kind, name }),
      this.program("RESOLVE", { name }),
      ends && this.program(ends, { kind, name: m.writtenEnds ? name : null }),
    ]);
  }

  drawBlended(name, [first, second, resolve, ends]) {
    const { gl } = this;
    const m = GL_METHODS[name];
    const formats = this.blends32 ? m.formats : m.half;
    const targets = formats.map((format, i) => [`target ${i}`, format]);
    const endsOnly = {};
    if (m.ends && this.blends32) {
      this.into([["ends", "rg32f"]], "depth");
      this.clear(0, [-3e38, -3e38, 0, 0]);
      this.state({ blend: { equation: "MAX" } });
      this.use(ends);
      this.drawTransparent();
      endsOnly.ends = this.texture("ends", "rg32f");
    } else if (m.ends) {
      for (const [end, depth, start] of [
        ["nearest", "LESS", 1],
        ["farthest", "GREATER", 0],
      ]) {
        this.into([], end);
        this.state({ depth, write: true });
        gl.clearBufferfv(gl.DEPTH, 0, [start]);
        this.use(ends, { opaque_depth: this.texture("depth", "depth") });
        this.drawTransparent();
        endsOnly[end] = this.texture(end, "depth");
      }
    }
    const state = Object.fromEntries(
      targets.map(([target, format], i) => [`target${i}`, this.texture(target, format)]),
    );
    Object.assign(state, endsOnly);
    this.into(targets, "depth");
    targets.forEach((_, i) => this.clear(i, [0, 0, 0, 0]));
    this.state({ blend: {} });
    this.use(first, m.prepass ? endsOnly : {});
    this.drawTransparent();
    this.into([["weighted", this.color]], "depth");
    this.clear(0, [0, 0, 0, 0]);
    this.state({ blend: {} });
    this.use(second, state);
    this.drawTransparent();
    this.into([["method", "rgba32f"]]);
    this.state({ depth: null });
    this.use(resolve, {
      ...state,
      weighted: this.texture("weighted", this.color),
      background: this.texture("background", "rgba32f"),
    });
    this.everywhere();
  }

  /** Draws a frame; options and result are those of WebGpuRenderer. */
  async draw(options) {
    const { gl, width, height } = this;
    const support = this.support(options.method);
    const m = method(options.method);
    if (support.reason) throw new Error(`${m.title} ${support.reason}.`);
    this.options = options;
    this.view = viewOf(options.camera, this.scene.transparent, width, height, true);
    frameData((this.frameFloats ??= new Float32Array(FRAME_FLOATS)), this.view, width, height, this.scene, options);
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.frame);
    gl.bufferData(gl.UNIFORM_BUFFER, this.frameFloats, gl.DYNAMIC_DRAW);
    gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, this.frame);
    const exactNeeded = options.measure || options.mode !== "image" || m.kind === "lists";
    const blended = m.kind === "blended" ? await this.prepareBlended(options.method) : null;
    const present = await this.program("PRESENT");
    await this.drawOpaque();
    const key = exactKey(this, options);
    if (exactNeeded && (options.sink || this.exactKey !== key)) await this.drawExact(options.sink);
    if (exactNeeded) this.exactKey = key;
    const query = options.measure && this.timer && m.kind !== "lists" ? gl.createQuery() : null;
    if (query) gl.beginQuery(this.timer.TIME_ELAPSED_EXT, query);
    if (m.kind === "objects") await this.drawObjects();
    if (blended) this.drawBlended(options.method, blended);
    if (query) gl.endQuery(this.timer.TIME_ELAPSED_EXT);
    this.lastImage = m.kind === "lists" ? "exact" : "method";
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
    this.state({ depth: null });
    const image = this.texture(this.lastImage, "rgba32f");
    this.use(
      present,
      exactNeeded
        ? { image, truth: this.texture("exact", "rgba32f"), counts: this.texture("counts", "r16f") }
        : { image, truth: image, counts: image },
    );
    gl.uniform1i(gl.getUniformLocation(present, "mode"), { image: 0, split: 1, error: 2, count: 3 }[options.mode]);
    gl.uniform1f(gl.getUniformLocation(present, "split"), (options.split ?? 0.5) * width);
    gl.uniform1f(gl.getUniformLocation(present, "scale"), options.scale ?? 0.1);
    this.everywhere();
    const error = gl.getError();
    if (error && !gl.isContextLost()) this.errors.push(`WebGL error 0x${error.toString(16)} after ${options.method}`);
    if (!options.measure) return null;
    const found = await this.compare();
    if (query) found.seconds = await this.elapsed(query);
    return found;
  }

  async elapsed(query) {
    const { gl } = this;
    for (let i = 0; i < 200 && !gl.getQueryParameter(query, gl.QUERY_RESULT_AVAILABLE); i++)
      await new Promise((resolve) => setTimeout(resolve, 5));
    const available =
      gl.getQueryParameter(query, gl.QUERY_RESULT_AVAILABLE) && !gl.getParameter(this.timer.GPU_DISJOINT_EXT);
    const seconds = available ? gl.getQueryParameter(query, gl.QUERY_RESULT) * 1e-9 : null;
    gl.deleteQuery(query);
    return seconds || null;
  }

  /** Four numbers a pixel of a target, rows from the bottom. */
  read(targets, index) {
    const { gl } = this;
    this.into(targets);
    gl.readBuffer(gl.COLOR_ATTACHMENT0 + index);
    const out = new Float32Array(4 * this.width * this.height);
    gl.readPixels(0, 0, this.width, this.height, gl.RGBA, gl.FLOAT, out);
    gl.readBuffer(gl.COLOR_ATTACHMENT0);
    return out;
  }

  async compare() {
    const [image, truth] = [await this.readImage(), await this.readImage("exact")];
    const found = {
      mse: 0,
      worst: 0,
      fragments: 0,
      most: this.most,
      covered: 0,
      overflow: this.most > MAX_LAYERS,
      bands: 1,
      seconds: null,
    };
    for (let i = 0; i < image.length; i++) {
      const d = image[i] - truth[i];
      found.mse += (d * d) / image.length;
      found.worst = Math.max(found.worst, Math.abs(d));
    }
    for (const n of this.counts) {
      found.fragments += n;
      found.covered += n > 0 ? 1 : 0;
    }
    return found;
  }

  async readImage(which = this.lastImage) {
    const rows = this.read([[which, "rgba32f"]], 0);
    const { width, height } = this;
    const out = new Float32Array(3 * width * height);
    for (let y = 0; y < height; y++) {
      for (let x = 0; x < width; x++) {
        const from = 4 * ((height - 1 - y) * width + x);
        out.set(rows.subarray(from, from + 3), 3 * (y * width + x));
      }
    }
    return out;
  }

  /** The transparent fragments of the present view, layer by layer; the shape is that of WebGpuRenderer. */
  async fragments() {
    const { width, height } = this;
    const layers = [];
    await this.draw({
      ...this.options,
      measure: false,
      mode: "image",
      method: "exact",
      sink: (color, v) => layers.push([color, v]),
    });
    if (this.most > MAX_LAYERS) throw new Error(`A pixel has ${this.most} fragments; the page peels ${MAX_LAYERS}.`);
    const offsets = new Uint32Array(width * height + 1);
    const [viewZ, alpha, color] = [[], [], []];
    for (let y = 0; y < height; y++) {
      for (let x = 0; x < width; x++) {
        const from = 4 * ((height - 1 - y) * width + x);
        for (const [colors, v] of layers) {
          if (v[from] > 1e38) break;
          viewZ.push(v[from]);
          alpha.push(colors[from + 3]);
          color.push(colors[from], colors[from + 1], colors[from + 2]);
        }
        offsets[y * width + x + 1] = viewZ.length;
      }
    }
    return {
      offsets,
      view_z: new Float32Array(viewZ),
      alpha: new Float32Array(alpha),
      color: new Float32Array(color),
      width,
      height,
      near: NEAR,
      far: FAR,
      range: this.view.range,
    };
  }

  destroy() {
    this.gl.getExtension("WEBGL_lose_context")?.loseContext();
  }
}
