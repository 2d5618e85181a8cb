# SPDX-License-Identifier: Apache-2.0
"""The OpenCL half alone: lights a G-buffer that another renderer made."""
from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .renderer import _light_list, _made_lights
from .scene import Lights


@dataclass
class GBuffer:
    """What a camera sees. Row 0 is on top; world axes.

    depth     [height, width], metres along the view direction; 0, below or not finite: background
    normal    [height, width, 3], unit
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


def _plane(values: ArrayLike, shape: tuple[int, ...], name: str) -> np.ndarray:
    array = np.asarray(values, dtype=np.float32)
    if array.ndim != 0 and array.shape != shape:
        raise _native.Error(f"G-buffer: {name} has the shape {array.shape}, must be {shape}")
    return np.ascontiguousarray(np.broadcast_to(array, shape))


class GBufferLighting:
    """Lights G-buffers on an OpenCL device; shading: "lambert", "blinn-phong" or "pbr"."""

    def __init__(self, device: str = "", shading: str = "pbr") -> None:
        self._native = _native.GBufferLighting(device, shading)

    def light(self, gbuffer: GBuffer, lights: Lights | Iterable[Lights], ambient: float = 0.0) -> LitGBuffer:
        """The light of every pixel, with the lists that the renderer `deferred` would use."""
        depth = np.asarray(gbuffer.depth, dtype=np.float32)
        if depth.ndim != 2:
            raise _native.Error(f"G-buffer: depth has the shape {depth.shape}, must be (height, width)")
        vectors = (*depth.shape, 3)
        planes = {
            "depth": np.ascontiguousarray(depth),
            "normal": _plane(gbuffer.normal, vectors, "normal"),
            "albedo": _plane(gbuffer.albedo, vectors, "albedo"),
            "roughness": _plane(gbuffer.roughness, depth.shape, "roughness"),
        }
        if np.any(gbuffer.metallic):
            planes["metallic"] = _plane(gbuffer.metallic, depth.shape, "metallic")
        if gbuffer.emissive is not None:
            planes["emissive"] = _plane(gbuffer.emissive, vectors, "emissive")
        camera = tuple(tuple(map(float, v)) for v in (gbuffer.position, gbuffer.focal_point, gbuffer.view_up))
        made = _made_lights(_light_list(lights) or [])
        return LitGBuffer(**self._native.light(planes, (*camera, gbuffer.y_fov), made, ambient))
