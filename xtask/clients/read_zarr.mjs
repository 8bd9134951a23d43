// zarrita on a Zarr store over HTTP: node read_zarr.mjs MODULES STORE ARRAY ROW COLUMN SIDE prints a part of the array as JSON.
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const [modules, address, name, ...numbers] = process.argv.slice(2);
const [row, column, side] = numbers.map(Number);
const zarr = await import(pathToFileURL(path.join(modules, 'zarrita/dist/src/index.js')));

const root = await zarr.open.v3(new zarr.FetchStore(address), { kind: 'group' });
const array = await zarr.open.v3(root.resolve(name), { kind: 'array' });
const part = await zarr.get(array, [zarr.slice(row, row + side), zarr.slice(column, column + side)]);
console.log(JSON.stringify({ attributes: array.attrs, shape: array.shape, part: Array.from(part.data) }));
