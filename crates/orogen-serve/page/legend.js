// The colors of the shown layer.

import { declared, rounded, unit } from "./texts.js";

const box = document.getElementById("legend");

/** Shows colors: a bar with its ends, or a list of classes. */
export function showLegend(colors) {
  box.replaceChildren();
  if (colors.classes.length > 0) {
    for (const { name, color } of colors.classes) {
      const row = document.createElement("div");
      row.className = "class";
      const square = document.createElement("i");
      square.style.background = color;
      row.append(square, declared(`class.${name}`, name));
      box.append(row);
    }
    return;
  }
  if (colors.stops.length < 2) return;
  const bar = document.createElement("div");
  bar.className = "bar";
  const step = 100 / (colors.stops.length - 1);
  bar.style.background = `linear-gradient(to right, ${colors.stops.map(([, color], k) => `${color} ${k * step}%`).join(", ")})`;
  const ends = document.createElement("div");
  ends.className = "ends";
  const middle = colors.stops[Math.floor(colors.stops.length / 2)];
  for (const [value] of [colors.stops[0], middle, colors.stops.at(-1)]) {
    const end = document.createElement("span");
    end.textContent = `${rounded(value)} ${unit(colors.unit)}`;
    ends.append(end);
  }
  box.append(bar, ends);
}
