// The page: settings, camera, measurements. What is drawn is drawn by render/.

import { METHODS, method } from "./render/methods.js";
import { WebGpuRenderer } from "./render/webgpu.js";
import { loadFiles } from "./scene/load.js";
import { writeNpz } from "./scene/npz.js";
import { SCENES, makeScene } from "./scene/scenes.js";

const $ = (id) => document.getElementById(id);
const query = new URLSearchParams(location.search);
const without = new Set((query.get("no") ?? "").split(",").filter(Boolean));

const MODES = [
  { name: "image", title: "Image" },
  { name: "split", title: "Split" },
  { name: "error", title: "Error" },
  { name: "count", title: "Layers" },
];
/** Grey of the plain background, linear. */
const PLAIN = [0.5, 0.5, 0.5];
/** Pixels of a frame that a card, and that a CPU draws. */
const MAX_PIXELS = { card: 2.6e6, software: 9e4 };
const ERROR_SCALE = 0.1;

const state = {
  scene: query.get("scene") ?? "glass",
  method: query.get("method") ?? "recommended",
  mode: query.get("view") ?? "split",
  split: 0.5,
  opacity: Number(query.get("opacity") ?? 1),
  plain: query.has("plain"),
  turn: false,
  detail: Number(query.get("detail") ?? 1),
  camera: null,
};

let renderer = null;
let scene = null;
/** What was measured of a method, by its name; `view` tells whether it still holds. */
let measured = new Map();
let viewNumber = 0;
let dirty = true;
let restless = 0;
let busy = false;
let stopped = false;
/** View and method that could not be drawn: they are not tried again. */
let broken = "";

function say(html) {
  $("message").hidden = !html;
  $("message").innerHTML = html ?? "";
}

const escape = (s) =>
  String(s).replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);

function fail(error) {
  console.error(error);
  say(`<b>That did not work.</b><p>${escape(error.message ?? error)}</p>`);
}

/** The renderer that this browser has, the best first, and why the others are not it. */
async function openRenderer(canvas) {
  const reasons = [];
  try {
    return { renderer: await WebGpuRenderer.create(canvas, { without }), reasons };
  } catch (error) {
    reasons.push(error.message);
  }
  const { WebGlRenderer } = await import("./render/webgl.js");
  const found = WebGlRenderer.create(canvas, { without });
  reasons[0] += " The page draws with WebGL 2 instead: methods that only blend, and exact images by peeling.";
  return { renderer: found, reasons };
}

// --- Views and measurements ----------------------------------------------------------------------------------------

/** Something that the image depends on has changed. */
function changed() {
  viewNumber += 1;
  redraw();
}

function redraw() {
  dirty = true;
  restless = performance.now();
}

function frameOptions(overrides = {}) {
  return {
    camera: state.camera,
    method: state.method,
    mode: state.mode,
    split: state.split,
    scale: state.mode === "count" ? Math.max(4, latest()?.most ?? 32) : ERROR_SCALE,
    opacity: state.opacity,
    backdrop: state.plain ? PLAIN : null,
    oneColor: query.has("onecolor"),
    transparentOnly: query.has("transparentonly"),
    measure: false,
    ...overrides,
  };
}

const latest = () => measured.get(state.method);

function keep(name, found) {
  if (!found) return;
  measured.set(name, { ...found, view: viewNumber });
  showMeasurements();
}

/** Draws a frame once the one before is done. */
async function draw(overrides) {
  while (busy) await new Promise((resolve) => setTimeout(resolve, 4));
  busy = true;
  try {
    fit();
    return await renderer.draw(frameOptions(overrides));
  } finally {
    busy = false;
  }
}

async function tick(now) {
  if (stopped) return;
  requestAnimationFrame(tick);
  if (busy || document.hidden || !scene) return;
  if (state.turn) {
    state.camera.yaw += Math.min(0.05, ((now - (tick.before ?? now)) / 1000) * 0.35);
    changed();
  }
  tick.before = now;
  const name = state.method;
  const view = viewNumber;
  const stale = latest()?.view !== viewNumber;
  const rested = now - restless > 220;
  const periodic = state.turn && now - (tick.measured ?? 0) > 700;
  if ((!dirty && !(stale && rested)) || broken === `${view} ${name}`) return;
  dirty = false;
  const measure = (stale && rested && !state.turn) || periodic;
  if (measure) tick.measured = now;
  try {
    // Where a CPU draws, exact images wait until the camera rests.
    const light = renderer.software && !rested && state.mode !== "image";
    if (light) dirty = true;
    const found = await draw({ measure, ...(light ? { mode: "image" } : {}) });
    if (found && view === viewNumber && !found.skipped) keep(name, found);
    else if (found && state.turn) keep(name, found);
  } catch (error) {
    broken = `${view} ${name}`;
    fail(error);
  }
}

/** Gives the canvas the size that it is shown at, or that a list has. */
function fit() {
  let width;
  let height;
  if (scene.size) {
    [width, height] = scene.size;
  } else if (query.get("size")) {
    [width, height] = query.get("size").split("x").map(Number);
  } else {
    const box = $("stage").getBoundingClientRect();
    const most = renderer.software ? MAX_PIXELS.software : MAX_PIXELS.card;
    const ratio = Math.min(window.devicePixelRatio || 1, 2, Math.sqrt(most / Math.max(1, box.width * box.height)));
    width = Math.max(16, Math.round(box.width * ratio));
    height = Math.max(16, Math.round(box.height * ratio));
  }
  renderer.resize(width, height);
}

async function measureAll() {
  $("compare").disabled = true;
  state.turn = $("turn").checked = false;
  try {
    for (const m of METHODS) {
      if (renderer.support(m.name).reason) continue;
      const view = viewNumber;
      await draw({ method: m.name, measure: true, mode: "image" });
      // The second time, its pipelines are ready and its times are its own.
      const found = await draw({ method: m.name, measure: true, mode: "image" });
      if (view === viewNumber) keep(m.name, found);
    }
  } catch (error) {
    fail(error);
  }
  $("compare").disabled = false;
  redraw();
}

// --- What is shown beside the picture ------------------------------------------------------------------------------

const SUPERSCRIPT = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/** A small number as 4.1·10⁻⁴. */
function power(x) {
  if (!(x > 0)) return x === 0 ? "0" : "–";
  const e = Math.floor(Math.log10(x));
  if (e >= -1) return x.toPrecision(2);
  return `${(x / 10 ** e).toFixed(1)}·10⁻${String(-e).replace(/./g, (d) => SUPERSCRIPT[d])}`;
}

const milliseconds = (s) => (s == null ? "–" : (1000 * s).toFixed(s < 0.01 ? 2 : 1));

function showMeasurements() {
  const now = latest();
  const others = METHODS.filter((m) => m.kind !== "lists" && measured.get(m.name)?.view === viewNumber);
  const best = Math.min(...others.map((m) => measured.get(m.name).mse));
  for (const row of $("methods").tBodies[0].rows) {
    const name = row.dataset.name;
    const found = measured.get(name);
    const cells = row.cells;
    const support = renderer.support(name);
    const exact = method(name).kind === "lists";
    const bits = exact ? (found?.covered ? Math.round((160 * found.fragments) / found.covered) : "") : support.bits;
    cells[1].textContent = bits ?? "";
    cells[2].innerHTML = found && !exact ? power(found.mse) : "";
    if (found && !exact && found.mse > 0) {
      // From 1e-7 to 1e-1, in equal steps of the logarithm.
      const length = Math.min(1, Math.max(0.03, (Math.log10(found.mse) + 7) / 6));
      cells[2].innerHTML += `<span class="bar"><i style="width:${(100 * length).toFixed(0)}%"></i></span>`;
    }
    cells[3].textContent = found ? milliseconds(found.seconds) : "";
    row.classList.toggle("stale", !!found && found.view !== viewNumber);
    row.classList.toggle("best", others.length > 1 && !exact && found?.view === viewNumber && found.mse === best);
  }
  const facts = [
    ["", `<b>${escape(renderer.adapter)}</b><span>, ${renderer.api}</span>`],
    ...(renderer.width ? [["", `${renderer.width} × ${renderer.height}`, "more"]] : []),
  ];
  if (now) {
    const mean = now.covered ? now.fragments / now.covered : 0;
    facts.push(["layers ", `<b>${mean.toFixed(1)}</b> mean, <b>${now.most}</b> most`, "more"]);
    if (method(state.method).kind !== "lists") facts.push(["error ", `<b>${power(now.mse)}</b>`]);
    // A program that draws on the CPU has no card's times.
    const by = renderer.software ? "CPU" : "GPU";
    if (now.seconds != null) facts.push([`${by} `, `<b>${milliseconds(now.seconds)} ms</b>`]);
    if (now.exactSeconds != null && method(state.method).kind !== "lists") {
      facts.push(["exact ", `${milliseconds(now.exactSeconds)} ms`, "more"]);
    }
    if (now.bands > 1) facts.push(["", `lists in ${now.bands} bands`]);
    if (now.overflow) facts.push(["", "<b>lists overflow: pink pixels are incomplete</b>"]);
  }
  $("facts").innerHTML = facts.map(([name, value, more = ""]) => `<li class="${more}">${name}${value}</li>`).join("");
  $("legend-to").textContent = state.mode === "count" ? Math.max(4, now?.most ?? 32) : `${ERROR_SCALE}`;
}

function showState() {
  const pressed = (parent, name) => {
    for (const b of parent.querySelectorAll("[data-name]")) {
      const on = b.dataset.name === name;
      b.setAttribute("aria-checked", on);
      if (b.tabIndex >= -1) b.tabIndex = on ? 0 : -1;
    }
  };
  pressed($("modes"), state.mode);
  pressed($("scenes"), state.scene);
  pressed($("methods").tBodies[0], state.method);
  const m = method(state.method);
  $("method-note").textContent = renderer.support(m.name).reason
    ? `${m.title} ${renderer.support(m.name).reason}.`
    : m.note;
  $("scene-note").textContent = SCENES.find((s) => s.name === state.scene)?.note ?? scene?.title ?? "";
  $("opacity").value = Math.log2(state.opacity);
  $("opacity-value").textContent = `× ${state.opacity.toFixed(2)}`;
  $("turn").checked = state.turn;
  $("plain").checked = state.plain;
  $("stage").classList.toggle("dark", state.mode === "error" || state.mode === "count");
  $("legend").hidden = state.mode !== "error" && state.mode !== "count";
  $("legend-what").textContent = state.mode === "count" ? "fragments a pixel" : "difference of linear colour";
  $("divider").hidden = state.mode !== "split";
  $("label-left").textContent = state.mode === "split" ? "Exact" : "";
  $("label-right").textContent = state.mode === "split" ? m.title : "";
  $("divider").style.left = `${100 * state.split}%`;
  $("divider").setAttribute("aria-valuenow", Math.round(100 * state.split));
  // Beside the divider, and whole.
  const [left, right] = ["label-left", "label-right"].map((id) => $(id).offsetWidth + 8);
  $("label-left").style.left = `max(${100 * state.split}% - 26px, ${left}px)`;
  $("label-right").style.left = `min(${100 * state.split}% + 26px, 100% - ${right}px)`;
  $("canvas").classList.toggle("list", !!scene?.size);
  for (const row of $("methods").tBodies[0].rows) {
    const { reason } = renderer.support(row.dataset.name);
    row.setAttribute("aria-disabled", !!reason);
    row.title = reason ? `${method(row.dataset.name).title} ${reason}` : method(row.dataset.name).note;
  }
  showMeasurements();
  // The address opens what is shown.
  for (const [name, value] of [
    ["scene", scene?.name],
    ["method", state.method],
    ["view", state.mode],
  ]) {
    if (value && value !== "file") query.set(name, value);
  }
  history.replaceState(null, "", `?${query.toString().replace(/=(?=&|$)/g, "")}`);
}

function showNotes(notes) {
  $("notes").innerHTML = notes.map((n) => `<p>${escape(n)}</p>`).join("");
}

// --- Settings ------------------------------------------------------------------------------------------------------

function choose(what, name) {
  if (what === "method") {
    if (renderer.support(name).reason) {
      $("method-note").textContent = `${method(name).title} ${renderer.support(name).reason}.`;
      return;
    }
    state.method = name;
    redraw();
  } else if (what === "mode") {
    state.mode = name;
    redraw();
  } else {
    setScene(makeScene(name, state.detail));
    return;
  }
  showState();
}

let reasons = [];

function setScene(found) {
  scene = found;
  state.scene = found.name;
  state.camera = { ...found.view, target: [...found.view.target] };
  measured = new Map();
  renderer.setScene(scene);
  if (renderer.support(state.method).reason)
    state.method = METHODS.find((m) => !renderer.support(m.name).reason && m.kind === "blended").name;
  say(null);
  showNotes([...reasons, ...renderer.notes, ...(scene.notes ?? [])]);
  changed();
  showState();
}

function buildPanel() {
  const buttons = (parent, items, what) => {
    for (const item of items) {
      const button = document.createElement("button");
      Object.assign(button, { type: "button", textContent: item.title });
      button.dataset.name = item.name;
      button.setAttribute("role", "radio");
      button.onclick = () => choose(what, item.name);
      parent.append(button);
    }
    arrows(parent, items, what);
  };
  buttons($("modes"), MODES, "mode");
  buttons($("scenes"), SCENES, "scene");
  const body = $("methods").tBodies[0];
  for (const m of METHODS) {
    const row = body.insertRow();
    row.dataset.name = m.name;
    row.tabIndex = -1;
    row.setAttribute("role", "radio");
    row.insertCell().textContent = m.title;
    for (let i = 0; i < 3; i++) row.insertCell();
    row.onclick = () => choose("method", m.name);
  }
  arrows(body, METHODS, "method");
  $("compare").onclick = measureAll;
  $("opacity").oninput = () => {
    state.opacity = 2 ** Number($("opacity").value);
    changed();
    showState();
  };
  $("turn").onchange = () => {
    state.turn = $("turn").checked;
    redraw();
  };
  $("plain").onchange = () => {
    state.plain = $("plain").checked;
    changed();
  };
  $("open").onclick = () => $("file").click();
  $("file").onchange = () => openFiles([...$("file").files]);
  $("save").onclick = () => save().catch(fail);
}

/** Arrow keys move within a group of choices. */
function arrows(parent, items, what) {
  parent.addEventListener("keydown", (event) => {
    const step = { ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    const at = items.findIndex((i) => i.name === event.target.dataset?.name);
    for (let k = 1; k <= items.length; k++) {
      const next = items[(at + step * k + items.length * k) % items.length];
      if (what === "method" && renderer.support(next.name).reason) continue;
      choose(what, next.name);
      parent.querySelector(`[data-name="${next.name}"]`)?.focus();
      break;
    }
  });
}

async function openFiles(files) {
  if (!files.length) return;
  try {
    setScene(await loadFiles(files));
  } catch (error) {
    fail(error);
  }
}

/** The fragments of this view as the bytes of an .npz file. */
async function fragmentsFile() {
  await draw({ measure: true, method: "exact", mode: "image" });
  const f = await renderer.fragments();
  const one = (x, Type) => ({ data: new Type([x]), shape: [] });
  return {
    range: f.range,
    bytes: writeNpz({
      offsets: { data: f.offsets, shape: [f.offsets.length] },
      view_z: { data: f.view_z, shape: [f.view_z.length] },
      alpha: { data: f.alpha, shape: [f.alpha.length] },
      color: { data: f.color, shape: [f.view_z.length, 3] },
      width: one(f.width, Uint32Array),
      height: one(f.height, Uint32Array),
      near: one(f.near, Float32Array),
      far: one(f.far, Float32Array),
    }),
  };
}

async function save() {
  const { bytes } = await fragmentsFile();
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes], { type: "application/zip" }));
  link.download = `${state.scene}.npz`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  redraw();
}

// --- Pointer -------------------------------------------------------------------------------------------------------

function watchPointer() {
  const canvas = $("canvas");
  const pointers = new Map();
  const at = ({ clientX, clientY }) => ({ clientX, clientY });
  const orbit = (dx, dy) => {
    state.camera.yaw -= dx * 0.008;
    state.camera.pitch = Math.min(1.5, Math.max(-0.15, state.camera.pitch + dy * 0.006));
    changed();
  };
  const zoom = (factor) => {
    state.camera.distance = Math.min(30, Math.max(0.6, state.camera.distance * factor));
    changed();
  };
  const pan = (dx, dy) => {
    const { yaw, distance, target } = state.camera;
    const step = (distance * 1.2) / $("stage").clientHeight;
    target[0] -= step * dx * Math.cos(yaw);
    target[2] += step * dx * Math.sin(yaw);
    target[1] += step * dy;
    changed();
  };
  canvas.addEventListener("pointerdown", (event) => {
    if (scene?.size) return;
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, { ...at(event), button: event.button, pointerId: event.pointerId });
    state.turn = $("turn").checked = false;
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const [dx, dy] = [event.clientX - before.clientX, event.clientY - before.clientY];
    if (pointers.size === 1) {
      if (before.button === 2 || event.shiftKey) pan(dx, dy);
      else orbit(dx, dy);
    } else if (pointers.size === 2) {
      const other = [...pointers.values()].find((p) => p.pointerId !== event.pointerId);
      const span = (e) => Math.hypot(e.clientX - other.clientX, e.clientY - other.clientY);
      zoom(span(before) / Math.max(1, span(event)));
      pan(dx / 2, dy / 2);
    }
    pointers.set(event.pointerId, { ...at(event), button: before.button, pointerId: event.pointerId });
  });
  for (const end of ["pointerup", "pointercancel"])
    canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      if (!scene?.size) zoom(Math.exp(Math.min(60, Math.max(-60, event.deltaY)) * 0.003));
    },
    { passive: false },
  );
  canvas.addEventListener("keydown", (event) => {
    const turn = { ArrowLeft: [-12, 0], ArrowRight: [12, 0], ArrowUp: [0, -12], ArrowDown: [0, 12] }[event.key];
    if (turn) orbit(...turn);
    else if (event.key === "+" || event.key === "-") zoom(event.key === "+" ? 0.9 : 1.1);
    else return;
    event.preventDefault();
  });

  const divider = $("divider");
  const place = (x) => {
    const box = $("stage").getBoundingClientRect();
    state.split = Math.min(0.98, Math.max(0.02, (x - box.left) / box.width));
    dirty = true;
    showState();
  };
  divider.addEventListener("pointerdown", (event) => divider.setPointerCapture(event.pointerId));
  divider.addEventListener(
    "pointermove",
    (event) => divider.hasPointerCapture(event.pointerId) && place(event.clientX),
  );
  divider.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -0.02, ArrowRight: 0.02 }[event.key];
    if (!step) return;
    state.split = Math.min(0.98, Math.max(0.02, state.split + step));
    dirty = true;
    showState();
  });

  const stage = document.body;
  stage.addEventListener("dragover", (event) => {
    event.preventDefault();
    $("drop").hidden = false;
  });
  stage.addEventListener("dragleave", (event) => {
    if (!event.relatedTarget) $("drop").hidden = true;
  });
  stage.addEventListener("drop", (event) => {
    event.preventDefault();
    $("drop").hidden = true;
    openFiles([...event.dataTransfer.files]);
  });
  new ResizeObserver(changed).observe($("stage"));
  document.addEventListener("visibilitychange", redraw);
}

// --- Start ---------------------------------------------------------------------------------------------------------

async function start() {
  const opened = await openRenderer($("canvas"));
  renderer = opened.renderer;
  reasons = opened.reasons;
  if (query.get("nodes")) renderer.maxNodes = Number(query.get("nodes"));
  renderer.lost?.then((info) => {
    if (info.reason !== "destroyed")
      fail(new Error(`The graphics device was lost: ${info.message || "no reason given"}. Load the page again.`));
  });
  buildPanel();
  watchPointer();
  setScene(makeScene(state.scene, state.detail));
  requestAnimationFrame(tick);
}

/** For scripts and tests; `nmt.ready` resolves once a scene is there. */
window.nmt = {
  ready: start().catch((error) => {
    fail(error);
    throw error;
  }),
  get renderer() {
    return renderer;
  },
  state,
  methods: METHODS.map((m) => m.name),
  scenes: SCENES.map((s) => s.name),
  /** Draws and measures a method of the present scene; overrides are the options of a frame. */
  measure: (overrides = {}) => draw({ measure: true, mode: "image", ...overrides }),
  image: (which) => renderer.readImage(which),
  fragmentsFile,
  choose,
  openFiles,
  measureAll,
  /** Stops the page's own frames, so that a script alone draws. */
  stop() {
    stopped = true;
  },
};
