# SPDX-License-Identifier: Apache-2.0
"""Errors of a picture against a reference.

Pictures are arrays [height, width, 3 or 4], alpha is ignored: uint8 for sRGB codes, floats for
linear light.
"""
from __future__ import annotations

import numpy as np

from . import _native


def _colours(picture: np.ndarray) -> np.ndarray:
    array = np.asarray(picture)
    if array.dtype != np.uint8 and not np.issubdtype(array.dtype, np.floating):
        raise _native.Error(f"picture: values are {array.dtype}, must be uint8 (sRGB codes) or floats (linear light)")
    colours = array[..., :3] if array.ndim == 3 else array
    return colours / 255.0 if array.dtype == np.uint8 else colours.astype(np.float64)


def _of_one_kind(picture: np.ndarray, reference: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    codes = [np.asarray(image).dtype == np.uint8 for image in (picture, reference)]
    if codes[0] != codes[1]:
        raise _native.Error("compare: one picture has sRGB codes (uint8), the other linear light (floats)")
    return _colours(picture), _colours(reference)


def _linear(picture: np.ndarray) -> np.ndarray:
    """IEC 61966-2-1 of codes from 0 to 1."""
    return np.where(picture <= 0.04045, picture / 12.92, ((picture + 0.055) / 1.055) ** 2.4)


def _compare(picture: np.ndarray, reference: np.ndarray, peak: float = 0.0) -> dict[str, float]:
    return _native.compare(*_of_one_kind(picture, reference), peak)


def rmse(picture: np.ndarray, reference: np.ndarray) -> float:
    """Root of the mean squared difference over all channels; codes count from 0 to 1."""
    return _compare(picture, reference)["rmse"]


def max_error(picture: np.ndarray, reference: np.ndarray) -> float:
    """The largest difference of a channel; codes count from 0 to 1."""
    return _compare(picture, reference)["max"]


def relmse(picture: np.ndarray, reference: np.ndarray) -> float:
    """Mean of (p - r)^2 / (r^2 + e), e = 1e-2 times the square of the reference's mean."""
    return _compare(picture, reference)["relmse"]


def psnr(picture: np.ndarray, reference: np.ndarray, peak: float | None = None) -> float:
    """20 log10(peak / rmse) [dB], infinite when equal. Peak: 1 for codes, else the reference's largest value."""
    codes = np.asarray(reference).dtype == np.uint8
    return _compare(picture, reference, (1.0 if codes else 0.0) if peak is None else peak)["psnr"]


def _flip(picture: np.ndarray, reference: np.ndarray) -> tuple[float, np.ndarray]:
    pictures = _of_one_kind(picture, reference)
    if np.asarray(reference).dtype == np.uint8:
        return _native.flip(_linear(pictures[0]), _linear(pictures[1]), False)
    return _native.flip(*pictures, True)


def flip(picture: np.ndarray, reference: np.ndarray) -> float:
    """Mean FLIP, 0 (equal) to 1: LDR-FLIP of codes (Andersson et al. 2020), HDR-FLIP of light (2021)."""
    return _flip(picture, reference)[0]


def flip_map(picture: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """FLIP of every pixel, float64 [height, width]."""
    return _flip(picture, reference)[1]


def ssim(picture: np.ndarray, reference: np.ndarray) -> float | None:
    """Mean structural similarity of codes (uint8), 1 when equal; None below 11x11 pixels."""
    def rgba(image: np.ndarray) -> np.ndarray:
        array = np.asarray(image)
        if array.dtype != np.uint8:
            raise _native.Error(f"ssim: pictures must be uint8, this is {array.dtype}")
        return np.dstack([array[..., :3], np.full(array.shape[:2], 255, np.uint8)])
    return _native.ssim(rgba(picture), rgba(reference))
