// Takes the frames of the README's moving picture: node film.mjs PROGRAM FOLDER
//
// `film.py` beside it makes one file of them.

import { spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";

import { Browser } from "./browser.mjs";

const [program, pictures] = process.argv.slice(2);
if (!pictures) throw new Error("node film.mjs PROGRAM FOLDER");
mkdirSync(pictures, { recursive: true });
const folder = mkdtempSync(join(tmpdir(), "kfrac-film-"));
writeFileSync(join(folder, "tree.yaml"), `title: Tree
params:
  angle: {value: 28, min: 5, max: 80, about: "Angle between a branch and the branch before it"}
  ratio: {value: 0.7, min: 0.5, max: 0.8}
initiator: [[0, 0], [0, 1]]
generator:
  elements:
    - {from: [0, 0], to: [1, 0], fertile: false}
    - {from: [1, 0], to: [1 + ratio * cos(angle), ratio * sin(angle)]}
    - {from: [1, 0], to: [1 + ratio * cos(angle), -ratio * sin(angle)]}
steps: 4
style: {color_by: step, palette: earth-to-leaf, width: 2}
`);
const studio = spawn(resolve(program), ["studio", "tree.yaml", "--no-open"], { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });
const url = await new Promise((done) => studio.stdout.setEncoding("utf8").once("data", (text) => done(text.trim())));
const browser = await Browser.start();
let number = 0;
const wait = (time) => new Promise((done) => setTimeout(done, time));
async function take(pause = 450) {
  await wait(pause);
  await browser.screenshot(join(pictures, `${String(number).padStart(3, "0")}.png`));
  number += 1;
}
try {
  await browser.size(1120, 700);
  await browser.open(url);
  await browser.until("document.querySelector('#status').textContent.includes('elements')");
  await take(900);
  for (let step = 0; step < 5; step += 1) {
    await browser.click("#forward");
    await take();
  }
  const slide = async (index, values) => {
    for (const value of values) {
      await browser.value(`(() => { const range = document.querySelectorAll('#parameters input[type=range]')[${index}]; range.value = ${value}; range.dispatchEvent(new Event('input')); range.dispatchEvent(new Event('change')); })()`);
      await take();
    }
  };
  await slide(0, [34, 40, 46, 52, 58]);
  await slide(1, [0.67, 0.64, 0.61]);
  await browser.click("#tab-style");
  await take(300);
  await browser.click("[data-name=sunset]");
  await take();
  for (let turn = 0; turn < 6; turn += 1) {
    await browser.send("Input.dispatchMouseEvent", { type: "mouseWheel", x: 305, y: 150, deltaX: 0, deltaY: -160 });
    await take();
  }
} finally {
  studio.kill("SIGINT");
  await browser.end();
  rmSync(folder, { recursive: true, force: true });
}
