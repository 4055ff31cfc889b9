// A picture under the figures of the design, and the system that is fitted to it.

const SVG = "http://www.w3.org/2000/svg";
const $ = (id) => document.getElementById(id);
const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6d1f", "#555555"];
let page = null; // what the rest of the page lends: tab, call, json, state, take, say, choices, opened
let known = { id: null, url: null, inks: [] }; // the picture that is shown, and its shape in the colours of the maps
let measuring = 0;
let fitting = null;

export function start(lent) {
  page = lent;
  $("underlay-choose").onclick = () => $("underlay-file").click();
  $("underlay-file").onchange = () => lay($("underlay-file").files[0]);
  $("underlay-remove").onclick = () => ask("DELETE", `/underlay?tab=${page.tab}`);
  $("underlay-opacity").oninput = () => page.redraw();
  for (const id of ["underlay-x", "underlay-y", "underlay-width"]) $(id).onchange = place;
  $("underlay-fit").onclick = fit;
  $("underlay-stop").onclick = () => page.json("DELETE", "/fit").catch((error) => page.say(error.message));
  $("underlay-cancel").onclick = () => fitting?.abort();
  $("underlay-method").append(...page.choices().methods.map((name) => new Option(name)));
  // Pictures may be dropped anywhere.
  const has = (event) => [...(event.dataTransfer?.types ?? [])].includes("Files");
  document.addEventListener("dragover", (event) => has(event) && event.preventDefault());
  document.addEventListener("drop", (event) => {
    if (!has(event)) return;
    event.preventDefault();
    lay(event.dataTransfer.files[0]);
  });
}

async function ask(...all) {
  try {
    page.take(await page.json(...all));
    page.say("");
  } catch (error) {
    page.say(error.message);
  }
}
/** Lays a picture under the figures. */
async function lay(file) {
  $("underlay-file").value = "";
  if (!file) return;
  page.opened();
  await ask("PUT", `/underlay?tab=${page.tab}&name=${encodeURIComponent(file.name)}`, file, file.type || "application/octet-stream");
}
function place() {
  const [x, y, width] = ["underlay-x", "underlay-y", "underlay-width"].map((id) => +$(id).value);
  return ask("POST", "/underlay/place", { tab: page.tab, corner: [x, y], width });
}
async function fit() {
  const [least, most = least] = $("underlay-maps").value.split("..").map(Number);
  if (!(least >= 2 && most >= least && most <= 32)) return page.say("a fit has a number of maps from 2 to 32, or a range such as 2..8");
  fitting = new AbortController();
  const working = setInterval(async () => {
    const now = await page.json("GET", "/fit").catch(() => ({}));
    if (fitting && now.evaluated != null) $("underlay-progress").textContent = `${now.evaluated.toLocaleString("en")} systems evaluated${now.best ? `; best: ${now.best.maps} maps by ${now.best.method}, overlap ${now.best.iou.toFixed(4)}` : ""}`;
  }, 300);
  const asked = { tab: page.tab, maps: [least, most], method: $("underlay-method").value, similar: $("underlay-similar").checked, disks: Math.max(0, Math.round(+$("underlay-disks").value) || 0) };
  show();
  try {
    await page.call("POST", "/fit", asked, undefined, fitting.signal);
    // A text that is refused does not keep the system from its place.
    const refused = await page.flush().then(() => "", (error) => error.message);
    fitting.signal.throwIfAborted();
    page.fitted(await page.json("POST", "/fit/open", { tab: page.tab }));
    page.say(refused);
  } catch (error) {
    if (error.name !== "AbortError") page.say(error.message);
  }
  clearInterval(working);
  fitting = null;
  $("underlay-progress").textContent = "";
  show();
}

/** Shows the picture of a state. */
export async function show() {
  const now = page.state().underlay;
  $("underlay-tools").hidden = $("underlay-remove").hidden = !now;
  if (!now) return forget();
  const values = { "underlay-x": now.corner[0], "underlay-y": now.corner[1], "underlay-width": now.width };
  for (const [id, value] of Object.entries(values)) if (document.activeElement !== $(id)) $(id).value = +value.toPrecision(9);
  $("underlay-about").textContent = `${now.name}: ${now.why ?? now.about}`;
  $("underlay-fit").disabled = Boolean(now.why || fitting);
  $("underlay-stop").hidden = $("underlay-cancel").hidden = !fitting;
  if (known.id !== now.id) await load(now);
  measure();
}
function forget() {
  for (const url of [known.url, ...known.inks]) if (url) URL.revokeObjectURL(url);
  known = { id: null, url: null, inks: [] };
  $("underlay-error").textContent = "";
}
async function load(now) {
  forget();
  const mine = (known = { id: now.id, url: null, inks: [] });
  try {
    mine.url = URL.createObjectURL(await (await page.call("GET", "/underlay")).blob());
    if (!now.why) mine.inks = await inks(await (await page.call("GET", "/underlay?ink=true")).blob());
  } catch (error) {
    page.say(error.message);
  }
  if (known === mine) return page.redraw();
  // Another picture was laid meanwhile.
  for (const url of [mine.url, ...mine.inks]) if (url) URL.revokeObjectURL(url);
}
/** Returns the shape in the colours of the maps. */
async function inks(blob) {
  const ink = await createImageBitmap(blob);
  const small = Math.min(1, 640 / Math.max(ink.width, ink.height));
  const canvas = new OffscreenCanvas(Math.max(1, ink.width * small), Math.max(1, ink.height * small));
  const context = canvas.getContext("2d");
  const all = [];
  for (const colour of COLOURS) {
    context.globalCompositeOperation = "copy";
    context.drawImage(ink, 0, 0, canvas.width, canvas.height);
    context.globalCompositeOperation = "source-in";
    context.fillStyle = colour;
    context.fillRect(0, 0, canvas.width, canvas.height);
    all.push(URL.createObjectURL(await canvas.convertToBlob()));
  }
  return all;
}
/** Shows how far the collage of the picture is from it. */
function measure() {
  if (measuring) return (measuring = 2);
  measuring = 1;
  setTimeout(async () => {
    const found = await page.json("GET", `/underlay/collage?tab=${page.tab}`).catch(() => ({}));
    const isLate = measuring === 2;
    measuring = 0;
    if (page.state().underlay) $("underlay-error").textContent = found.iou == null ? "" : `Collage: overlap ${found.iou.toFixed(4)}, distance ${found.distance.toFixed(2)} pixels`;
    if (isLate) measure();
  });
}

/** Returns the picture, and its copies under the maps, of a panel: images of the unit square of SVG. */
export function images(panel) {
  const now = page.state().underlay;
  if (!now || !known.url || panel.role === "base_element") return [];
  const opacity = +$("underlay-opacity").value;
  const [x, y] = now.corner;
  const high = now.width * now.size[1] / now.size[0];
  const image = (href, [o, right, up], shade) => {
    const element = document.createElementNS(SVG, "image");
    const matrix = [right[0] - o[0], o[1] - right[1], o[0] - up[0], up[1] - o[1], up[0], -up[1]];
    const all = { href, width: 1, height: 1, preserveAspectRatio: "none", transform: `matrix(${matrix})`, opacity: shade, "pointer-events": "none" };
    for (const [key, value] of Object.entries(all)) element.setAttribute(key, value);
    return element;
  };
  const copies = known.inks.length ? panel.maps.map((map, at) => !map.is_instance && !map.depth && image(known.inks[at % known.inks.length], map.frame, opacity)) : [];
  return [image(known.url, [[x, y], [x + now.width, y], [x, y + high]], opacity), ...copies.filter(Boolean)];
}
