// SPDX-License-Identifier: Apache-2.0
// Measures one renderer: `open` makes it, `frame` times one frame, `picture` reads the last one back.
//
// A renderer's page exports `open(canvas, scene, settings)`, which returns
//   move(lights)   sets the lights' positions: Float32Array, 3 a light [m]
//   render()       submits a frame to a float target; resolves when the device has finished it
//   read()         resolves to the frame's values: Float32Array, 4 a pixel, row 0 on top
//   facts          what a reader of the table has to know: API, caps
import {loadScene, placesAt} from './scene.js';

let renderer, scene;

async function open(page, settings) {
    scene = await loadScene('/work/scene.json');
    const canvas = document.getElementById('canvas');
    canvas.width = scene.width;
    canvas.height = scene.height;
    const made = await import(`/pages/${page}.js`);
    renderer = await made.open(canvas, scene, settings);
    return renderer.facts;
}

// Milliseconds from the first call to the end of the work on the device.
async function frame(time) {
    const start = performance.now();
    renderer.move(placesAt(scene.lights, time));
    await renderer.render();
    return performance.now() - start;
}

async function picture() {
    const values = await renderer.read();
    const bytes = new Uint8Array(values.buffer, values.byteOffset, values.byteLength);
    let text = '';
    for (let i = 0; i < bytes.length; i += 32768) {
        text += String.fromCharCode(...bytes.subarray(i, i + 32768));
    }
    return btoa(text);
}

window.kilolux = {open, frame, picture};
