# SPDX-License-Identifier: Apache-2.0
"""Frames of a sequence on the workers of a Dask cluster."""
from __future__ import annotations

import hashlib
import os
import pickle
import threading
from collections.abc import Callable, Iterable
from typing import Any, TypeVar

from .renderer import Frame, Renderer
from .scene import Scene

Result = TypeVar("Result")

_lock = threading.Lock()  # a worker's threads take turns: one renderer uses all its cores
_kept: tuple[tuple[str, int], Renderer] | None = None

_Job = tuple[str, "str | os.PathLike[str] | Scene", dict[str, Any]]  # a digest, the scene, the options


def _same(job: _Job) -> _Job:
    """A task of its own: a worker receives the scene once. Dask runs it again if all workers that held it have died."""
    return job


def _renderer(job: _Job) -> Renderer:
    """The last task's renderer where scene and options are the same."""
    global _kept
    digest, scene, options = job
    changed = os.stat(scene).st_mtime_ns if isinstance(scene, (str, os.PathLike)) and os.path.exists(scene) else 0
    if _kept is None or _kept[0] != (digest, changed):
        _kept = None  # two might not fit into memory
        _kept = (digest, changed), Renderer(scene, **options)
    return _kept[1]


def _make(job: _Job, number: int, time: float, take: Callable[[Frame, int], Result]) -> Result:
    with _lock:
        frame = _renderer(job).render(time)
    return take(frame, number)


def map_frames(client: Any, scene: str | os.PathLike[str] | Scene, frames: Iterable[int],
               take: Callable[[Frame, int], Result], *, fps: float = 24.0, **options: Any) -> list[Any]:
    """Renders frames on the workers of `client`, a distributed.Client. Returns their futures.

    `take(frame, number)` runs on the worker, and its result is the future's: the name of a file that it wrote, say.
    Frame f is at the time `time` of the options (0) + f / fps, in seconds, as of `kilolux render --frames`. A worker keeps
    its renderer from frame to frame; frames of a worker that dies are made by others.
    """
    start = options.pop("time", 0.0)
    digest = hashlib.sha256(pickle.dumps((scene, sorted(options.items())))).hexdigest()
    job = client.submit(_same, (digest, scene, options), pure=False)
    return [client.submit(_make, job, number, start + number / fps, take, pure=False) for number in frames]
