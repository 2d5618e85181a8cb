# SPDX-License-Identifier: Apache-2.0
"""The window of `kilolux view --serve` beside a notebook."""
from __future__ import annotations

import atexit
import html

from . import _native
from .renderer import Renderer, _made_lights

_shown: View | None = None


class View:
    """A live view: the window of a renderer's scene in a frame of the notebook, or at `address` in a browser.

    It has a renderer of its own, which begins with the options of the one that was shown. There is
    one in a process.
    """

    def __init__(self, renderer: Renderer, serve: str, height: int) -> None:
        words, lights = renderer._said(dict(renderer._options), True)
        self._session = _native.ServedSession(renderer._scene, words, renderer._made, _made_lights(lights or []), serve)
        self._height = height
        self.address: str = self._session.address()

    def close(self) -> None:
        """Ends the session; its page says so."""
        self._session.close()

    def __repr__(self) -> str:
        return f"<View {self.address}>"

    def _repr_html_(self) -> str:
        """For notebooks, which show it."""
        return (f'<iframe src="{html.escape(self.address)}" width="100%" height="{self._height}" '
                'style="border: 0" allow="fullscreen; clipboard-write"></iframe>')


def show(renderer: Renderer, *, serve: str = "local", height: int = 600) -> View:
    """A live view of the renderer's scene; it replaces the one before.

    serve   where it listens, as for `kilolux view --serve`: a browser on another machine needs a
            port that is forwarded, as "127.0.0.1:8080"
    height  of the frame in CSS pixels
    """
    global _shown
    close()
    _shown = View(renderer, serve, height)
    return _shown


def close() -> None:
    """Ends the live view, if there is one."""
    global _shown
    if _shown is not None:
        _shown.close()
    _shown = None


atexit.register(close)
