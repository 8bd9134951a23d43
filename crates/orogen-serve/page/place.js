// Positions: on the map in degrees, in requests in coordinates of the world.

const RADIUS = 6378137;

/** The length of the equator of Web Mercator, in metres. */
export const EQUATOR = 2 * Math.PI * RADIUS;

let web;

/** Sets the place of the world on the map. */
export function setPlace(place) {
  web = place;
}

/** Coordinates of the world at a position of the map. */
export function toWorld({ lng, lat }) {
  const east = RADIUS * lng * Math.PI / 180;
  const north = RADIUS * Math.asinh(Math.tan(lat * Math.PI / 180));
  return [web.origin[0] + east * web.per_metre[0], web.origin[1] + north * web.per_metre[1]];
}

/** The position on the map, in degrees, of coordinates of the world. */
export function toMap([x, y]) {
  const east = (x - web.origin[0]) / web.per_metre[0];
  const north = (y - web.origin[1]) / web.per_metre[1];
  return [east / RADIUS * 180 / Math.PI, Math.atan(Math.sinh(north / RADIUS)) * 180 / Math.PI];
}

/** West, south, east and north of the visible part, in coordinates of the world. */
export function visible(map) {
  const box = map.getBounds();
  let [west, south] = toWorld(box.getSouthWest());
  let [east, north] = toWorld(box.getNorthEast());
  if (web.bounds) {
    const [left, bottom] = toWorld({ lng: web.bounds[0], lat: web.bounds[1] });
    const [right, top] = toWorld({ lng: web.bounds[2], lat: web.bounds[3] });
    west = Math.max(west, left);
    south = Math.max(south, bottom);
    east = Math.min(east, right);
    north = Math.min(north, top);
  }
  return [west, south, east, north];
}
