// The profile: heights along a line that is drawn on the map.

import { complain, say } from "./message.js";
import { mark } from "./marks.js";
import { toMap, toWorld } from "./place.js";
import { ask } from "./server.js";
import { onChange } from "./state.js";
import { length, number, rounded, t } from "./texts.js";

const get = (id) => document.getElementById(id);
const SVG = "http://www.w3.org/2000/svg";
/** The size of the chart, in units of its own. */
const [WIDE, HIGH] = [1000, 130];

/** The room for labels of heights, in pixels. */
const LABELS = 64;

let corners = [];
let drawing = false;
let running;
let world;

/** Starts the tool. */
export function startProfile(map, described) {
  world = described;
  const update = () => {
    get("profile-start").setAttribute("aria-pressed", drawing);
    get("profile-start").textContent = t(drawing ? "profile-end" : "profile-start");
    get("profile-add").disabled = !drawing;
    get("profile-clear").disabled = corners.length === 0;
    map.getCanvas().style.cursor = drawing ? "crosshair" : "";
    map.doubleClickZoom[drawing ? "disable" : "enable"]();
    mark("line", corners.map((corner) => ["", corner]));
  };
  const add = ({ lng, lat }) => {
    corners.push([lng, lat]);
    update();
    if (corners.length > 1) measure();
  };
  const end = () => {
    drawing = false;
    update();
  };
  const clear = () => {
    corners = [];
    mark("at", []);
    get("chart").hidden = true;
    end();
  };
  get("profile-start").addEventListener("click", () => {
    if (!drawing) corners = [];
    drawing = !drawing;
    update();
  });
  get("profile-add").addEventListener("click", () => add(map.getCenter()));
  get("profile-clear").addEventListener("click", clear);
  map.on("click", (event) => drawing && add(event.lngLat));
  map.on("dblclick", (event) => {
    if (drawing) {
      event.preventDefault();
      end();
    }
  });
  addEventListener("keydown", (event) => {
    if (drawing && (event.key === "Enter" || event.key === "Escape") && event.target === map.getCanvas()) end();
    else if (event.key === "Escape" && !get("chart").hidden) clear();
  });
  onChange((names) => {
    if (corners.length > 1 && names.some((name) => ["seed", "set"].includes(name))) measure();
  });
  return { toggle: () => get("profile-start").click(), update, clear };
}

async function measure() {
  running?.abort();
  const mine = running = new AbortController();
  const points = corners.map(([lng, lat]) => toWorld({ lng, lat }).join(",")).join(";");
  try {
    draw(await ask("profile", { points, samples: 512 }, mine.signal));
  } catch (error) {
    complain(error);
  }
}

function element(name, attributes, text) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
}

/** Draws the chart of an answer. */
function draw({ distance, values, x, y, length: whole }) {
  const known = values.filter((value) => value !== null);
  const box = get("chart");
  if (known.length === 0) {
    box.hidden = true;
    complain(new Error(t("profile-outside")));
    return;
  }
  box.hidden = false;
  const left = LABELS * WIDE / box.clientWidth;
  const [lowest, highest] = [Math.min(...known), Math.max(...known)];
  const room = Math.max(highest - lowest, 1) * 0.08;
  const [low, high] = [lowest - room, highest + room];
  const across = (at) => left + (WIDE - left) * at / whole;
  const down = (height) => HIGH * (high - height) / (high - low);
  const svg = element("svg", { viewBox: `0 0 ${WIDE} ${HIGH + 20}`, preserveAspectRatio: "none", role: "img" });
  const rise = values.slice(1).reduce((sum, value, k) => sum + Math.max(0, value - values[k]), 0);
  const words = t("profile-words", { length: length(whole), lowest: rounded(lowest), highest: rounded(highest), rise: rounded(rise) });
  svg.append(element("title", {}, words));
  for (const height of [lowest, (lowest + highest) / 2, highest]) {
    svg.append(element("line", { class: "axis", x1: left, x2: WIDE, y1: down(height), y2: down(height) }));
  }
  let path = "";
  let open = false;
  values.forEach((value, k) => {
    const at = [across(distance[k]).toFixed(1), value === null ? 0 : down(value).toFixed(1)];
    if (value === null && open) path += `V${HIGH}Z`;
    if (value !== null) path += open ? `L${at}` : `M${at[0]},${HIGH}L${at}`;
    open = value !== null;
  });
  if (open) path += `L${WIDE},${HIGH}Z`;
  if (world.sea_level !== null && world.sea_level > low) {
    const top = Math.max(0, down(world.sea_level));
    svg.append(element("rect", { class: "sea", x: left, y: top, width: WIDE - left, height: HIGH - top }));
  }
  svg.append(element("path", { class: "ground", d: path, "vector-effect": "non-scaling-stroke" }));
  const at = element("line", { class: "at", visibility: "hidden", y1: 0, y2: HIGH, "vector-effect": "non-scaling-stroke" });
  svg.append(at);

  const line = document.createElement("p");
  const shown = document.createElement("span");
  const close = document.createElement("button");
  close.type = "button";
  close.textContent = t("close");
  close.addEventListener("click", () => get("profile-clear").click());
  shown.textContent = words;
  line.append(shown, close);
  box.replaceChildren(line, svg);
  say(words);
  labels(svg, [lowest, highest], down, whole, left);

  const point = (event) => {
    const area = svg.getBoundingClientRect();
    const share = ((event.clientX - area.left) / area.width * WIDE - left) / (WIDE - left);
    const k = Math.round(Math.min(1, Math.max(0, share)) * (values.length - 1));
    for (const end of ["x1", "x2"]) at.setAttribute(end, across(distance[k]));
    at.setAttribute("visibility", "visible");
    mark("at", [["", toMap([x[k], y[k]])]]);
    shown.textContent = `${length(distance[k])}: ${values[k] === null ? t("outside") : `${rounded(values[k])} m`}   (${number(x[k])}, ${number(y[k])})`;
  };
  svg.addEventListener("pointermove", point);
  svg.addEventListener("pointerdown", point);
  svg.addEventListener("pointerleave", () => {
    at.setAttribute("visibility", "hidden");
    mark("at", []);
    shown.textContent = words;
  });
}

/** Labels in an SVG without distortion: the chart is stretched, its labels are not. */
function labels(svg, heights, down, whole, left) {
  const place = () => {
    const area = svg.getBoundingClientRect();
    if (area.width === 0) return;
    const [sx, sy] = [WIDE / area.width, (HIGH + 20) / area.height];
    for (const old of svg.querySelectorAll("text")) old.remove();
    const text = (x, y, anchor, words) => {
      const made = element("text", { "text-anchor": anchor, transform: `translate(${x} ${y}) scale(${sx} ${sy})` }, words);
      svg.append(made);
    };
    for (const height of heights) text(left - 4 * sx, down(height) + 4 * sy, "end", `${rounded(height)} m`);
    for (const share of [0, 0.25, 0.5, 0.75, 1]) {
      const anchor = share === 0 ? "start" : share === 1 ? "end" : "middle";
      text(left + (WIDE - left) * share, HIGH + 14 * sy, anchor, length(whole * share));
    }
  };
  new ResizeObserver(place).observe(svg);
}
