// SPDX-License-Identifier: Apache-2.0
// Babylon.js with ClusteredLightContainer, WebGL 2: its standard material, 1 - d / range, which is
// the falloff that its clustered lights have.
import {Engine} from 'babylon/Engines/engine.js';
import {Scene} from 'babylon/scene.js';
import {TargetCamera} from 'babylon/Cameras/targetCamera.js';
import {Color3, Color4} from 'babylon/Maths/math.color.js';
import {Matrix, Quaternion, Vector3} from 'babylon/Maths/math.vector.js';
import {Mesh} from 'babylon/Meshes/mesh.js';
import {VertexData} from 'babylon/Meshes/mesh.vertexData.js';
import {StandardMaterial} from 'babylon/Materials/standardMaterial.js';
import {RenderTargetTexture} from 'babylon/Materials/Textures/renderTargetTexture.js';
import {PointLight} from 'babylon/Lights/pointLight.js';
import {ClusteredLightContainer} from 'babylon/Lights/Clustered/clusteredLightContainer.js';
import 'babylon/Engines/Extensions/engine.readTexture.js';
import 'babylon/Rendering/depthRendererSceneComponent.js';
import {flipped} from './scene.js';

const FLOAT = 1;  // Constants.TEXTURETYPE_FLOAT
// The standard material clamps light to 1, so lights are dimmed and the picture is brightened.
const DIMMED = 1 / 1024;

function meshOf(scene, world) {
    const mesh = new Mesh('scene', world);
    const data = new VertexData();
    data.positions = scene.positions;
    data.normals = scene.normals;
    data.indices = scene.indices;
    data.applyToMesh(mesh);
    mesh.alwaysSelectAsActiveMesh = true;
    const material = new StandardMaterial('matte', world);
    material.diffuseColor = new Color3(scene.albedo, scene.albedo, scene.albedo);
    material.specularColor = Color3.Black();
    material.sideOrientation = 1;  // counter-clockwise triangles face outwards
    mesh.material = material;
    return mesh;
}

function cameraOf(scene, world) {
    const {position, right, up, back, y_angle, near, far} = scene.camera;
    const camera = new TargetCamera('camera', new Vector3(...position), world);
    camera.fov = y_angle;
    camera.minZ = near;
    camera.maxZ = far;
    const axes = Matrix.FromValues(...right, 0, ...up, 0, ...back, 0, 0, 0, 0, 1);
    camera.rotationQuaternion = Quaternion.FromRotationMatrix(axes);
    return camera;
}

export async function open(canvas, scene, settings) {
    const engine = new Engine(canvas, false, {preserveDrawingBuffer: true, useHighPrecisionFloats: true});
    const world = new Scene(engine);
    world.useRightHandedSystem = true;
    world.clearColor = new Color4(0, 0, 0, 1);
    world.ambientColor = Color3.Black();
    world.skipPointerMovePicking = true;
    const mesh = meshOf(scene, world), camera = cameraOf(scene, world);
    const {count, rgb, range} = scene.lights;
    const lights = [];
    for (let i = 0; i < count; ++i) {
        const light = new PointLight(`light${i}`, Vector3.Zero(), world, true);
        light.diffuse = new Color3(...rgb.slice(3 * i, 3 * i + 3).map(c => DIMMED * c));
        light.specular = Color3.Black();
        light.range = range;
        lights.push(light);
    }
    const container = new ClusteredLightContainer('lights', lights, world);
    if (!container.isSupported) throw new Error('Babylon.js has no clustered lights here');
    const target = new RenderTargetTexture('target', {width: scene.width, height: scene.height}, world,
        {type: FLOAT, generateDepthBuffer: true, samplingMode: 1, generateMipMaps: false});
    target.activeCamera = camera;
    target.renderList = [mesh];
    target.clearColor = world.clearColor;
    camera.outputRenderTarget = target;
    await world.whenReadyAsync();
    const pixel = new Float32Array(4);
    const read = async () => target.readPixels(0, 0, null, true, false, 0, 0, scene.width, scene.height);
    // The mask is a texture with verticalTiles rows for each batch of lights, of as many lights as a float has bits. Where it is taller
    // than textures may be, the picture is black.
    const {shaderFloatPrecision, maxTextureSize} = engine.getCaps();
    const most = shaderFloatPrecision * Math.floor(maxTextureSize / container.verticalTiles);
    return {
        facts: {api: 'WebGL 2', cap: `${most} lights`, version: Engine.Version},
        move(places) {
            lights.forEach((light, i) => light.position.set(...places.subarray(3 * i, 3 * i + 3)));
        },
        async render() {
            world.render();
            await target.readPixels(0, 0, pixel, true, false, 0, 0, 1, 1);  // waits for the device
        },
        async read() {
            return flipped((await read()).map(c => c / DIMMED), scene.width, scene.height);
        },
    };
}
