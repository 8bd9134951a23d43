// Search for places: questions in words, or conditions.

import { complain, say } from "./message.js";
import { mark } from "./marks.js";
import { toMap, toWorld } from "./place.js";
import { ask } from "./server.js";
import { length, number, rounded, t, unit } from "./texts.js";

const get = (id) => document.getElementById(id);

/** Number of places that are found at once. */
const COUNT = 5;

// Each question: what to ask, and the amount that it needs, in a unit for people.
const QUESTIONS = {
  "highest-summit": { ask: () => ({ find: "summits", largest: "height" }) },
  "summit-above": { amount: ["height", 1000, "m"], ask: (amount) => ({ find: "summits", where: `height > ${amount}` }) },
  "largest-lake": { ask: () => ({ find: "lakes", largest: "area" }) },
  "lake-above": { amount: ["area", 50, "ha"], ask: (amount) => ({ find: "lakes", where: `area > ${amount}ha` }) },
  "widest-river": { ask: () => ({ find: "rivers", largest: "width" }) },
  "river-above": { amount: ["width", 20, "m"], ask: (amount) => ({ find: "rivers", where: `width > ${amount}` }) },
  coast: { ask: () => ({ find: "coast" }) },
  flat: {
    amount: ["area", 25, "ha"],
    ask: (amount, world) => ({ where: `slope < 3 and height > ${world.sea_level ?? -1000}`, area: amount * 10000 }),
  },
  ground: { where: true, ask: () => ({ where: get("where").value }) },
};

/** The values that say most about a place come first. */
const TOLD = ["height", "area", "width", "prominence", "level", "depth", "slope", "discharge"];

let running;

/** Starts the search. */
export function startSearch(map, world) {
  const question = get("question");
  question.replaceChildren(...Object.keys(QUESTIONS).map((name) => new Option(t(`question.${name}`), name)));
  const shape = () => {
    const { amount, where } = QUESTIONS[question.value];
    get("amount-label").hidden = !amount;
    get("where-label").hidden = !where;
    if (amount) {
      get("amount-name").textContent = `${t(`amount.${amount[0]}`)} (${amount[2]})`;
      get("amount").value = amount[1];
    }
  };
  question.addEventListener("change", shape);
  shape();
  get("search").addEventListener("submit", (event) => {
    event.preventDefault();
    search(map, world);
  });
  get("search-stop").addEventListener("click", () => running?.abort());
}

/** Puts the words of the language into the questions. */
export function renameQuestions() {
  for (const option of get("question").options) option.text = t(`question.${option.value}`);
  const { amount } = QUESTIONS[get("question").value];
  if (amount) get("amount-name").textContent = `${t(`amount.${amount[0]}`)} (${amount[2]})`;
}

async function search(map, world) {
  running?.abort();
  const mine = running = new AbortController();
  const { ask: request } = QUESTIONS[get("question").value];
  const parameters = {
    ...request(Number(get("amount").value), world), near: toWorld(map.getCenter()).join(","), within: 1000 * get("within").value, count: COUNT,
  };
  get("search-stop").hidden = false;
  get("found-none").textContent = t("searching");
  get("found").replaceChildren();
  try {
    const { places } = await ask("locate", parameters, mine.signal);
    show(map, places);
  } catch (error) {
    get("found-none").textContent = error.name === "AbortError" ? t("stopped") : "";
    complain(error);
  } finally {
    if (running === mine) get("search-stop").hidden = true;
  }
}

function show(map, places) {
  get("found-none").textContent = places.length === 0 ? t("found-none") : "";
  say(t("found", { count: places.length }));
  const marks = places.map((place, k) => [String(k + 1), toMap(place.coordinates)]);
  mark("place", marks);
  get("found").replaceChildren(...places.map((place, k) => {
    const button = document.createElement("button");
    button.type = "button";
    const order = ([name]) => (TOLD.indexOf(name) + 1) || TOLD.length + 1;
    const numbers = Object.entries(place.values).filter(([name, value]) => typeof value === "number" && name !== "id");
    const values = numbers.sort((a, b) => order(a) - order(b)).slice(0, 2);
    button.textContent = `${k + 1}. ${values.map(([name, value]) => readable(name, value)).join(", ") || t("place")}`;
    const small = document.createElement("small");
    small.textContent = `${place.coordinates.map((part) => number(part)).join(", ")} · ${t("away", { distance: length(place.distance) })}`;
    button.append(small);
    button.addEventListener("click", () => map.flyTo({ center: marks[k][1], zoom: Math.max(map.getZoom(), 12.5) }));
    const item = document.createElement("li");
    item.append(button);
    return item;
  }));
  if (marks.length > 0) map.flyTo({ center: marks[0][1], zoom: Math.max(map.getZoom(), 12) });
}

/** A value with its name and unit. */
function readable(name, value) {
  const units = { area: "m^2", drainage_area: "m^2", discharge: "m^3/s", slope: "deg" };
  const lengths = ["height", "prominence", "level", "depth", "width", "length", "elevation", "key_col"];
  const key = t(`amount.${name}`) === `amount.${name}` ? name : t(`amount.${name}`);
  if (units[name] === "m^2" && value >= 1e6) return `${key} ${number(value / 1e6, 1)} km²`;
  if (units[name] === "m^2") return `${key} ${number(value / 1e4, 1)} ha`;
  return `${key} ${rounded(value)} ${unit(units[name] ?? (lengths.includes(name) ? "m" : ""))}`.trim();
}
