// Shows the meshes of `orogen serve` in Cesium: node drive_cesium.mjs MODULES URL PICTURE POINTS prints heights at points, as JSON.
// POINTS are degrees, LON,LAT;LON,LAT.
import path from 'node:path';
import { open, watched } from './browser.mjs';

const [modules, url, picture, points] = process.argv.slice(2);
const PAGE = `<!doctype html><meta charset="utf-8"><title>Cesium</title><script>window.CESIUM_BASE_URL = "/cesium/";</script>
<script src="/cesium/Cesium.js"></script><link rel="stylesheet" href="/cesium/Widgets/widgets.css">
<style>html, body, #globe { margin: 0; height: 100% }</style><div id="globe"></div>`;

const browser = await open();
const { page, wrong, close } = await watched(browser, [800, 600], new URL(url).host);
// The page and the files of Cesium, in place of answers of the server.
const folder = path.join(modules, 'cesium/Build/Cesium');
await page.route('**/cesium/**', (route) => {
  const name = decodeURIComponent(new URL(route.request().url()).pathname).replace(/^.*?\/cesium\//, '');
  return route.fulfill(name === '' ? { contentType: 'text/html', body: PAGE } : { path: path.join(folder, name) });
});
await page.goto(new URL('/cesium/', url).href);
const found = await page.evaluate(async ([url, points]) => {
  const terrainProvider = await Cesium.CesiumTerrainProvider.fromUrl(`${url}mesh`, { requestVertexNormals: true });
  const viewer = new Cesium.Viewer('globe', {
    terrainProvider, baseLayer: false, baseLayerPicker: false, geocoder: false, animation: false, timeline: false,
    navigationInstructionsInitiallyVisible: false,
  });
  viewer.scene.globe.enableLighting = true;
  viewer.scene.globe.baseColor = Cesium.Color.BEIGE;
  const places = points.map(([east, north]) => Cesium.Cartographic.fromDegrees(east, north));
  await Cesium.sampleTerrainMostDetailed(terrainProvider, places);
  // From the south, in the morning.
  viewer.clock.currentTime = Cesium.JulianDate.fromIso8601('2026-03-21T08:00:00Z');
  viewer.camera.setView({
    destination: Cesium.Cartesian3.fromDegrees(0.07, -0.19, 5000),
    orientation: { heading: 0, pitch: Cesium.Math.toRadians(-22), roll: 0 },
  });
  // The list of tiles is empty before the first picture, too.
  await new Promise((resolve) => {
    let isFirst = true;
    viewer.scene.globe.tileLoadProgressEvent.addEventListener((left) => {
      if (left === 0 && !isFirst) resolve();
      isFirst = false;
    });
  });
  return { heights: places.map((place) => place.height), normals: terrainProvider.hasVertexNormals };
}, [url, points.split(';').map((point) => point.split(',').map(Number))]);
await page.screenshot({ path: picture, timeout: 240_000 });
await close();
await browser.close();
console.log(JSON.stringify({ ...found, wrong }));
