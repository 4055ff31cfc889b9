// Headless Chromium over the pipe of its DevTools protocol.

import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const FLAGS = [
  "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--no-first-run", "--disable-quic",
  "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage", "--hide-scrollbars", "--remote-debugging-pipe",
];

export class Browser {
  static async start(program = process.env.CHROMIUM ?? "chromium") {
    const browser = new Browser();
    browser.folder = mkdtempSync(join(tmpdir(), "kfrac-studio-"));
    const stdio = ["ignore", "ignore", "ignore", "pipe", "pipe"];
    browser.process = spawn(program, [...FLAGS, `--user-data-dir=${browser.folder}`, "about:blank"], { stdio });
    browser.process.on("error", (error) => { throw new Error(`${program} cannot be started: ${error.message}`); });
    browser.waiting = new Map();
    browser.heard = [];
    browser.number = 0;
    let rest = "";
    browser.process.stdio[4].setEncoding("utf8").on("data", (data) => {
      const messages = (rest + data).split("\0");
      rest = messages.pop();
      messages.map(JSON.parse).forEach((message) => browser.hear(message));
    });
    const { targetInfos } = await browser.send("Target.getTargets");
    const page = targetInfos.find((it) => it.type === "page");
    browser.session = (await browser.send("Target.attachToTarget", { targetId: page.targetId, flatten: true })).sessionId;
    for (const domain of ["Page", "Runtime", "Accessibility", "Log"]) await browser.send(`${domain}.enable`);
    return browser;
  }

  hear(message) {
    if (message.id === undefined) return this.heard.push(message);
    const { resolve, reject } = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    if (message.error) reject(new Error(`${message.error.message} ${message.error.data ?? ""}`));
    else resolve(message.result);
  }

  send(method, params = {}) {
    const id = (this.number += 1);
    const sessionId = method.startsWith("Target.") ? undefined : this.session;
    this.process.stdio[3].write(JSON.stringify({ id, method, params, sessionId }) + "\0");
    return new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject }));
  }

  /** Evaluates an expression in the page. */
  async value(expression) {
    const { result, exceptionDetails } = await this.send("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  /** Waits until an expression holds. */
  async until(expression, patience = 20_000) {
    const end = Date.now() + patience;
    while (!(await this.value(expression))) {
      if (Date.now() > end) throw new Error(`never: ${expression}`);
      await new Promise((resolve) => setTimeout(resolve, 40));
    }
  }

  async size(width, height, scale = 1) {
    await this.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: scale, mobile: false });
  }

  async prefer(features) {
    await this.send("Emulation.setEmulatedMedia", { features: Object.entries(features).map(([name, value]) => ({ name, value })) });
  }

  async open(url) {
    await this.send("Page.navigate", { url: "about:blank" });
    await this.send("Page.navigate", { url });
    await this.until("document.readyState === 'complete'");
  }

  async key(key, { text = key.length === 1 ? key : undefined, modifiers = 0 } = {}) {
    const codes = { Tab: 9, Enter: 13, Escape: 27, " ": 32, ArrowLeft: 37, ArrowUp: 38, ArrowRight: 39, ArrowDown: 40 };
    const code = codes[key] ?? key.toUpperCase().charCodeAt(0);
    const base = { key, modifiers, windowsVirtualKeyCode: code, text: modifiers & 2 ? undefined : key === "Enter" ? "\r" : text };
    await this.send("Input.dispatchKeyEvent", { type: "keyDown", ...base });
    await this.send("Input.dispatchKeyEvent", { type: "keyUp", ...base });
  }

  async type(text) {
    await this.send("Input.insertText", { text });
  }

  async pointer(type, x, y, more = {}) {
    await this.send("Input.dispatchMouseEvent", { type, x, y, button: "left", buttons: type === "mouseReleased" ? 0 : 1, clickCount: 1, ...more });
  }

  async drag([x, y], [toX, toY], steps = 8) {
    await this.pointer("mousePressed", x, y);
    for (let step = 1; step <= steps; step += 1) await this.pointer("mouseMoved", x + (toX - x) * step / steps, y + (toY - y) * step / steps);
    await this.pointer("mouseReleased", toX, toY);
  }

  async click(selector) {
    const [x, y] = await this.value(`(() => { const box = document.querySelector(${JSON.stringify(selector)}).getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; })()`);
    await this.pointer("mousePressed", x, y);
    await this.pointer("mouseReleased", x, y);
  }

  async screenshot(path) {
    const { data } = await this.send("Page.captureScreenshot", { format: "png" });
    writeFileSync(path, Buffer.from(data, "base64"));
  }

  /** Returns the controls of the accessibility tree, with role and name. */
  async controls() {
    const { nodes } = await this.send("Accessibility.getFullAXTree");
    const roles = ["button", "slider", "textbox", "searchbox", "combobox", "checkbox", "tab", "tabpanel", "listbox", "option", "image", "application", "spinbutton", "dialog", "group"];
    const shown = nodes.filter((it) => !it.ignored && roles.includes(it.role?.value));
    return shown.map((it) => ({ role: it.role.value, name: it.name?.value ?? "" }));
  }

  errors() {
    const failures = this.heard.filter((it) => it.method === "Runtime.exceptionThrown" || (it.method === "Log.entryAdded" && it.params.entry.level === "error"));
    return failures.map((it) => it.params.exceptionDetails?.exception?.description ?? `${it.params.entry?.text} ${it.params.entry?.url ?? ""}`);
  }

  async end() {
    await this.send("Browser.close").catch(() => {});
    await new Promise((resolve) => (this.process.exitCode === null ? this.process.on("exit", resolve) : resolve()));
    rmSync(this.folder, { recursive: true, force: true });
  }
}
