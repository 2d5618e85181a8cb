# SPDX-License-Identifier: Apache-2.0
"""The OpenCL half alone: lights a G-buffer that another renderer made."""
from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from . import _native, arrays
from .renderer import _light_list, _made_lights
from .scene import Lights


@dataclass
class GBuffer:
    """What a camera sees. Row 0 is on top; world axes.

    depth     [height, width], metres along the view direction; 0, below or not finite: background
    normal    [height, width, 3], of any length but 0
    albedo    [height, width, 3], linear Rec. 709
    roughness, metallic  [height, width] or one value
    emissive  [height, width, 3], radiance, or None
    position, focal_point, view_up  of the camera, metres; y_fov its vertical angle, radians; pixels
              are square
    """

    depth: ArrayLike
    normal: ArrayLike
    albedo: ArrayLike
    position: Sequence[float]
    focal_point: Sequence[float]
    view_up: Sequence[float] = (0.0, 1.0, 0.0)
    y_fov: float = math.pi / 4
    roughness: ArrayLike = 1.0
    metallic: ArrayLike = 0.0
    emissive: ArrayLike | None = None


@dataclass(frozen=True)
class LitGBuffer:
    """radiance  float32 [height, width, 3], linear Rec. 709, 0 for background
    evaluated  uint32 [height, width]: lights in each pixel's list
    covering   uint32 [height, width]: those of them whose range covers the pixel
    """

    radiance: np.ndarray
    evaluated: np.ndarray
    covering: np.ndarray


def _surfaces(gbuffer: GBuffer) -> dict[str, np.ndarray]:
    depth = arrays.floats(gbuffer.depth, "G-buffer: depth", np.float32)
    if depth.ndim != 2:
        raise _native.Error(f"G-buffer: depth has the shape {depth.shape}, must be (height, width)")
    if depth.size == 0:
        raise _native.Error("G-buffer: depth has no pixels")
    vectors = (*depth.shape, 3)
    shapes = {"normal": vectors, "albedo": vectors, "roughness": depth.shape}
    if np.any(arrays.floats(gbuffer.metallic, "G-buffer: metallic")):
        shapes["metallic"] = depth.shape
    if gbuffer.emissive is not None:
        shapes["emissive"] = vectors
    planes = {name: arrays.plane(getattr(gbuffer, name), shape, f"G-buffer: {name}") for name, shape in shapes.items()}
    drawn = (depth > 0) & np.isfinite(depth)
    for name, values in planes.items():
        _refuse(drawn & ~np.isfinite(values).reshape(*depth.shape, -1).all(axis=2), values, name, "must be finite")
    length = np.linalg.norm(planes["normal"].astype(np.float64), axis=2, keepdims=True)
    _refuse(drawn & (length[..., 0] == 0), planes["normal"], "normal", "has no direction")
    with np.errstate(invalid="ignore"):
        planes["normal"] = (planes["normal"] / np.where(length > 0, length, 1)).astype(np.float32)
    return {"depth": np.ascontiguousarray(depth), **planes}


def _refuse(wrong: np.ndarray, values: np.ndarray, name: str, why: str) -> None:
    if wrong.any():
        y, x = np.argwhere(wrong)[0]
        raise _native.Error(f"G-buffer: {name} of pixel {x},{y} is {values[y, x]}, {why}")


class GBufferLighting:
    """Lights G-buffers on an OpenCL device; shading: "lambert", "blinn-phong" or "pbr"."""

    def __init__(self, device: str | int = "", shading: str = "pbr") -> None:
        self._native = _native.GBufferLighting(str(device), shading)

    def light(self, gbuffer: GBuffer, lights: Lights | Iterable[Lights], ambient: float = 0.0) -> LitGBuffer:
        """The light of every pixel, with the lists that the renderer `deferred` would use."""
        camera = tuple(arrays.vector(getattr(gbuffer, name), f"G-buffer: {name}")
                       for name in ("position", "focal_point", "view_up"))
        y_fov = arrays.number(gbuffer.y_fov, "G-buffer: y_fov [radians]", 1e-3, math.pi - 1e-3)
        groups = _light_list(lights)
        if groups is None:
            raise _native.Error(f"lights: must be Lights or a list of them, not {type(lights).__name__}")
        return LitGBuffer(**self._native.light(_surfaces(gbuffer), (*camera, y_fov), _made_lights(groups),
                                               arrays.number(ambient, "ambient")))
