// Download of the visible part as a file of heights or a mesh, and of the picture.

import { visible } from "./place.js";
import { address } from "./server.js";
import { onChange, state } from "./state.js";
import { declared, length, number, t } from "./texts.js";

const get = (id) => document.getElementById(id);

/** Samples along the longer side. */
const SIDES = [256, 512, 1024, 2048, 4096, 8192];

/** Starts the downloads. */
export function startDownload(map, world) {
  const format = get("format");
  format.replaceChildren(...world.formats.map(({ name, about }) => {
    const option = new Option(`.${name}: ${declared(`format.${name}`, about)}`, name);
    option.title = about;
    return option;
  }));
  format.value = "tif";
  get("samples").replaceChildren(
    ...SIDES.map((side) => new Option(number(side), side)), new Option(t("own-cell", { cell: number(world.cell, 3) }), "own"),
  );
  get("samples").value = "1024";
  const update = () => offer(map, world);
  format.addEventListener("change", update);
  get("samples").addEventListener("change", update);
  map.on("moveend", update);
  onChange(update);
  get("picture").addEventListener("click", () => picture(map, world));
  update();
}

/** Puts the words of the language into the lists. */
export function renameFormats(world) {
  for (const option of get("format").options) {
    const { about } = world.formats.find(({ name }) => name === option.value);
    option.text = `.${option.value}: ${declared(`format.${option.value}`, about)}`;
  }
  get("samples").options[SIDES.length].text = t("own-cell", { cell: number(world.cell, 3) });
}

/** Sets the address of the download. */
function offer(map, world) {
  const link = get("download");
  const [west, south, east, north] = visible(map);
  const [wide, high] = [east - west, north - south];
  // Coordinates of a geographic system are degrees.
  const metres = (along, axis) => along / Math.abs(world.web.per_metre[axis]);
  const longer = Math.max(metres(wide, 0), metres(high, 1));
  const cell = get("samples").value === "own" ? world.cell : longer / Number(get("samples").value);
  const count = [metres(wide, 0), metres(high, 1)].map((side) => Math.max(1, Math.round(side / cell)));
  const fits = wide > 0 && high > 0;
  const isSmall = count[0] * count[1] <= world.max_samples;
  link.toggleAttribute("aria-disabled", !(fits && isSmall));
  if (!fits || !isSmall) {
    link.removeAttribute("href");
    link.setAttribute("aria-disabled", "true");
    get("download-size").textContent = fits ? t("download-large", { count: number(count[0] * count[1]), most: number(world.max_samples) }) : t("outside");
    return;
  }
  link.removeAttribute("aria-disabled");
  const name = get("format").value;
  link.href = address(`window.${name}`, { bbox: [west, south, east, north].join(","), cell, ...(state.layer === "height" ? {} : { layer: state.layer }) });
  link.download = `${world.name}.${name}`;
  get("download-size").textContent = t("download-size", { width: number(count[0]), height: number(count[1]), cell: length(cell) });
}

/** Downloads what the map shows. */
function picture(map, world) {
  map.once("render", () => {
    map.getCanvas().toBlob((blob) => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(blob);
      link.download = `${world.name}-map.png`;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    });
  });
  map.triggerRepaint();
}
