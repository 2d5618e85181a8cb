# SPDX-License-Identifier: Apache-2.0
"""Arrays as callers hand them over: checked, so that a mistake is one line that names it."""
from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from ._native import Error


def floats(values: ArrayLike, what: str, dtype: type = np.float64) -> np.ndarray:
    try:
        return np.asarray(values, dtype=dtype)
    except (TypeError, ValueError) as error:
        raise Error(f"{what}: {error}") from None


def vector(values: Sequence[float], what: str) -> tuple[float, float, float]:
    """Three finite numbers."""
    array = floats(values, what)
    if array.shape != (3,) or not np.isfinite(array).all():
        raise Error(f"{what}: {values} is not three finite numbers")
    return (float(array[0]), float(array[1]), float(array[2]))


def number(value: float, what: str, least: float = -math.inf, most: float = math.inf) -> float:
    """A finite number from `least` to `most`."""
    array = floats(value, what)
    if array.size != 1 or not np.isfinite(array).all() or not least <= array.item() <= most:
        limits = "" if math.isinf(least) and math.isinf(most) else f" from {least:g} to {most:g}"
        raise Error(f"{what}: {value} is not a number{limits}")
    return array.item()


def plane(values: ArrayLike, shape: tuple[int, ...], what: str) -> np.ndarray:
    """float32 of `shape`, a single value repeated."""
    array = floats(values, what, np.float32)
    if array.ndim != 0 and array.shape != shape:
        raise Error(f"{what} has the shape {array.shape}, must be {shape}")
    return np.ascontiguousarray(np.broadcast_to(array, shape))


def indices(values: ArrayLike, what: str) -> np.ndarray:
    """int64 [n, 3]."""
    array = np.asarray(floats(values, what) if np.size(values) == 0 else values)
    if array.ndim != 2 or array.shape[1] != 3:
        raise Error(f"{what}: shape {array.shape}, must be (n, 3)")
    if array.size and not np.issubdtype(array.dtype, np.integer):
        raise Error(f"{what}: are {array.dtype}, must be integers")
    return array.astype(np.int64)
