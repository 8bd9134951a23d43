// A decoder of quantized-mesh on tiles over HTTP: node read_mesh.mjs MODULES ADDRESS... prints the vertices of each as JSON.
import { createRequire } from 'node:module';
import path from 'node:path';

const [modules, ...addresses] = process.argv.slice(2);
const { default: decode } = createRequire(import.meta.url)(path.join(modules, '@here/quantized-mesh-decoder'));

const read = async (address) => {
  const accept = 'application/vnd.quantized-mesh;extensions=octvertexnormals';
  const answer = await fetch(address, { headers: { accept } });
  const found = decode(await answer.arrayBuffer());
  const { minHeight, maxHeight } = found.header;
  const count = found.vertexData.length / 3;
  const part = (axis) => Array.from(found.vertexData.slice(axis * count, (axis + 1) * count));
  return {
    u: part(0),
    v: part(1),
    heights: part(2).map((height) => minHeight + (height / 32767) * (maxHeight - minHeight)),
    triangles: Array.from(found.triangleIndices),
    edges: ['west', 'south', 'east', 'north'].map((name) => Array.from(found[`${name}Indices`])),
    normals: found.extensions.vertexNormals.length,
  };
};

console.log(JSON.stringify(await Promise.all(addresses.map(read))));
