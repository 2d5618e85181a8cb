# SPDX-License-Identifier: Apache-2.0
"""Frames of a sequence on the workers of a Dask cluster."""
from __future__ import annotations

import os
import pickle
import threading
from collections.abc import Callable, Iterable
from typing import Any, TypeVar

from .renderer import Frame, Renderer
from .scene import Scene

Result = TypeVar("Result")

_lock = threading.Lock()  # a worker's threads take turns: one renderer uses all its cores
_kept: tuple[bytes, Renderer] | None = None


def _renderer(scene: str | os.PathLike[str] | Scene, options: dict[str, Any]) -> Renderer:
    """The last task's renderer where scene and options are the same."""
    global _kept
    changed = os.stat(scene).st_mtime_ns if isinstance(scene, (str, os.PathLike)) and os.path.exists(scene) else 0
    key = pickle.dumps((scene, changed, sorted(options.items())))
    if _kept is None or _kept[0] != key:
        _kept = None  # two might not fit into memory
        _kept = key, Renderer(scene, **options)
    return _kept[1]


def _make(scene: str | os.PathLike[str] | Scene, options: dict[str, Any], number: int, time: float,
          take: Callable[[Frame, int], Result]) -> Result:
    with _lock:
        frame = _renderer(scene, options).render(time)
    return take(frame, number)


def map_frames(client: Any, scene: str | os.PathLike[str] | Scene, frames: Iterable[int],
               take: Callable[[Frame, int], Result], *, fps: float = 24.0, **options: Any) -> list[Any]:
    """Renders frames on the workers of `client`, a distributed.Client. Returns their futures.

    `take(frame, number)` runs on the worker, and its result is the future's: the name of a file that it wrote, say.
    Frame f is at the time `time` of the options (0) + f / fps, in seconds, as of `kilolux render --frames`. A worker keeps
    its renderer from frame to frame; frames of a worker that dies are made by others.
    """
    start = options.pop("time", 0.0)
    return [client.submit(_make, scene, options, number, start + number / fps, take, pure=False)
            for number in frames]
