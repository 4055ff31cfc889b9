// Design by hand: figures with handles. Where a point comes to rest, and what is written, is decided by the server.

const SVG = "http://www.w3.org/2000/svg";
const $ = (id) => document.getElementById(id);
let page = null; // what the rest of the page lends: tab, call, json, make, state, take, ask, refresh, stepNow, images, forget
let chosen = null; // panel, what, index
let held = null; // panel and window while a pointer is down
let drawing = null; // panel and points of a polyline that is drawn
let waiting = null; // the latest movement that is not sent yet
let isSending = false;
let file = null; // number of the file that is designed
let isOld = false; // whether fields are those of the file before
let components = null; // those of the library, once they are asked for

const svg = (name, properties = {}, ...children) => {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(properties)) element.setAttribute(key, value);
  element.append(...children);
  return element;
};
const scene = () => page.state().design;
const panelOf = (id) => scene()?.panels.find((it) => it.id === id);
const button = (text, act, more = {}) => page.make("button", { type: "button", className: "small", onclick: act, ...more }, text);

export function start(lent) {
  page = lent;
  $("design-view").onchange = () => view($("design-view").value);
  $("design-grid").onchange = $("design-parts").onchange = $("design-lock").onchange = $("design-table").ontoggle = show;
  document.addEventListener("keydown", keys, true);
}

/** Sends a gesture; returns whether it was done. */
async function act(gesture) {
  try {
    page.take(await page.json("POST", "/edit", { tab: page.tab, gesture }));
    say("");
    return true;
  } catch (error) {
    await failed(error);
    return false;
  }
}
/** Shows figures of space from another side. */
async function view(view) {
  try {
    page.take(await page.json("POST", "/design/view", { tab: page.tab, view }));
  } catch (error) {
    say(error.message);
  }
}
/** Shows why a gesture failed; one upon a text that has changed meanwhile shows that text. */
async function failed(error) {
  if (error.status === 409) await page.refresh().catch(() => {});
  say(error.message);
}
const say = (text) => ($("design-badge").textContent = text);

async function send(pointer) {
  const grid = $("design-grid").value;
  const more = { parts: Math.max(1, Math.round(+$("design-parts").value) || 12), unlocked: !$("design-lock").checked, ...(grid && { grid }) };
  try {
    const next = await page.json("POST", "/pointer", { tab: page.tab, pointer: { ...more, ...pointer } });
    if (next.hand.selected && pointer.phase === "down") chosen = next.hand.selected;
    else if (pointer.phase === "down") chosen = null;
    page.take(next);
    say(next.hand.badge ?? "");
    return next;
  } catch (error) {
    await failed(error);
    return null;
  }
}
/** Sends movements, one at a time: the latest one waits for the answer to the one before. */
async function move(pointer) {
  waiting = pointer;
  if (isSending) return;
  isSending = true;
  while (waiting) {
    const next = waiting;
    waiting = null;
    await send(next);
  }
  isSending = false;
}
async function settled() {
  while (isSending || waiting) await new Promise((resolve) => setTimeout(resolve, 4));
}

// Figures.

/** Shows the design of a state. */
export function show() {
  const all = scene();
  if (file !== page.state().file) {
    file = page.state().file;
    isOld = true;
    chosen = held = drawing = waiting = null;
  }
  $("design-why").textContent = all?.why ?? (all ? "" : "The text has mistakes: there is nothing to take hold of.");
  $("design-tools").hidden = !all || Boolean(all.why);
  $("design-figure").hidden = !all?.why;
  $("design-table").hidden = !all || Boolean(all.why);
  if (!all) return;
  if (all.why) picture();
  $("design-view-label").hidden = !all.view;
  if (all.view) $("design-view").value = all.view;
  if (chosen && !exists(chosen)) chosen = null;
  const box = $("design-figures");
  const old = new Map([...box.children].map((it) => [it.dataset.panel, it]));
  const blocks = all.panels.map((panel) => {
    const block = old.get(panel.id) ?? figure(panel.id);
    fill(block, panel);
    return block;
  });
  if (blocks.length !== box.children.length || blocks.some((it, at) => box.children[at] !== it)) box.replaceChildren(...blocks);
  const isBusy = $("design").contains(document.activeElement) && document.activeElement.matches("input, select") && document.activeElement.closest("#design-chosen, #design-table, #design-select");
  if (!isBusy || isOld) {
    isOld = false;
    chosenBox();
    table();
    selection();
  }
}
/** Shows the figure of a rule that is designed in its text. */
async function picture() {
  const image = $("design-figure");
  const { revision, look } = page.state();
  const about = JSON.stringify([revision, look.set, look.options.from]);
  if (image.dataset.about === about) return;
  image.dataset.about = about;
  try {
    const url = URL.createObjectURL(await (await page.call("GET", `/figure?tab=${page.tab}`)).blob());
    image.onload = () => URL.revokeObjectURL(url);
    image.src = url;
    image.alt = `Figure of ${page.state().about?.title || page.state().name}, as kfrac show draws it`;
  } catch (error) {
    if (error.status !== 410) image.alt = error.message;
    else image.dataset.about = "";
  }
}
const exists = ({ panel, what, index }) => Boolean({ point: panelOf(panel)?.points, element: panelOf(panel)?.elements, map: panelOf(panel)?.maps, limit: panelOf(panel)?.limits }[what]?.[index]);

function figure(id) {
  const drawn = svg("svg", { tabindex: 0, role: "application" });
  const block = page.make("section", { "data-panel": id, className: "figure" }, page.make("div", { className: "row" }), drawn);
  const at = (event) => {
    const box = drawn.getBoundingClientRect();
    const [x, y, wide, high] = drawn.dataset.view.split(" ").map(Number);
    const pixel = Math.max(wide / box.width, high / box.height);
    return { panel: id, x: x + wide / 2 + (event.clientX - box.left - box.width / 2) * pixel, y: y + high / 2 - (event.clientY - box.top - box.height / 2) * pixel, pixel, shift: event.shiftKey, alt: event.altKey };
  };
  drawn.addEventListener("pointerdown", async (event) => {
    event.preventDefault();
    drawn.focus();
    if (drawing?.panel === id) return place(at(event));
    drawn.setPointerCapture(event.pointerId);
    held = { panel: id, view: drawn.dataset.view };
    await settled();
    move({ ...at(event), phase: "down" });
    await settled();
  });
  drawn.addEventListener("pointermove", (event) => {
    if (drawing?.panel === id) move({ ...at(event), phase: "hover", drawn: drawing.points });
    else if (held?.panel === id) settledDown().then(() => held && move({ ...at(event), phase: "move" }));
  });
  drawn.addEventListener("pointerup", async (event) => {
    if (held?.panel !== id) return;
    const last = at(event);
    await settled();
    held = null;
    await send({ ...last, phase: "up" });
  });
  drawn.addEventListener("pointercancel", () => cancel(id));
  drawn.addEventListener("dblclick", (event) => !drawing && send({ ...at(event), phase: "double" }));
  return block;
}
// A movement must not take the place of the press that waits.
const settledDown = async () => {
  while (waiting?.phase === "down") await new Promise((resolve) => setTimeout(resolve, 4));
};
async function cancel(id) {
  held = null;
  waiting = null;
  await settled();
  await send({ panel: id, x: 0, y: 0, pixel: 1, phase: "cancel" });
}

// Components.

/** Whether a panel shows a component of a rule, and no further part of one. */
const isComponent = ({ role, id }) => role === "initiator" || (role === "generator" && !/parts\/[1-9]/.test(id)) || id === "base_element";
async function load() {
  components = [];
  ({ entries: components } = await page.json("GET", "/library"));
  show();
}
/** A choice of the components of a kind, of which one takes the place of what a panel shows. */
function exchange(kind, panel, label) {
  if (!components) load();
  const { make } = page;
  const names = components.filter((it) => it.is_component && it.kind === kind);
  return make("select", { className: "small", "aria-label": label, onchange: (event) => event.target.value && act({ act: "exchange", panel, name: event.target.value }) }, make("option", { value: "" }, "From the library…"), ...names.map((it) => make("option", { value: it.name }, it.title || it.name)));
}
/** Uses a component of the library in the rule. */
export function use({ kind, name }) {
  const panel = kind === "generator" ? scene()?.panels.find((it) => it.role === "generator")?.id ?? kind : kind;
  return act({ act: "exchange", panel, name });
}
async function saveComponent(panel, name) {
  try {
    page.take(await page.json("POST", "/component", { tab: page.tab, panel, name }));
    components = null;
    page.forget();
    show();
    say(`Saved in your library as '${name}'.`);
    return true;
  } catch (error) {
    say(error.message);
    return false;
  }
}

function fill(block, panel) {
  const isDraw = drawing?.panel === panel.id;
  const head = [page.make("h3", {}, panel.title)];
  const generator = panel.role === "generator" ? /^generators\/([^/]+)/.exec(panel.id)?.[1] ?? "generator" : null;
  if (panel.why?.startsWith("it is written in")) head.push(button("Make it mine", () => act({ act: "own", panel: panel.id }), { title: panel.why }));
  if (panel.role !== "maps" && !(scene().view === "left" && panel.role === "generator")) head.push(button(isDraw ? "Done" : "Draw", () => (isDraw ? finish() : begin(panel.id)), { title: "Draw a polyline (P, clicks, Enter)", "aria-pressed": String(isDraw) }));
  if (isComponent(panel)) {
    head.push(exchange(panel.role, panel.id, `${panel.title}: from the library`));
    if (!panel.why) head.push(button("Save…", () => name("Save as a component", "mine", (to) => saveComponent(panel.id, to)), { title: "Save as a component, in your library" }));
  }
  if (generator) {
    head.push(button("Add a copy", () => name("A further generator", generator === "generator" ? "second" : `${generator}-2`, (to) => act({ act: "add_generator", from: generator === "generator" ? "first" : generator, name: to })), { title: "Add a generator: a copy of this one" }));
    if (scene().generators.length > 1) head.push(
      button("Rename", () => name("Another name", generator, (to) => act({ act: "rename_generator", from: generator, to }))),
      button("Remove", () => act({ act: "remove_generator", name: generator })));
  }
  if (panel.shrink !== null) head.push(field("shrink", panel.shrink, (value) => act({ act: "set", at: "vertices/shrink", value }), { size: 6, "aria-label": "factor of the maps towards the vertices" }));
  const isTyping = block.firstElementChild.contains(document.activeElement) && document.activeElement.matches("input");
  if (!isTyping) block.firstElementChild.replaceChildren(...head);
  const drawn = block.lastElementChild;
  const wide = block.clientWidth || 340;
  let [x0, y0, x1, y1] = panel.window;
  if (held?.panel === panel.id) [x0, y0, x1, y1] = ((it) => [it[0], it[1], it[0] + it[2], it[1] + it[3]])(held.view.split(" ").map(Number));
  const high = Math.max(panel.role === "generator" || panel.role === "maps" ? 200 : 120, Math.min(panel.role === "generator" || panel.role === "maps" ? 340 : 160, wide * (y1 - y0) / (x1 - x0)));
  drawn.dataset.view = `${x0} ${y0} ${x1 - x0} ${y1 - y0}`;
  drawn.setAttribute("viewBox", `${x0} ${-y1} ${x1 - x0} ${y1 - y0}`);
  drawn.style.height = `${high}px`;
  const count = panel.maps.length ? `${panel.maps.length} ${panel.maps[0].is_instance ? "instances" : "maps"}` : `${panel.points.length} points, ${panel.elements.length} elements`;
  drawn.setAttribute("aria-label", `${panel.title}: ${count}. Full stop and comma choose a handle, arrow keys move it.`);
  const pixel = Math.max((x1 - x0) / wide, (y1 - y0) / high);
  const parts = [...page.images(panel), ...grid(panel, pixel, [x0, y0, x1, y1])];
  for (const ghost of panel.ghosts) parts.push(svg("polyline", { class: "ghost", points: ghost.map(([x, y]) => `${x},${-y}`).join(" ") }));
  for (const face of panel.faces) parts.push(svg("polygon", { class: "face", points: face.map((at) => `${panel.points[at].x},${-panel.points[at].y}`).join(" ") }));
  panel.elements.forEach((it, index) => parts.push(...element(panel, it, index, pixel)));
  panel.maps.forEach((it, index) => parts.push(...parallelogram(panel, it, index, pixel)));
  panel.points.forEach((it, index) => {
    const isChosen = chosen?.panel === panel.id && chosen.what === "point" && chosen.index === index;
    parts.push(svg("circle", { class: `handle ${it.basis}${it.pinned ? " pinned" : ""}${isChosen ? " chosen" : ""}`, cx: it.x, cy: -it.y, r: (isChosen ? 8 : 5.5) * pixel }));
  });
  panel.limits.forEach((it, index) => {
    const isChosen = chosen?.panel === panel.id && chosen.what === "limit" && chosen.index === index;
    parts.push(svg("circle", { class: `handle limit${isChosen ? " chosen" : ""}`, cx: it.at[0], cy: -it.at[1], r: (isChosen ? 6.5 : 4) * pixel }));
  });
  if (isDraw) {
    const all = [...drawing.at, ...(drawing.next ? [drawing.next] : [])];
    parts.push(svg("polyline", { class: "drawing", points: all.map(([x, y]) => `${x},${-y}`).join(" ") }));
    all.forEach(([x, y]) => parts.push(svg("circle", { class: "handle chosen", cx: x, cy: -y, r: 4.5 * pixel })));
  }
  drawn.replaceChildren(...parts);
  drawn.classList.toggle("closed", Boolean(panel.why));
  drawn.classList.toggle("draws", isDraw);
}
function* grid(panel, pixel, [x0, y0, x1, y1]) {
  if (panel.role !== "maps") yield svg("line", { class: "unit", x1: 0, y1: 0, x2: 1, y2: 0 });
  else yield svg("rect", { class: "unit", x: 0, y: -1, width: 1, height: 1 });
  const kind = $("design-grid").value;
  const cell = 1 / Math.max(1, +$("design-parts").value || 12);
  if (!kind || (x1 - x0) / cell > 60) return;
  const high = kind === "triangular" ? cell * Math.sqrt(3) / 2 : cell;
  for (let row = Math.ceil(y0 / high); row * high < y1; row += 1) {
    const off = kind === "triangular" && row % 2 ? cell / 2 : 0;
    const dots = [];
    for (let column = Math.ceil((x0 - off) / cell); column * cell + off < x1; column += 1) dots.push(`M${column * cell + off} ${-row * high}h0`);
    yield svg("path", { class: "grid", d: dots.join(""), "stroke-width": 2.2 * pixel });
  }
}
function element(panel, it, index, pixel) {
  const [a, b] = [panel.points[it.from], panel.points[it.to]];
  const isChosen = chosen?.panel === panel.id && chosen.what === "element" && chosen.index === index;
  const kind = `element${it.fertile ? "" : " infertile"}${it.visible ? "" : " invisible"}${isChosen ? " chosen" : ""}`;
  const line = svg("line", { class: kind, x1: a.x, y1: -a.y, x2: b.x, y2: -b.y });
  if (panel.role === "base_element" || !it.fertile) return [line];
  // The arrow of the direction: 1 and 2 forwards, 3 and 4 backwards; the flag stands on the side that is up.
  const [x, y] = [a.x + 0.62 * (b.x - a.x), a.y + 0.62 * (b.y - a.y)];
  const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
  const [u, v] = [(b.x - a.x) / length, (b.y - a.y) / length];
  // Directions 5 to 8 are those with the third axis reflected.
  const flat = (it.direction - 1) % 4;
  const [along, side] = [flat > 1 ? -1 : 1, flat % 2 ? -1 : 1];
  const size = Math.min(9 * pixel, 0.22 * length);
  const at = (s, t) => `${x + size * (s * along * u - t * side * v)} ${-(y + size * (s * along * v + t * side * u))}`;
  return [line, svg("path", { class: `arrow${isChosen ? " chosen" : ""}`, d: `M${at(1, 0)}L${at(-0.8, 0)}L${at(-0.8, 0.95)}Z${it.direction > 4 ? `M${at(-0.8, -0.3)}L${at(0.6, -0.3)}L${at(0.6, -0.5)}L${at(-0.8, -0.5)}Z` : ""}` })];
}
function parallelogram(panel, it, index, pixel) {
  const isChosen = chosen?.panel === panel.id && chosen.what === "map" && chosen.index === index;
  const [o, x, y] = it.frame;
  const far = [x[0] + y[0] - o[0], x[1] + y[1] - o[1]];
  const kind = isChosen ? " chosen" : "";
  const middle = [(o[0] + far[0]) / 2, (o[1] + far[1]) / 2];
  // The box of a map in space: the face behind, and the edges to it.
  const behind = it.depth && Math.hypot(...it.depth) > pixel ? [svg("path", { class: "box", d: [o, x, far, y].map((at, i, all) => { const to = all[(i + 1) % 4]; const [u, v] = it.depth; return `M${at[0]} ${-at[1]}L${at[0] + u} ${-at[1] - v}L${to[0] + u} ${-to[1] - v}`; }).join("") })] : [];
  const name = svg("text", { class: "name", x: middle[0], y: -middle[1], "font-size": 12 * pixel });
  name.textContent = it.name;
  return [...behind, svg("polygon", { class: `map${kind}`, points: [o, x, far, y].map((at) => `${at[0]},${-at[1]}`).join(" ") }), name,
    ...[[o, "corner"], [x, "x"], [y, "y"]].map(([at, what]) => svg("circle", { class: `handle ${it.basis} ${what}${kind}`, cx: at[0], cy: -at[1], r: 5 * pixel }))];
}

// The chosen handle, as fields.

function chosenBox() {
  const box = $("design-chosen");
  box.hidden = !chosen;
  if (!chosen) return;
  const { panel: id, what, index } = chosen;
  const panel = panelOf(id);
  const { make } = page;
  if (what === "point") {
    box.replaceChildren(make("b", {}, `Point ${index}`), ...coordinates(id, panel.points[index], index), button("Delete", () => act({ act: "join", panel: id, point: index }), { title: "Delete: the elements that meet here become one" }));
  } else if (what === "element") {
    const it = panel.elements[index];
    box.replaceChildren(make("b", {}, `Element ${index + 1}`), ...elementFields(id, it, index), button("Split", () => act({ act: "split", panel: id, element: index }), { title: "Split in its middle (S)" }), button("Delete", () => act({ act: "join", panel: id, point: it.to })));
  } else if (what === "limit") {
    const it = panel.limits[index];
    box.replaceChildren(make("b", {}, `${it.side ? "Largest" : "Least"} values of point ${it.point}`), make("span", { className: "quiet" }, `[${panel.points[it.point].text.join(", ")}]`));
  } else {
    const it = panel.maps[index];
    const at = id + "/" + (Number.isNaN(+it.name) ? it.name : it.name - 1);
    const weight = it.is_instance ? [] : [field("weight", it.weight ?? "", (value) => act(value ? { act: "set", at: `${at}/weight`, value } : { act: "remove", at: `${at}/weight` }))];
    const copies = id === "objects" ? [] : [button("Copy", () => act({ act: "add_map", panel: id, map: index })), button("Delete", () => act({ act: "remove_map", panel: id, map: index }))];
    box.replaceChildren(make("b", {}, titled(it)), make("span", { className: "quiet" }, it.form), ...weight, ...copies);
  }
}
const titled = (map) => `${map.is_instance ? "Instance" : "Map"} ${map.name}`;
const field = (label, value, act, more = {}) => page.make("label", {}, `${label} `, page.make("input", { type: "text", value, autocomplete: "off", spellcheck: false, onchange: (event) => { event.target.blur(); act(event.target.value.trim()); }, ...more }));
function coordinates(id, it, index) {
  const write = (axis) => (value) => act({ act: "place", panel: id, point: index, x: axis ? it.text[0] : value, y: axis ? value : it.text[1] });
  return ["x", "y"].map((name, axis) => field(name, it.text[axis], write(axis), { "aria-label": `${name} of point ${index}` }));
}
function elementFields(id, it, index) {
  const { make } = page;
  const key = (key) => (value) => act({ act: "key", panel: id, element: index, key, value: value || null });
  if (it.entry === null) return [make("span", { className: "quiet" }, "closes the figure")];
  const options = (now, list) => list.map(([value, text]) => make("option", { value, selected: value === now }, text));
  const directions = ["normal", "sides swapped", "ends swapped", "both"].map((name, at) => [String(at + 1), `${at + 1} ${name}`]);
  if (scene().view) directions.push(...directions.map(([, name], at) => [String(at + 5), `${at + 5} ${name.slice(2)}, front and back`]));
  const direction = make("select", { "aria-label": `direction of element ${index + 1}`, onchange: (event) => key("direction")(event.target.value) }, ...options(String(it.direction), directions));
  const flags = ["fertile", "visible", "connected"].map((name) => make("label", {}, make("input", { type: "checkbox", checked: it[name], onchange: (event) => key(name)(String(event.target.checked)) }), name));
  const generators = scene().generators;
  const uses = generators.length ? make("select", { "aria-label": `generator of element ${index + 1}`, onchange: (event) => key("use")(event.target.value) }, ...options(it.use ?? "", [["", "as selected"], ...generators.map((name) => [name, `use ${name}`])])) : null;
  return [direction, ...flags, uses, scene().view ? field("roll", it.roll ?? "", key("roll"), { size: 4 }) : null, field("base element", it.base_element ?? "", key("base_element"), { size: 8 })].filter(Boolean);
}
function table() {
  const { make } = page;
  if (!$("design-table").open) return;
  const rows = scene().panels.flatMap((panel) => [
    make("h3", {}, panel.title),
    ...panel.points.map((it, index) => make("div", { className: "row wrap" }, make("span", {}, `Point ${index}`), ...coordinates(panel.id, it, index))),
    ...(panel.role === "generator" || panel.role === "initiator" ? panel.elements.map((it, index) => make("div", { className: "row wrap" }, make("span", {}, `Element ${index + 1}`), ...elementFields(panel.id, it, index))) : []),
    ...panel.maps.map((it) => make("div", { className: "row wrap" }, make("span", {}, `${titled(it)}: ${it.form || "as it is"}`))),
  ]);
  $("design-rows").replaceChildren(...rows);
}
/** Shows the selection: chips by index, sliders of weights, rows of conditions. */
function selection() {
  const { make } = page;
  const { select, generators } = scene();
  const box = $("design-select");
  const rule = scene().panels.some((it) => it.role === "generator");
  const followers = rule ? null : edges();
  box.hidden = !rule && !followers;
  if (!rule) return box.replaceChildren(...(followers ?? []));
  const parts = generators.length > 1 ? [make("h3", {}, "Selection")] : [];
  const set = (at, value) => act({ act: "set", at, value });
  const choice = (now, change) => make("select", { "aria-label": "generator", onchange: (event) => change(event.target.value) }, ...generators.map((name) => make("option", { value: name, selected: name === now }, name)));
  if (Array.isArray(select)) {
    select.forEach((it, at) => parts.push(make("div", { className: "row wrap" }, it.when === undefined ? "else" : field("when", it.when, (value) => set(`select/${at}/when`, value), { size: 14 }), choice(it.use, (value) => set(`select/${at}/use`, value)), it.when === undefined ? null : button("Remove", () => act({ act: "remove", at: `select/${at}` })))));
  } else if (select?.by_index) {
    const list = select.by_index;
    const chips = list.map((name, at) => make("span", { className: "chip" }, choice(name, (value) => set(`select/by_index/${at}`, value)), button("◀", () => set("select/by_index", `[${list.map((it, i) => (i === at ? list[at - 1] : i === at - 1 ? name : it)).join(", ")}]`), { disabled: at === 0, "aria-label": `${name} earlier` }), button("×", () => act({ act: "remove", at: `select/by_index/${at}` }), { disabled: list.length < 2, "aria-label": `remove ${name}` })));
    parts.push(make("div", { className: "row wrap" }, ...chips, button("Add", () => set("select/by_index", `[${[...list, generators[0]].join(", ")}]`))));
  } else if (select?.at_random) {
    for (const [name, weight] of Object.entries(select.at_random)) {
      const range = make("input", { type: "range", min: 0.1, max: Math.max(10, 2 * weight), step: 0.1, value: weight, "aria-label": `weight of ${name}`, onchange: (event) => set(`select/at_random/${name}`, event.target.value) });
      parts.push(make("label", { className: "row" }, make("span", {}, `${name}: ${weight}`), range));
    }
  } else if (generators.length > 1) parts.push(make("p", { className: "quiet" }, "Elements name their generators themselves."));
  if (generators.length > 1) {
    const all = generators.map((it) => it);
    const write = { by_index: `{by_index: [${all.join(", ")}]}`, at_random: `{at_random: {${all.map((it) => `${it}: 1`).join(", ")}}}`, when: `[{when: odd(step), use: ${all[1]}}, {use: ${all[0]}}]` };
    parts.push(make("div", { className: "row wrap" }, ...[["by_index", "By index"], ["at_random", "At random"], ["when", "By condition"]].map(([kind, text]) => {
      const isNow = kind === "when" ? Array.isArray(select) : select?.[kind] !== undefined;
      return button(text, () => isNow || set("select", write[kind]), { "aria-pressed": String(isNow) });
    })));
  }
  if (!scene().panels.some((it) => it.role === "base_element")) parts.push(make("label", {}, "Base element ", exchange("base_element", "base_element", "Base element from the library")));
  parts.push(button("From here on another rule", () => name("From here on another rule", generators.length ? `rule-${generators.length + 1}` : "second", (to) => act({ act: "from_here", step: page.stepNow(), name: to })), { title: "Elements of later steps are replaced by a copy, which can be changed" }));
  box.replaceChildren(...parts);
}
/** Shows which maps of a system may follow each of them: a table of ticks. */
function edges() {
  const { make } = page;
  const maps = panelOf("maps")?.maps ?? [];
  if (maps.length < 2 || maps.length > 12 || panelOf("maps").why) return null;
  const names = maps.map((it) => it.name);
  const number = (name) => (names.indexOf(String(name)) + 1) || +name;
  const written = scene().edges;
  const weights = (list) => new Map(Array.isArray(list) ? list.map((name) => [number(name), null]) : Object.entries(list ?? {}).map(([name, weight]) => [number(name), weight]));
  const all = new Map(names.map((_, at) => [at + 1, null]));
  const known = new Map(Object.entries(written ?? {}).map(([name, list]) => [number(name), weights(list)]));
  const rows = names.map((_, at) => (written ? known.get(at + 1) ?? new Map() : new Map(all)));
  const text = (name) => (/^[A-Za-z0-9][\w-]*$/.test(name) ? name : JSON.stringify(name));
  const toggle = (from, to) => {
    const row = rows[from];
    if (!row.delete(to + 1)) row.set(to + 1, [...row.values()].some((it) => it !== null) ? "1" : null);
    const has = (row) => [...row].sort(([a], [b]) => a - b);
    const line = (row) => ([...row.values()].some((it) => it !== null) ? `{${has(row).map(([to, weight]) => `${text(names[to - 1])}: ${weight ?? 1}`).join(", ")}}` : `[${has(row).map(([to]) => text(names[to - 1])).join(", ")}]`);
    act({ act: "set", at: "edges", value: `{${rows.map((row, at) => `${text(names[at])}: ${line(row)}`).join(", ")}}` });
  };
  const head = make("tr", {}, make("th", {}, "after"), ...names.map((name) => make("th", { scope: "col" }, name)));
  const body = names.map((name, from) => make("tr", {}, make("th", { scope: "row" }, name), ...names.map((other, to) => make("td", {}, make("input", { type: "checkbox", checked: rows[from].has(to + 1), "aria-label": `map ${other} after map ${name}`, onchange: () => toggle(from, to) })))));
  const free = written ? button("Any map may follow", () => act({ act: "remove", at: "edges" })) : null;
  return [make("h3", {}, "Maps that may follow"), make("table", { className: "edges" }, make("tbody", {}, head, ...body)), free].filter(Boolean);
}
function name(title, value, act) {
  const input = page.make("input", { type: "text", value, required: true });
  page.ask(title, [page.make("label", {}, "Name", input)], { go: "OK", act: async () => {
    if (!(await act(input.value.trim()))) throw new Error($("design-badge").textContent);
  } });
}

// Drawing.

function begin(id) {
  drawing = { panel: id, points: [], at: [], next: null, cursor: [0, 0] };
  say("Click the points one after the other, or move with the arrow keys and press Space; Enter ends, Esc cancels.");
  show();
  document.querySelector(`[data-panel="${CSS.escape(id)}"] svg`)?.focus();
}
async function place(at) {
  await settled();
  const mine = drawing;
  if (!mine) return;
  const next = await send({ ...at, phase: "hover", drawn: mine.points });
  if (!next?.place || drawing !== mine) return;
  mine.points.push(next.place.text);
  mine.at.push(next.place.at);
  mine.cursor = next.place.at;
  show();
}
async function finish() {
  if (!drawing) return;
  const { panel, points } = drawing;
  drawing = null;
  await settled();
  await act({ act: "draw", panel, points });
  show();
}

// Keys.

async function keys(event) {
  const block = event.target.closest?.("[data-panel]");
  if (event.key === "Escape" && held) {
    event.preventDefault();
    return cancel(held.panel);
  }
  if (!block || event.target.tagName !== "svg" || event.ctrlKey || event.metaKey) return;
  const id = block.dataset.panel;
  const panel = panelOf(id);
  const own = chosen?.panel === id ? chosen : null;
  const stop = () => { event.preventDefault(); event.stopPropagation(); };
  const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
  const by = (event.shiftKey ? 0.1 : 1) / Math.max(1, +$("design-parts").value || 12);
  if (drawing) {
    if (event.key === "Enter") return stop(), finish();
    if (event.key === "Escape") return stop(), (drawing = null), say(""), show();
    if (event.key === "Backspace") return stop(), drawing.points.pop(), drawing.at.pop(), show();
    const [x, y] = drawing.cursor;
    if (event.key === " ") return stop(), place({ panel: id, x, y, pixel: by / 100 });
    if (step) {
      stop();
      drawing.cursor = drawing.next = [x + by * step[0], y + by * step[1]];
      say(`Space draws a point at ${drawing.cursor.map((it) => +it.toFixed(4)).join(", ")}.`);
      return show();
    }
  }
  if (step && own && own.what !== "element") {
    stop();
    const from = { point: () => [panel.points[own.index].x, panel.points[own.index].y], map: () => panel.maps[own.index].frame[0], limit: () => panel.limits[own.index].at }[own.what]();
    const at = (sign) => ({ panel: id, x: from[0] + sign * step[0] * by, y: from[1] + sign * step[1] * by, pixel: by / 100, alt: event.altKey });
    held = { panel: id, view: block.lastElementChild.dataset.view };
    await settled();
    await send({ ...at(0), phase: "down", map: own.what === "map" ? own.index : null, limit: own.what === "limit" ? own.index : null });
    await send({ ...at(1), phase: "move" });
    held = null;
    await send({ ...at(1), phase: "up" });
    return;
  }
  const letter = event.key.toLowerCase();
  const handles = [...panel.points.map((_, index) => ({ panel: id, what: "point", index })), ...panel.elements.map((_, index) => ({ panel: id, what: "element", index })), ...panel.maps.map((_, index) => ({ panel: id, what: "map", index })), ...panel.limits.map((_, index) => ({ panel: id, what: "limit", index }))];
  const next = { ".": 1, ",": -1 }[letter];
  if (next && handles.length) {
    stop();
    const now = handles.findIndex((it) => own && it.what === own.what && it.index === own.index);
    chosen = handles[(now + next + handles.length) % handles.length];
    const it = { point: panel.points, element: panel.elements, map: panel.maps, limit: panel.limits }[chosen.what][chosen.index];
    say(`${chosen.what} ${chosen.index + (chosen.what === "point" ? 0 : 1)}${it.text ? `: [${it.text.join(", ")}]` : ""}`);
    return show();
  }
  if (letter === "p") return stop(), begin(id);
  if (letter === "w" && scene().view) {
    stop();
    const list = [...$("design-view").options].map((it) => it.value);
    await view(list[(list.indexOf(scene().view) + 1) % list.length]);
    return document.querySelector(`[data-panel="${CSS.escape(id)}"] svg`)?.focus();
  }
  if (letter === "g") {
    stop();
    const list = $("design-grid");
    list.selectedIndex = (list.selectedIndex + 1) % list.options.length;
    return show();
  }
  if (!own) return;
  const index = own.index;
  const key = (key, value) => act({ act: "key", panel: id, element: index, key, value });
  if (own.what === "element") {
    const it = panel.elements[index];
    const flag = { f: "fertile", v: "visible", c: "connected" }[letter];
    if ((scene().view ? "12345678" : "1234").includes(letter)) return stop(), key("direction", letter);
    if (flag) return stop(), key(flag, String(!it[flag]));
    if (letter === "u" && scene().generators.length) {
      const list = [null, ...scene().generators];
      return stop(), key("use", list[(list.indexOf(it.use) + 1) % list.length]);
    }
    if (letter === "b") return stop(), $("design-chosen").querySelector("label:last-of-type input")?.focus();
    if (letter === "r" && scene().view) return stop(), [...$("design-chosen").querySelectorAll("label")].find((it) => it.textContent.startsWith("roll"))?.querySelector("input").focus();
    if (letter === "s") return stop(), act({ act: "split", panel: id, element: index });
    if (event.key === "Delete") return stop(), act({ act: "join", panel: id, point: it.to });
  } else if (event.key === "Delete" && own.what !== "limit") {
    stop();
    await act(own.what === "map" ? { act: "remove_map", panel: id, map: index } : { act: "join", panel: id, point: index });
  }
}
