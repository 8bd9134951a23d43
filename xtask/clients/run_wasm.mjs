// Runs the `main` of a WebAssembly module that imports nothing: node run_wasm.mjs MODULE. Its exit code is that of the module; a trap is 254.
import { readFile } from 'node:fs/promises'
import { argv, exit } from 'node:process'

const { instance } = await WebAssembly.instantiate(await readFile(argv[2]), {})
try {
  exit(instance.exports.main(0, 0))
} catch (trap) {
  console.error(trap)
  exit(254)
}
