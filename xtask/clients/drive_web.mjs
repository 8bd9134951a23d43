// Uses the studio in Chromium like a person: node drive_web.mjs PLAIN ISOLATED FOLDER NODE_MODULES.
//
// PLAIN and ISOLATED are addresses of the same site; pages of the second one are isolated, and use threads. Pictures and
// downloads go to the folder, and what happened is printed as JSON: messages of the console, requests, workers, and texts
// that the page keeps. check_web.py judges them.

import { createRequire } from "node:module";
import { join } from "node:path";

const [plain, isolated, folder, modules] = process.argv.slice(2);
const { chromium } = createRequire(join(modules, "/"))("playwright-core");

// Both kinds of graphics are drawn by the processor; without the flags for Vulkan, pictures of WebGPU are empty.
const FLAGS = [
  "--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--enable-unsafe-webgpu",
  "--use-webgpu-adapter=swiftshader", "--enable-features=Vulkan", "--use-vulkan=swiftshader", "--disable-quic",
  "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
];
// The whole run on a busy machine.
const PATIENCE = 240_000;

const browser = await chromium.launchPersistentContext(join(folder, "profile"), {
  executablePath: "/usr/bin/chromium",
  args: FLAGS,
  viewport: { width: 1280, height: 800 },
  colorScheme: "dark",
  acceptDownloads: true,
});
const said = { errors: [], requests: [], texts: {}, downloads: [], workers: {}, pages: {} };

async function open(address, query) {
  const page = await browser.newPage();
  page.on("worker", () => { page.workersBegun = (page.workersBegun ?? 0) + 1; });
  page.on("console", (message) => message.type() === "error" && said.errors.push(message.text()));
  page.on("pageerror", (error) => said.errors.push(error.message));
  page.on("request", (request) => said.requests.push(request.url()));
  await page.goto(`${address}studio/${query}`);
  await page.waitForFunction(() => document.getElementById("note").hidden, null, { timeout: PATIENCE });
  return page;
}

// The number of different colors in a part of the window, which is greater where land is.
async function colors(page, clip) {
  const bytes = await page.screenshot({ clip });
  return page.evaluate(async (encoded) => {
    const picture = await createImageBitmap(await (await fetch(`data:image/png;base64,${encoded}`)).blob());
    const canvas = new OffscreenCanvas(picture.width, picture.height);
    const context = canvas.getContext("2d");
    context.drawImage(picture, 0, 0);
    const pixels = new Uint32Array(context.getImageData(0, 0, picture.width, picture.height).data.buffer);
    return new Set(pixels).size;
  }, bytes.toString("base64"));
}

async function until(what, holds) {
  const begun = Date.now();
  while (!(await holds())) {
    if (Date.now() - begun > PATIENCE) throw new Error(`${what}: not after ${PATIENCE / 1000} s`);
    await new Promise((resolve) => setTimeout(resolve, 200));
  }
}

const LAND = { x: 250, y: 180, width: 460, height: 300 };
const land = (page) => until("the land", async () => (await colors(page, LAND)) > 2000);
// The text that was not saved.
const draft = (page) => page.evaluate(() => localStorage.getItem("orogen:/.orogen/unsaved/1.toml") ?? "");
const changed = (page, what, before) => until(what, async () => (await draft(page)) !== before);
const shot = (page, name) => page.screenshot({ path: join(folder, `${name}.png`) });

// Waits until an act has changed the picture: on a busy machine a frame takes a second, and keys that come together are lost.
async function seen(page, act) {
  const before = await page.screenshot();
  await act();
  await until("a change of the window", async () => !(await page.screenshot()).equals(before));
  await page.waitForTimeout(400);
}

async function drag(page, [x, y], [toX, toY]) {
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let step = 1; step <= 8; step++) {
    await page.mouse.move(x + ((toX - x) * step) / 8, y + ((toY - y) * step) / 8);
    await page.waitForTimeout(30);
  }
  await page.mouse.up();
}

// A click that takes more than a frame, as a hand's does.
async function click(page, x, y) {
  await page.mouse.move(x, y);
  await page.waitForTimeout(400);
  await page.mouse.click(x, y, { delay: 150 });
}

async function download(page, act) {
  const [file] = await Promise.all([page.waitForEvent("download", { timeout: PATIENCE }), act()]);
  await file.saveAs(join(folder, file.suggestedFilename()));
  said.downloads.push(file.suggestedFilename());
}

// A command by its name.
async function command(page, name) {
  await seen(page, () => page.keyboard.press("Control+Shift+P"));
  await seen(page, () => page.keyboard.type(name));
  await page.keyboard.press("Enter");
  await page.waitForTimeout(800);
}

// A page with one thread, drawn with WebGL 2.
async function single() {
  // A recipe of the host, in English.
  const page = await open(plain, "?open=../recipes/land.toml&lang=en");
  await land(page);
  await shot(page, "english");
  said.pages.single = await about(page);

  // A slider changes the text, and the land.
  const before = await draft(page);
  await drag(page, [1087, 193], [1120, 193]);
  await changed(page, "the slider", before);
  said.texts.slider = await draft(page);
  await page.waitForTimeout(1500);
  await shot(page, "slider");

  // A node after the last one.
  await command(page, "add a node");
  await seen(page, () => page.keyboard.type("terrace"));
  await page.keyboard.press("Enter");
  await changed(page, "a node", said.texts.slider);
  said.texts.node = await draft(page);
  await land(page);
  await shot(page, "node");

  // Saved in the browser, and downloaded.
  await seen(page, () => page.keyboard.press("Control+S"));
  await page.keyboard.press("Control+A");
  await seen(page, () => page.keyboard.type("mine.toml"));
  await page.keyboard.press("Enter");
  const saved = () => page.evaluate(() => localStorage.getItem("orogen:/mine.toml"));
  await until("the saved recipe", saved);
  said.texts.saved = await saved();
  await download(page, () => command(page, "download"));

  // An export has the bytes of the command line.
  await seen(page, () => page.keyboard.press("Control+E"));
  await shot(page, "export");
  await download(page, () => click(page, 567, 331));
  await page.close();

  // The other language; a file of the computer; what was saved is still there.
  const chinese = await open(plain, "?open=../recipes/land.toml&lang=zh-CN");
  await land(chinese);
  await shot(chinese, "chinese");
  said.texts.kept = await chinese.evaluate(() => localStorage.getItem("orogen:/mine.toml"));
  await seen(chinese, () => chinese.keyboard.press("Control+O"));
  await shot(chinese, "open");
  const [chooser] = await Promise.all([
    chinese.waitForEvent("filechooser", { timeout: PATIENCE }),
    click(chinese, 480, 147),
  ]);
  await chooser.setFiles(join(folder, "other.toml"));
  const other = () => chinese.evaluate(() => localStorage.getItem("orogen:/other.toml"));
  await until("a file of the computer", other);
  said.texts.other = await other();
  await land(chinese);
  await shot(chinese, "other");
  await chinese.close();

  // A wrong address is a sentence in the window.
  const wrong = await open(plain, "?open=../recipes/none.toml&lang=en");
  await wrong.waitForTimeout(1500);
  await shot(wrong, "wrong");
  await wrong.close();
}

// What a page is, and the number of its workers.
async function about(page) {
  const about = await page.evaluate(() => ({
    isIsolated: crossOriginIsolated,
    cores: navigator.hardwareConcurrency,
    isWebGpu: document.getElementById("studio").getContext("webgpu") !== null,
  }));
  return { ...about, workers: page.workersBegun };
}

// An isolated page. Changes interrupt the solver, and no worker is replaced.
async function threads() {
  const page = await open(isolated, "?open=../recipes/heavy.toml&lang=en");
  await land(page);
  said.pages.threads = await about(page);
  const before = await draft(page);
  for (const x of [1100, 1110, 1120]) {
    const text = await draft(page);
    await drag(page, [x === 1100 ? 1087 : x - 10, 193], [x, 193]);
    await changed(page, "the slider", text);
    await page.waitForTimeout(700);
  }
  said.texts.heavyBefore = before;
  said.texts.heavy = await draft(page);
  await page.waitForTimeout(1500);
  await land(page);
  await shot(page, "threads");
  said.workers.changed = page.workersBegun;
  await seen(page, () => page.keyboard.press("Control+E"));
  await download(page, () => click(page, 567, 350));
  await page.close();
}

// An isolated page that is drawn with WebGPU.
async function webGpu() {
  const page = await open(isolated, "?open=../recipes/land.toml&lang=en&graphics=webgpu");
  await land(page);
  await shot(page, "webgpu");
  said.pages.webGpu = await about(page);
  await page.close();
}

try {
  await webGpu();
  await threads();
  await single();
} catch (error) {
  said.errors.push(String(error));
}
await browser.close();
console.log(JSON.stringify(said));
