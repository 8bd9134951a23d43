// The style of the map: what is drawn, from the state.

import { address } from "./server.js";
import { state } from "./state.js";

const dark = matchMedia("(prefers-color-scheme: dark)");

/** The color where there is no world. */
const outside = () => (dark.matches ? "#10161a" : "#e4eaed");

/** Calls a function when the colors of the browser change. */
export function onScheme(listener) {
  dark.addEventListener("change", listener);
}

/** The style. `stops`: heights and their colors; `marks`: what the tools draw. */
export function style(world, stops, marks) {
  const { bounds } = world.web;
  // Heights are colored here, so that palette and sun need no tiles; until the colors are known nothing is drawn.
  const isHeights = state.layer === "height";
  const heights = (surface) => ({
    type: "raster-dem", url: address("tilejson/terrarium.json", { surface, v: version(world) }), encoding: "terrarium", tileSize: 256,
  });
  const colors = { v: version(world), ...(state.palette ? { palette: state.palette } : {}) };
  const sources = {
    mask: { type: "geojson", data: mask(bounds) },
    marks: { type: "geojson", data: marks },
  };
  if (world.has_heights) {
    // Ground for colors; the surface, with a flat sea, twice: the map in 3D needs one of its own.
    Object.assign(sources, { ground: heights("ground"), shade: heights("water"), surface: heights("water") });
  }
  if (!isHeights) {
    sources.layer = { type: "raster", url: address(`tilejson/${encodeURIComponent(state.layer)}.json`, colors), tileSize: 256 };
  }
  const lines = ["contours", "rivers", "lakes", "summits"].filter((name) => state[name]);
  if (world.has_heights && lines.length > 0) {
    sources.lines = { type: "vector", url: address("tilejson/vector.json", { v: version(world) }) };
  }
  return {
    version: 8,
    sources,
    sky: {
      "sky-color": dark.matches ? "#1b2c3d" : "#8fbce0", "horizon-color": dark.matches ? "#10161a" : "#e9f0f4", "fog-color": outside(),
      "sky-horizon-blend": 0.7, "horizon-fog-blend": 0.7, "fog-ground-blend": 0.9,
    },
    layers: [
      { id: "background", type: "background", paint: { "background-color": outside() } },
      ...(isHeights ? (stops.length > 1 ? ground(stops) : []) : [{ id: "layer", type: "raster", source: "layer", paint: { "raster-fade-duration": 100 } }]),
      ...(bounds ? [{ id: "mask", type: "fill", source: "mask", paint: { "fill-color": outside(), "fill-antialias": false } }] : []),
      ...(sources.lines ? lines.flatMap((name) => DRAWN[name]()) : []),
      ...drawnMarks(),
    ],
    ...(state.relief3d && world.has_heights ? { terrain: { source: "surface", exaggeration: state.exaggeration } } : {}),
  };
}

/** Changes when the browser must not use what it has. */
function version(world) {
  return world.version;
}

/** The world outside its bounds. */
function mask(bounds) {
  if (!bounds) return { type: "FeatureCollection", features: [] };
  const [west, south, east, north] = bounds;
  const ring = (w, s, e, n) => [[w, s], [e, s], [e, n], [w, n], [w, s]];
  const hole = ring(west, south, east, north).reverse();
  return { type: "Feature", properties: {}, geometry: { type: "Polygon", coordinates: [ring(-180, -85, 180, 85), hole] } };
}

/**
 * The ground: colors of heights and shading, with three lights like the maps of the program: ridges parallel to a single
 * light would not be seen. MapLibre keeps the color of ground that meets the light at 30 degrees.
 */
function ground(stops) {
  const ramp = ["interpolate", ["linear"], ["elevation"], ...stops.flat()];
  const each = (of) => [0, -50, 50].map(of);
  return [
    { id: "relief", type: "color-relief", source: "ground", paint: { "color-relief-color": ramp } },
    {
      id: "shade", type: "hillshade", source: "shade",
      paint: {
        "hillshade-method": "multidirectional", "hillshade-illumination-anchor": "map",
        "hillshade-illumination-direction": each((turn) => (state.azimuth + turn + 360) % 360),
        "hillshade-illumination-altitude": each((turn) => (turn ? 0.67 : 0.75) * state.altitude),
        "hillshade-exaggeration": 0.0042 * state.shading,
        "hillshade-shadow-color": each((turn) => (turn ? "#14203480" : "#142034")),
        "hillshade-highlight-color": each((turn) => (turn ? "#fff8e840" : "#fff8e8a0")),
      },
    },
  ];
}

const WATER = "#3f7fb5";
const halo = { "text-halo-color": "#fffc", "text-halo-width": 1.4 };

const DRAWN = {
  contours: () => [
    {
      id: "contours", type: "line", source: "lines", "source-layer": "contours",
      paint: { "line-color": "#5b4224", "line-opacity": ["case", ["get", "index"], 0.75, 0.45], "line-width": ["case", ["get", "index"], 1.2, 0.7] },
    },
    {
      id: "contour-heights", type: "symbol", source: "lines", "source-layer": "contours", filter: ["get", "index"],
      layout: { "symbol-placement": "line", "symbol-spacing": 350, "text-field": ["to-string", ["get", "elevation"]], "text-size": 11, "text-max-angle": 30 },
      paint: { "text-color": "#5b4224", ...halo },
    },
  ],
  rivers: () => [{
    id: "rivers", type: "line", source: "lines", "source-layer": "rivers", layout: { "line-cap": "round", "line-join": "round" },
    paint: { "line-color": WATER, "line-width": ["interpolate", ["linear"], ["coalesce", ["get", "strahler"], 1], 1, 0.8, 3, 1.6, 6, 3.5] },
  }],
  lakes: () => [
    { id: "lakes", type: "fill", source: "lines", "source-layer": "lakes", paint: { "fill-color": "#7db4dc" } },
    { id: "shores", type: "line", source: "lines", "source-layer": "lakes", paint: { "line-color": WATER, "line-width": 0.8 } },
  ],
  summits: () => [{
    id: "summits", type: "symbol", source: "lines", "source-layer": "summits",
    layout: {
      "text-field": ["format", "▲", { "font-scale": 0.9 }, "\n", {}, ["to-string", ["round", ["get", "height"]]], {}],
      "text-size": 12, "text-line-height": 1, "symbol-sort-key": ["-", 0, ["coalesce", ["get", "prominence"], ["get", "height"]]],
    },
    paint: { "text-color": "#2d2418", ...halo },
  }],
};

/** What the tools draw: the line of a profile and places that were found. */
function drawnMarks() {
  const of = (kind) => ["==", ["get", "kind"], kind];
  return [
    { id: "line-halo", type: "line", source: "marks", filter: of("line"), paint: { "line-color": "#fff", "line-width": 5 } },
    { id: "line", type: "line", source: "marks", filter: of("line"), paint: { "line-color": "#b3261e", "line-width": 2.5 } },
    {
      id: "points", type: "circle", source: "marks", filter: ["in", ["get", "kind"], ["literal", ["corner", "at", "place"]]],
      paint: {
        "circle-radius": ["match", ["get", "kind"], "place", 7, 5], "circle-color": ["match", ["get", "kind"], "at", "#fff", "#b3261e"],
        "circle-stroke-color": ["match", ["get", "kind"], "at", "#b3261e", "#fff"], "circle-stroke-width": 2,
      },
    },
    {
      id: "names", type: "symbol", source: "marks", filter: of("place"),
      layout: { "text-field": ["get", "name"], "text-size": 13, "text-offset": [0, -1.2], "text-anchor": "bottom", "text-allow-overlap": true },
      paint: { "text-color": "#7a1712", ...halo },
    },
  ];
}
