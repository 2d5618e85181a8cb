# SPDX-License-Identifier: Apache-2.0
"""Kilolux lights a scene with thousands to a million lights.

    import kilolux
    frame = kilolux.render("atrium", lights=5000, resolution=(640, 360))
    frame.display      # uint8 [height, width, 4], sRGB
    frame.radiance     # float32 [height, width, 3], linear Rec. 709

Options are those of the command `kilolux render`, with underscores for dashes: numbers, texts,
tuples for values with commas, True for flags. `kilolux render --help-all` lists them. Lengths are
in metres, times in seconds, intensities in candela, angles of arrays in radians; row 0 is on top.
"""
from ._native import Error, devices, version
from .lighting import GBuffer, GBufferLighting, LitGBuffer
from .live import View, show
from .metrics import flip, flip_map, max_error, psnr, relmse, rmse, ssim
from .renderer import Frame, Probe, Reference, Renderer, render
from .scene import Lights, Material, Mesh, Scene

__version__ = version()
__all__ = [
    "Error", "Frame", "GBuffer", "GBufferLighting", "Lights", "LitGBuffer", "Material", "Mesh", "Probe",
    "Reference", "Renderer", "Scene", "View", "devices", "flip", "flip_map", "max_error", "psnr", "relmse", "render",
    "rmse", "show", "ssim", "version",
]
