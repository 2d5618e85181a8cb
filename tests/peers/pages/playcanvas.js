// SPDX-License-Identifier: Apache-2.0
// PlayCanvas with clustered lighting, WebGL 2: Lambert without 1 / pi, 16 / (d^2 + 1), a squared window.
import {flipped} from './scene.js';

await new Promise((resolve, reject) => {
    const script = document.createElement('script');
    script.src = '/node_modules/playcanvas/build/playcanvas.js';
    script.onload = resolve;
    script.onerror = reject;
    document.head.append(script);
});
const pc = window.pc;

function meshOf(scene, device) {
    const mesh = new pc.Mesh(device);
    mesh.setPositions(scene.positions);
    mesh.setNormals(scene.normals);
    mesh.setIndices(scene.indices);
    mesh.update();
    const material = new pc.StandardMaterial();
    material.diffuse = new pc.Color(1, 1, 1);
    material.specular = new pc.Color(0, 0, 0);
    material.useFog = material.useSkybox = material.useTonemap = false;
    material.update();
    return new pc.MeshInstance(mesh, material);
}

function cameraOf(scene, target) {
    const {position, right, up, back, y_angle, near, far} = scene.camera;
    const entity = new pc.Entity('camera');
    entity.addComponent('camera', {
        fov: y_angle * 180 / Math.PI, nearClip: near, farClip: far, clearColor: new pc.Color(0, 0, 0, 1),
        renderTarget: target, toneMapping: pc.TONEMAP_NONE, gammaCorrection: pc.GAMMA_NONE,
    });
    const m = new pc.Mat4().set([...right, 0, ...up, 0, ...back, 0, 0, 0, 0, 1]);
    entity.setPosition(...position);
    entity.setRotation(new pc.Quat().setFromMat4(m));
    return entity;
}

// A light's colour is decoded from sRGB, its intensity is not.
function setIntensity(light, rgb) {
    const most = Math.max(...rgb, 1e-9), scale = Math.max(most, 1);
    light.color = new pc.Color(...rgb.map(c => c / scale)).gamma();
    light.intensity = scale;
}

export async function open(canvas, scene, settings) {
    const device = await pc.createGraphicsDevice(canvas, {deviceTypes: [pc.DEVICETYPE_WEBGL2], antialias: false});
    const options = new pc.AppOptions();
    options.graphicsDevice = device;
    options.componentSystems = [pc.RenderComponentSystem, pc.CameraComponentSystem, pc.LightComponentSystem];
    const app = new pc.AppBase(canvas);
    app.init(options);
    app.autoRender = false;
    app.scene.clusteredLightingEnabled = true;
    app.scene.ambientLight = new pc.Color(0, 0, 0);
    const lighting = app.scene.lighting, {count, rgb, range} = scene.lights;
    lighting.maxLights = Math.max(count, 1);
    lighting.maxLightsPerCell = settings.cap || 255;
    lighting.shadowsEnabled = lighting.cookiesEnabled = false;
    const colour = new pc.Texture(device, {
        width: scene.width, height: scene.height, format: pc.PIXELFORMAT_RGBA32F, mipmaps: false,
        minFilter: pc.FILTER_NEAREST, magFilter: pc.FILTER_NEAREST,
    });
    const target = new pc.RenderTarget({colorBuffer: colour, depth: true, samples: 1});
    app.root.addChild(cameraOf(scene, target));
    const entity = new pc.Entity('scene');
    entity.addComponent('render', {meshInstances: [meshOf(scene, device)]});
    app.root.addChild(entity);
    const lights = [];
    for (let i = 0; i < count; ++i) {
        const light = new pc.Entity(`light${i}`);
        light.addComponent('light', {type: 'omni', range, castShadows: false, falloffMode: pc.LIGHTFALLOFF_INVERSESQUARED});
        setIntensity(light.light, rgb.slice(3 * i, 3 * i + 3));
        app.root.addChild(light);
        lights.push(light);
    }
    app.start();
    const read = async (width, height) => colour.read(0, 0, width, height, {renderTarget: target, immediate: true});
    return {
        facts: {api: 'WebGL 2', cap: `${lighting.maxLightsPerCell} a cell, ${lighting.maxLights} lights`, version: pc.version},
        move(places) {
            lights.forEach((light, i) => light.setPosition(...places.subarray(3 * i, 3 * i + 3)));
        },
        async render() {
            app.render();
            await read(1, 1);  // waits for the device
        },
        async read() {
            return flipped(await read(scene.width, scene.height), scene.width, scene.height);
        },
    };
}
