// Checks the page of kfrac studio: node check.mjs PROGRAM [FOLDER]
//
// The program is `kfrac`; screenshots are written into the folder, if there is one.

import { spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";

import { Browser } from "./browser.mjs";

const [program, pictures] = process.argv.slice(2);
if (!program) throw new Error("node check.mjs PROGRAM [FOLDER]");
if (pictures) mkdirSync(pictures, { recursive: true });
const folder = mkdtempSync(join(tmpdir(), "kfrac-rules-"));
let checks = 0;
function check(holds, what) {
  if (!holds) throw new Error(`does not hold: ${what}`);
  checks += 1;
}

/** Serves a rule, and returns the address of its page. */
async function serve(rule, ...more) {
  const studio = spawn(resolve(program), ["studio", rule, "--no-open", ...more], { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });
  const url = await new Promise((resolve, reject) => {
    let text = "";
    studio.stdout.setEncoding("utf8").on("data", (data) => {
      text += data;
      if (text.includes("\n")) resolve(text.trim());
    });
    studio.on("exit", () => reject(new Error("the studio ended")));
  });
  return { url, end: () => studio.kill("SIGINT") };
}

const browser = await Browser.start();
const shoot = (name) => pictures && browser.screenshot(join(pictures, `${name}.png`));
const isDrawn = "document.querySelector('#status').textContent.includes('ms') || document.querySelector('#status').textContent.includes(' s')";
const status = () => browser.value("document.querySelector('#status').textContent");
const text = (selector) => browser.value(`document.querySelector(${JSON.stringify(selector)}).textContent`);
const value = (selector) => browser.value(`document.querySelector(${JSON.stringify(selector)}).value`);
/** Returns a number for the pixels of the picture, and how many of them are not empty. */
const pixels = () => browser.value(`(() => {
  const canvas = document.querySelector("#picture");
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let sum = 0, inked = 0;
  for (let at = 0; at < data.length; at += 4) {
    if (data[at + 3]) inked += 1;
    sum = (sum * 31 + data[at] + 3 * data[at + 1] + 7 * data[at + 2] + 11 * data[at + 3]) % 2147483647;
  }
  return [sum, inked];
})()`);
async function changes(act, what) {
  const [before] = await pixels();
  await act();
  const end = Date.now() + 20_000;
  while ((await pixels())[0] === before) {
    if (Date.now() > end) throw new Error(`the picture stays: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 40));
  }
  await settled();
  checks += 1;
}
/** Waits until the picture has been drawn in full. */
async function settled() {
  let last = null;
  for (;;) {
    await new Promise((resolve) => setTimeout(resolve, 220));
    const now = await pixels();
    if (String(now) === String(last)) return;
    last = now;
  }
}
async function open(url) {
  await browser.open(url);
  await browser.until(isDrawn);
  await settled();
}

const TREE = readFileSync(new URL("tree.yaml", import.meta.url), "utf8");
const studios = [];
try {
  writeFileSync(join(folder, "tree.yaml"), TREE);
  const studio = await serve("tree.yaml");
  studios.push(studio);
  await browser.size(1360, 860);
  await open(studio.url);
  check((await pixels())[1] > 2000, "there is ink");
  check((await status()).startsWith("Step "), "the status line has the step");
  check((await text("#dimension")).includes("dimension"), "the dimension is shown");
  check((await text("#command")).startsWith("kfrac grow tree.yaml"), "the command is shown");
  await shoot("first-sight");

  // Every control has a name, in every panel.
  for (const panel of ["family", "style", "text", "library"]) {
    await browser.click(`#tab-${panel}`);
    await browser.until(`!document.querySelector('#${panel}').hidden`);
    if (panel === "library") await browser.until("document.querySelectorAll('#entries img[src]').length > 8");
    const unnamed = (await browser.controls()).filter((it) => it.role !== "image" && !it.name);
    check(unnamed.length === 0, `named controls: ${JSON.stringify(unnamed)}`);
    await shoot(`panel-${panel}`);
  }
  await browser.click("#tab-family");
  const small = await browser.value(`[...document.querySelectorAll("button, input, select")].filter((it) => it.checkVisibility() && it.type !== "checkbox" && it.getBoundingClientRect().height < 24).map((it) => it.id || it.className)`);
  check(small.length === 0, `targets of 24 pixels: ${small}`);

  // A slider.
  const drag = async () => {
    const [x, y, width, height] = await browser.value("(() => { const { x, y, width, height } = document.querySelector('#parameters input[type=range]').getBoundingClientRect(); return [x, y, width, height]; })()");
    await browser.drag([x + width * 0.4, y + height / 2], [x + width * 0.75, y + height / 2]);
  };
  await changes(drag, "a slider changes the picture");
  await browser.until("document.querySelector('#command').textContent.includes('--set=')");
  await shoot("slider");
  await browser.click("[data-write=angle]");
  await browser.until("document.querySelector('#file').className.includes('unsaved') && !document.querySelector('#command').textContent.includes('--set=')");
  check(await browser.value("document.querySelector('[data-write=angle]').hidden"), "the value is written into the file");
  await browser.key("z", { modifiers: 2 });
  await browser.until(`document.querySelector('#code').value === ${JSON.stringify(TREE)}`);
  await browser.until("document.querySelector('#file').className === 'quiet'");

  // Drag and wheel on the picture.
  const before = await value("#factor");
  await changes(() => browser.drag([500, 400], [560, 350]), "a drag moves the picture");
  await changes(() => browser.send("Input.dispatchMouseEvent", { type: "mouseWheel", x: 500, y: 380, deltaX: 0, deltaY: -600 }), "the wheel zooms");
  check(before === "" && (await value("#factor")).startsWith("×"), "the magnification is shown");
  await browser.until("document.querySelector('#command').textContent.includes('--view=')");
  await shoot("zoomed");

  // Turn and window in the plane.
  await browser.value("document.querySelector('#picture').focus()");
  await changes(() => browser.key("ArrowLeft", { modifiers: 8 }), "Shift and an arrow key turn the picture");
  await changes(async () => {
    await browser.pointer("mousePressed", 700, 300, { modifiers: 8 });
    for (let y = 300; y < 420; y += 20) await browser.pointer("mouseMoved", 700, y, { modifiers: 8 });
    await browser.pointer("mouseReleased", 700, 420, { modifiers: 8 });
  }, "Shift and a drag turn the picture");
  await browser.until("document.querySelector('#command').textContent.includes('--turn=')");
  await browser.click("#tab-style");
  await changes(() => browser.value("(() => { const window = document.querySelector('#style-window'); window.value = '-0.5, 0, 1, 1'; window.dispatchEvent(new Event('change')); })()"), "a window that is typed is shown");
  await browser.click("#tab-family");

  // The keyboard alone: from the top of the page to the slider of steps, and back.
  await open(studio.url);
  await browser.value("document.activeElement.blur(); document.querySelector('.skip').focus()");
  const seen = [];
  for (let step = 0; step < 40 && seen.at(-1) !== "step"; step += 1) {
    await browser.key("Tab");
    seen.push(await browser.value("document.activeElement.id"));
  }
  check(seen.includes("picture") && seen.at(-1) === "step", `Tab reaches the slider of steps: ${seen}`);
  const stepBefore = +(await value("#step"));
  await changes(() => browser.key("ArrowRight"), "an arrow key steps forward");
  check(+(await value("#step")) === stepBefore + 1, "by one step");
  await browser.value("document.querySelector('#picture').focus()");
  await changes(() => browser.key("0"), "0 shows all");
  await changes(() => browser.key("+"), "plus zooms in");
  await changes(() => browser.key("ArrowLeft"), "an arrow key moves");
  await changes(() => browser.key("["), "a bracket steps back");
  await browser.key("?");
  check(await browser.value("document.querySelector('#ask').open"), "a question mark shows the keys");
  await browser.key("Escape");
  check(!(await browser.value("document.querySelector('#ask').open")), "Escape closes them");
  await browser.value("document.querySelector('#tab-family').focus()");
  await browser.key("ArrowRight");
  check((await browser.value("document.activeElement.id")) === "tab-design", "arrow keys change panels");
  await browser.value("document.querySelector('#picture').focus()");
  await changes(() => browser.key("0"), "0 shows all again");

  // A step beyond the budget is grey, and is not drawn.
  await browser.value("(() => { const range = document.querySelector('#step'); range.value = range.max; range.dispatchEvent(new Event('input')); })()");
  await browser.until("!document.querySelector('#message').hidden");
  check((await text("#message")).includes("elements"), "the message has the number");
  check(await browser.value("document.querySelector('#forecast').className === 'beyond'"), "the forecast is grey");
  await shoot("beyond");
  await changes(() => browser.click("#to-pixel"), "to the pixel it is drawn");

  // A mistake in the text: underlined at its place, with the last picture dimmed.
  await browser.click("#tab-text");
  const type = (from, to) => browser.value(`(() => { const code = document.querySelector('#code'); const at = code.value.indexOf(${JSON.stringify(from)}); code.focus(); code.setRangeText(${JSON.stringify(to)}, at, at + ${from.length}, 'end'); code.dispatchEvent(new InputEvent('input')); })()`);
  await type("fertile: false", "fertil: false");
  await browser.until("document.querySelectorAll('#marks mark').length > 0");
  check((await text("#marks mark")) === "fertil", "the mistake is underlined at its place");
  check(await browser.value("document.querySelector('#paper').classList.contains('wrong')"), "the last picture is dimmed");
  check((await text("#problems")).includes("fertile"), "the remedy is shown");
  check((await pixels())[1] > 2000, "the last picture stays");
  await shoot("mistake");
  await type("fertil: false", "fertile: false");
  await browser.until("document.querySelectorAll('#marks mark').length === 0");
  await browser.value("document.querySelector('#code').focus()");
  await browser.key("z", { modifiers: 2 });
  await browser.until("document.querySelectorAll('#marks mark').length > 0");
  await browser.key("z", { modifiers: 2 });
  await browser.until(`document.querySelector('#code').value === ${JSON.stringify(TREE)}`);
  checks += 1;

  // Completion from the schema.
  await type("title:", "ab\ntitle:");
  await browser.value("(() => { const code = document.querySelector('#code'); code.setSelectionRange(2, 2); })()");
  await browser.key(" ", { modifiers: 2 });
  await browser.until("!document.querySelector('#words').hidden");
  check((await text("#words")).includes("about"), "keys are offered");
  await browser.key("Escape");
  await browser.key("z", { modifiers: 2 });
  await browser.until(`document.querySelector('#code').value === ${JSON.stringify(TREE)}`);
  await browser.until("document.querySelector('#file').className === 'quiet'");

  // Another editor.
  writeFileSync(join(folder, "tree.yaml"), TREE.replace("angle: {value: 38", "angle: {value: 70"));
  await browser.until("document.querySelector('#code').value.includes('value: 70')");
  checks += 1;
  // While one types: both texts are kept.
  const theirs = TREE.replace("angle: {value: 38", "angle: {value: 55");
  await browser.value("(() => { const add = () => { const code = document.querySelector('#code'); code.value += '#'; code.dispatchEvent(new InputEvent('input')); }; window.typist = setInterval(add, 90); add(); })()");
  writeFileSync(join(folder, "tree.yaml"), theirs);
  await new Promise((resolve) => setTimeout(resolve, 1200));
  await browser.value("clearInterval(window.typist)");
  await browser.until("!document.querySelector('#conflict').hidden");
  check((await browser.value("document.querySelector('#code').value")).includes("value: 70"), "the typed text stays");
  await browser.click("#save");
  await settled();
  check(readFileSync(join(folder, "tree.yaml"), "utf8") === theirs, "the other text stays in the file");
  await browser.click("[data-settle=theirs]");
  await browser.until("document.querySelector('#code').value.includes('value: 55')");

  // Ends of lines that differ are kept, but for those of what is typed.
  const file = TREE.split("\n").map((line, at) => line + (at % 3 ? "\r\n" : "\n")).join("");
  writeFileSync(join(folder, "ends.yaml"), file);
  const mixed = await serve("ends.yaml");
  studios.push(mixed);
  await open(mixed.url);
  await browser.click("#tab-text");
  await browser.click("#save");
  await browser.until("document.querySelector('#status').textContent.startsWith('Saved')");
  check(readFileSync(join(folder, "ends.yaml"), "utf8") === file, "nothing is written but what was changed");
  await type("angle: {value: 38", "angle: {value: 39");
  await browser.until("document.querySelector('#file').className === 'quiet unsaved'");
  await browser.click("#save");
  await browser.until("document.querySelector('#file').className === 'quiet'");
  check(readFileSync(join(folder, "ends.yaml"), "utf8") === file.replace("angle: {value: 38", "angle: {value: 39"), "the ends of other lines stay");

  // Random trees: six seeds. Vary.
  const random = await serve("random-tree");
  studios.push(random);
  await open(random.url);
  await browser.until("!document.querySelector('#seeds').hidden");
  await changes(() => browser.click("#another"), "another seed is another tree");
  await browser.click("#six");
  await browser.until("document.querySelectorAll('.grid img[src]').length === 6");
  await settled();
  await shoot("six-seeds");
  await changes(() => browser.click(".grid button:nth-child(4)"), "a click takes a seed");
  await browser.click("#vary");
  await browser.until("document.querySelectorAll('.grid img[src]').length === 9");
  await settled();
  await shoot("vary");
  await changes(() => browser.click(".grid button:nth-child(2)"), "a click takes a member");

  // A complex parameter: its pad shows the map of the parameter.
  const pad = await serve("complex-pair");
  studios.push(pad);
  await open(pad.url);
  /** Returns the number of colours of the map behind a pad. */
  const colours = () => browser.value(`(async () => {
    const image = new Image();
    image.src = document.querySelector(".pad").style.backgroundImage.slice(5, -2);
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    return new Set(new Uint32Array(context.getImageData(0, 0, image.width, image.height).data.buffer)).size;
  })()`);
  const hasMap = "document.querySelector('.pad').style.backgroundImage.startsWith('url(')";
  await browser.until(hasMap);
  check((await colours()) > 8, "the pad shows the map of the complex parameter");
  const area = await browser.value("(() => { const { x, y, width, height } = document.querySelector('.pad').getBoundingClientRect(); return [x, y, width, height]; })()");
  check(Math.abs(area[2] / area[3] - 1) < 0.02, "the map of a square is a square");
  await changes(() => browser.drag([area[0] + area[2] * 0.6, area[1] + area[3] * 0.4], [area[0] + area[2] * 0.66, area[1] + area[3] * 0.3]), "a pad changes the picture");
  await shoot("pad");

  // Two parameters of a system have a pad beside their sliders.
  writeFileSync(join(folder, "two.yaml"), "kind: ifs\nparams:\n  a: {value: 0.45, min: 0.1, max: 0.8}\n  b: {value: 60, min: 0, max: 180}\nmaps:\n  - {scale: a, rotate: b}\n  - {scale: a, shift: [1, 0]}\n");
  const two = await serve("two.yaml");
  studios.push(two);
  await open(two.url);
  await browser.until(hasMap);
  check((await colours()) > 4, "the pad shows the map of two parameters");
  await browser.value("document.querySelector('.pad').focus()");
  await changes(() => browser.key("ArrowRight"), "an arrow key moves the point");
  check((await value("#value-a")) === "0.457", "the slider follows the point");
  await shoot("two-parameters");

  // Whole numbers have a slider of whole numbers. Systems without a number of steps are drawn to the pixel.
  writeFileSync(join(folder, "ring.yaml"), "kind: ifs\nparams:\n  n: {value: 5, min: 3, max: 9}\n  turn: {value: 0, min: 0, max: 90}\nmaps:\n  - {for: {k: 1..n}, scale: 1/n, rotate: turn, shift: [cos(360*k/n), sin(360*k/n)]}\n");
  const ring = await serve("ring.yaml");
  studios.push(ring);
  await open(ring.url);
  await browser.until("document.querySelector('#value-n')?.closest('.parameter').querySelector('input[type=range]')");
  await changes(() => browser.value("(() => { const range = document.querySelector('#value-n').closest('.parameter').querySelector('input[type=range]'); range.value = 6.4; range.dispatchEvent(new Event('input')); range.dispatchEvent(new Event('change')); })()"), "another number of maps is another set");
  check((await value("#value-n")) === "6", "the slider has whole numbers");
  check((await browser.value("document.querySelectorAll('.pad').length")) === 0, "whole numbers have no pad");
  await settled();
  check(await browser.value("document.querySelector('#limit').checked"), "a set without steps is drawn to the pixel");
  check((await text("#forecast")) === "To the pixel", "the forecast names no step");
  await changes(() => browser.click("#limit"), "a step is drawn");
  check((await text("#forecast")).startsWith("Step "), "the forecast names the step");
  await changes(() => browser.click("#limit"), "the set is drawn to the pixel again");

  // A picture that is dropped lies under the figures; a system is fitted to it, whose collage is measured while a map moves.
  const fits = await serve("tree.yaml");
  studios.push(fits);
  await open(fits.url);
  await browser.value(`(async () => {
    const canvas = new OffscreenCanvas(132, 132);
    const context = canvas.getContext("2d");
    context.fillStyle = "#fff";
    context.fillRect(0, 0, 132, 132);
    context.fillStyle = "#000";
    for (let row = 0; row < 128; row += 1) for (let column = 0; column < 128; column += 1) if (!(column & (127 - row))) context.fillRect(column + 2, row + 2, 1, 1);
    const data = new DataTransfer();
    data.items.add(new File([await canvas.convertToBlob()], "gasket.png", { type: "image/png" }));
    document.dispatchEvent(new DragEvent("drop", { dataTransfer: data, cancelable: true }));
  })()`);
  await browser.until("document.querySelectorAll('.figure image').length > 0");
  check((await browser.value("document.querySelectorAll('.figure[data-panel=base_element] image').length")) === 0, "base elements have no picture");
  await shoot("underlay");
  await browser.value("void (document.querySelector('#underlay-maps').value = '3')");
  // Letters that are typed while the fit runs are sent before its system is opened.
  await browser.value("(() => { document.querySelector('#underlay-fit').click(); const it = document.querySelector('#code'); it.value += '# typed\\n'; it.dispatchEvent(new InputEvent('input')); })()");
  await browser.until("document.querySelector('#title').textContent === 'Fit of gasket.png'");
  await browser.click("#undo");
  await browser.until("document.querySelector('#title').textContent === 'Tree' && document.querySelector('#code').value.endsWith('# typed\\n')");
  await browser.click("#redo");
  await browser.until("document.querySelector('#title').textContent === 'Fit of gasket.png'");
  await browser.until("document.querySelectorAll('.figure image').length === 4 && document.querySelector('#underlay-error').textContent.startsWith('Collage: overlap ')");
  await settled();
  await shoot("fit");
  const overlap = async () => +(/overlap ([0-9.]+)/.exec(await text("#underlay-error"))?.[1]);
  const fitted = await overlap();
  check(fitted > 0.9, `the collage is near the picture: ${fitted}`);
  const map = await browser.value("(() => { const it = document.querySelector('.figure .map'); it.scrollIntoView({ block: 'center' }); const { x, y, width, height } = it.getBoundingClientRect(); return [x + width / 2, y + height / 2]; })()");
  await changes(() => browser.drag(map, [map[0] + 25, map[1] - 15]), "a map is dragged over the picture");
  for (let end = Date.now() + 5000; (await overlap()) > fitted - 0.05; ) {
    if (Date.now() > end) throw new Error("the error of the collage does not follow the hand");
    await new Promise((resolve) => setTimeout(resolve, 40));
  }
  await shoot("dragged");
  await browser.click("#undo");
  await browser.until(`document.querySelector('#underlay-error').textContent.includes('overlap ${fitted.toFixed(4)}')`);
  await browser.click("#undo");
  await browser.until("document.querySelector('#title').textContent === 'Tree'");
  await browser.click("#undo");
  await browser.until("!document.querySelector('#code').value.includes('# typed')");
  await browser.click("#underlay-remove");
  await browser.until("document.querySelectorAll('.figure image').length === 0");
  checks += 4;

  // The time line: key frames of the sliders, played, moved, written.
  const film = await serve("tree.yaml");
  studios.push(film);
  await open(film.url);
  const press = (id) => browser.value(`(() => { const it = document.querySelector(${JSON.stringify(id)}); it.scrollIntoView(); it.click(); })()`);
  const keys = () => browser.value("[...document.querySelectorAll('.key')].map((it) => /angle = ([^,]*)/.exec(it.title)[1]).join()");
  const bend = (angle) => browser.value(`(() => { const typed = document.querySelector('#value-angle'); typed.value = '${angle}'; typed.dispatchEvent(new Event('change')); })()`);
  check(await browser.value("document.querySelector('#film-play').disabled"), "a film has two key frames at least");
  for (const angle of [20, 70, 40]) {
    await changes(() => bend(angle), `the angle ${angle} is drawn`);
    await press("#film-add");
  }
  check((await keys()) === "20,70,40", "key frames have the present values");
  await press("#film-play");
  const frames = new Set();
  for (let look = 0; look < 20; look += 1) {
    frames.add((await pixels())[0]);
    await new Promise((resolve) => setTimeout(resolve, 60));
  }
  check(frames.size > 4, `a film moves: ${frames.size} pictures`);
  const angle = +(await value("#value-angle"));
  check(angle >= 20 && angle <= 70, "the sliders follow the film");
  await press("#film-play");
  await settled();
  const ends = await browser.value("[...document.querySelectorAll('.key')].map((it) => { const box = it.getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; })");
  await browser.drag(ends[0], ends[2]);
  check((await keys()) === "70,40,20", "a key frame is dragged to another place");
  await changes(() => browser.click(".key"), "a click shows a key frame");
  check((await value("#value-angle")) === "70", "with its values");
  await browser.value("document.querySelectorAll('.key')[1].focus()");
  await browser.key("ArrowLeft");
  check((await keys()) === "40,70,20", "an arrow key moves a key frame");
  await browser.key("Delete");
  check((await keys()) === "70,20", "Delete removes a key frame");
  await browser.value("(() => { const set = (name, value) => { const it = document.querySelector(`[data-film=${name}]`); it.type === 'checkbox' ? (it.checked = value) : (it.value = value); it.dispatchEvent(new Event('change')); }; set('frames', 12); set('bounce', true); })()");
  await settled();
  await open(film.url);
  check((await keys()) === "70,20", "a reload keeps the key frames");
  await shoot("time-line");
  await press("#film-export");
  await browser.until("document.querySelector('#ask').open");
  const made = await text("#ask code");
  check(made.startsWith("kfrac animate tree.yaml") && made.includes("--set=angle=70,20") && made.includes("--frames=12") && made.includes("--bounce"), `the command of the film is shown: ${made}`);
  await browser.value("(() => { for (const [at, value] of [[0, 160], [1, 120]]) { const it = document.querySelectorAll('#ask input[type=number]')[at]; it.value = value; it.dispatchEvent(new Event('input')); } })()");
  check((await text("#ask code")).endsWith(" --size=160x120 --output=tree.gif"), "the command follows the size");
  await browser.click("#ask-go");
  await browser.until("document.querySelector('#ask [role=status]').textContent.includes('frames')");
  const report = await text("#ask [role=status]");
  check(report.split("tree.gif").length === 2, `the report names the film once: ${report}`);
  check(readFileSync(join(folder, "tree.gif")).subarray(0, 4).toString() === "GIF8", "the film is written");
  await shoot("film");

  // A large tree, and space.
  const large = await serve("pythagoras");
  studios.push(large);
  await open(large.url);
  await browser.value("(() => { const range = document.querySelector('#step'); range.value = 15; range.dispatchEvent(new Event('input')); })()");
  await settled();
  await shoot("large");
  const space = await serve("menger");
  studios.push(space);
  await open(space.url);
  await changes(() => browser.drag([400, 400], [520, 360]), "a drag turns a set in space");
  await browser.until("document.querySelector('#command').textContent.includes('--from=')");
  const wheel = () => browser.send("Input.dispatchMouseEvent", { type: "mouseWheel", x: 420, y: 380, deltaX: 0, deltaY: -500 });
  await changes(wheel, "the wheel zooms in space");
  check((await value("#factor")).startsWith("×"), "the magnification in space is shown");
  await changes(async () => {
    await browser.pointer("mousePressed", 400, 400, { modifiers: 2 });
    for (let x = 400; x < 480; x += 20) await browser.pointer("mouseMoved", x, 400, { modifiers: 2 });
    await browser.pointer("mouseReleased", 480, 400, { modifiers: 2 });
  }, "Ctrl and a drag move a set in space");
  await browser.until("document.querySelector('#command').textContent.includes('--look-at=')");
  await browser.value("document.querySelector('#picture').focus()");
  await changes(() => browser.key("ArrowRight", { modifiers: 2 }), "Ctrl and an arrow key move it");
  await changes(() => browser.key("0"), "0 shows all of it");
  await browser.click("#tab-style");
  await shoot("space");

  // L-systems and structures, opened from the library.
  const opened = await serve("koch");
  studios.push(opened);
  await open(opened.url);
  for (const [name, kind] of [["gosper-lsystem", "lsystem"], ["ternary-tree", "instancing"], ["pound-sign-in-space", "instancing"]]) {
    await browser.click("#tab-library");
    await browser.until("document.querySelectorAll('#entries button').length > 0");
    await browser.value(`(() => { const search = document.querySelector('#search'); search.value = ${JSON.stringify(name)}; search.dispatchEvent(new Event('input')); })()`);
    await changes(async () => {
      await browser.click("#entries button");
      await browser.until(`document.querySelector('#file').textContent.startsWith(${JSON.stringify(name)}) || document.querySelector('#ask').open`);
      if (await browser.value("document.querySelector('#ask').open")) await browser.click("#ask-go");
    }, `${name} is opened`);
    await browser.until(`document.querySelector('#code').value.includes('kind: ${kind}')`);
    await browser.until("!document.querySelector('#back').disabled");
    await changes(() => browser.click("#back"), `${name} steps back`);
    await shoot(name);
  }

  // A file of one's own, from nothing.
  await changes(async () => {
    await browser.click("#new");
    await browser.until("document.querySelector('#ask').open");
    await browser.value("(() => { document.querySelector('#ask input[type=text]').value = 'coral'; document.querySelector('#ask select').value = 'ifs'; })()");
    await browser.click("#ask input[type=checkbox]");
    await browser.click("#ask-go");
    await browser.until("!document.querySelector('#ask').open");
  }, "a system of space is begun");
  const begun = await browser.value("[document.querySelector('#code').value, document.querySelector('#file').textContent, document.querySelector('#tab-design').getAttribute('aria-selected')]");
  check(begun[0].includes("kind: ifs") && begun[0].includes("space: 3") && begun[1].startsWith("coral") && begun[2] === "true", "it is a copy that is not saved, and is designed");
  const left = await browser.value("document.querySelector('#file').textContent");
  await browser.click("#new");
  await browser.until("document.querySelector('#ask').open");
  await browser.value("(() => { document.querySelector('#ask select').value = 'lsystem'; })()");
  await browser.click("#ask-go");
  await browser.until("document.querySelector('#file').textContent.startsWith('my-fractal')");
  check(await browser.value("document.querySelector('#tab-text').getAttribute('aria-selected') === 'true'"), "an L-system is begun as a text");
  await changes(() => browser.click("#undo"), "undo leads back");
  check((await browser.value("document.querySelector('#file').textContent")) === left, "undo leads back to the file that was left");

  // Two letters that are typed just before undo and redo; a dialog about a file that is left meanwhile.
  const whole = await browser.value("(() => { const code = document.querySelector('#code'); const add = () => { code.value += '#'; code.dispatchEvent(new InputEvent('input')); }; add(); setTimeout(add, 225); setTimeout(() => document.querySelector('#undo').click(), 226); return code.value; })()");
  const reads = (text) => browser.until(`document.querySelector('#code').value === ${JSON.stringify(text)} && !document.querySelector('#redo').disabled`);
  await reads(whole);
  await browser.click("#redo");
  await browser.until(`document.querySelector('#code').value === ${JSON.stringify(whole + "#")}`);
  check(true, "what is typed is sent in its order, and is in the history");
  await browser.click("#save-as");
  await browser.until("document.querySelector('#ask').open");
  check((await browser.value("document.querySelector('#ask input[type=text]').value")) === "coral.yaml", "the file is saved under the name that it was given");
  for (let step = 0; step < 9 && (await browser.value("document.querySelector('#file').textContent")) === left; step += 1) {
    const before = await value("#code");
    await browser.value("document.querySelector('#undo').click()");
    await browser.until(`document.querySelector('#code').value !== ${JSON.stringify(before)}`);
  }
  check((await browser.value("document.querySelector('#ask').open")) === false, "a dialog about a file is closed with the file");

  // Design by hand: drag, grid, draw, keys, Escape, and a table.
  const MINE = "title: Mine # my own\ninitiator: segment\ngenerator:\n  - [0, 0]\n  - [1/2, 0.2] # apex\n  - [1, 0]\n";
  writeFileSync(join(folder, "mine.yaml"), MINE);
  const mine = await serve("mine.yaml");
  studios.push(mine);
  await open(mine.url);
  await browser.click("#tab-design");
  await browser.until("document.querySelectorAll('[data-panel=generator] circle').length === 3");
  /** Returns the place on the screen of a point of a panel. */
  const spot = (panel, x, y) => browser.value(`(() => { const figure = document.querySelector('[data-panel="${panel}"] svg'); const box = figure.getBoundingClientRect(); const [left, low, wide, high] = figure.dataset.view.split(' ').map(Number); const pixel = Math.max(wide / box.width, high / box.height); return [box.left + box.width / 2 + (${x} - left - wide / 2) / pixel, box.top + box.height / 2 - (${y} - low - high / 2) / pixel]; })()`);
  const becomes = (text, what) => browser.until(`document.querySelector('#code').value === ${JSON.stringify(text)}`).catch(async () => { throw new Error(`${what}: ${await value("#code")}`); }).then(() => (checks += 1));
  await browser.value("(() => { document.querySelector('#design-parts').value = 6; const grid = document.querySelector('#design-grid'); grid.value = 'triangular'; grid.dispatchEvent(new Event('change')); })()");
  await changes(async () => browser.drag(await spot("generator", 0.5, 0.2), await spot("generator", 0.51, 0.28)), "a drag changes the picture");
  const apex = MINE.replace("0.2]", "sqrt(3)/6]");
  await becomes(apex, "a point snaps to the grid and is written nicely");
  check((await text("#design-badge")).includes("sqrt(3)/6"), "the badge has what is written");
  await shoot("design");
  const [x, y] = await spot("generator", 0.5, 0.2887);
  await browser.pointer("mousePressed", x, y);
  await browser.pointer("mouseMoved", x + 90, y - 60);
  await browser.until(`document.querySelector('#code').value !== ${JSON.stringify(apex)}`);
  await browser.key("Escape");
  await becomes(apex, "Escape takes a drag back");
  await browser.pointer("mouseReleased", x + 90, y - 60);
  await browser.click("[data-panel=generator] button:nth-of-type(1)");
  for (const [x, y] of [[1 / 3, 0.01], [0.5, 0.29], [2 / 3, -0.01]]) {
    const at = await spot("generator", x, y);
    const count = await browser.value("document.querySelectorAll('[data-panel=generator] .handle.chosen').length");
    await browser.pointer("mousePressed", ...at, { clickCount: 1 });
    await browser.pointer("mouseReleased", ...at, { clickCount: 1 });
    await browser.until(`document.querySelectorAll('[data-panel=generator] .handle.chosen').length > ${count}`);
  }
  await shoot("drawing");
  await browser.key("Enter");
  const koch = MINE.replace("  - [1/2, 0.2] # apex\n", "  - [1/3, 0] # apex\n  - [1/2, sqrt(3)/6]\n  - [2/3, 0]\n");
  await becomes(koch, "clicks and Enter draw the Koch curve");
  // By keyboard alone: a point, then an element.
  await browser.value("document.querySelector('[data-panel=generator] svg').focus()");
  /** Goes to a handle by keys. */
  const reach = async (name) => {
    for (let step = 0; step < 20 && (await browser.value("document.querySelector('#design-chosen b')?.textContent")) !== name; step += 1) await browser.key(".");
    check((await text("#design-chosen b")) === name, `a full stop goes on to ${name}`);
  };
  await reach("Point 2");
  await browser.value("(() => { const grid = document.querySelector('#design-grid'); grid.value = 'square'; grid.dispatchEvent(new Event('change')); document.querySelector('[data-panel=generator] svg').focus(); })()");
  await browser.key("ArrowUp");
  const raised = koch.replace("[1/2, sqrt(3)/6]", "[1/2, 1/2]");
  await becomes(raised, "an arrow key moves a point by a cell of the grid");
  await reach("Element 1");
  await browser.key("2");
  await becomes(raised.replace("  - [1/3, 0] #", "  - {to: [1/3, 0], direction: 2} #"), "2 is a direction");
  await browser.key("1");
  await becomes(raised, "1 makes it a point again");
  await browser.value("(() => { document.querySelector('#design-table').open = true; })()");
  await browser.until("document.querySelectorAll('#design-rows input').length > 9");
  await browser.value("(() => { const field = document.querySelector('#design-rows input[aria-label=\"y of point 2\"]'); field.value = '-1/4'; field.dispatchEvent(new Event('change')); })()");
  await becomes(raised.replace("[1/2, 1/2]", "[1/2, -1/4]"), "a field of the table is written");
  await shoot("design-table");
  await browser.value("document.querySelector('[data-panel=generator] svg').focus()");
  await browser.key("p");
  for (const moves of [{ ArrowRight: 2 }, { ArrowRight: 1, ArrowUp: 2 }, { ArrowRight: 1, ArrowDown: 2 }]) {
    for (const [name, times] of Object.entries(moves)) for (let step = 0; step < times; step += 1) await browser.key(name);
    const count = await browser.value("document.querySelectorAll('[data-panel=generator] .handle.chosen').length");
    await browser.key(" ");
    await browser.until(`document.querySelectorAll('[data-panel=generator] .handle.chosen').length > ${count}`);
  }
  await browser.key("Enter");
  await becomes(koch.replace("[1/2, sqrt(3)/6]", "[1/2, 1/3]"), "arrow keys, Space and Enter draw a figure");
  for (let step = 0; step < 30 && (await value("#code")) !== MINE; step += 1) {
    await browser.key("z", { modifiers: 2 });
    await new Promise((resolve) => setTimeout(resolve, 80));
  }
  await becomes(MINE, "undo brings back every byte");

  // Dark, narrow, and with reduced motion.
  await browser.prefer({ "prefers-color-scheme": "dark", "prefers-reduced-motion": "reduce" });
  await open(large.url);
  await shoot("dark");
  check((await browser.value("getComputedStyle(document.querySelector('#picture')).transitionDuration")) === "0s", "nothing moves by itself");
  await browser.prefer({});
  await browser.size(390, 844, 2);
  await open(studio.url);
  await shoot("narrow");
  check(await browser.value("document.documentElement.scrollWidth <= innerWidth"), "a narrow page has no second direction");

  // Without the key, the page shows nothing.
  await browser.value("sessionStorage.clear()");
  await browser.open(studio.url.split("#")[0] + "?2");
  await browser.until("!document.querySelector('#message').hidden");
  check((await text("#message")).includes("key"), "without the key there is a message");

  const errors = browser.errors().filter((it) => !/status of (403|422|410|409)/.test(it));
  check(errors.length === 0, `no errors in the page: ${errors.join("\n")}`);
  console.log(`${checks} checks of the page hold`);
} catch (error) {
  await shoot("failure");
  console.error(error, browser.errors());
  process.exitCode = 1;
} finally {
  studios.forEach((studio) => studio.end());
  await browser.end();
  rmSync(folder, { recursive: true, force: true });
}
