# SPDX-License-Identifier: Apache-2.0
"""Scenes, meshes, materials and lights from arrays."""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _native


def _rows(values: ArrayLike, count: int) -> np.ndarray:
    """float64 [count, 3], a single row repeated."""
    return np.ascontiguousarray(np.broadcast_to(np.asarray(values, dtype=np.float64), (count, 3)))


def _column(values: ArrayLike, count: int) -> np.ndarray:
    return np.ascontiguousarray(np.broadcast_to(np.asarray(values, dtype=np.float64), (count,)))


def _text(values: ArrayLike) -> str:
    return str(np.shape(values))


@dataclass
class Lights:
    """Lights of one kind.

    position   [n, 3], metres, world
    intensity  [n, 3], [n] or one value: candela, for directional lights lux; linear Rec. 709
    range      [n] or one value, metres: beyond it a light is exactly 0; 0: from the intensity
    direction  [n, 3] or one row: the way the light travels (spot, directional); any length but 0
    inner_cone, outer_cone  [n] or one value: half angles of spot lights, radians
    kind       "point", "spot" or "directional"

    Lights that cannot be used (not finite, no intensity) are counted as rejected in a frame's stats.
    """

    position: ArrayLike
    intensity: ArrayLike = 1.0
    range: ArrayLike = 0.0
    direction: ArrayLike = (0.0, -1.0, 0.0)
    inner_cone: ArrayLike = 0.0
    outer_cone: ArrayLike = 0.7853981633974483
    kind: str = "point"

    def _made(self) -> Any:
        position = np.atleast_2d(np.asarray(self.position, dtype=np.float64))
        if position.ndim != 2 or position.shape[1] != 3:
            raise _native.Error(f"lights: position has the shape {_text(self.position)}, must be (n, 3)")
        count = len(position)
        intensity = np.asarray(self.intensity, dtype=np.float64)
        if intensity.ndim == 1 and intensity.shape != (3,):
            intensity = intensity[:, None]
        try:
            return _native.lights(
                self.kind, position, _rows(self.direction, count), _rows(intensity, count),
                _column(self.range, count), _column(self.inner_cone, count), _column(self.outer_cone, count))
        except ValueError as error:
            raise _native.Error(f"lights: {count} positions, but {error}") from None


@dataclass
class Material:
    """A glTF metallic-roughness material.

    base_color, emissive  linear Rec. 709, 3 values; emissive is radiance
    base_color_image, emissive_image  uint8 [height, width, 3 or 4], sRGB, multiplied in
    metallic_roughness_image          the same, linear: G roughness, B metallic
    Texture coordinates of the mesh place images, (0, 0) is their upper left.
    """

    base_color: Sequence[float] = (1.0, 1.0, 1.0)
    metallic: float = 0.0
    roughness: float = 1.0
    emissive: Sequence[float] = (0.0, 0.0, 0.0)
    base_color_image: np.ndarray | None = None
    metallic_roughness_image: np.ndarray | None = None
    emissive_image: np.ndarray | None = None
    double_sided: bool = False
    unlit: bool = False
    name: str = "material"


@dataclass
class Mesh:
    """A list of triangles.

    positions  [n, 3], metres; indices [m, 3], each below n, counter-clockwise seen from outside
    normals    [n, 3]; without them every triangle is flat
    texcoords  [n, 2]; colors [n, 3 or 4], linear, multiply the material's
    material   a Material, shared by the meshes that name the same one; None: white
    world_from_object  [4, 4], as numpy multiplies column vectors: world = M @ object
    """

    positions: ArrayLike
    indices: ArrayLike
    normals: ArrayLike | None = None
    texcoords: ArrayLike | None = None
    colors: ArrayLike | None = None
    material: Material | None = None
    world_from_object: ArrayLike = field(default_factory=lambda: np.eye(4))
    name: str = "mesh"


def _rgba(image: np.ndarray | None) -> np.ndarray | None:
    if image is None or np.ndim(image) != 3 or np.shape(image)[2] != 3:
        return image
    return np.dstack([image, np.full(np.shape(image)[:2], 255, np.uint8)])


def _floats(values: ArrayLike | None, columns: int) -> np.ndarray:
    if values is None:
        return np.empty((0, columns), np.float32)
    return np.ascontiguousarray(values, dtype=np.float32)


def _flat(mesh: Mesh) -> tuple[list[np.ndarray], np.ndarray, np.ndarray]:
    """Per-vertex arrays in which no triangle shares a vertex, flat normals, and indices."""
    indices = np.asarray(mesh.indices, dtype=np.int64)
    positions = _floats(mesh.positions, 3)
    if indices.size and (indices.min() < 0 or indices.max() >= len(positions)):
        raise _native.Error(f"mesh '{mesh.name}': indices from {indices.min()} to {indices.max()}, "
                            f"but there are {len(positions)} positions")
    corners = indices.reshape(-1)
    triangles = positions[corners].reshape(-1, 3, 3).astype(np.float64)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    arrays = [positions[corners]]
    for values, columns in ((mesh.texcoords, 2), (mesh.colors, 4)):
        arrays.append(_floats(None, columns) if values is None else _floats(values, columns)[corners])
    return arrays, np.repeat(normals, 3, axis=0), np.arange(corners.size, dtype=np.int64).reshape(-1, 3)


class Scene:
    """A scene from meshes and lights; Renderer and render() take it in place of a name or file."""

    def __init__(self, meshes: Iterable[Mesh], lights: Lights | Iterable[Lights] | None = None,
                 name: str = "scene") -> None:
        self.name = name
        self.lights = lights
        self._native = _native.Scene(name)
        self._materials: dict[int, tuple[int, Material]] = {}
        for mesh in meshes:
            self._add(mesh)

    def _material(self, material: Material | None) -> int | None:
        if material is None:
            return None
        if id(material) not in self._materials:
            values = dict(vars(material), base_color=tuple(material.base_color), emissive=tuple(material.emissive))
            for key in ("base_color_image", "metallic_roughness_image", "emissive_image"):
                values[key] = _rgba(values[key])
            self._native.add_material(values)
            self._materials[id(material)] = (len(self._materials), material)
        return self._materials[id(material)][0]

    def _add(self, mesh: Mesh) -> None:
        if mesh.normals is None:
            (positions, texcoords, colors), normals, indices = _flat(mesh)
        else:
            positions, normals = _floats(mesh.positions, 3), mesh.normals
            texcoords, colors = _floats(mesh.texcoords, 2), _floats(mesh.colors, 4)
            indices = np.asarray(mesh.indices, dtype=np.int64)
        if colors.ndim == 2 and colors.shape[1] == 3:
            colors = np.hstack([colors, np.ones((len(colors), 1), np.float32)])
        self._native.add_mesh(mesh.name, positions, _floats(normals, 3), texcoords, colors, indices,
                              self._material(mesh.material), np.asarray(mesh.world_from_object, np.float64))
