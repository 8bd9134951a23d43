// The seed and the numbers of the recipe: sliders that show a variant of the world.

import { complain } from "./message.js";
import { ask } from "./server.js";
import { change, onChange, state } from "./state.js";
import { number, t, unit } from "./texts.js";

const get = (id) => document.getElementById(id);

/** Steps of a slider. */
const STEPS = 200;

let recipe;

/** Fills the section; a world without a recipe has none. */
export async function startParameters() {
  try {
    recipe = await ask("recipe.json", {}, undefined, true);
  } catch (error) {
    complain(error);
    return;
  }
  get("variant").hidden = false;
  get("seed").addEventListener("change", () => reseed(Number(get("seed").value)));
  get("another").addEventListener("click", () => reseed(Math.floor(Math.random() * 1e6)));
  get("original").addEventListener("click", () => {
    change({ seed: null, set: {} });
    showParameters();
  });
  onChange((names) => names.includes("seed") && fillSeed());
  showParameters();
}

function reseed(seed) {
  if (Number.isInteger(seed) && seed >= 0) change({ seed: seed === recipe.seed ? null : seed });
}

function fillSeed() {
  get("seed").value = state.seed ?? recipe.seed;
}

/** Shows the sliders, in the language of the page. */
export function showParameters() {
  if (!recipe) return;
  fillSeed();
  const box = get("parameters");
  box.replaceChildren(...recipe.parameters.map((parameter) => slider(parameter, parameter.set)));
  const nodes = Map.groupBy(recipe.nodes.filter(({ formula }) => !formula), ({ node }) => node);
  if (nodes.size === 0) return;
  const all = document.createElement("details");
  const title = document.createElement("summary");
  title.textContent = t("all-numbers");
  all.append(title);
  for (const [node, numbers] of nodes) {
    const name = document.createElement("h3");
    name.textContent = `${node} (${numbers[0].op})`;
    all.append(name, ...numbers.map((one) => slider(one, one.parameter)));
  }
  box.append(all);
}

/** A slider for a number. Its ends are those of the parameter where they are near, otherwise a quarter and four times the value. */
function slider(parameter, name) {
  const { set, value, range, whole, doc } = parameter;
  const around = value === 0 ? [-1, 1] : [Math.min(value / 4, value * 4), Math.max(value / 4, value * 4)];
  const low = Math.max(range[0] ?? -Infinity, range[0] !== null && range[1] !== null ? range[0] : around[0]);
  const high = Math.min(range[1] ?? Infinity, range[0] !== null && range[1] !== null ? range[1] : around[1]);
  // A wide range of positive numbers has equal steps in its logarithm.
  const isLog = low > 0 && high / low > 10 && !whole;
  const at = (share) => (isLog ? low * (high / low) ** share : low + (high - low) * share);
  const tidy = (number) => (whole ? Math.round(number) : Number(number.toPrecision(4)));
  const share = (number) => (isLog ? Math.log(number / low) / Math.log(high / low) : (number - low) / (high - low));

  const label = document.createElement("label");
  label.title = doc ?? "";
  const words = document.createElement("span");
  words.textContent = name;
  const input = Object.assign(document.createElement("input"), { type: "range", min: 0, max: STEPS, step: 1 });
  const output = document.createElement("output");
  input.value = Math.round(STEPS * share(Number(state.set[set] ?? value)));
  const chosen = () => tidy(at(input.value / STEPS));
  const show = (now) => {
    output.textContent = `${number(now, 4)} ${unit(parameter.unit ?? "")}`.trim();
    input.setAttribute("aria-valuetext", output.textContent);
  };
  show(Number(state.set[set] ?? value));
  input.addEventListener("input", () => show(chosen()));
  input.addEventListener("change", () => {
    const next = { ...state.set, [set]: chosen() };
    if (next[set] === value) delete next[set];
    change({ set: next });
  });
  label.append(words, input, output);
  return label;
}
