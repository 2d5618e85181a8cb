// SPDX-License-Identifier: Apache-2.0
// Prints what the Khronos validator says of glTF files: "<severity> <file> <code> <pointer> <message>"
// a line, severity 0 error, 1 warning, 2 information, 3 hint.
//   node validate.js FOLDER-WITH-NODE_MODULES FILE...
const fs = require('fs');
const path = require('path');
const [folder, ...files] = process.argv.slice(2);
const validator = require(path.join(path.resolve(folder), 'node_modules', 'gltf-validator'));

async function validate(file) {
    const read = (name) => new Uint8Array(fs.readFileSync(name));
    const beside = (uri) => path.join(path.dirname(file), decodeURIComponent(uri));
    const report = await validator.validateBytes(read(file), {
        uri: path.basename(file),
        maxIssues: 100,
        externalResourceFunction: async (uri) => read(beside(uri)),
    });
    for (const m of report.issues.messages) {
        console.log(m.severity, path.basename(file), m.code, m.pointer || '-', m.message);
    }
    console.log('validated', path.basename(file), report.validatorVersion);
}

(async () => {
    for (const file of files) await validate(file);
})();
