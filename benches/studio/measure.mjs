// Measures the studio, and prints a table: node measure.mjs PROGRAM [--build]
//
// The program is `kfrac`, built with --release. Latencies are those in headless Chromium, which draws in software: from the
// event of the pointer to the frame after the one into which the picture is painted. At 60 frames a second, the event waits for
// a frame and the painted picture for another; what the studio takes, from the request to the painted picture, has a row of its
// own. With --build, cargo builds the program with the studio and without it, in folders of their own, and the processor time
// and the sizes are compared (minutes).

import { execFileSync, spawn, spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import http from "node:http";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";

import { Browser } from "../../tests/studio/browser.mjs";

const [given, ...options] = process.argv.slice(2);
if (!given) throw new Error("node measure.mjs PROGRAM [--build]");
const program = resolve(given);
const root = resolve(import.meta.dirname, "../..");
const folder = mkdtempSync(join(tmpdir(), "kfrac-measure-"));

/** Rules of about 100,000 elements, each longer than a pixel, with a parameter. */
const tree = (more) => `params: {angle: {value: 28, min: 5, max: 60}}
initiator: [[0, 0], [0, 1]]
generator:
  elements:
    - {from: [0, 0], to: [1, 0], fertile: false}
    - {from: [1, 0], to: [1 + 0.8 * cos(angle), 0.8 * sin(angle)]}
    - {from: [1, 0], to: [1 + 0.78 * cos(angle), -0.78 * sin(angle)]}
steps: 15
${more}
`;
const curve = `params: {angle: {value: 30, min: 5, max: 80}}
initiator: segment
generator: [[0, 0], [1/3, 0], [1/2, tan(angle)/6], [2/3, 0], [1, 0]]
steps: 8
`;
const squares = `params: {angle: {value: 40, min: 10, max: 80}}
initiator: segment
base_element: square
generator:
  connected: false
  elements:
    - {from: [0, 0], to: [1, 0], fertile: false}
    - {from: [0, 1], to: [cos(angle)^2, 1 + cos(angle) * sin(angle)]}
    - {from: [cos(angle)^2, 1 + cos(angle) * sin(angle)], to: [1, 1]}
steps: 15
`;
const RULES = {
  "Koch curve, 65,536 elements": curve,
  "tree, 98,302 elements": tree(""),
  "tree, strokes of 4 pixels": tree("style: {width: 4}"),
  "tree, coloured by step": tree("style: {color_by: step, palette: earth-to-leaf}"),
  "squares, 98,302, filled": squares,
};

const running = new Set();
const rows = [];
const row = (what, value, wanted) => {
  rows.push([what, value, wanted]);
  process.stderr.write(`${what}: ${value}\n`);
};
const sorted = (all) => [...all].sort((a, b) => a - b);
const quantile = (all, share) => sorted(all)[Math.min(all.length - 1, Math.floor(all.length * share))];
const ms = (value) => `${value.toFixed(1)} ms`;

/** Serves a rule. */
async function serve(rule) {
  const started = performance.now();
  const child = spawn(program, ["studio", rule, "--no-open"], { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });
  running.add(child);
  const url = await new Promise((done, failed) => {
    child.stdout.setEncoding("utf8").once("data", (text) => done(text.trim()));
    child.on("exit", () => failed(new Error("the studio ended")));
  });
  const [base, key] = url.split("/#");
  const agent = new http.Agent({ keepAlive: true });
  const call = (method, path, body) => new Promise((done, failed) => {
    const text = typeof body === "string" ? body : JSON.stringify(body ?? {});
    const request = http.request(base + path, { method, agent, headers: { "x-kfrac-key": key, "content-type": "application/json" } }, (answer) => {
      const parts = [];
      answer.on("data", (part) => parts.push(part)).on("end", () => done({ status: answer.statusCode, body: Buffer.concat(parts) }));
    });
    request.on("error", failed);
    request.end(method === "GET" ? undefined : text);
  });
  const stat = () => {
    const fields = readFileSync(`/proc/${child.pid}/stat`, "utf8").split(") ")[1].split(" ");
    return 10 * (+fields[11] + +fields[12]);
  };
  const memory = (name) => +/(\d+) kB/.exec(readFileSync(`/proc/${child.pid}/status`, "utf8").split("\n").find((line) => line.startsWith(name)))[1] / 1024;
  const end = () => new Promise((done) => { agent.destroy(); running.delete(child); child.on("exit", done); child.kill("SIGINT"); });
  return { url, call, stat, memory, end, started };
}

/** Runs in the page before its script: notes the pointer's event to which a picture answers, and when it is shown. */
const WATCH = `
  window.latencies = [];
  window.own = [];
  let last = 0, sent = 0;
  addEventListener("pointermove", (event) => { last = event.timeStamp; }, true);
  const real = window.fetch;
  window.fetch = (...all) => { if (all[0] === "/picture") sent = last; return real(...all); };
  addEventListener("picture", ({ detail }) => {
    const from = sent;
    if (!from || from === window.before) return;
    window.before = from;
    window.own.push(detail);
    requestAnimationFrame(() => { const channel = new MessageChannel(); channel.port1.onmessage = () => window.latencies.push(performance.now() - from); channel.port2.postMessage(0); });
  });
`;

/** Opens a page whose picture has 1024 × 768 pixels. */
async function open(browser, url) {
  let size = [1480, 960];
  await browser.size(...size);
  await browser.open(url);
  await browser.until("document.querySelector('#status').textContent.includes('elements')");
  const canvas = await browser.value("(() => { const it = document.querySelector('#picture'); return [it.width, it.height]; })()");
  size = [size[0] + 1024 - canvas[0], size[1] + 768 - canvas[1]];
  await browser.size(...size);
  await browser.until("document.querySelector('#picture').width === 1024 && document.querySelector('#picture').height === 768");
  await new Promise((done) => setTimeout(done, 700));
}

async function drag(browser) {
  const [x, y, width, height] = await browser.value("(() => { const { x, y, width, height } = document.querySelector('#parameters input[type=range]').getBoundingClientRect(); return [x, y, width, height]; })()");
  const at = (share) => [x + width * share, y + height / 2];
  await browser.pointer("mousePressed", ...at(0.4));
  await browser.value("latencies.length = own.length = 0");
  const end = performance.now() + 4000;
  for (let step = 0; performance.now() < end; step += 1) {
    await browser.pointer("mouseMoved", ...at(0.45 + 0.15 * Math.sin(step / 25)));
    await new Promise((done) => setTimeout(done, 8));
  }
  await browser.pointer("mouseReleased", ...at(0.4));
  return browser.value("[latencies, own]");
}

const user = (args, env) => {
  const text = spawnSync("bash", ["-c", `TIMEFORMAT='%U %S'; time nice ${args}`], { cwd: root, env: { ...process.env, ...env }, encoding: "utf8", maxBuffer: 1 << 28 });
  if (text.status !== 0) throw new Error(text.stderr);
  return text.stderr.trim().split("\n").at(-1).split(" ").map(Number).reduce((a, b) => a + b);
};

let browser = null;
try {
  for (const [number, text] of Object.values(RULES).entries()) writeFileSync(join(folder, `rule${number}.yaml`), text);

  const starts = [];
  for (let time = 0; time < 10; time += 1) {
    const studio = await serve("pythagoras");
    const { status } = await studio.call("POST", "/picture", { tab: "a", width: 1024, height: 768 });
    if (status !== 200) throw new Error("no picture");
    starts.push(performance.now() - studio.started);
    await studio.end();
  }
  row("start of the program to its first picture, median of 10", ms(quantile(starts, 0.5)), "150 ms");

  const edited = await serve("rule0.yaml");
  const times = [];
  for (let time = 0; time < 60; time += 1) {
    const { revision } = JSON.parse((await edited.call("GET", "/state")).body);
    const start = performance.now();
    await edited.call("PUT", `/text?revision=${revision}`, curve.replace("min: 5", `min: ${1 + (time % 4)}`));
    const { status } = await edited.call("GET", "/numbers");
    if (status !== 200) throw new Error("no numbers");
    times.push(performance.now() - start);
  }
  row("edit to forecast and dimension, two calls, median of 60", ms(quantile(times, 0.5)), "2 ms");
  await edited.end();

  browser = await Browser.start();
  await browser.send("Page.addScriptToEvaluateOnNewDocument", { source: WATCH });
  for (const [number, name] of Object.keys(RULES).entries()) {
    const studio = await serve(`rule${number}.yaml`);
    await open(browser, studio.url);
    const [all, own] = await drag(browser);
    const quantiles = (times) => `${ms(quantile(times, 0.5))}, ${ms(quantile(times, 0.95))}`;
    row(`pointer to picture, ${name}: median, 95 % (${all.length} pictures)`, quantiles(all), "16 ms, 33 ms");
    row("  of it, from the request to the painted picture", quantiles(own), "");
    if (number === 1) {
      await new Promise((done) => setTimeout(done, 1500));
      const before = studio.stat();
      await new Promise((done) => setTimeout(done, 10_000));
      row("processor time in 10 s of rest, with a page open", `${studio.stat() - before} ms`, "0");
      row("memory after the drag: now, most", `${studio.memory("VmRSS").toFixed(0)} MiB, ${studio.memory("VmHWM").toFixed(0)} MiB`, "150 MB");
    }
    await studio.end();
  }
  const size = (names) => {
    const paths = names.map((name) => join(root, "src/studio/page", name));
    const bytes = paths.map((path) => statSync(path).size).reduce((a, b) => a + b);
    const lines = paths.map((path) => readFileSync(path, "utf8").split("\n").length - 1).reduce((a, b) => a + b);
    return `${(bytes / 1000).toFixed(0)} kB, ${lines} lines`;
  };
  row("the page as it is loaded", size(["studio.html", "studio.css", "studio.js", "film.js"]), "90 kB, 1,500 lines");
  row("figures of a design, loaded when they are seen first", size(["design.js"]), "");
  const crates = (features) => new Set(execFileSync("cargo", ["tree", "--locked", "-e", "normal", "--prefix", "none", ...features], { cwd: root, encoding: "utf8" }).trim().split("\n").map((line) => line.replace(" (*)", ""))).size;
  const without = ["--no-default-features", "--features", "cli"];
  row("crates with and without", `${crates([])}, ${crates(without)}`, "30 more");

  if (options.includes("--build")) {
    const built = [[], without].map((features, number) => {
      const target = join(folder, `target${number}`);
      mkdirSync(target);
      const cpu = user(`cargo build --release --locked --bin kfrac ${features.join(" ")}`, { CARGO_TARGET_DIR: target });
      return [cpu, statSync(join(target, "release/kfrac")).size];
    });
    row("processor time of a release build with and without", built.map(([cpu]) => `${cpu.toFixed(0)} s`).join(", "), "40 s more");
    row("program with and without", built.map(([, size]) => `${(size / 1e6).toFixed(2)} MB`).join(", "), "1.2 MB more");
  }
} finally {
  running.forEach((child) => child.kill("SIGINT"));
  await browser?.end();
  rmSync(folder, { recursive: true, force: true });
}
const wide = [0, 1, 2].map((column) => Math.max(...rows.map((it) => it[column].length)));
console.log(["", "measured", "wanted"].map((it, column) => it.padEnd(wide[column])).join("  ").trimEnd());
for (const it of rows) console.log(it.map((text, column) => text.padEnd(wide[column])).join("  ").trimEnd());
