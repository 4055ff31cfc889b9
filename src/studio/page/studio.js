// The page of the studio: a screen and a hand. Whatever is decided is decided by the server.

import * as film from "./film.js";
import * as underlay from "./underlay.js";

const $ = (id) => document.getElementById(id);
const key = location.hash.slice(1) || sessionStorage.getItem("key") || "";
const tab = Math.random().toString(36).slice(2, 10);
if (location.hash) {
  sessionStorage.setItem("key", key);
}
let state = {}; // as the server has it
let look = {}; // steps, seed, parameters, style and view
let choices = {};
let numbers = null; // forecast and dimension
let drawn = null; // numbers of the last picture

/** Calls the server; returns the answer, or throws its message. */
async function call(method, path, body, kind = "application/json", signal) {
  const answer = await fetch(path, {
    method,
    headers: { "x-kfrac-key": key, "x-kfrac-file": state.file ?? "", ...(body === undefined ? {} : { "content-type": kind }) },
    body: body === undefined || typeof body === "string" || body instanceof Blob ? body : JSON.stringify(body),
    signal,
  });
  if (answer.ok) {
    return answer;
  }
  const { error } = await answer.json().catch(() => ({ error: answer.statusText }));
  throw Object.assign(new Error(error), { status: answer.status });
}
const json = async (...all) => (await call(...all)).json();
/** Returns the step of an arrow key, to the right and up. */
const arrow = (event) => ({ ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] })[event.key];

/** Makes an element with properties and children. */
function make(name, properties = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (key in element && key !== "list") element[key] = value;
    else if (value !== null && value !== undefined) element.setAttribute(key, value);
  }
  element.append(...children.filter((it) => it !== null && it !== undefined));
  return element;
}

const tick = (more) => make("input", { type: "checkbox", ...more });
const words = (more) => make("input", { type: "text", autocomplete: "off", ...more });
const reset = (label, act) => make("button", { className: "reset", type: "button", title: "As in the file", "aria-label": `${label} as in the file`, onclick: act }, "↺");

// Pictures: one request at a time; what changes in between goes with the next one.

const canvas = $("picture");
const plane = canvas.getContext("2d");
const sheet = document.createElement("canvas"); // a draft, in pixels
let bitmap = null;
let bitmapSize = [1, 1];
const still = () => ({ by: 1, t: [0, 0] });
let shown = still(); // movement of the view since the bitmap was drawn
let pending = still(); // the part of it that the server does not know
let isBusy = false;
let asked = null; // window that is typed
let isStale = false; // whether the look has changed since the last request
let again = null;
let calm = 0;
let slow = false; // whether the last picture took longer than a frame

const after = (a, b) => ({ by: a.by * b.by, t: [0, 1].map((i) => b.by * a.t[i] + b.t[i]) });
const moves = (it) => it.by !== 1 || it.t[0] !== 0 || it.t[1] !== 0;

function paint() {
  const { width, height } = canvas;
  plane.setTransform(1, 0, 0, 1, 0, 0);
  plane.clearRect(0, 0, width, height);
  if (!bitmap) return;
  const w = width * shown.by;
  const h = (width * bitmapSize[1] / bitmapSize[0]) * shown.by;
  const x = width / 2 + shown.t[0] * width - w / 2;
  const y = height / 2 - shown.t[1] * width - h / 2;
  plane.imageSmoothingEnabled = shown.by < 4;
  plane.drawImage(bitmap, x, y, w, h);
}

/** Asks for a picture: a draft while a hand moves, and in full once it rests. */
function draw(draft = false) {
  clearTimeout(calm);
  if (draft) calm = setTimeout(() => draw(false), 80);
  if (isBusy) again = again === false ? false : draft;
  else request(draft);
}

/** Returns the error of work upon a file that has been left. */
const left = () => Object.assign(new Error("Another file is shown now."), { status: 410 });
/** Returns the image of an answer; a draft has no encoding. */
async function image(answer, draft, [width, height]) {
  if (!draft) return createImageBitmap(await answer.blob());
  const pixels = new ImageData(new Uint8ClampedArray(await answer.arrayBuffer()), width, height);
  [sheet.width, sheet.height] = [width, height];
  sheet.getContext("2d").putImageData(pixels, 0, 0);
  return sheet;
}

async function request(draft) {
  if (!state.hasGood || !canvas.width) return;
  isBusy = true;
  const sent = pending;
  pending = still();
  const scale = draft && slow ? 0.5 : 1;
  const size = [canvas.width, canvas.height].map((side) => Math.max(1, Math.round(side * scale)));
  const wanted = { tab, width: size[0], height: size[1], draft };
  if (isStale) wanted.look = look;
  if (asked) wanted.window = asked;
  asked = null;
  if (moves(sent)) wanted.gesture = { by: sent.by, about: [0, 0], shift: sent.t };
  isStale = false;
  const start = performance.now();
  const { file } = state;
  try {
    const answer = await call("POST", "/picture", wanted);
    const found = JSON.parse(answer.headers.get("x-kfrac-picture"));
    const next = await image(answer, draft, size);
    if (state.file !== file) throw left();
    bitmap?.close?.();
    [bitmap, bitmapSize, shown] = [next, size, pending];
    if (draft) slow = performance.now() - start > (slow ? 6 : 12);
    drawn = { ...found, bytes: +answer.headers.get("content-length") };
    const kept = found.session.look;
    if (!isStale) look = kept;
    else {
      look.view = kept.view;
      for (const option of ["zoom", "look-at"]) if (kept.options[option] !== undefined) look.options[option] = kept.options[option];
    }
    $("factor").value = factor(found.session.factor);
    say("");
    paint();
    window.dispatchEvent(new CustomEvent("picture", { detail: performance.now() - start }));
    if (!draft) tell();
  } catch (error) {
    if (error.status !== 410 && error.status !== 409) say(error.message, error.status === 422);
    shown = pending;
    if (moves(sent) || error.status === 409) await refresh().catch(() => {});
    paint();
  }
  isBusy = false;
  if (again !== null) {
    const next = again;
    again = null;
    request(next);
  }
}

const factor = (value) => (!value || Math.abs(value - 1) < 1e-9 ? "" : `× ${value >= 1e6 || value < 0.01 ? value.toExponential(2).replace("e+", "e") : +value.toPrecision(4)}`);

function say(message, offers = false) {
  $("message").hidden = !message;
  $("message").firstElementChild.textContent = message;
  $("to-pixel").hidden = !(offers && look.detail == null && look.steps != null);
}

/** Fills the status line, which is read aloud. */
function tell() {
  if (!drawn) return;
  const parts = [];
  const count = drawn.elements;
  if (drawn.steps != null) parts.push(`Step ${drawn.steps}`);
  if (count != null) parts.push(`${count.toLocaleString("en")} elements${look.view || state.isInSpace ? " drawn" : ""}`);
  parts.push(`${drawn.size[0]} × ${drawn.size[1]}`, bytes(drawn.bytes), time(drawn.seconds));
  $("status").textContent = parts.join("  ·  ") + (drawn.notes.length ? `  ·  ${drawn.notes.join("  ·  ")}` : "");
  $("command").textContent = drawn.command;
  $("command").title = drawn.command;
  if (state.isInSpace) placeSteps();
  if ($("style-window") && document.activeElement !== $("style-window")) $("style-window").value = drawn.window?.map((it) => +it.toPrecision(6)).join(", ") ?? "";
  canvas.setAttribute("aria-label", `Picture of ${title()}: ${parts.slice(0, 2).join(", ")}`);
}
const bytes = (n) => (n < 1e6 ? `${Math.ceil(n / 1e3)} kB` : `${(n / 1e6).toFixed(1)} MB`);
const time = (s) => (s < 1 ? `${Math.max(1, Math.round(s * 1000))} ms` : `${s.toFixed(1)} s`);
const title = () => state.about?.title || state.name;

function resize() {
  const { width, height } = canvas.getBoundingClientRect();
  const dense = Math.min(devicePixelRatio || 1, 3);
  const size = [width, height].map((it) => Math.min(8192, Math.max(16, Math.round(it * dense))));
  if (size[0] === canvas.width && size[1] === canvas.height) return;
  [canvas.width, canvas.height] = size;
  paint();
  draw();
}
new ResizeObserver(resize).observe($("paper"));

// The view: pan, zoom and turn.

function move(by, about, shift = [0, 0]) {
  const step = { by, t: [0, 1].map((i) => -about[i] * (by - 1) + shift[i]) };
  shown = after(shown, step);
  pending = after(pending, step);
  requestAnimationFrame(paint);
  draw(true);
}
function turn(by, option = "from") {
  const now = angles(option);
  const next = [now[0] + by[0], Math.max(-90, Math.min(90, now[1] + by[1]))];
  set(option, next.map((it) => +it.toFixed(2)).join(","), true);
  placeAngles(option);
}
const angles = (option) => (look.options?.[option]?.split(",").map(Number) ?? state.style?.[option] ?? [0, 0]);
const place = (event) => {
  const box = canvas.getBoundingClientRect();
  return [(event.clientX - box.left) / box.width - 0.5, -((event.clientY - box.top) / box.width - box.height / box.width / 2)];
};
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  const lines = event.deltaMode === 1 ? 16 : 1;
  const by = Math.exp(-Math.max(-240, Math.min(240, event.deltaY * lines)) * 0.0022);
  move(by, place(event));
}, { passive: false });
const pointers = new Map();
/** Turns a set of the plane. */
function spin(by) {
  const angle = (+(look.options?.turn ?? 0) + by + 540) % 360 - 180;
  set("turn", Math.abs(angle) < 1e-6 ? null : String(+angle.toFixed(2)), true);
  if ($("style-turn")) $("style-turn").value = angle;
}
canvas.addEventListener("contextmenu", (event) => event.preventDefault());
canvas.addEventListener("pointerdown", (event) => {
  canvas.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, place(event));
});
canvas.addEventListener("pointermove", (event) => {
  const before = pointers.get(event.pointerId);
  if (!before) return;
  const now = place(event);
  pointers.set(event.pointerId, now);
  const delta = [now[0] - before[0], now[1] - before[1]];
  const isPan = event.ctrlKey || event.metaKey || event.buttons & 2;
  if (pointers.size === 1 && state.isInSpace && !isPan) {
    const isLight = event.shiftKey;
    turn([(isLight ? 220 : -220) * delta[0], (isLight ? 140 : -140) * delta[1]], isLight ? "light" : "from");
  } else if (pointers.size === 1 && event.shiftKey && !state.isInSpace) {
    const angle = (at) => Math.atan2(at[1], at[0]) * 180 / Math.PI;
    spin(angle(now) - angle(before));
  } else if (pointers.size === 1) move(1, [0, 0], delta);
  else {
    const [other] = [...pointers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
    const apart = (at) => Math.hypot(at[0] - other[0], at[1] - other[1]) || 1e-6;
    move(Math.max(0.2, Math.min(5, apart(now) / apart(before))), other);
  }
});
for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
canvas.addEventListener("keydown", (event) => {
  const step = arrow(event)?.map((it) => -it);
  if (!step || event.altKey) return;
  event.preventDefault();
  const isPan = event.ctrlKey || event.metaKey;
  if (!state.isInSpace && event.shiftKey) spin(5 * (step[0] + step[1]));
  else if (state.isInSpace && !isPan) turn([-5 * step[0], -5 * step[1]], event.shiftKey ? "light" : "from");
  else move(1, [0, 0], step.map((it) => it * 0.08));
});
function whole() {
  if (state.isInSpace) {
    for (const option of ["from", "look-at", "zoom"]) delete look.options[option];
    placeAngles("from");
  }
  look.view = null;
  pending = still();
  changed();
}
$("zoom-in").onclick = () => move(1.5, [0, 0]);
$("zoom-out").onclick = () => move(1 / 1.5, [0, 0]);
$("whole").onclick = whole;

/** Draws the look that has changed. */
function changed(draft = false) {
  isStale = true;
  placed.forEach((place) => place());
  offerWriting();
  draw(draft);
}
function set(option, value, draft = false) {
  if (value === "" || value == null) delete look.options[option];
  else look.options[option] = value;
  changed(draft);
}

// Generation: steps and seeds.

// Sets without a number of steps are drawn to the pixel.
const isLimit = () => look.steps == null && (look.detail != null || Boolean(state.isLimit));
const stepNow = () => look.steps ?? (state.isInSpace ? drawn?.steps : null) ?? numbers?.proposed ?? 0;
function goTo(step) {
  look.steps = Math.max(0, step);
  look.detail = null;
  placeSteps();
  changed();
}
function placeSteps() {
  const range = $("step");
  const last = Math.max(numbers?.last ?? 12, 1);
  range.max = last;
  range.value = stepNow();
  const steps = numbers?.steps ?? [];
  const ticks = $("ticks");
  if (ticks.childElementCount !== last + 1) {
    ticks.replaceChildren(...Array.from({ length: last + 1 }, (_, at) => make("i", { onclick: () => goTo(at) })));
  }
  [...ticks.children].forEach((tick, at) => {
    const size = steps[at] ? Math.log10(Math.max(1, count(steps[at].elements))) : 0;
    tick.style.setProperty("--tall", `${Math.min(24, 3 + size * 2.6)}px`);
    tick.className = (steps[at] && !steps[at].fits ? "beyond" : "") + (at === stepNow() ? " now" : "");
    tick.title = describe(at);
  });
  const now = steps[stepNow()];
  $("limit").checked = look.detail != null || isLimit();
  $("forecast").className = now && !now.fits && !isLimit() ? "beyond" : "";
  const [head, ...rest] = isLimit() ? ["To the pixel"] : describe(stepNow()).split(" · ");
  $("forecast").replaceChildren(make("b", {}, head), rest.join(" · "));
  range.setAttribute("aria-valuetext", (isLimit() ? head : describe(stepNow())) + (now && !now.fits && !isLimit() ? ", beyond what is grown here" : ""));
  $("back").disabled = stepNow() === 0;
}
const count = (text) => (text.includes("^") ? 10 ** +text.split("^")[1] : +text.replaceAll(",", ""));
function describe(at) {
  const step = numbers?.steps[at];
  if (!step) return `Step ${at}`;
  return [`Step ${at}`, `${step.elements} elements`, step.bytes && `${step.bytes} of SVG`, step.seconds].filter(Boolean).join(" · ");
}
$("step").oninput = () => goTo(+$("step").value);
$("back").onclick = () => goTo(stepNow() - 1);
$("forward").onclick = () => goTo(stepNow() + 1);
$("limit").onchange = () => {
  look.detail = $("limit").checked && !state.isLimit ? 1 : null;
  look.steps = $("limit").checked || !state.isLimit ? null : numbers?.proposed ?? 0;
  placeSteps();
  changed();
};
$("to-pixel").onclick = () => {
  look.detail = 0.5;
  placeSteps();
  changed();
};
$("follow").onchange = () => {
  look.follows = $("follow").checked;
  changed();
};
$("seed").onchange = () => sow($("seed").value.trim() || "0");
function sow(seed) {
  if (!/^\d{1,20}$/.test(seed)) return say("a seed is a whole number from 0");
  look.seed = seed;
  $("seed").value = seed;
  changed();
}
const another = () => sow(String(Math.floor(Math.random() * 1e6)));
$("another").onclick = another;

// Choosing from small pictures: six seeds, members near the present one, thumbnails.

const waiting = [];
let fetching = 0;
/** Shows a picture in an image, a few at a time. */
function fill(image, get) {
  waiting.push([image, get]);
  pump();
}
async function pump() {
  if (fetching >= 3 || !waiting.length) return;
  const [image, get] = waiting.shift();
  if (!image.isConnected) return pump();
  fetching += 1;
  try {
    const url = URL.createObjectURL(await (await get()).blob());
    image.onload = () => URL.revokeObjectURL(url);
    image.src = url;
  } catch (error) {
    image.alt = error.message;
  }
  fetching -= 1;
  pump();
}
function choose(heading, items, take, more) {
  const grid = make("div", { className: "grid" });
  const offer = (items) => grid.replaceChildren(...items.map((item, at) => {
    const image = make("img", { alt: "" });
    setTimeout(() => fill(image, () => call("POST", "/preview", { tab: `preview ${tab} ${at}`, width: 340, height: 255, ...item.picture })));
    return make("button", { type: "button", title: item.about, "aria-label": item.about, "aria-pressed": String(!!item.isNow), onclick: () => { $("ask").close(); take(item); } }, image, make("span", {}, item.label));
  }));
  offer(items);
  ask(heading, [grid], more ? { go: more.label, act: async () => { offer(await more.next()); return false; } } : {});
}
$("six").onclick = () => {
  const six = () => {
    const first = Math.floor(Math.random() * 1e6);
    const seeds = [look.seed, ...Array.from({ length: 5 }, (_, at) => String(first + at))];
    return seeds.map((seed, at) => ({ seed, isNow: at === 0, label: `seed ${seed}`, about: `Seed ${seed}`, picture: { look: { ...look, seed } } }));
  };
  choose("Six seeds", six(), (item) => sow(item.seed), { label: "Five others", next: async () => six() });
};
$("vary").onclick = async () => {
  const next = async () => {
    const { variants } = await json("POST", "/vary", { seed: Math.floor(Math.random() * 4e9) });
    const items = variants.map((it, at) => ({ at, label: it.changes.slice(0, 2).join(", "), about: it.changes.join(", "), picture: { look, variant: at } }));
    items.splice(4, 0, { label: "as it is", about: "As it is", isNow: true, picture: { look } });
    return items;
  };
  try {
    choose("Members near this one", await next(), async (item) => {
      if (item.isNow) return;
      await json("POST", "/take", { tab, variant: item.at }).then(take, (error) => say(error.message));
    }, { label: "Others", next });
  } catch (error) {
    say(error.message);
  }
};

// Family: a slider for a parameter, a pad for a complex one, and for two of a system.

let placed = []; // functions that place sliders and knobs
let pads = [];
let map = {}; // the picture of a map, and what it depends on
const valueOf = (it) => look.set[it.name] ?? String(it.value);
const read = (name, parts) => (parts[0].whole ? (look.set[name] ?? `[${parts.map((it) => it.value)}]`).replace(/[[\]\s]/g, "").split(",") : parts.map(valueOf)).map(Number);
const limits = (it) => {
  const wide = Math.max(1, Math.abs(it.value));
  return [it.min ?? (it.max != null ? it.max - 2 * wide : it.value - wide), it.max ?? (it.min != null ? it.min + 2 * wide : it.value + wide)];
};
const isFixed = (it) => limits(it)[0] === limits(it)[1];
const isMapped = () => state.isSystem && !state.isInSpace;
function groups() {
  const parts = new Map();
  for (const it of state.parameters ?? []) parts.set(it.whole ?? it.name, [...(parts.get(it.whole ?? it.name) ?? []), it]);
  return [...parts];
}
/** Returns the present values of all parameters. */
const values = () => Object.fromEntries(groups().map(([name, parts]) => [name, parts[0].whole ? `[${read(name, parts)}]` : valueOf(parts[0])]));
function family() {
  [placed, pads] = [[], []];
  const all = groups();
  $("no-parameters").hidden = all.length > 0;
  $("about").textContent = state.about?.about ?? "";
  $("about").hidden = !state.about?.about;
  $("source").textContent = state.about?.source ? `From: ${state.about.source}` : "";
  const controls = all.map(([name, parts]) => (parts[0].whole ? pad(name, parts) : slider(parts[0])));
  const isPair = all.length === 2 && state.parameters.length === 2 && !state.parameters.some((it) => it.is_integer || isFixed(it));
  if (isMapped() && isPair) controls.push(pad("", state.parameters));
  $("parameters").replaceChildren(...controls);
  offerWriting();
  pads.forEach(lay);
  film.show();
}
/** Shows the map of two parameters behind the point that is dragged. */
async function lay({ area, name, parts, span }) {
  const over = name ? [`${name}=[${span.map((it) => it[0])}]..[${span.map((it) => it[1])}]`] : parts.map((it, at) => `${it.name}=${span[at].join("..")}`);
  const others = Object.entries(look.set).filter(([key]) => key !== name && !parts.some((it) => it.name === key));
  const about = JSON.stringify([state.revision, over, others]);
  if (!isMapped() || parts.some(isFixed) || area.dataset.map === about) return;
  if (map.about !== about) map = { about, url: call("POST", "/map", { tab, over, width: 240, height: name ? 240 : 150 }).then((it) => it.blob()).then(URL.createObjectURL) };
  try {
    area.style.backgroundImage = `url(${await map.url})`;
    area.dataset.map = about;
    if (name) area.style.aspectRatio = 1;
  } catch {
    area.style.backgroundImage = "";
  }
}
/** Shows for which parameters a value is set that the file does not have. */
function offerWriting() {
  document.querySelectorAll("[data-write]").forEach((it) => (it.hidden = look.set?.[it.dataset.write] === undefined));
}
async function write(name) {
  try {
    take(await json("POST", "/write", { tab, name }));
  } catch (error) {
    say(error.message);
  }
}
function heading(name, about, input) {
  const back = reset(name, () => { delete look.set[name]; changed(); recount(); });
  const writes = make("button", { className: "small", type: "button", title: "Write this value into the file", "aria-label": `Write ${name} into the file`, "data-write": name, hidden: true, onclick: () => write(name) }, "Write");
  return [make("div", { className: "row" }, make("label", { htmlFor: `value-${name}` }, name), make("span", { className: "row" }, writes, back, input)), about ? make("p", { className: "quiet" }, about) : null];
}
function slider(it) {
  const [min, max] = limits(it);
  const typed = words({ id: `value-${it.name}` });
  const range = make("input", { type: "range", min, max, step: it.is_integer ? 1 : "any", "aria-label": `${it.name}, from ${min} to ${max}` });
  const place = () => {
    const value = typed.value = valueOf(it);
    if (Number.isFinite(+value)) range.value = value;
  };
  range.oninput = () => {
    const digits = it.is_integer ? 0 : Math.max(0, 3 - Math.floor(Math.log10((max - min) || 1)));
    look.set[it.name] = String(+(+range.value).toFixed(Math.min(12, digits)));
    changed(true);
  };
  range.onchange = recount;
  typed.onchange = () => {
    look.set[it.name] = typed.value.trim();
    if (!typed.value.trim()) delete look.set[it.name];
    changed();
    recount();
  };
  range.onkeydown = (event) => {
    const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageUp: 10, PageDown: -10 }[event.key];
    if (!by) return;
    event.preventDefault();
    range.value = +range.value + by * (it.is_integer ? 1 : (max - min) / (event.shiftKey ? 1000 : 100));
    range.dispatchEvent(new Event("input"));
    range.dispatchEvent(new Event("change"));
  };
  placed.push(place);
  place();
  return make("div", { className: "parameter" }, ...heading(it.name, it.about, typed), range);
}
/** Makes a pad for the parts of a complex parameter, or for two parameters without a name of their own. */
function pad(name, parts) {
  const span = parts.map(limits);
  const typed = name ? words({ id: `value-${name}` }) : null;
  const knob = make("i");
  const called = name || parts.map((it) => it.name).join(" and ");
  const area = make("div", { className: "pad", tabIndex: 0, role: "application", "aria-label": `${called}: arrow keys move the point` }, knob);
  const share = (at, value) => `${100 * Math.abs(at - (value - span[at][0]) / (span[at][1] - span[at][0] || 1))}%`;
  area.style.setProperty("--zero-x", share(0, 0));
  area.style.setProperty("--zero-y", share(1, 0));
  const put = (value) => {
    const inside = value.map((it, at) => +Math.max(span[at][0], Math.min(span[at][1], it)).toFixed(4));
    if (name) look.set[name] = `[${inside}]`;
    else parts.forEach((it, at) => (look.set[it.name] = String(inside[at])));
    changed(true);
  };
  const place = () => {
    const now = read(name, parts);
    if (typed) typed.value = look.set[name] ?? `[${now}]`;
    knob.style.setProperty("--x", share(0, now[0]));
    knob.style.setProperty("--y", share(1, now[1]));
  };
  area.onpointerdown = area.onpointermove = (event) => {
    if (!event.buttons) return;
    area.setPointerCapture(event.pointerId);
    const box = area.getBoundingClientRect();
    const at = [(event.clientX - box.left) / box.width, 1 - (event.clientY - box.top) / box.height];
    put(at.map((it, i) => span[i][0] + it * (span[i][1] - span[i][0])));
  };
  area.onpointerup = recount;
  area.onkeydown = (event) => {
    const step = arrow(event);
    if (!step) return;
    event.preventDefault();
    put(read(name, parts).map((it, i) => it + step[i] * (span[i][1] - span[i][0]) / (event.shiftKey ? 1000 : 100)));
    recount();
  };
  if (typed) {
    typed.onchange = () => {
      look.set[name] = typed.value.trim();
      changed();
      recount();
    };
  }
  placed.push(place);
  pads.push({ area, name, parts, span });
  place();
  return make("div", { className: "parameter" }, ...(name ? heading(name, parts[0].about?.replace(/^the real part of [^:]*(: )?/, ""), typed) : []), area);
}

// Style: each control is an option of `kfrac grow`.

function style() {
  const box = $("style");
  const own = state.style ?? {};
  const rows = [];
  const head = (text) => rows.push(make("h3", {}, text));
  const row = (option, label, ...controls) => {
    const id = `style-${option}`;
    controls.find((it) => !it.id && it.matches("input:not([type=color]), select"))?.setAttribute("id", id);
    rows.push(make("label", { htmlFor: id }, label), make("div", { className: "row" }, ...controls), reset(label, () => { set(option, null); style(); }));
  };
  const now = (option) => look.options[option] ?? own[option] ?? "";
  const text = (option, label, hint = "") => {
    const input = words({ value: now(option), placeholder: hint, onchange: () => set(option, input.value.trim()) });
    row(option, label, input);
  };
  const colour = (option, label) => {
    const input = words({ value: now(option) || "none" });
    const well = make("input", { type: "color", value: hex(now(option)), "aria-label": `${label}, chosen from a palette` });
    well.oninput = () => { input.value = well.value; set(option, well.value, true); };
    input.onchange = () => { set(option, input.value.trim()); well.value = hex(input.value.trim()); };
    row(option, label, well, input);
  };
  const select = (option, label, names, missing) => {
    const all = missing === undefined ? names : ["", ...names];
    const input = make("select", { onchange: () => set(option, input.value) }, ...all.map((name) => make("option", { value: name }, name || missing)));
    input.value = now(option);
    row(option, label, input);
  };
  const range = (option, label, min, max, missing = min) => {
    const input = make("input", { type: "range", min, max, step: "any", value: now(option) || missing, oninput: () => set(option, String(+(+input.value).toFixed(2)), true) });
    row(option, label, input);
  };
  const check = (option, label) => {
    const input = tick({ checked: String(now(option)) === "true", onchange: () => set(option, String(input.checked)) });
    row(option, label, input);
  };
  const two = (option, labels) => {
    labels.forEach((label, at) => {
      const [min, max] = at ? [-90, 90] : [-180, 180];
      const input = make("input", { type: "range", min, max, step: 1, value: angles(option)[at], "data-angle": `${option} ${at}`, "aria-label": label });
      input.oninput = () => { const next = angles(option); next[at] = +input.value; set(option, next.join(","), true); };
      input.id = `style-${option}-${at}`;
      rows.push(make("label", { htmlFor: input.id }, label), make("div", { className: "row" }, input), make("span"));
    });
  };
  head("Colours");
  select("color-by", "Colour by", choices["color-by"].filter((name) => state.isSystem ? !["age", "fractal", "generator"].includes(name) : !["hits", "first-map", "last-map"].includes(name)));
  const palettes = make("div", { id: "palettes", role: "group", "aria-label": "Palette" }, ...choices.palettes.map(({ name, colours }) => {
    const strip = make("i");
    strip.style.background = `linear-gradient(90deg, ${colours.join(", ")})`;
    const press = () => {
      set("palette", name);
      if (now("color-by") === "none") { look.options["color-by"] = "step"; }
      style();
      $("palettes").querySelector(`[data-name="${name}"]`).focus();
    };
    return make("button", { type: "button", "data-name": name, "aria-pressed": String(now("palette") === name), onclick: press }, strip, name);
  }));
  rows.push(palettes);
  colour("stroke", "Stroke");
  colour("fill", "Fill");
  colour("background", "Background");
  if (state.isInSpace) {
    head("Camera");
    two("from", ["Azimuth", "Elevation"]);
    range("perspective", "Perspective", 1, 120, 1);
    head("Light");
    select("shade", "Shading", choices.shade, "as usual");
    two("light", ["Light azimuth", "Light elevation"]);
    check("occlusion", "Occlusion");
    check("shadows", "Shadows");
  } else {
    head("Lines");
    text("stroke-width", "Width", "1.5 or 10%");
    select("cap", "Ends", choices.cap);
    select("join", "Corners", choices.join);
    head("View");
    if (look.options.method !== "chaos") range("turn", "Turn", -180, 180, 0);
    const window = words({ value: "", placeholder: "x, y, width, height" });
    window.onchange = () => show(window.value);
    row("window", "Window", window);
    rows.pop();
    rows.push(make("span"));
  }
  if (state.isSystem) {
    head("Random iteration");
    const input = tick({ checked: look.options.method === "chaos", onchange: () => { set("method", input.checked ? "chaos" : null); style(); } });
    row("method", "Draw points", input);
    if (input.checked) {
      text("points", "Points", "10M");
      select("tone", "Tone", choices.tone, "log");
      range("gamma", "Gamma", 0.2, 8, 1);
      text("oversample", "Bins a pixel", "1");
      text("kernel", "Kernel", "1");
    }
  }
  box.replaceChildren(...rows);
}
/** Shows a window of the plane, as it is typed. */
function show(text) {
  const numbers = text.split(",").map(Number);
  if (!text.trim()) return whole();
  if (numbers.length !== 4 || !numbers.every(Number.isFinite) || numbers[2] <= 0 || numbers[3] <= 0) return say("a window is x, y, width, height: its lower left corner, and its size above 0");
  asked = numbers;
  draw();
}
function placeAngles(option) {
  document.querySelectorAll(`[data-angle^="${option} "]`).forEach((input) => {
    const at = +input.dataset.angle.split(" ")[1];
    const value = angles(option)[at];
    input.value = at ? value : ((value + 180) % 360 + 360) % 360 - 180;
  });
}
/** Returns a colour as six digits, for a well. */
function hex(text) {
  const probe = document.createElement("canvas").getContext("2d");
  probe.fillStyle = "#000000";
  probe.fillStyle = !text || text === "none" ? "#ffffff" : text;
  return probe.fillStyle.startsWith("#") ? probe.fillStyle : "#000000";
}

// Text: the editor, its mistakes and completions.

const code = $("code");
let typing = 0;
let upon = null; // the text that is typed upon, with its revision
const toPage = (text) => text.replace(/\r\n?/g, "\n");
/** Returns a position of the page's text for one of the file's. */
const inPage = (at) => at - (state.text.slice(0, at).match(/\r\n/g) ?? []).length;
/** Returns the file's text for one of the page, which keeps no returns: what is not changed keeps the ends of its lines. */
function toFile(text, file) {
  const before = toPage(file);
  const least = Math.min(before.length, text.length);
  let [from, back] = [0, 0];
  while (from < least && before[from] === text[from]) from += 1;
  while (back < least - from && before.at(-1 - back) === text.at(-1 - back)) back += 1;
  const ends = /\r\n/.test(file) && !/[^\r]\n/.test(file) ? "\r\n" : "\n";
  const places = [];
  for (let at = 0; at < file.length; at += file.startsWith("\r\n", at) ? 2 : 1) places.push(at);
  places.push(file.length);
  const added = text.slice(from, text.length - back).replaceAll("\n", ends);
  return file.slice(0, places[from]) + added + file.slice(places[before.length - back]);
}

function showText() {
  const text = toPage(state.text);
  if (code.value !== text && !typing) {
    const at = code.selectionStart;
    code.value = text;
    code.selectionStart = code.selectionEnd = Math.min(at, text.length);
  }
  mark();
}
function mark() {
  const marks = $("marks");
  const text = code.value;
  const found = (code.value === toPage(state.text) ? state.problems : []).filter((it) => it.range);
  const parts = [];
  let done = 0;
  for (const { range, severity } of found) {
    let [from, to] = range.map(inPage);
    if (from < done) continue;
    if (to === from) to = Math.min(text.length, from + 1);
    parts.push(text.slice(done, from), make("mark", { className: severity }, text.slice(from, to) || " "));
    done = Math.max(from, to);
  }
  marks.replaceChildren(...parts, text.slice(done) + "\n ");
  [marks.scrollTop, marks.scrollLeft] = [code.scrollTop, code.scrollLeft];
  const mistakes = state.problems.filter((it) => it.severity === "error").length;
  $("mistakes").hidden = !mistakes;
  $("mistakes").textContent = mistakes;
  $("mistakes").setAttribute("aria-label", `${mistakes} mistakes`);
  $("problems").replaceChildren(...state.problems.map((it) => make("li", { className: it.severity }, make("button", { type: "button", onclick: () => goToPlace(it) },
    make("b", {}, it.file ? `${it.file}:${it.line}` : it.line ? `Line ${it.line}` : "File"), ` ${it.message}`, it.hint ? make("small", {}, it.hint) : null))));
}
function goToPlace({ range }) {
  if (!range) return;
  const [from, to] = range.map(inPage);
  code.focus();
  code.setSelectionRange(from, to);
  const line = code.value.slice(0, from).split("\n").length;
  code.scrollTop = Math.max(0, (line - 4) * 20);
}
code.onscroll = () => ([$("marks").scrollTop, $("marks").scrollLeft] = [code.scrollTop, code.scrollLeft]);
code.oninput = (event) => {
  clearTimeout(typing);
  upon ??= state;
  typing = setTimeout(sendText, 220);
  mark();
  if (event.inputType === "insertText") suggest();
  else hideWords();
};
let sending = Promise.resolve();
/** Sends what is typed, once what was typed before has been sent; returns why it is refused, if it is. */
const sendText = () => (sending = sending.then(sendNow));
/** Sends what is typed, before anything else happens to the text. */
async function flush() {
  const { file } = state;
  const refused = await sendText();
  if (refused) throw refused;
  if (state.file !== file) throw left();
}
async function sendNow() {
  const on = upon;
  clearTimeout(typing);
  [typing, upon] = [0, null];
  const text = on && toFile(code.value, on.text);
  if (!on || text === state.text) return null;
  let refused = null;
  try {
    take(await json("PUT", `/text?revision=${on.revision}&tab=${tab}`, text, "text/plain"));
  } catch (error) {
    refused = error;
    say(error.message);
    await refresh().catch(() => {});
  }
  // More may have been typed in the meantime.
  if (upon) upon = state;
  return refused;
}
let suggested = [];
async function suggest() {
  const at = code.selectionStart;
  const { words } = await json("POST", "/complete", { text: code.value, position: at }).catch(() => ({ words: [] }));
  if (at !== code.selectionStart) return;
  suggested = words;
  const list = $("words");
  list.hidden = !words.length;
  if (!words.length) return;
  list.replaceChildren(...words.map(({ word, about }, number) => make("li", { role: "option", id: `word-${number}`, "aria-selected": String(number === 0), onpointerdown: (event) => { event.preventDefault(); pick(number); } }, make("code", {}, word.replace(/: $/, "")), about ? make("small", {}, about) : null)));
  const before = code.value.slice(0, at).split("\n");
  const [x, y] = [before.at(-1).length * 7.53 + 16 - code.scrollLeft, before.length * 20 + 16 - code.scrollTop];
  list.style.left = `${Math.max(4, Math.min(x, code.clientWidth - 330))}px`;
  list.style.top = `${y + 210 > code.clientHeight ? Math.max(4, y - 30 - Math.min(210, list.offsetHeight)) : y}px`;
  code.setAttribute("aria-controls", "words");
  code.setAttribute("aria-activedescendant", "word-0");
}
function hideWords() {
  $("words").hidden = true;
  code.removeAttribute("aria-activedescendant");
}
function pick(number) {
  const { word, replaces } = suggested[number];
  const at = code.selectionStart;
  code.setRangeText(word, at - replaces, at, "end");
  hideWords();
  code.dispatchEvent(new InputEvent("input"));
}
code.onblur = hideWords;
code.onkeydown = (event) => {
  if (event.key === " " && event.ctrlKey) {
    event.preventDefault();
    return suggest();
  }
  if ($("words").hidden) return;
  const list = [...$("words").children];
  const now = list.findIndex((it) => it.getAttribute("aria-selected") === "true");
  const by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
  if (by) {
    event.preventDefault();
    const next = (now + by + list.length) % list.length;
    list.forEach((it, at) => it.setAttribute("aria-selected", String(at === next)));
    list[next].scrollIntoView({ block: "nearest" });
    code.setAttribute("aria-activedescendant", `word-${next}`);
  } else if (event.key === "Enter" || event.key === "Tab") {
    event.preventDefault();
    pick(now);
  } else if (event.key === "Escape") {
    event.stopPropagation();
    hideWords();
  }
};

// Library.

let entries = null;
let wantedTag = "";
async function library() {
  if (!entries) {
    ({ entries } = await json("GET", "/library"));
    const kinds = [...new Set(entries.map((it) => it.id.split("/")[0]))];
    $("shelf").replaceChildren(make("option", { value: "" }, "all"), ...kinds.map((it) => make("option", { value: it }, it.replace("_", " "))));
    const counts = new Map();
    entries.flatMap((it) => it.tags).forEach((it) => counts.set(it, (counts.get(it) ?? 0) + 1));
    const tags = [...counts].filter(([, count]) => count > 1).sort((a, b) => b[1] - a[1]).map(([name]) => name);
    $("tags").replaceChildren(...tags.slice(0, 30).map((it) => make("button", { type: "button", "aria-pressed": "false", onclick: (event) => {
      wantedTag = wantedTag === it ? "" : it;
      [...$("tags").children].forEach((other) => other.setAttribute("aria-pressed", String(other === event.currentTarget && wantedTag !== "")));
      list();
    } }, it)));
  }
  list();
}
const sight = new IntersectionObserver((all) => all.filter((it) => it.isIntersecting).forEach(({ target }) => {
  sight.unobserve(target);
  fill(target, () => call("GET", `/thumb?id=${encodeURIComponent(target.dataset.id)}`));
}));
function list() {
  const text = $("search").value.trim().toLowerCase();
  const fits = (it) => [it.name, it.title ?? "", ...it.tags].some((word) => word.toLowerCase().includes(text)) && it.id.startsWith($("shelf").value) && (!wantedTag || it.tags.includes(wantedTag));
  const found = entries.filter(fits);
  const isRule = state.design?.panels.some((it) => it.role === "initiator");
  sight.disconnect();
  waiting.length = 0;
  $("entries").replaceChildren(...found.map((it) => {
    const image = make("img", { alt: "", "data-id": it.id });
    sight.observe(image);
    return make("li", {}, make("button", { type: "button", title: [it.title, it.source].filter(Boolean).join("\n"), onclick: () => openEntry(it.id) }, image, make("span", {}, it.title || it.name), make("span", { className: "quiet" }, it.is_component ? `${it.kind.replace("_", " ")} ${it.name}` : it.name)), ...(it.is_component && isRule ? [make("button", { type: "button", className: "use", title: `Use this ${it.kind.replace("_", " ")} in the rule`, "aria-label": `Use ${it.title || it.name}`, onclick: () => loaded().then((design) => design.use(it)) }, "Use")] : []));
  }));
  if (!found.length) $("entries").append(make("li", { className: "quiet" }, "Nothing has this in its name, title or tags."));
}
async function openEntry(id) {
  const open = async () => {
    await flush();
    opened(await json("POST", "/open", { tab, id }));
  };
  if (state.isSaved || !state.canUndo) return open().catch((error) => say(error.message));
  ask("Open a copy", [make("p", {}, "The text is not saved. Undo brings it back.")], { go: "Open", act: open });
}
/** Begins a file as `kfrac new` does. */
function beginFile() {
  const name = make("input", { type: "text", value: "my-fractal", required: true });
  const kind = make("select", {}, ...choices.kinds.map((it) => make("option", { value: it.name }, it.about.replace(/^an? /, ""))));
  const space = tick();
  const isKept = state.isSaved || !state.canUndo;
  ask("New", [
    make("label", {}, "Name", name),
    make("label", {}, "Kind", kind),
    make("label", {}, space, " In space"),
    isKept ? null : make("p", {}, "The text is not saved. Undo brings it back."),
  ].filter(Boolean), { go: "Begin", act: async () => {
    await flush();
    opened(await json("POST", "/new", { tab, name: name.value, kind: kind.value, space: space.checked }));
    // The design of an L-system is its text.
    openTab($(kind.value === "lsystem" ? "tab-text" : "tab-design"));
  } });
  name.select();
}
$("search").oninput = list;
$("shelf").onchange = list;

// Dialogs.

function ask(heading, body, { go = "", act = null } = {}) {
  const dialog = $("ask");
  $("ask-title").textContent = heading;
  $("ask-body").replaceChildren(...body);
  $("ask-error").textContent = "";
  $("ask-go").hidden = !go;
  $("ask-go").textContent = go;
  $("ask-go").className = "main";
  $("ask-cancel").onclick = () => dialog.close();
  dialog.querySelector("form").onsubmit = async (event) => {
    event.preventDefault();
    try {
      if ((await act?.()) !== false) dialog.close();
    } catch (error) {
      $("ask-error").textContent = error.message;
    }
  };
  if (!dialog.open) dialog.showModal();
}
const isFile = /\.(ya?ml|json)$/;
const base = () => state.name.split(/[\\/]/).at(-1);
const stem = () => base().replace(isFile, "");
function saveAs() {
  const name = make("input", { type: "text", value: isFile.test(state.name) ? base() : `${base()}.yaml`, required: true });
  const inLibrary = tick();
  const replace = tick();
  ask("Save as", [
    make("label", {}, `File, below ${state.start}`, name),
    state.library ? make("label", {}, inLibrary, ` In my library, ${state.library}`) : null,
    make("label", {}, replace, " Replace a file of this name"),
  ].filter(Boolean), { go: "Save", act: async () => {
    await flush();
    take(await json("POST", "/save", { tab, path: name.value.trim(), library: inLibrary.checked, replace: replace.checked }));
    entries = null;
  } });
}
async function save() {
  if (!state.path) return saveAs();
  try {
    await flush();
    take(await json("POST", "/save", { tab }));
    say("");
    $("status").textContent = `Saved ${state.path}`;
  } catch (error) {
    say(error.message);
    await refresh();
  }
}
$("save").onclick = save;
$("save-as").onclick = saveAs;
$("mine-as").onclick = saveAs;
/** Asks for a file, and writes it. */
function exports(heading, formats, more, note = "") {
  const format = make("select", {}, ...formats.map((it) => make("option", { value: it }, it)));
  const name = make("input", { type: "text", value: `${stem()}.${formats[0]}`, required: true });
  const [width, height] = [canvas.width, canvas.height].map((value) => make("input", { type: "number", min: 1, max: 100000, value }));
  const replace = tick();
  const command = make("code", {});
  const write = () => (command.textContent = note && `${note} --size=${width.value}x${height.value} --output=${/^[\w./-]*$/.test(name.value) ? name.value : `'${name.value}'`}`);
  for (const field of [name, width, height]) field.oninput = write;
  format.onchange = () => {
    name.value = name.value.replace(/\.[^.]*$/, "") + `.${format.value}`;
    write();
  };
  write();
  const done = make("p", { className: "quiet", role: "status" });
  ask(heading, [
    make("label", {}, "Format", format),
    make("label", {}, `File, below ${state.start}`, name),
    make("div", { className: "row" }, make("label", {}, "Width in pixels", width), make("label", {}, "Height in pixels", height)),
    ...more.map(([option, label]) => make("label", {}, option, label)),
    make("label", {}, replace, " Replace a file of this name"),
    command,
    done,
  ], { go: "Export", act: async () => {
    done.textContent = "Writing…";
    try {
      const options = Object.fromEntries(more.map(([option]) => [option.name, option.checked]));
      const { path, summary, notes } = await json("POST", "/export", { tab, path: name.value.trim(), width: +width.value, height: +height.value, replace: replace.checked, film: Boolean(note), ...options });
      done.textContent = [`${path}: ${summary}`, ...notes].join("\n");
    } catch (error) {
      done.textContent = "";
      throw error;
    }
    return false;
  } });
}
$("export").onclick = () => exports("Export", state.isInSpace ? ["png", "svg", "pdf", "dxf", "usda", "3mf", "glb", "pov", "stl", "obj", "ply", "csv", "json"] : ["svg", "png", "pdf", "dxf", "csv", "json"], [[tick({ name: "plot" }), " Single strokes, for a plotter"]]);
$("film-export").onclick = () => film.frames().then(({ command }) => exports("Export the film", ["gif", "apng", "y4m", "mp4", "webm"], [], command), (error) => say(error.message));
$("help").onclick = () => {
  const keys = [["[ and ]", "a step back, a step forward"], ["+ − 0", "zoom in, zoom out, show all"], ["arrows", "on the picture: move it, and with Shift turn it; in space turn it, with Ctrl move it, with Shift turn the light"], ["wheel, drag", "zoom about the pointer; move, and with Shift turn; in space turn, with Ctrl or the right button move, with Shift turn the light"], ["R", "another seed"], ["Ctrl+S", "save"], ["Ctrl+Z, Ctrl+Shift+Z", "undo, redo"], ["Ctrl+Space", "in the text: completions"], [". and ,", "in a figure: choose the next handle, the one before"], ["arrows, 1 2 3 4, F V C U B, S, Delete", "in a figure: move the point; direction, in space 1 to 8; fertile, visible, connected, use, base element; split; remove"], ["W, R", "in a figure of space: another view; roll"], ["P, arrows, Space, Enter", "in a figure: draw, go to a point, place it, end"], ["G, Esc", "in a figure: grid; cancel"], ["?", "these keys"]];
  ask("Keys", [make("dl", {}, ...keys.flatMap(([name, about]) => [make("dt", {}, name), make("dd", {}, about)]))]);
};
$("copy").onclick = async () => {
  await navigator.clipboard.writeText(drawn?.command ?? "").catch(() => getSelection().selectAllChildren($("command")));
  $("copy").textContent = "Copied";
  setTimeout(() => ($("copy").textContent = "Copy command"), 1500);
};
document.querySelectorAll("[data-settle]").forEach((button) => (button.onclick = () => json("POST", "/settle", { tab, theirs: button.dataset.settle === "theirs" }).then(take, (error) => (say(error.message), refresh()))));

// Undo, tabs and keys.

async function travel(path) {
  try {
    await flush();
    take(await json("POST", path, { tab }));
  } catch (error) {
    say(error.message);
  }
}
$("undo").onclick = () => travel("/undo");
$("redo").onclick = () => travel("/redo");
let design = null;
/** Returns the code of the figures of a design, which is loaded when they are seen first. */
const loaded = () => (design ??= import("./design.js").then(
  (it) => (it.start({ tab, call, json, make, take, ask, refresh, stepNow, state: () => state, images: underlay.images, forget: () => (entries = null) }), it),
  (error) => { design = null; throw error; },
));
/** Shows the figures of the design, if its tab is open. */
async function figures() {
  if ($("design").hidden) return;
  underlay.show();
  try {
    (await loaded()).show();
  } catch (error) {
    say(error.message);
  }
}
/** Asks for the figures of the values that are set. */
async function redesign() {
  try {
    const { design } = await json("GET", "/state");
    state.design = design;
    figures();
  } catch (error) {
    say(error.message);
  }
}
const tabs = [...document.querySelectorAll("[role=tab]")];
function openTab(button, focuses = false) {
  tabs.forEach((it) => {
    it.setAttribute("aria-selected", String(it === button));
    it.tabIndex = it === button ? 0 : -1;
    $(it.getAttribute("aria-controls")).hidden = it !== button;
  });
  if (focuses) button.focus();
  sessionStorage.setItem("tab", button.id);
  if (button.id === "tab-library") library().catch((error) => say(error.message));
  if (button.id === "tab-text") mark();
  if (button.id === "tab-design" && state.design !== undefined) redesign();
  document.body.classList.toggle("designs", button.id === "tab-design");
  if (state.design !== undefined) figures();
}
tabs.forEach((button, at) => {
  button.onclick = () => openTab(button);
  button.onkeydown = (event) => {
    const by = { ArrowRight: 1, ArrowLeft: -1, Home: -at, End: tabs.length - 1 - at }[event.key];
    if (by !== undefined) openTab(tabs[(at + by + tabs.length) % tabs.length], true);
  };
});
document.addEventListener("keydown", (event) => {
  const command = event.ctrlKey || event.metaKey;
  const name = event.key.toLowerCase();
  if ($("ask").open && !(command && name === "s")) return;
  if (command && name === "s") $("ask").open || save();
  else if (command && name === "z") travel(event.shiftKey ? "/redo" : "/undo");
  else if (command && name === "y") travel("/redo");
  else {
    if (command || event.altKey || event.target.matches("input, textarea, select")) return;
    const act = { "[": () => $("back").click(), "]": () => $("forward").click(), "+": () => $("zoom-in").click(), "=": () => $("zoom-in").click(), "-": () => $("zoom-out").click(), 0: whole, r: () => $("seeds").hidden || another(), "?": () => $("help").click() }[name];
    if (!act) return;
    act();
  }
  event.preventDefault();
});

// State.

/** Forgets what was begun in the file that has been left. */
function leave() {
  clearTimeout(typing);
  [typing, upon] = [0, null];
  film.stop();
  $("ask").close();
  [pending, asked, isStale] = [still(), null, false];
}
/** Takes the state of the server. */
function take(next) {
  // Answers may arrive in another order.
  if (next.revision < state.revision) return;
  const before = state;
  state = next;
  if (before.file !== state.file) leave();
  const isNew = before.revision !== state.revision;
  document.title = `${title()} – kfrac studio`;
  $("title").textContent = title();
  $("file").textContent = state.path ?? `${state.name}, a copy that is not saved`;
  $("file").className = state.isSaved ? "quiet" : "quiet unsaved";
  $("undo").disabled = !state.canUndo;
  $("redo").disabled = !state.canRedo;
  $("conflict").hidden = state.theirs == null;
  $("paper").classList.toggle("wrong", !state.isGood);
  $("veil").hidden = state.isGood || !state.hasGood;
  if (!state.hasGood) say("There is nothing to draw yet: the text has mistakes.");
  $("factor").value = factor(state.factor);
  $("follow-label").hidden = state.isInSpace;
  showText();
  if (isNew || JSON.stringify(state.look) !== JSON.stringify(look)) {
    look = state.look;
    look.options ??= {};
    $("seed").value = look.seed;
    $("follow").checked = look.follows;
    const drags = Boolean(state.hand?.drags);
    if (state.hasGood && !drags) {
      family();
      style();
    }
    placeSteps();
    draw(drags);
    if (!drags) recount();
  }
  figures();
}
const refresh = async () => take(await json("GET", "/state"));
let counting = 0;
/** Asks for forecast and dimension. */
function recount() {
  pads.forEach(lay);
  clearTimeout(counting);
  counting = setTimeout(async () => {
    if (!state.hasGood) return;
    try {
      numbers = await json("GET", `/numbers?tab=${tab}`);
      $("seeds").hidden = !numbers.is_random;
      $("dimension").textContent = numbers.dimension.join("  ·  ");
      $("dimension").title = numbers.dimension.join("\n");
      placeSteps();
    } catch (error) {
      if (error.status !== 410) $("dimension").textContent = error.message;
    }
  }, 60);
}
/** Follows changes that others make: other tabs, and other programs. */
async function follow() {
  for (;;) {
    try {
      const reader = (await call("GET", "/events")).body.pipeThrough(new TextDecoderStream()).getReader();
      let rest = "";
      for (;;) {
        const { value, done } = await reader.read();
        if (done) break;
        const lines = (rest + value).split("\n");
        rest = lines.pop();
        const data = lines.filter((it) => it.startsWith("data:")).map((it) => JSON.parse(it.slice(5)));
        if (data.some((it) => it.tab !== tab)) await refresh();
      }
    } catch {
      say("The studio has ended: its terminal has no connection to this page.");
    }
    await new Promise((resolve) => setTimeout(resolve, 1500));
    if (await json("GET", "/state").then((next) => (take(next), true), () => false)) say("");
  }
}

/** Opens a copy, whose look is its own. */
function opened(next) {
  take(next);
  look = state.look;
  changed();
}
film.start({ tab, json, make, say, values, changed, state: () => state, look: () => look });
try {
  [choices, state] = await Promise.all([json("GET", "/choices"), json("GET", "/state")]);
  underlay.start({ tab, call, json, take, say, flush, fitted: opened, state: () => state, choices: () => choices, redraw: figures, opened: () => openTab($("tab-design")) });
  $("new").onclick = beginFile;
  $("film-ease").append(...choices.ease.map((it) => make("option", {}, it)));
  const first = state;
  state = {};
  resize();
  take(first);
  openTab($(sessionStorage.getItem("tab") ?? "") ?? tabs[0]);
  follow();
} catch (error) {
  say(error.message);
}
