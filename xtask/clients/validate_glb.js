// The Khronos validator on .glb files: node validate_glb.js MODULES FILE... prints a JSON report for each.
const path = require('path');
const fs = require('fs');
const [modules, ...files] = process.argv.slice(2);
const validator = require(path.join(modules, 'gltf-validator'));

const report = (file) =>
  validator.validateBytes(new Uint8Array(fs.readFileSync(file)), { maxIssues: 20 })
    .then((found) => ({ file, ...found.issues, info: found.info }))
    .catch((refused) => ({ file, numErrors: 1, numWarnings: 0, messages: [{ message: String(refused) }] }));

Promise.all(files.map(report)).then((reports) => console.log(JSON.stringify(reports)));
