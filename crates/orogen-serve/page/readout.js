// The bottom line: scale, position and height under the pointer, or in the middle for keys and touch.

import { complain, say } from "./message.js";
import { EQUATOR, toWorld } from "./place.js";
import { ask } from "./server.js";
import { onChange, state } from "./state.js";
import { length, number, rounded, t, unit } from "./texts.js";

const here = document.getElementById("here");

let asked;
let pointed = null;

/** Starts the bottom line. */
export function startReadout(map, world) {
  const look = () => show(world, pointed ?? map.getCenter(), pointed === null);
  map.on("mousemove", (event) => {
    pointed = event.lngLat;
    document.body.classList.remove("centered");
    look();
  });
  const leave = () => {
    pointed = null;
    look();
  };
  map.on("mouseout", leave);
  map.on("touchend", leave);
  map.getCanvas().addEventListener("keydown", () => {
    pointed = null;
    document.body.classList.add("centered");
  });
  map.on("touchstart", () => document.body.classList.add("centered"));
  map.on("moveend", look);
  map.on("zoom", () => scale(map));
  onChange((names) => {
    if (names.some((name) => ["layer", "seed", "set"].includes(name))) look();
  });
  scale(map);
  look();
}

async function show(world, position, isMiddle) {
  asked?.abort();
  const mine = asked = new AbortController();
  const [x, y] = toWorld(position);
  const place = `${t("east")} ${number(x, 1)}  ${t("north")} ${number(y, 1)}`;
  if (!isInside(world.web.bounds, position)) {
    here.textContent = `${place}   ${t("outside")}`;
    return;
  }
  const layers = [...new Set([world.has_heights ? "height" : state.layer, state.layer])];
  // The pointer rests before anything is asked.
  await new Promise((wait) => setTimeout(wait, 40));
  if (mine.signal.aborted) return;
  try {
    const answers = await Promise.all(layers.map((layer) => value(x, y, layer, mine.signal)));
    const values = answers.filter(Boolean).map(({ layer, value, unit: own }) =>
      layer === "height" ? `${rounded(value)} m` : `${layer} ${rounded(value)} ${unit(own)}`);
    here.textContent = [place, ...values].join("   ");
    if (isMiddle && document.body.classList.contains("centered")) say(`${t("middle")}: ${here.textContent}`);
  } catch (error) {
    if (error.name !== "AbortError") {
      here.textContent = place;
      complain(error);
    }
  }
}

/** Whether a position is in the world. */
function isInside(bounds, { lng, lat }) {
  return !bounds || (lng >= bounds[0] && lat >= bounds[1] && lng <= bounds[2] && lat <= bounds[3]);
}

/** The value of a layer; nothing outside the world, and for layers of several numbers. */
async function value(x, y, layer, signal) {
  if (VECTORS.has(layer)) return null;
  try {
    const answer = await ask("height", { x, y, layer }, signal);
    return answer.value === null ? null : answer;
  } catch (error) {
    if (error.name === "AbortError") throw error;
    return null;
  }
}

const VECTORS = new Set(["normal", "albedo"]);

/** The bar of the scale: one metre of the world is one metre of the map. */
function scale(map) {
  const perPixel = EQUATOR / (512 * 2 ** map.getZoom());
  const most = 100 * perPixel;
  const ten = 10 ** Math.floor(Math.log10(most));
  const nice = [5, 2, 1].map((k) => k * ten).find((step) => step <= most);
  document.getElementById("scale-bar").style.width = `${nice / perPixel}px`;
  document.getElementById("scale-text").textContent = nice < 1000 ? `${number(nice, 2)} m` : `${number(nice / 1000)} km`;
}
