#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks sizes: size_rules.py [ROOT]. Prints what is too large and exits with 1.

A folder with code has at most 30 files; one of results alone has a file for each measurement. A
call or declaration of the launchers and kernels has at most 8 arguments: what belongs together goes
as a struct, and in kernels as a macro of arguments.
"""
import re
import sys
from pathlib import Path

MOST_FILES = 30
MOST_ARGUMENTS = 8
CODE = {".h", ".cpp", ".cl", ".glsl", ".frag", ".vert", ".py"}
LAUNCHERS = ("host/stages/", "host/lighting/", "host/surfaces/", "host/render/", "kernels/")
NOT_OURS = {"enqueueCopyBufferRect"}  # OpenCL's


def crowded(root):
    for room in ("host", "kernels", "raster", "present", "tests"):
        for folder in sorted({file.parent for file in (root / room).rglob("*") if file.suffix in CODE}):
            count = sum(file.is_file() for file in folder.iterdir())
            if "__pycache__" not in folder.parts and count > MOST_FILES:
                yield f"{folder.relative_to(root)}: {count} files, at most {MOST_FILES}"


def long_lists(name, text):
    text = re.sub(r'"(\\.|[^"\\\n])*"' + r"|'(\\.|[^'\\\n])'", '""', text)
    text = re.sub(r"//[^\n]*", "", text)
    open_at = []  # brackets: [place, commas]
    for at, sign in enumerate(text):
        if sign in "([{":
            open_at.append([at, 0])
        elif sign == "," and open_at:
            open_at[-1][1] += 1
        elif sign in ")]}" and open_at:
            start, commas = open_at.pop()
            if text[start] != "(" or commas < MOST_ARGUMENTS:
                continue
            called = re.search(r"(\w+)\s*$", text[:start])
            if not called or called[1] in NOT_OURS:
                continue
            line = text.count("\n", 0, start) + 1
            yield f"{name}:{line}: {called[1]}: {commas + 1} arguments, at most {MOST_ARGUMENTS}"


def main(root):
    found = list(crowded(root))
    for file in sorted(root.rglob("*")):
        name = file.relative_to(root).as_posix()
        if name.startswith(LAUNCHERS) and file.suffix in {".h", ".cpp", ".cl"}:
            found += long_lists(name, file.read_text())
    print("\n".join(found), end="\n" if found else "")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent)))
