// Loads the studio, shows how much of it is there, and says what is wrong if it cannot run.

import init, { run } from "./studio.js";

const FILE = "studio_bg.wasm.gz";

const canvas = document.getElementById("studio");
const note = document.getElementById("note");
const text = document.getElementById("text");
const share = document.getElementById("share");

const isChinese = (new URLSearchParams(location.search).get("lang") ?? navigator.language ?? "en").startsWith("zh");

function say(english, chinese, details) {
  text.textContent = (isChinese ? chinese : english) + (details ? ` (${details})` : "");
  share.hidden = true;
  note.hidden = false;
}

// The bytes of the module. The host may have unpacked the file already.
async function load() {
  const response = await fetch(FILE);
  if (!response.ok) throw new Error(`${FILE}: ${response.status} ${response.statusText}`);
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

// A page whose graphics are lost cannot draw again.
canvas.addEventListener("webglcontextlost", () => {
  canvas.hidden = true;
  say(
    "The graphics device was lost. Reload the page: what was not saved is kept.",
    "图形设备已丢失。请重新加载页面：未保存的内容会保留。",
  );
});

addEventListener("error", (event) => {
  if (!(event.error instanceof WebAssembly.RuntimeError)) return;
  canvas.hidden = true;
  say(
    "The studio ended because of an internal error. Reload the page: what was not saved is kept.",
    "工作室因内部错误而终止。请重新加载页面：未保存的内容会保留。",
    event.message,
  );
});

try {
  await init({ module_or_path: load() });
} catch (error) {
  say("The studio cannot be loaded.", "无法加载工作室。", error.message ?? error);
  throw error;
}
// Unsaved texts of a page that is still open are not offered in another one. Browsers have locks for https and localhost alone.
const locks = navigator.locks;
const held = locks ? (await locks.query()).held.map((lock) => lock.name) : [];
const hold = (name) => locks?.request(name, () => new Promise(() => {}));

try {
  await run(canvas, held, hold);
  note.hidden = true;
} catch (error) {
  say(
    "This browser cannot draw the studio: it needs WebGL 2. Switch on hardware acceleration, or use another browser.",
    "此浏览器无法显示工作室：需要 WebGL 2。请启用硬件加速，或换用其他浏览器。",
    error.message ?? error,
  );
  throw error;
}
