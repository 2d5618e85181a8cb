// SPDX-License-Identifier: Apache-2.0
// The scene as arrays, and the closed form of its lights' places: see ../scene.py.

export async function loadScene(url) {
    const scene = await (await fetch(url)).json();
    const bytes = await (await fetch(new URL(scene.arrays, new URL(url, location)))).arrayBuffer();
    let at = 0;
    const take = (Type, count) => {
        const array = new Type(bytes, at, count);
        at += array.byteLength;
        return array;
    };
    scene.positions = take(Float32Array, 3 * scene.vertices);
    scene.normals = take(Float32Array, 3 * scene.vertices);
    scene.indices = take(Uint32Array, scene.indices);
    scene.lights.places = new Float32Array(3 * scene.lights.count);
    return scene;
}

// Each coordinate goes to and fro between the ends of the box: turns = phase + rate * time.
export function placesAt(lights, time) {
    const {low, high, phase, rate, places} = lights;
    for (let i = 0; i < places.length; ++i) {
        let turns = phase[i] + rate[i] * time;
        turns -= Math.floor(turns);
        const share = turns < 0.5 ? 2 * turns : 2 - 2 * turns;
        places[i] = low[i % 3] + share * (high[i % 3] - low[i % 3]);
    }
    return places;
}

// The last row of a WebGL picture is on top.
export function flipped(values, width, height) {
    const out = new Float32Array(values.length);
    for (let y = 0; y < height; ++y) {
        out.set(values.subarray(4 * width * y, 4 * width * (y + 1)), 4 * width * (height - 1 - y));
    }
    return out;
}
