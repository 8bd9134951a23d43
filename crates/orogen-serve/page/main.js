// The page of a world: a map with its tools.

import { Map, NavigationControl, FullscreenControl } from "./maplibre-gl.mjs";
import { renameFormats, startDownload } from "./download.js";
import { showLegend } from "./legend.js";
import { collection, onMarks } from "./marks.js";
import { complain, say } from "./message.js";
import { showParameters, startParameters } from "./parameters.js";
import { setPlace } from "./place.js";
import { startProfile } from "./profile.js";
import { startReadout } from "./readout.js";
import { renameQuestions, startSearch } from "./search.js";
import { address, ask } from "./server.js";
import { change, keepView, onChange, read, state } from "./state.js";
import { onScheme, style } from "./style.js";
import { apply, declared, language, load, number, other, t } from "./texts.js";

const get = (id) => document.getElementById(id);

read();
await load();
apply();
let world;
try {
  world = await ask("world.json");
} catch (error) {
  complain(error);
  throw error;
}
setPlace(world.web);
describe();

let colors = { stops: [], classes: [], unit: "" };
const map = new Map({
  container: "map", style: style(world, [], collection()), attributionControl: false, maxPitch: 80, minZoom: 1, maxZoom: Math.min(world.web.max_zoom + 1, 22),
  renderWorldCopies: false, ...view(),
});
map.addControl(new NavigationControl({ visualizePitch: true }), "top-right");
map.addControl(new FullscreenControl(), "top-right");
map.getCanvas().setAttribute("aria-label", t("map-label", { name: world.name }));
map.on("error", ({ error }) => complain(error));
map.on("moveend", () => {
  const { lng, lat } = map.getCenter();
  keepView([map.getZoom().toFixed(2), lng.toFixed(6), lat.toFixed(6), map.getBearing().toFixed(1), map.getPitch().toFixed(1)].map(Number));
  get("link").value = location.href;
});
// When the map has drawn everything, for programs that drive the page.
let isColoring = false;
map.on("idle", () => {
  if (!isColoring) document.body.dataset.still = "true";
});
onMarks((marks) => map.getSource("marks")?.setData(marks));

const redraw = () => {
  document.body.dataset.still = "false";
  map.setStyle(style(world, colors.stops, collection()), { diff: true });
};
onScheme(redraw);

/** Takes the colors of the layer from the server. */
let coloring;
async function recolor() {
  coloring?.abort();
  const mine = coloring = new AbortController();
  isColoring = true;
  document.body.dataset.still = "false";
  try {
    colors = await ask(`colors/${encodeURIComponent(state.layer)}.json`, state.palette ? { palette: state.palette } : {}, mine.signal);
  } catch (error) {
    if (error.name === "AbortError") return;
    colors = { stops: [], classes: [], unit: "" };
    complain(error);
  }
  isColoring = false;
  showLegend(colors);
  redraw();
}

startControls();
startSearch(map, world);
const profile = startProfile(map, world);
startDownload(map, world);
startReadout(map, world);
startParameters();
onChange((names) => {
  get("link").value = location.href;
  if (names.some((name) => ["seed", "set"].includes(name))) describe();
  if (names.some((name) => ["layer", "palette", "seed", "set"].includes(name))) recolor();
  else redraw();
});
get("link").value = location.href;
await recolor();
document.body.dataset.ready = "true";

/** The first view: that of the address, otherwise the whole world. */
function view() {
  if (state.view) {
    const [zoom, lng, lat, bearing, pitch] = state.view;
    return { zoom, center: [lng, lat], bearing, pitch };
  }
  const { bounds, own_zoom } = world.web;
  const isWide = innerWidth > 640;
  const pitch = state.relief3d && world.has_heights ? 30 : 0;
  if (!bounds) return { center: [0, 0], zoom: Math.max(1, own_zoom - 2), pitch: 1.5 * pitch };
  const padding = { top: 30, bottom: isWide ? 60 : innerHeight * 0.55, left: isWide ? 350 : 15, right: 30 };
  return { bounds: [[bounds[0], bounds[1]], [bounds[2], bounds[3]]], fitBoundsOptions: { padding }, pitch };
}

/** The words about the world that are in no control. */
function describe() {
  document.title = world.name;
  document.querySelector("h1").textContent = world.name;
  const size = world.size ? `${number(world.size[0] / 1000, 1)} × ${number(world.size[1] / 1000, 1)} km` : t("unbounded");
  const parts = [world.about, size, t("cell", { cell: number(world.cell, 3) }), world.crs].filter(Boolean);
  get("about").textContent = parts.join(" · ");
  get("addresses").href = address("addresses");
  get("worlds").hidden = document.documentElement.dataset.root === "";
  get("worlds").href = new URL(`../${new URL(address("")).search}`, address("")).href.replace(/[?&](seed|set)=[^&]*/g, "");
  const root = new URL(document.documentElement.dataset.root || "./", address("").split("?")[0]);
  get("studio").hidden = !world.has_studio;
  get("book").hidden = !world.has_book;
  get("book").href = new URL(language === "en" ? "book/" : "book/zh-CN/", root).href;
  // The studio opens the recipe with the seed and the numbers of now.
  const studio = new URL("studio/", root);
  studio.searchParams.set("open", address("recipe.toml"));
  studio.searchParams.set("lang", language);
  get("studio").href = studio.href;
  get("language").textContent = language === "en" ? "中文" : "English";
  get("language").lang = other();
  const keys = [["+ −", "keys-zoom"], ["← ↑ → ↓", "keys-move"], ["Shift + ← →", "keys-turn"], ["Shift + ↑ ↓", "keys-tilt"], ["/", "keys-search"], ["P", "keys-profile"], ["M", "keys-panel"]];
  get("keys").replaceChildren(...keys.flatMap(([key, text]) => {
    const [term, words] = [document.createElement("dt"), document.createElement("dd")];
    term.textContent = key;
    words.textContent = t(text);
    return [term, words];
  }));
}

/** The lists of layers and palettes. */
function fillLists() {
  get("layer").replaceChildren(...world.layers.map(({ name, about }) => {
    const option = new Option(declared(`layer.${name}`, name), name);
    option.title = about;
    return option;
  }));
  const heights = state.layer === "height";
  const suits = world.palettes.filter(({ suits }) => suits === "any" || (suits === "heights") === heights);
  get("palette").replaceChildren(
    new Option(t("own-palette"), ""),
    ...suits.filter(({ name }) => name !== "hypsometric").map(({ name }) => new Option(declared(`palette.${name}`, name), name)),
  );
  get("layer").value = state.layer;
  get("palette").value = state.palette;
}

function startControls() {
  if (!world.layers.some(({ name }) => name === state.layer)) state.layer = world.layers[0]?.name ?? "height";
  fillLists();
  get("layer").addEventListener("change", () => {
    change({ layer: get("layer").value, palette: "" });
    fillLists();
  });
  get("palette").addEventListener("change", () => change({ palette: get("palette").value }));
  for (const name of ["contours", "rivers", "lakes", "summits", "relief3d"]) {
    const box = get(name);
    box.checked = state[name];
    box.disabled = !world.has_heights;
    box.addEventListener("change", () => change({ [name]: box.checked }));
  }
  const units = { exaggeration: "×", azimuth: "°", altitude: "°", shading: "%" };
  for (const [name, sign] of Object.entries(units)) {
    const slider = get(name);
    const output = document.querySelector(`output[for=${name}]`);
    slider.value = state[name];
    const show = () => { output.textContent = `${number(slider.value, 1)}${sign}`; };
    slider.addEventListener("input", () => {
      show();
      change({ [name]: Number(slider.value) });
    });
    show();
  }
  get("open").addEventListener("click", togglePanel);
  if (innerWidth <= 640) togglePanel();
  get("language").addEventListener("click", translate);
  get("copy").addEventListener("click", copy);
  addEventListener("hashchange", () => location.reload());
  addEventListener("keydown", (event) => {
    const isTyping = /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName);
    if (isTyping || event.ctrlKey || event.metaKey || event.altKey) return;
    const tools = { "/": focusSearch, p: () => profile.toggle(), m: togglePanel };
    const tool = tools[event.key.toLowerCase()];
    if (tool) {
      event.preventDefault();
      tool();
    }
  });
}

function togglePanel() {
  const isClosed = document.body.classList.toggle("closed");
  get("open").setAttribute("aria-expanded", !isClosed);
}

function focusSearch() {
  if (document.body.classList.contains("closed")) togglePanel();
  get("question").focus();
}

async function translate() {
  await load(other());
  apply();
  describe();
  fillLists();
  renameQuestions();
  renameFormats(world);
  profile.update();
  showLegend(colors);
  showParameters();
  map.getCanvas().setAttribute("aria-label", t("map-label", { name: world.name }));
}

async function copy() {
  const field = get("link");
  field.select();
  try {
    await navigator.clipboard.writeText(field.value);
  } catch {
    document.execCommand("copy");
  }
  get("copy").textContent = t("copied");
  say(t("copied"));
  setTimeout(() => { get("copy").textContent = t("copy"); }, 2000);
}
