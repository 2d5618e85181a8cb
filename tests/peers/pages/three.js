// SPDX-License-Identifier: Apache-2.0
// three.js with ClusteredLighting, WebGPU: Lambert, inverse square, a squared window.
import * as THREE from 'three/webgpu';
import {ClusteredLighting} from 'three/addons/lighting/ClusteredLighting.js';

function geometryOf(scene) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(scene.positions, 3));
    geometry.setAttribute('normal', new THREE.BufferAttribute(scene.normals, 3));
    geometry.setIndex(new THREE.BufferAttribute(scene.indices, 1));
    return geometry;
}

function cameraOf(scene) {
    const {position, right, up, back, y_angle, near, far} = scene.camera;
    const degrees = y_angle * 180 / Math.PI;
    const camera = new THREE.PerspectiveCamera(degrees, scene.width / scene.height, near, far);
    const m = new THREE.Matrix4().makeBasis(
        new THREE.Vector3(...right), new THREE.Vector3(...up), new THREE.Vector3(...back));
    camera.quaternion.setFromRotationMatrix(m);
    camera.position.set(...position);
    return camera;
}

export async function open(canvas, scene, settings) {
    const renderer = new THREE.WebGPURenderer({canvas, antialias: false});
    await renderer.init();
    if (!renderer.backend.isWebGPUBackend) throw new Error('three.js has no WebGPU here');
    const cap = settings.cap || 64;
    const {count, rgb, range} = scene.lights;
    renderer.lighting = new ClusteredLighting(Math.max(count, 1), 32, 24, cap);
    renderer.toneMapping = THREE.NoToneMapping;
    renderer.setSize(scene.width, scene.height, false);
    const target = new THREE.RenderTarget(scene.width, scene.height,
        {type: THREE.FloatType, colorSpace: THREE.LinearSRGBColorSpace, samples: 0});
    renderer.setRenderTarget(target);
    renderer.setClearColor(0, 1);
    const world = new THREE.Scene();
    const material = new THREE.MeshLambertNodeMaterial();
    material.color.setRGB(scene.albedo, scene.albedo, scene.albedo, THREE.LinearSRGBColorSpace);
    const mesh = new THREE.Mesh(geometryOf(scene), material);
    mesh.frustumCulled = false;
    world.add(mesh);
    const lights = [];
    for (let i = 0; i < count; ++i) {
        const light = new THREE.PointLight(0xffffff, 1, range, 2);
        light.color.setRGB(...rgb.slice(3 * i, 3 * i + 3), THREE.LinearSRGBColorSpace);
        world.add(light);
        lights.push(light);
    }
    const camera = cameraOf(scene);
    return {
        facts: {api: 'WebGPU', cap: `${cap} a cluster`, version: THREE.REVISION},
        move(places) {
            lights.forEach((light, i) => light.position.fromArray(places, 3 * i));
        },
        async render() {
            renderer.render(world, camera);
            await renderer.backend.device.queue.onSubmittedWorkDone();
        },
        async read() {
            return renderer.readRenderTargetPixelsAsync(target, 0, 0, scene.width, scene.height);
        },
    };
}
