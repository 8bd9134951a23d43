// The texts of the page, in English and Chinese.

const LANGUAGES = ["en", "zh-CN"];

let texts = {};
let english = {};

export let language = "en";

/** Loads a language; by default that of the address, of the last visit or of the browser. */
export async function load(chosen) {
  const asked = chosen ?? new URLSearchParams(location.search).get("lang") ?? kept() ?? navigator.language;
  language = asked.startsWith("zh") ? "zh-CN" : "en";
  const read = async (name) => (await fetch(new URL(`./${name}.json`, import.meta.url))).json();
  [english, texts] = await Promise.all([read("en"), read(language)]);
  document.documentElement.lang = language;
  if (chosen) {
    try {
      localStorage.setItem("language", language);
    } catch {
      // Without storage the choice lasts as long as the page.
    }
  }
}

function kept() {
  try {
    return localStorage.getItem("language");
  } catch {
    return null;
  }
}

/** The other language. */
export function other() {
  return LANGUAGES.find((name) => name !== language);
}

/** A text, with values in place of its `{names}`. */
export function t(key, values = {}) {
  const text = texts[key] ?? english[key] ?? key;
  return text.replace(/\{(\w+)\}/g, (all, name) => values[name] ?? all);
}

/** A text of what the program declares: that of the language, otherwise the program's own. */
export function declared(key, own) {
  return texts[key] ?? own;
}

/** Puts the texts into the page. */
export function apply() {
  for (const element of document.querySelectorAll("[data-text]")) element.textContent = t(element.dataset.text);
  for (const element of document.querySelectorAll("[data-label]")) element.setAttribute("aria-label", t(element.dataset.label));
  for (const element of document.querySelectorAll("[data-title]")) {
    element.title = t(element.dataset.title);
    element.setAttribute("aria-label", t(element.dataset.title));
  }
}

/** A number with at most this many decimals. */
export function number(value, decimals = 0) {
  return new Intl.NumberFormat(language, { maximumFractionDigits: decimals }).format(value);
}

/** A number with a few significant digits. */
export function rounded(value) {
  const size = Math.abs(value);
  return number(value, size >= 100 || size === 0 ? 0 : size >= 1 ? 1 : 3);
}

/** A length in metres or kilometres. */
export function length(metres) {
  return Math.abs(metres) < 10000 ? `${rounded(metres)} m` : `${number(metres / 1000, 1)} km`;
}

/** A unit as people write it. */
export function unit(text) {
  return { "m^2": "m²", deg: "°", "m^3/s": "m³/s" }[text] ?? text;
}
