# SPDX-License-Identifier: Apache-2.0
"""A scene for all renderers: one mesh of one matte material, a camera, lights that drift.

The scene is written by `kilolux export`. Its triangles become one mesh in world space, as .glb for Kilolux and as
arrays for the pages, so that loaders, textures and draw calls do not differ."""
from __future__ import annotations

import importlib.util
import json
import math
import pathlib
import struct
import subprocess

import numpy as np

ALBEDO = 0.5
KINDS = {5121: "<u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
MAX_SPEED, MIN_CROSSING = 1.2, 8.0  # [m/s], [s]: host/scene/lights/light_generator.cpp
RATE_STREAM = 3  # kernels/shared/lights/light_drift.h

_TEXTS = pathlib.Path(__file__).resolve().parents[2] / "present/commands/benchmark/text"
_spec = importlib.util.spec_from_file_location("million_lights", _TEXTS / "million_lights.py")
formula = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(formula)


class Glb:
    """A .glb file as kilolux writes it: no sparse accessors, one buffer."""

    def __init__(self, file: pathlib.Path):
        data = file.read_bytes()
        size = struct.unpack_from("<I", data, 12)[0]
        self.json = json.loads(data[20:20 + size])
        self.bytes = data[28 + size:]

    def array(self, accessor: int) -> np.ndarray:
        a = self.json["accessors"][accessor]
        view = self.json["bufferViews"][a["bufferView"]]
        kind, width = np.dtype(KINDS[a["componentType"]]), WIDTHS[a["type"]]
        begin = view.get("byteOffset", 0) + a.get("byteOffset", 0)
        strides = (view.get("byteStride", kind.itemsize * width), kind.itemsize)
        return np.ndarray((a["count"], width), kind, self.bytes, begin, strides)

    def placed(self, nodes=None, parent=np.eye(4)):
        """Pairs (node, world_from_node) of the scene."""
        for index in self.json["scenes"][0]["nodes"] if nodes is None else nodes:
            node = self.json["nodes"][index]
            here = parent @ np.array(node.get("matrix", np.eye(4).ravel())).reshape(4, 4).T
            if "translation" in node:
                here[:3, 3] += here[:3, :3] @ np.array(node["translation"])
            yield node, here
            yield from self.placed(node.get("children", []), here)


def _merged(glb: Glb):
    positions, normals, indices, count = [], [], [], 0
    for node, world in glb.placed():
        if "mesh" not in node:
            continue
        axes = world[:3, :3]
        for part in glb.json["meshes"][node["mesh"]]["primitives"]:
            p = glb.array(part["attributes"]["POSITION"]) @ axes.T + world[:3, 3]
            n = glb.array(part["attributes"]["NORMAL"]) @ np.linalg.inv(axes)
            i = glb.array(part["indices"]).reshape(-1, 3).astype("<u4")
            if np.linalg.det(axes) < 0:
                i = i[:, ::-1]
            positions.append(p)
            normals.append(n / np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-30))
            indices.append(i + count)
            count += len(p)
    return (np.concatenate(positions).astype("<f4"), np.concatenate(normals).astype("<f4"),
            np.concatenate(indices).astype("<u4"))


def _camera(glb: Glb):
    node, world = next((n, w) for n, w in glb.placed() if "camera" in n)
    return world, glb.json["cameras"][node["camera"]]["perspective"]["yfov"]


def _write_glb(file: pathlib.Path, arrays, world, y_angle) -> None:
    positions, normals, indices = arrays
    blob = b"".join(a.tobytes() for a in arrays)
    views, at = [], 0
    for a in arrays:
        views.append({"buffer": 0, "byteOffset": at, "byteLength": a.nbytes})
        at += a.nbytes
    accessors = [
        {"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3",
         "min": positions.min(axis=0).tolist(), "max": positions.max(axis=0).tolist()},
        {"bufferView": 1, "componentType": 5126, "count": len(normals), "type": "VEC3"},
        {"bufferView": 2, "componentType": 5125, "count": indices.size, "type": "SCALAR"}]
    matte = {"pbrMetallicRoughness": {"baseColorFactor": [ALBEDO, ALBEDO, ALBEDO, 1], "metallicFactor": 0},
             "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "extensionsUsed": ["KHR_materials_specular"],
        "nodes": [{"mesh": 0}, {"camera": 0, "matrix": world.T.ravel().tolist()}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": y_angle, "znear": 0.1}}],
        "materials": [matte], "buffers": [{"byteLength": len(blob)}], "bufferViews": views, "accessors": accessors,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0}]}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    blob += b"\0" * (-len(blob) % 4)
    file.write_bytes(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(blob))
                     + struct.pack("<I4s", len(text), b"JSON") + text
                     + struct.pack("<I4s", len(blob), b"BIN\0") + blob)


class Lights:
    """The lights of `--lights COUNT --light-seed SEED` in a box, as phases and rates: see pages/scene.js."""

    def __init__(self, count, seed, low, high, radius, intensity):
        self.count, self.seed, self.radius, self.intensity = count, seed, radius, intensity
        self.low, self.high = np.array(low, float), np.array(high, float)
        extent = self.high - self.low
        fastest = np.minimum(MAX_SPEED, extent / MIN_CROSSING) / extent  # twice the largest rate [turns/s]
        keys = [formula.key_of(seed, i) for i in range(count)]
        unit = 2.0**-64
        self.phase = np.array([[formula.bits(k, a) * unit for a in range(3)] for k in keys]).reshape(-1, 3)
        centred = [[(formula.bits(k, RATE_STREAM + a) - 2**63) * unit for a in range(3)] for k in keys]
        self.rate = np.array(centred).reshape(-1, 3) * fastest
        self.rgb = np.array([formula.colour(k, intensity) for k in keys]).reshape(-1, 3)

    def places(self, time: float) -> np.ndarray:
        turns = (self.phase + self.rate * time) % 1.0
        share = np.where(turns < 0.5, 2 * turns, 2 - 2 * turns)
        return self.low + share * (self.high - self.low)

    def options(self) -> dict:
        """For kilolux.Renderer, which makes the same lights."""
        return {"lights": self.count, "light_seed": self.seed, "light_radius": self.radius,
                "light_intensity": self.intensity, "light_box": (*self.low, *self.high), "rig": "none", "ambient": 0}


class PeerScene:
    """The files of a scene in `folder`: scene.glb, and scene.json with scene.bin for the pages."""

    def __init__(self, kilolux: pathlib.Path, name: str, folder: pathlib.Path):
        folder.mkdir(parents=True, exist_ok=True)
        source = folder / "exported.glb"
        words = [str(kilolux), "export", name, "--lights", "0", "--rig", "none", "-q", "-o", str(source)]
        subprocess.run(words, check=True)
        glb = Glb(source)
        self.folder, self.name, self.glb = folder, name, folder / "scene.glb"
        self.arrays = _merged(glb)
        self.world, self.y_angle = _camera(glb)
        _write_glb(self.glb, self.arrays, self.world, self.y_angle)
        (folder / "scene.bin").write_bytes(b"".join(a.tobytes() for a in self.arrays))

    def lights(self, count: int, radius: float) -> Lights:
        """In the scene's box without its rim, as bright together whatever their number."""
        p = self.arrays[0]
        low, high = p.min(axis=0).astype(float), p.max(axis=0).astype(float)
        rim = 0.04 * (high - low)
        volume = float(np.prod(high - low))
        intensity = float(np.float32(min(2.0, 0.8 * volume / (count * radius))))
        return Lights(count, 1, low + rim, high - rim, radius, intensity)

    def one_light(self) -> Lights:
        """A light before the camera that reaches far: the renderers' own check."""
        eye, back = self.world[:3, 3], self.world[:3, 2]
        at = eye - 3.0 * back
        return Lights(1, 1, at - 1e-3, at + 1e-3, 12.0, 20.0)

    def write_lights(self, lights: Lights, size: tuple[int, int]) -> None:
        extent = np.linalg.norm(self.arrays[0].max(axis=0) - self.arrays[0].min(axis=0))
        document = {
            "width": size[0], "height": size[1], "albedo": ALBEDO, "arrays": "scene.bin",
            "vertices": len(self.arrays[0]), "indices": int(self.arrays[2].size),
            "camera": {"position": self.world[:3, 3].tolist(), "right": self.world[:3, 0].tolist(),
                       "up": self.world[:3, 1].tolist(), "back": self.world[:3, 2].tolist(),
                       "y_angle": self.y_angle, "near": 0.1, "far": float(math.ceil(extent))},
            "lights": {"count": lights.count, "range": lights.radius, "low": lights.low.tolist(),
                       "high": lights.high.tolist(), "phase": lights.phase.ravel().tolist(),
                       "rate": lights.rate.ravel().tolist(), "rgb": lights.rgb.ravel().tolist()}}
        (self.folder / "scene.json").write_text(json.dumps(document))
