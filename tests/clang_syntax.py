# SPDX-License-Identifier: Apache-2.0
"""Compiles the program's files with clang, without code: usage clang_syntax.py BUILD [SUBSTRING].

The units are those of BUILD/compile_commands.json (files of a room together with KILOLUX_UNITY) that do not belong to
tests, or whose names hold SUBSTRING. g++'s own options and precompiled headers are left out.
"""
import concurrent.futures
import json
import os
import shlex
import subprocess
import sys

ONLY_GNU = {"-Winvalid-pch", "-Wno-subobject-linkage", "-Wno-maybe-uninitialized", "-fno-sanitize-recover=all"}


def clang_command(command):
    words = iter(shlex.split(command)[1:])
    kept = ["clang++", "-fsyntax-only"]
    for word in words:
        if word.endswith("/g++") or word.endswith("/c++"):
            continue  # behind a launcher
        if word == "-o" or (word == "-include"):
            next(words)
        elif word != "-c" and word not in ONLY_GNU and not word.startswith("-fsanitize"):
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

    def compile_unit(unit):
        return subprocess.run(clang_command(unit["command"]), cwd=unit["directory"], check=False).returncode

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        codes = list(pool.map(compile_unit, chosen))
    print(f"{len(codes)} units, {len(codes) - codes.count(0)} do not compile with clang")
    sys.exit(1 if any(codes) else 0)


main()
