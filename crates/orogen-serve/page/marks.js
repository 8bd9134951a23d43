// What the tools draw on the map.

const parts = { line: [], place: [], at: [] };
let put = () => {};

/** Sets the function that shows the marks. */
export function onMarks(show) {
  put = show;
}

/** Replaces the marks of a tool: `line` (with corners), `place` or `at`. Each is `[name, position]`, in degrees. */
export function mark(kind, marks) {
  parts[kind] = marks;
  put(collection());
}

/** All marks, as GeoJSON. */
export function collection() {
  const point = (kind, [name, position]) => ({ type: "Feature", properties: { kind, name }, geometry: { type: "Point", coordinates: position } });
  const corners = parts.line.map(([, position]) => position);
  const lines = corners.length > 1
    ? [{ type: "Feature", properties: { kind: "line" }, geometry: { type: "LineString", coordinates: corners } }]
    : [];
  const points = [
    ...parts.line.map((corner) => point("corner", corner)),
    ...parts.place.map((place) => point("place", place)),
    ...parts.at.map((at) => point("at", at)),
  ];
  return { type: "FeatureCollection", features: [...lines, ...points] };
}
