# SPDX-License-Identifier: Apache-2.0
"""Float64 pictures by the lighting model of each renderer, every light at every pixel; scores by `kilolux score`."""
from __future__ import annotations

import json
import pathlib
import struct
import subprocess
from typing import Callable, NamedTuple

import numpy as np


def _window(d2, r):
    return np.clip(1.0 - (d2 / (r * r))**2, 0.0, 1.0)


class Model(NamedTuple):
    falloff: Callable  # radiance of a white surface by 1 cd at the squared distance d2 [m^2], range r, without the cosine
    is_white: bool = False  # its surface has albedo 1, for it takes colours as sRGB


MODELS = {
    "kilolux": Model(lambda d2, r: _window(d2, r) / np.maximum(d2, 1e-4) / np.pi),
    "three": Model(lambda d2, r: _window(d2, r)**2 / np.maximum(d2, 0.01) / np.pi),
    "babylon": Model(lambda d2, r: np.maximum(0.0, 1.0 - np.sqrt(d2) / r)),
    "playcanvas": Model(lambda d2, r: 16.0 / (d2 + 1.0) * _window(d2, r)**2, is_white=True),
}


def _smooth(position, normal):
    """Pixels that no edge is near: their neighbours lie nearly in their plane. Rasterisers shift edges."""
    out = np.zeros(normal.shape[:2], bool)
    out[1:-1, 1:-1] = np.linalg.norm(normal[1:-1, 1:-1], axis=2) > 0.5
    for dy, dx in ((0, 1), (0, -1), (1, 0), (-1, 0)):
        other_n, other_p = np.roll(normal, (dy, dx), (0, 1)), np.roll(position, (dy, dx), (0, 1))
        off_plane = np.abs(np.einsum("ijk,ijk->ij", other_p - position, normal))
        out &= (np.einsum("ijk,ijk->ij", other_n, normal) > 0.99) & (off_plane < 0.02)
    return out


class Surfaces:
    """The surfaces that the centres of every `step`-th pixel see, from Kilolux's float32 layers."""

    def __init__(self, kilolux, scene, size, step=1):
        self.chosen = (slice(step // 2, None, step),) * 2  # rows, columns
        frame = kilolux.render(str(scene.glb), resolution=size, lights=0, rig="none", ambient=0, gbuffer="full",
                               aov=["position", "normal", "depth"], quiet=True)
        position, normal = frame.aovs["position"], frame.aovs["normal"]
        self.smooth = _smooth(position, normal)[self.chosen]
        position, normal = position[self.chosen], normal[self.chosen]
        self.shape = position.shape[:2]
        self.position = position.reshape(-1, 3).astype(float)
        self.normal = normal.reshape(-1, 3).astype(float)
        self.drawn = np.linalg.norm(self.normal, axis=1) > 0.5


def picture(model: str, surfaces: Surfaces, lights, time: float, albedo: float) -> np.ndarray:
    """[height, width, 3]. Sums are those of float64; lights out of range are left out, which add exactly 0."""
    falloff, is_white = MODELS[model]
    p, n = surfaces.position[surfaces.drawn], surfaces.normal[surfaces.drawn]
    out = np.zeros_like(p)
    for place, rgb in zip(lights.places(time), lights.rgb):
        v = place - p
        d2 = np.einsum("ij,ij->i", v, v)
        near = np.flatnonzero(d2 < lights.radius**2)
        if near.size == 0:
            continue
        d2 = d2[near]
        cosine = np.einsum("ij,ij->i", v[near], n[near]) / np.sqrt(np.maximum(d2, 1e-30))
        light = falloff(d2, lights.radius) * np.maximum(cosine, 0.0)
        out[near] += light[:, None] * rgb
    whole = np.zeros((surfaces.position.shape[0], 3))
    whole[surfaces.drawn] = out * (1.0 if is_white else albedo)
    return whole.reshape(*surfaces.shape, 3)


def write_exr(file: pathlib.Path, rgb: np.ndarray) -> None:
    """An OpenEXR file of float32 without compression (openexr.com, "OpenEXR File Layout")."""
    height, width = rgb.shape[:2]

    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    channels = b"".join(c + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for c in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    header = struct.pack("<ii", 20000630, 2) + b"".join((
        attribute("channels", "chlist", channels), attribute("compression", "compression", b"\0"),
        attribute("dataWindow", "box2i", window), attribute("displayWindow", "box2i", window),
        attribute("lineOrder", "lineOrder", b"\0"), attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0)),
        attribute("screenWindowWidth", "float", struct.pack("<f", 1)))) + b"\0"
    row = 12 * width
    first = len(header) + 8 * height
    offsets = struct.pack(f"<{height}Q", *(first + y * (row + 8) for y in range(height)))
    planes = np.ascontiguousarray(rgb[:, :, ::-1].transpose(0, 2, 1), "<f4")
    rows = b"".join(struct.pack("<ii", y, row) + planes[y].tobytes() for y in range(height))
    file.write_bytes(header + offsets + rows)


def score(program: pathlib.Path, folder: pathlib.Path, name: str, rgb: np.ndarray, reference: np.ndarray) -> dict:
    """What `kilolux score --json` says of a picture; both stay in `folder`."""
    mine, theirs = folder / f"{name}.exr", folder / f"{name}_reference.exr"
    write_exr(mine, rgb)
    write_exr(theirs, reference)
    words = [str(program), "score", str(mine), "--reference", str(theirs), "--json"]
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip())
    return json.loads(done.stdout)
