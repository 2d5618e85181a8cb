# SPDX-License-Identifier: Apache-2.0
"""Pictures of scenes."""
from __future__ import annotations

import json
import os
import struct
import zlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from operator import index
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native
from .scene import Lights, Scene

if TYPE_CHECKING:
    from typing import Unpack

    from .options import Options


@dataclass(frozen=True, repr=False)
class Frame:
    """A picture. Its arrays are views of the renderer's own memory, not copies, and stay valid.

    display   uint8 [height, width, 4], sRGB with the options' exposure and tone curve
    radiance  float32 [height, width, 3], linear Rec. 709, unclamped
    aovs      by the names of the option `aov`: float32 or uint32, [height, width] or
              [height, width, 3]; metres and unit vectors in the world. Those of `light_groups`
              are "light.NAME"
    stats     the document of --stats; null for what was not counted
    """

    display: np.ndarray
    radiance: np.ndarray
    aovs: dict[str, np.ndarray]
    stats: dict[str, Any]

    @property
    def lights(self) -> dict[str, np.ndarray]:
        """The light of each group of the option `light_groups` and of the "rest", as radiance."""
        begin = "light."
        return {name[len(begin):]: light for name, light in self.aovs.items() if name.startswith(begin)}

    def __repr__(self) -> str:
        height, width = self.display.shape[:2]
        aovs = f", aovs: {', '.join(self.aovs)}" if self.aovs else ""
        return f"<Frame {width}x{height}, {self.stats['frame_ms']:.1f} ms{aovs}>"

    def _repr_png_(self) -> bytes:
        """For notebooks, which show it."""
        height, width = self.display.shape[:2]
        rows = np.hstack([np.zeros((height, 1), np.uint8), self.display.reshape(height, -1)])  # filter 0
        chunks = ((b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)),
                  (b"IDAT", zlib.compress(rows.tobytes(), 6)), (b"IEND", b""))
        return b"\x89PNG\r\n\x1a\n" + b"".join(
            struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
            for name, data in chunks)


@dataclass(frozen=True)
class Probe:
    """What lights a pixel; metres, world space.

    lights  of the list that is evaluated: position [n, 3], intensity [n, 3] candela, range [n];
            empty with renderer="forward", which has no lists
    layers  surfaces in front that blend or transmit, from near to far: depth, position, normal,
            albedo, roughness, metallic, transmission and the name of their material
    """

    drawn: bool
    depth: float
    position: tuple[float, float, float]
    normal: tuple[float, float, float]
    albedo: tuple[float, float, float]
    roughness: float
    metallic: float
    cluster: tuple[int, int, int]
    coarse_lights: int
    lights: dict[str, np.ndarray]
    layers: list[dict[str, Any]]


@dataclass(frozen=True)
class Reference:
    """A float64 reference: radiance [height, width, 3], and scale, the unit of relative errors."""

    radiance: np.ndarray
    scale: np.ndarray
    lights_per_pixel: float


def _value(value: Any) -> str:
    if isinstance(value, (list, tuple, np.ndarray)):
        return ",".join(_value(part) for part in value)
    return os.fspath(value) if isinstance(value, os.PathLike) else str(value)


def _words(options: Mapping[str, Any]) -> list[str]:
    """The options as a command line has them; quiet unless said otherwise."""
    words = []
    for name, value in {"quiet": not options.get("verbose", False), **options}.items():
        option = "--" + name.replace("_", "-")
        if value is True:
            words.append(f"{option}=true")
        elif value is not False and value is not None:
            words.append(f"{option}={_value(value)}")
    return words


def _light_list(lights: Any) -> list[Lights] | None:
    """The arrays of the option `lights`; None where it is a number, as on the command line."""
    if isinstance(lights, Lights):
        return [lights]
    if isinstance(lights, Iterable) and not isinstance(lights, str):
        return list(lights)
    return None


def _made_lights(groups: Iterable[Lights]) -> Any:
    made = _native.Lights()
    for group in groups:
        if not isinstance(group, Lights):
            raise _native.Error(f"lights: must be Lights or a list of them, not of {type(group).__name__}")
        made.extend(group._made())
    return made


class Renderer:
    """Renders one scene again and again, and makes anew only what changed.

    scene    "atrium" or another generated scene, a .gltf or .glb file, or a Scene
    options  those of the command line; `lights` may also be Lights or a list of them. Lights of a
             Scene or in arrays are the only ones unless `rig` or a number of lights is given, too:
             Renderer("atrium", lights=Lights(...), rig="swarm").

    Any thread may use it; calls of several threads come one after the other. Other Python threads
    run meanwhile; an interruption from the keyboard ends the call that gets it, and no other. Raises
    Error with the words of the command line.
    """

    def __init__(self, scene: str | os.PathLike[str] | Scene = "atrium", **options: Unpack[Options]) -> None:
        self._scene = scene.name if isinstance(scene, Scene) else os.fspath(scene)
        if isinstance(scene, Scene) and options.get("lights") is None and scene.lights is not None:
            options["lights"] = scene.lights
        words, lights = self._said(options, True)
        self._made = scene._native if isinstance(scene, Scene) else None
        self._native = _native.Renderer(self._scene, words, self._made, _made_lights(lights or []))
        self._options = options

    @staticmethod
    def _said(options: dict[str, Any], reads_lights: bool) -> tuple[list[str], list[Lights] | None]:
        """The options' words, and their lights in arrays; None: those so far."""
        lights = _light_list(options.get("lights"))
        words = dict(options)
        if lights is not None:
            del words["lights"]
            words.setdefault("rig", "none")
        return _words(words), (lights or []) if reads_lights else None

    def change(self, **options: Unpack[Options]) -> None:
        """Sets options: camera, lights, time, settings. None takes one back to its default. Lights whose
        arrays were edited count once they are given again: change(lights=lights).

        When it raises, everything stays as it was. The scene itself cannot change.
        """
        merged = {name: value for name, value in {**self._options, **options}.items() if value is not None}
        words, lights = self._said(merged, "lights" in options)
        self._native.change(self._scene, words, None if lights is None else _made_lights(lights))
        self._options = merged

    def render(self, time: float | None = None, *, counts: bool = False) -> Frame:
        """The picture at `time`, by default that of the options.

        `counts` fills stats["evaluations"]["useful_per_pixel"] and the stages' limits, by passes and
        measurements of their own.
        """
        made, stats = self._native.render(None if time is None else float(time), counts)
        return Frame(stats=json.loads(stats), **made)

    def probe(self, x: int, y: int) -> Probe:
        """What lights pixel (x, y) of the last picture, (0, 0) on the upper left.

        After change(), and before any picture, that of the options is made first.
        """
        return Probe(**self._native.probe(index(x), index(y)))

    def reference(self) -> Reference:
        """The float64 reference of the picture that probe() means: its own surfaces, every light.

        It has one sample a pixel, no background and no reflections; raises Error where the picture has them. Takes pixels times lights: a second for 320x180 pixels and 1000 lights on two cores.
        """
        return Reference(**self._native.reference())


def render(scene: str | os.PathLike[str] | Scene = "atrium", *, counts: bool = False, **options: Unpack[Options]) -> Frame:
    """One picture: Renderer(scene, **options).render(counts=counts)."""
    return Renderer(scene, **options).render(counts=counts)
