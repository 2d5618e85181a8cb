# SPDX-License-Identifier: Apache-2.0
"""Compiles the program's files with clang, without code: usage clang_syntax.py BUILD [SUBSTRING].

The units are those of BUILD/compile_commands.json (files of a room together with KILOLUX_UNITY) that do not belong to
tests, or whose names hold SUBSTRING. With KILOLUX_UNITY six of a library are compiled as one, since most of the time goes
to the headers that they share. g++'s own options and precompiled headers are left out.
"""
import concurrent.futures
import json
import os
import shlex
import subprocess
import sys

ONLY_GNU = {"-Winvalid-pch", "-Wno-subobject-linkage", "-Wno-maybe-uninitialized", "-fno-sanitize-recover=all"}


UNITS_AT_ONCE = 6


def clang_command(unit):
    words = iter(shlex.split(unit["command"])[1:])
    kept = ["clang++", "-fsyntax-only"]
    for word in words:
        if word.endswith("/g++") or word.endswith("/c++"):
            continue  # behind a launcher
        if word in ("-o", "-include"):
            next(words)
        elif word not in ("-c", unit["file"]) and word not in ONLY_GNU and not word.startswith("-fsanitize"):
            kept.append(word)
    return kept


def main():
    build, wanted = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else ""
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        units = json.load(file)
    tests = os.path.join(os.path.abspath(build), "tests")
    chosen = [u for u in units if (wanted in u["file"] if wanted else not u["file"].startswith(tests)
                                   and "/tests/" not in u["file"]) and not u["file"].endswith("cmake_pch.hxx.cxx")]
    if not chosen:
        sys.exit(f"{build}: no unit to compile")

    together = {}  # files by command and folder
    for unit in chosen:
        together.setdefault((tuple(clang_command(unit)), unit["directory"]), []).append(unit["file"])
    parts = []
    for (command, folder), files in together.items():
        step = UNITS_AT_ONCE if all("/Unity/" in file for file in files) else 1
        parts += [(command, folder, files[i:i + step]) for i in range(0, len(files), step)]

    def compile_part(part):
        command, folder, files = part
        text = "".join(f'#include "{file}"\n' for file in files)
        return subprocess.run([*command, "-x", "c++", "-"], cwd=folder, input=text, text=True, check=False).returncode

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        codes = list(pool.map(compile_part, parts))
    print(f"{len(chosen)} units, {len(codes) - codes.count(0)} of {len(codes)} parts do not compile with clang")
    sys.exit(1 if any(codes) else 0)


main()
