// SPDX-License-Identifier: Apache-2.0
// Uses `kilolux view --serve` in Chromium: node drive.mjs PLAYWRIGHT ADDRESS FOLDER. Writes what it saw to
// FOLDER: NAME.rgb, the pixels of the page's canvas, NAME.png, the page, and seen.json.
import { createConnection, createServer } from "node:net";
import { createRequire } from "node:module";
import { writeFileSync } from "node:fs";
import { join } from "node:path";

const [playwright, address, folder] = process.argv.slice(2);
const { chromium } = createRequire(join(playwright, "package.json"))("playwright-core");
const url = new URL(address);
const kPatience = 120000;  // [ms], to compile kernels under load
const seen = { sizes: {} };

// A connection of the page to the server that can be cut, as an ssh tunnel can.
class Tunnel {
  sockets = new Set();
  server = createServer(near => {
    const far = createConnection(Number(url.port), url.hostname);
    for (const [from, to] of [[near, far], [far, near]]) {
      this.sockets.add(from);
      from.setNoDelay(true);
      from.on("error", () => {});
      from.on("close", () => { this.sockets.delete(from); to.destroy(); });
      from.pipe(to);
    }
  });
  open(port = 0) { return new Promise(done => this.server.listen(port, "127.0.0.1", () => done(this.server.address().port))); }
  cut() {
    for (const socket of this.sockets) socket.destroy();
    return new Promise(done => this.server.close(done));
  }
}

const tunnel = new Tunnel();
const port = await tunnel.open();
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--disable-gpu"] });
const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, hasTouch: true });
await context.grantPermissions(["clipboard-read", "clipboard-write"], { origin: `http://127.0.0.1:${port}` });
const page = await context.newPage();
const complaints = [];
page.on("pageerror", error => complaints.push(String(error)));
// Chromium itself logs connections that are refused.
page.on("console", message => { if (message.type() === "error" && !message.text().includes("ERR_CONNECTION_REFUSED")) complaints.push(message.text()); });

// Until a picture without loss that is newer than `after` has stayed for a while.
async function rest(after = 0) {
  let number = after;
  for (;;) {
    await page.waitForFunction(n => window.kiloluxState.lossless && window.kiloluxState.number > n, number, { timeout: kPatience });
    const now = await page.evaluate(() => window.kiloluxState.number);
    await page.waitForTimeout(2500);
    number = await page.evaluate(() => window.kiloluxState.number);
    if (number === now) return number;
    number -= 1;
  }
}
async function keep(name) {
  const { width, height, text } = await page.evaluate(() => {
    const canvas = document.getElementById("screen");
    const rgba = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    let out = "";
    for (let i = 0; i < rgba.length; i += 4) out += String.fromCharCode(rgba[i], rgba[i + 1], rgba[i + 2]);
    return { width: canvas.width, height: canvas.height, text: btoa(out) };
  });
  writeFileSync(join(folder, name + ".rgb"), Buffer.from(text, "base64"));
  seen.sizes[name] = [width, height];
}
// The middle of the panel's first slider's grip, which is found by its colour: SliderGrab in present/window/panel/gui.cpp.
function firstGrip() {
  return page.evaluate(() => {
    const canvas = document.getElementById("screen");
    const { width, data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    const isGrip = i => Math.hypot(data[i] - 116, data[i + 1] - 81, data[i + 2] - 29) < 6;
    for (let i = 0; i < data.length; i += 4) {
      let pixels = 0;
      while (isGrip(i + 4 * pixels)) ++pixels;
      if (pixels >= 4) return [(i / 4) % width + pixels / 2, Math.floor(i / 4 / width) + 4];
    }
    throw new Error("the panel has no slider");
  });
}
const shot = name => page.screenshot({ path: join(folder, name + ".png") });
const number = () => page.evaluate(() => window.kiloluxState.number);
const note = () => page.textContent("#note");
const act = async what => { const before = await number(); await what(); return rest(before); };
async function copied() {
  await page.keyboard.press("c");
  await page.waitForTimeout(1000);
  const command = await page.evaluate(() => navigator.clipboard.readText());
  await rest(await number() - 1);
  return command;
}

await page.goto(`http://127.0.0.1:${port}/${url.hash}`);
await rest();
seen.title = await page.title();
await keep("first");

// The camera, by a drag.
await act(async () => {
  await page.mouse.move(600, 300);
  await page.mouse.down();
  for (let i = 1; i <= 20; ++i) {
    await page.mouse.move(600 + 6 * i, 300 + 2 * i);
    await page.waitForTimeout(50);
  }
  await page.mouse.up();
  await page.mouse.move(1279, 719);
});
await keep("moved");
seen.command = await copied();

// A pixel's lists, then the panel, and a slider of it.
await act(async () => { await page.keyboard.press("x"); await page.mouse.move(640, 360); });
await keep("probed");
await act(async () => { await page.keyboard.press("x"); await page.mouse.move(1279, 719); });
await act(() => page.keyboard.press("Tab"));
await shot("panel");
await keep("panel");
const [x, y] = await firstGrip();
await act(async () => {
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 40, y, { steps: 5 });
  await page.mouse.up();
  await page.mouse.move(1279, 719);
});
await shot("slid");
await act(() => page.keyboard.press("Tab"));
await keep("slid");

// Shortcuts of the browser stay its own.
seen.kept = await page.evaluate(() => {
  const kept = {};
  for (const [name, init] of Object.entries({ reload: { code: "F5", key: "F5" }, tab: { code: "KeyT", key: "t", ctrlKey: true },
    tools: { code: "F12", key: "F12" }, back: { code: "ArrowLeft", key: "ArrowLeft", altKey: true }, leave: { code: "Tab", key: "Tab", shiftKey: true },
    panel: { code: "Tab", key: "Tab" }, fly: { code: "KeyW", key: "w" } })) {
    const event = new KeyboardEvent("keydown", { ...init, bubbles: true, cancelable: true });
    document.getElementById("screen").dispatchEvent(event);
    document.getElementById("screen").dispatchEvent(new KeyboardEvent("keyup", { ...init, bubbles: true, cancelable: true }));
    kept[name] = !event.defaultPrevented;
  }
  return kept;
});
await rest(await number());
seen.flown = await copied();

// Other sizes, a phone among them, whose finger is on the panel.
for (const [name, width, height] of [["large", 1920, 1080], ["phone", 390, 844]]) {
  await act(() => page.setViewportSize({ width, height }));
  await shot(name);
  await keep(name);
}
await act(() => page.touchscreen.tap(200, 400));
await act(() => page.setViewportSize({ width: 1280, height: 720 }));
seen.tapped = await copied();

// The connection is lost, and comes back.
await keep("before");
await tunnel.cut();
await page.waitForFunction(() => document.getElementById("note").textContent.startsWith("Connection lost"), null, { timeout: kPatience });
seen.lost = await note();
await shot("lost");
await page.waitForTimeout(500);
const again = new Tunnel();
await again.open(port);
await page.waitForFunction(() => document.getElementById("note").hidden, null, { timeout: kPatience });
await page.waitForTimeout(3000);
await keep("after");

// The session ends when the page asks for it.
await page.keyboard.press("Control+q");
await page.waitForFunction(() => document.getElementById("note").textContent.startsWith("The session has ended"), null, { timeout: kPatience });
seen.complaints = complaints;
writeFileSync(join(folder, "seen.json"), JSON.stringify(seen, null, 1));
await browser.close();
await again.cut();
