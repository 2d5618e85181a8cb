// SPDX-License-Identifier: Apache-2.0
// Serves the pages, the packages and a work folder on this machine, and obeys lines of JSON on stdin with lines of JSON on stdout:
//   {"open": "three", "settings": {...}}   -> {"facts": {...}}
//   {"frame": TIME}                        -> {"ms": ...}
//   {"close": true}                        -> {}
//   {"picture": true}                      -> {"picture": base64 of float32 RGBA, row 0 on top}
// node browser.mjs BUILD CHROMIUM: BUILD has node_modules/ and work/.
import {createReadStream, existsSync, statSync} from 'node:fs';
import {createServer} from 'node:http';
import {createRequire} from 'node:module';
import path from 'node:path';
import readline from 'node:readline';

const [build, chromium] = process.argv.slice(2);
const {chromium: browsers} = createRequire(path.join(path.resolve(build), 'x.js'))('playwright-core');
const folders = {pages: path.join(import.meta.dirname, 'pages'), node_modules: path.join(build, 'node_modules'), work: path.join(build, 'work')};
const types = {'.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.json': 'application/json', '.wasm': 'application/wasm'};

function fileOf(url) {
    const [, folder, ...rest] = decodeURIComponent(new URL(url, 'http://localhost').pathname).split('/');
    if (!(folder in folders) || rest.includes('..')) return null;
    const file = path.join(folders[folder], ...rest);
    return existsSync(file) && statSync(file).isFile() ? file : null;
}

const server = createServer((request, response) => {
    const file = fileOf(request.url);
    if (file === null) {
        response.writeHead(404).end();
        return;
    }
    response.writeHead(200, {'content-type': types[path.extname(file)] || 'application/octet-stream'});
    createReadStream(file).pipe(response);
});
await new Promise(resolve => server.listen(0, '127.0.0.1', resolve));
const browser = await browsers.launch({
    executablePath: chromium, headless: true,
    args: ['--no-sandbox', '--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader', '--enable-features=Vulkan',
        '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-gpu-watchdog', '--ignore-gpu-blocklist'],
});
let page = null, faults = [];

// A page that stays open takes the cores' time.
async function close() {
    if (page !== null) await page.close();
    page = null;
    return {};
}

async function open(name, settings) {
    await close();
    page = await browser.newPage();
    page.setDefaultTimeout(0);
    faults = [];
    page.on('pageerror', error => faults.push(String(error)));
    page.on('console', message => {
        if (message.type() === 'error' || message.type() === 'warning') faults.push(message.text());
    });
    await page.goto(`http://127.0.0.1:${server.address().port}/pages/index.html`);
    await page.waitForFunction(() => window.kilolux !== undefined);
    return page.evaluate(([n, s]) => window.kilolux.open(n, s), [name, settings]);
}

async function obey(order) {
    if ('open' in order) return {facts: await open(order.open, order.settings || {}), messages: faults};
    if ('frame' in order) return {ms: await page.evaluate(t => window.kilolux.frame(t), order.frame)};
    if ('close' in order) return close();
    if ('picture' in order) return {picture: await page.evaluate(() => window.kilolux.picture()), messages: faults};
    throw new Error('no such order: ' + JSON.stringify(order));
}

for await (const line of readline.createInterface({input: process.stdin})) {
    let answer;
    try {
        answer = await obey(JSON.parse(line));
    } catch (error) {
        answer = {error: String(error), messages: faults};
    }
    process.stdout.write(JSON.stringify(answer) + '\n');
}
await browser.close();
server.close();
