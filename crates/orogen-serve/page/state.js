// What the page shows. It is kept in the address, so that a link shows the same.

const initial = {
  layer: "height", palette: "", contours: false, rivers: true, lakes: true, summits: false,
  relief3d: true, exaggeration: 1, azimuth: 315, altitude: 45, shading: 50, seed: null, set: {}, view: null,
};

export const state = { ...initial, set: {} };

const listeners = [];

/** Calls a function after each change, with the names of what changed. */
export function onChange(listener) {
  listeners.push(listener);
}

/** Changes the state. */
export function change(changes) {
  Object.assign(state, changes);
  write();
  for (const listener of listeners) listener(Object.keys(changes));
}

/** Remembers the view without telling anybody. */
export function keepView(view) {
  state.view = view;
  write();
}

/** The part of the address after `#`. */
export function fragment() {
  const parts = new URLSearchParams();
  for (const [name, start] of Object.entries(initial)) {
    const value = state[name];
    if (name === "set") {
      for (const [node, number] of Object.entries(value)) parts.append("set", `${node}=${number}`);
    } else if (name === "view") {
      if (value) parts.set("view", value.join("/"));
    } else if (value !== start) {
      parts.set(name, typeof value === "boolean" ? Number(value) : value);
    }
  }
  return parts.toString().replaceAll("%2F", "/");
}

function write() {
  const text = fragment();
  history.replaceState(null, "", text ? `#${text}` : location.pathname + location.search);
}

/** Reads the address. Values that make no sense are left out. */
export function read() {
  const parts = new URLSearchParams(location.hash.slice(1));
  for (const [name, start] of Object.entries(initial)) {
    const text = parts.get(name);
    if (text === null) continue;
    if (name === "set") {
      const pairs = parts.getAll("set").map((pair) => pair.split("=")).filter((pair) => pair.length === 2);
      state.set = Object.fromEntries(pairs);
    } else if (name === "view") {
      const view = text.split("/").map(Number);
      if (view.length === 5 && view.every(Number.isFinite) && Math.abs(view[1]) < 86) state.view = view;
    } else if (typeof start === "boolean") {
      state[name] = text === "1";
    } else if (typeof start === "number" || start === null) {
      if (Number.isFinite(Number(text))) state[name] = Number(text);
    } else {
      state[name] = text;
    }
  }
}
