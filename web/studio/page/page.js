// Loads the studio, shows how much of it is there, and says what is wrong if it cannot run.

import { HAS_THREADS } from "./modules.js";

const FILE = "studio_bg.wasm.gz";

let canvas = document.getElementById("studio");
const note = document.getElementById("note");
const text = document.getElementById("text");
const share = document.getElementById("share");

const query = new URLSearchParams(location.search);
const isChinese = (query.get("lang") ?? navigator.language ?? "en").startsWith("zh");

function say(english, chinese, details) {
  text.textContent = (isChinese ? chinese : english) + (details ? ` (${details})` : "");
  share.hidden = true;
  note.hidden = false;
}

// The bytes of the module. The host may have unpacked the file already.
async function load(file) {
  const response = await fetch(file);
  if (!response.ok) throw new Error(`${file}: ${response.status} ${response.statusText}`);
  const length = Number(response.headers.get("Content-Length"));
  const isPacked = !response.headers.get("Content-Encoding");
  let there = 0;
  const counted = new TransformStream({
    transform(part, controller) {
      there += part.length;
      if (length && isPacked) share.value = there / length;
      controller.enqueue(part);
    },
  });
  const body = response.body.pipeThrough(counted);
  const unpacked = isPacked ? body.pipeThrough(new DecompressionStream("gzip")) : body;
  return new Response(unpacked, { headers: { "Content-Type": "application/wasm" } });
}

// The program: the one with threads needs memory that workers share, which browsers allow to isolated pages alone.
async function program() {
  const start = async (folder) => {
    const program = await import(`${folder}studio.js`);
    await program.default({ module_or_path: load(folder + FILE) });
    return program;
  };
  if (HAS_THREADS && globalThis.crossOriginIsolated && query.get("threads") !== "no") {
    try {
      return await start("./threads/");
    } catch (error) {
      console.warn(`The studio runs without threads: ${error.message ?? error}`);
    }
  }
  return start("./");
}

// A page whose graphics are lost cannot draw again.
function lose() {
  canvas.hidden = true;
  say(
    "The graphics device was lost. Reload the page: what was not saved is kept.",
    "图形设备已丢失。请重新加载页面：未保存的内容会保留。",
  );
}
canvas.addEventListener("webglcontextlost", lose);
addEventListener("graphicslost", lose);

// Whether to draw with WebGPU: on a graphics card, or if the address asks for it (`graphics=webgpu`).
async function hasWebGpu() {
  const asked = query.get("graphics");
  if (asked === "webgl" || !navigator.gpu) return false;
  try {
    const adapter = await navigator.gpu.requestAdapter({ powerPreference: "high-performance" });
    if (!adapter || (adapter.info?.isFallbackAdapter && asked !== "webgpu")) return false;
    (await adapter.requestDevice()).destroy();
    return true;
  } catch {
    return false;
  }
}

addEventListener("error", (event) => {
  if (!(event.error instanceof WebAssembly.RuntimeError)) return;
  canvas.hidden = true;
  say(
    "The studio ended because of an internal error. Reload the page: what was not saved is kept.",
    "工作室因内部错误而终止。请重新加载页面：未保存的内容会保留。",
    event.message,
  );
});

let run;
try {
  ({ run } = await program());
} catch (error) {
  say("The studio cannot be loaded.", "无法加载工作室。", error.message ?? error);
  throw error;
}
// Unsaved texts of a page that is still open are not offered in another one. Browsers have locks for https and localhost alone.
const locks = navigator.locks;
const held = locks ? (await locks.query()).held.map((lock) => lock.name) : [];
const hold = (name) => locks?.request(name, () => new Promise(() => {}));

// Starts the window. A canvas that WebGPU has failed with cannot be used with WebGL.
async function open() {
  if (await hasWebGpu()) {
    try {
      return await run(canvas, held, hold, true);
    } catch (error) {
      console.warn(`The studio draws without WebGPU: ${error.message ?? error}`);
      const other = canvas.cloneNode();
      other.addEventListener("webglcontextlost", lose);
      canvas.replaceWith(other);
      canvas = other;
    }
  }
  return run(canvas, held, hold, false);
}

try {
  await open();
  note.hidden = true;
} catch (error) {
  say(
    "This browser cannot draw the studio: it needs WebGL 2. Switch on hardware acceleration, or use another browser.",
    "此浏览器无法显示工作室：需要 WebGL 2。请启用硬件加速，或换用其他浏览器。",
    error.message ?? error,
  );
  throw error;
}
