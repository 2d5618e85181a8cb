#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes kilolux/options.py, the types of the keywords, from the program's own list of options.

make_options.py FOLDER: the package's, which holds the built module _native.
"""
import sys
from pathlib import Path

folder = Path(sys.argv[1])
sys.path.insert(0, str(folder))
import _native  # noqa: E402

TYPES = {"flag": "bool", "number": "float", "count": "int | str", "numbers": "str | Sequence[float]",
         "text": "str | PathLike[str]", "file": "str | PathLike[str]"}


def type_of(setting):
    if setting["name"] == "lights":
        return "int | str | Lights | Iterable[Lights]"
    words = "Literal[" + ", ".join(f'"{word}"' for word in setting["words"]) + "]"
    if setting["kind"] == "choice":
        return words
    if setting["kind"] == "list":
        return f"str | Sequence[{words}]" if setting["words"] else "str | Sequence[str]"
    auto = ' | Literal["auto"]' if "auto" in setting["form"] and setting["kind"] == "number" else ""
    return TYPES[setting["kind"]] + auto


lines = ['# SPDX-License-Identifier: Apache-2.0', '"""The keywords of Renderer() and render()."""',
         "from __future__ import annotations", "",
         "from collections.abc import Iterable, Sequence", "from os import PathLike",
         "from typing import Literal, TypedDict", "", "from .scene import Lights", "", "",
         "class Options(TypedDict, total=False):",
         '    """Options of `kilolux render`, with underscores for dashes. None is the default."""']
for option in _native.settings():
    if option["name"] == "scene":
        continue
    meaning = option["meaning"].replace("\\", "\\\\").replace('"', "'")
    lines += ["", f"    {option['name']}: {type_of(option)} | None", f'    """{meaning}"""']
(folder / "options.py").write_text("\n".join(lines) + "\n", encoding="utf-8")
