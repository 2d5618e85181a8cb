# SPDX-License-Identifier: Apache-2.0
"""Scenes, meshes, materials and lights from arrays."""
from __future__ import annotations

import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _native, arrays


@dataclass
class Lights:
    """Lights of one kind.

    position   [n, 3], metres, world
    intensity  [n, 3], [n], one colour or one value: candela, for directional lights lux, for flat
               ones candela straight ahead (luminance times area); linear Rec. 709. Of three lights
               say [3, 1] for values and [1, 3] for one colour.
    range      [n] or one value, metres: beyond it a light is exactly 0; 0: from the intensity
    direction  [n, 3] or one row: the way the light travels; not of points and spheres; any length but 0
    inner_cone, outer_cone  [n] or one value: half angles of spot lights, radians, at most pi / 2
    width, height  [n] or one value, metres: of "rect" and "disk" (an ellipse where they differ), and
               of "triangle" the first edge and the height over it
    side       [n, 3] or one row: the way of the width
    skew       [n] or one value, metres: the second edge of a triangle along the first
    radius     [n] or one value, metres: of "sphere"
    two_sided  whether flat lights shine to both sides
    kind       "point", "spot", "directional", "rect", "disk", "sphere" or "triangle" (about its centroid)

    Arrays are read when the lights are given to Renderer(), change() or light(). Lights that cannot
    be used (not finite, a negative intensity or range) are left out with a warning; a frame's stats
    count them.
    """

    position: ArrayLike
    intensity: ArrayLike = 1.0
    range: ArrayLike = 0.0
    direction: ArrayLike = (0.0, -1.0, 0.0)
    inner_cone: ArrayLike = 0.0
    outer_cone: ArrayLike = 0.7853981633974483
    width: ArrayLike = 0.0
    height: ArrayLike = 0.0
    skew: ArrayLike = 0.0
    radius: ArrayLike = 0.0
    side: ArrayLike = (1.0, 0.0, 0.0)
    two_sided: ArrayLike = False
    kind: str = "point"

    def __post_init__(self) -> None:
        self._values()

    def _values(self) -> dict[str, np.ndarray]:
        """float64, one row a light."""
        position = np.atleast_2d(arrays.floats(self.position, "lights: position"))
        if position.ndim != 2 or position.shape[1] != 3:
            raise _native.Error(f"lights: position has the shape {np.shape(self.position)}, must be (n, 3)")
        count = len(position)
        intensity = arrays.floats(self.intensity, "lights: intensity")
        if intensity.shape == (3,) and count == 3:
            raise _native.Error("lights: intensity has the shape (3,), and there are 3 lights: (3, 1) is a value for "
                                "each, (1, 3) a colour for all")
        if intensity.ndim == 1 and intensity.shape != (3,):
            intensity = intensity[:, None]
        columns = {name: arrays.floats(getattr(self, name), f"lights: {name}")
                   for name in (*_native.light_numbers(), "two_sided")}
        rows = {name: arrays.floats(getattr(self, name), f"lights: {name}") for name in ("direction", "side")}
        return {"position": position,
                **{name: _fill(name, row, (count, 3)) for name, row in rows.items()},
                "intensity": _fill("intensity", intensity, (count, 3)),
                **{name: _fill(name, column, (count,)) for name, column in columns.items()}}

    def _made(self) -> Any:
        values = self._values()
        good = {name: np.isfinite(values[name]) for name in ("position", "intensity", "range")}
        for name in ("intensity", "range"):
            good[name] &= values[name] >= 0
        bad = {name: ~np.atleast_2d(rows.T).all(axis=0) for name, rows in good.items()}
        for name, rows in bad.items():
            if rows.any():
                first = int(np.argmax(rows))
                warnings.warn(f"lights: {name} of light {first} is {values[name][first]}; {rows.sum()} of {len(rows)} "
                              "lights are left out for theirs", stacklevel=4)
                values["intensity"] = np.where(rows[:, None], np.nan, values["intensity"])
        return _native.lights(self.kind, values)


def _fill(name: str, values: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    try:
        return np.broadcast_to(values, shape)
    except ValueError:
        raise _native.Error(f"lights: {name} has the shape {values.shape}, must be {shape} or one for all") from None


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


def _rgba(image: Any, what: str) -> np.ndarray | None:
    if image is None:
        return None
    pixels = np.asarray(image)
    if pixels.dtype != np.uint8:
        raise _native.Error(f"{what}: values are {pixels.dtype}, must be uint8")
    if pixels.ndim == 3 and pixels.shape[2] == 3:
        return np.dstack([pixels, np.full(pixels.shape[:2], 255, np.uint8)])
    return pixels


def _material_values(material: Material) -> dict[str, Any]:
    """What the compiled half takes."""
    what = f"material '{material.name}': "
    values = dict(vars(material))
    for key in ("base_color", "emissive"):
        values[key] = arrays.vector(values[key], what + key)
    for key in ("metallic", "roughness"):
        values[key] = arrays.number(values[key], what + key, 0.0, 1.0)
    for key in ("base_color_image", "metallic_roughness_image", "emissive_image"):
        values[key] = _rgba(values[key], what + key)
    return values


def _floats(values: ArrayLike | None, columns: int, what: str = "") -> np.ndarray:
    """float32 [n, columns]."""
    if values is None:
        return np.empty((0, columns), np.float32)
    array = arrays.floats(values, what, np.float32)
    if array.ndim != 2 or array.shape[1] != columns:
        raise _native.Error(f"{what}: shape {array.shape}, must be (n, {columns})")
    return np.ascontiguousarray(array)


def _colors(values: ArrayLike | None, what: str) -> np.ndarray:
    """float32 [n, 4], alpha 1 where there is none."""
    if values is None or np.shape(values)[-1:] != (3,):
        return _floats(values, 4, what)
    colors = _floats(values, 3, what)
    return np.hstack([colors, np.ones((len(colors), 1), np.float32)])


def _flat(what: str, vertices: list[np.ndarray], indices: np.ndarray) -> tuple[list[np.ndarray], np.ndarray]:
    """positions, normals, texcoords and colors in which no triangle shares a vertex, and indices."""
    positions, _, texcoords, colors = vertices
    if indices.size and (indices.min() < 0 or indices.max() >= len(positions)):
        raise _native.Error(f"{what}indices from {indices.min()} to {indices.max()}, "
                            f"but there are {len(positions)} positions")
    corners = indices.reshape(-1)
    triangles = positions[corners].reshape(-1, 3, 3).astype(np.float64)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    for name, values in (("texcoords", texcoords), ("colors", colors)):
        if len(values) not in (0, len(positions)):
            raise _native.Error(f"{what}{name}: {len(values)} rows, but there are {len(positions)} positions")
    spread = [values[corners] if len(values) else values for values in (texcoords, colors)]
    repeated = np.repeat(normals, 3, axis=0).astype(np.float32)
    return [positions[corners], repeated, *spread], np.arange(corners.size, dtype=np.int64).reshape(-1, 3)


class Scene:
    """A scene from meshes and lights; Renderer and render() take it in place of a name or file."""

    def __init__(self, meshes: Iterable[Mesh], lights: Lights | Iterable[Lights] | None = None,
                 name: str = "scene") -> None:
        self.name = name
        self.lights = lights
        self._native = _native.Scene(name)
        self._materials: dict[int, tuple[int, Material]] = {}
        self._white = Material()
        for mesh in [meshes] if isinstance(meshes, Mesh) else meshes:
            self._add(mesh)

    def _material(self, material: Material | None) -> int:
        if material is None:
            material = self._white
        if not isinstance(material, Material):
            raise _native.Error(f"mesh: material must be a Material, not {type(material).__name__}")
        if id(material) not in self._materials:
            self._native.add_material(_material_values(material))
            self._materials[id(material)] = (len(self._materials), material)
        return self._materials[id(material)][0]

    def _add(self, mesh: Mesh) -> None:
        what = f"mesh '{mesh.name}': "
        vertices = [_floats(mesh.positions, 3, what + "positions"), _floats(mesh.normals, 3, what + "normals"),
                    _floats(mesh.texcoords, 2, what + "texcoords"), _colors(mesh.colors, what + "colors")]
        indices = arrays.indices(mesh.indices, what + "indices")
        if mesh.normals is None:
            vertices, indices = _flat(what, vertices, indices)
        matrix = arrays.floats(mesh.world_from_object, what + "world_from_object")
        if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
            raise _native.Error(f"{what}world_from_object must have the shape (4, 4) and be finite")
        self._native.add_mesh(mesh.name, *vertices, indices, self._material(mesh.material), matrix)
