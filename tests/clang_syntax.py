# SPDX-License-Identifier: Apache-2.0
"""Compiles the program's files with clang, without code: usage clang_syntax.py BUILD [SUBSTRING | --alone].

The targets are those of BUILD/compile_commands.json that are no tests, or the units whose names hold SUBSTRING. The units of a
target are compiled as one file, which includes them: a warning that clang gives of main files only is not given. g++'s own options and
precompiled headers are left out.

Without SUBSTRING the files of FUZZ are compiled one by one, too, which no unit of an ordinary build has. With --alone it is
the files of ALONE, to which a unit would lend its includes. Only headers of libraries, compiled once, come before each.
"""
import collections
import concurrent.futures
import glob
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile

ONLY_GNU = {"-Winvalid-pch", "-Wno-subobject-linkage", "-Wno-maybe-uninitialized", "-fno-sanitize-recover=all"}

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FUZZ = ("tests/fuzz",)
ALONE = ("present/cli", "present/commands", "present/image", "present/video")
LIBRARIES = ("kernels/shared", "host", "present/cli", "present/image", "present/video", "present/commands")
APART = "_tests.dir/"  # files with macros of their own
ALONE_HAS = "/kilolux_present.dir/"  # in the output of the unit whose options they get


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


def files_under(folder, extension):
    return sorted(glob.glob(os.path.join(ROOT, folder, "**", "*" + extension), recursive=True))


def compile_alone(units, folders):
    """The return codes of the folders' files; none where the build has not the program."""
    like = next((u for u in units if ALONE_HAS in u.get("output", u["command"])), None)
    if like is None:
        return []
    command, includes = clang_command(like), set()
    for path in (path for folder in LIBRARIES for path in files_under(folder, ".h")):
        with open(path, encoding="utf-8") as file:
            includes |= set(re.findall(r"^#include <[\w./+-]+>", file.read(), re.M))
    with tempfile.TemporaryDirectory() as folder:
        header, compiled = os.path.join(folder, "libraries.h"), os.path.join(folder, "libraries.pch")
        with open(header, "w", encoding="utf-8") as file:
            file.write("\n".join(sorted(includes)) + "\n")
        emit = [word for word in command if word != "-fsyntax-only"]
        subprocess.run([*emit, "-x", "c++-header", header, "-o", compiled], cwd=like["directory"], check=True)

        def compile_file(path):
            return subprocess.run([*command, "-include-pch", compiled, path], cwd=like["directory"], check=False).returncode

        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            return list(pool.map(compile_file, (path for folder in folders for path in files_under(folder, ".cpp"))))


def compile_targets(units):
    """The return codes of the units' targets; those of a target are compiled as one, which reads its headers once."""
    targets = collections.defaultdict(list)
    for unit in units:
        output = (unit.get("output") or unit["command"].split(" -o ")[1]).split()[0]
        name = output if APART in output else output.split(".dir/")[0]
        targets[unit["directory"], name, tuple(clang_command(unit))].append(unit["file"])
    with tempfile.TemporaryDirectory() as folder:

        def compile_target(item):
            index, ((directory, _, command), files) = item
            joint = os.path.join(folder, f"{index}.cpp")
            with open(joint, "w", encoding="utf-8") as file:
                file.writelines(f'#include "{path}"\n' for path in sorted(files))
            return subprocess.run([*command, joint], cwd=directory, check=False).returncode

        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            return list(pool.map(compile_target, enumerate(targets.items())))


def main():
    build, wanted = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else ""
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        units = json.load(file)
    if wanted == "--alone":
        codes = compile_alone(units, ALONE)
        sys.exit(f"{build}: has no program" if not codes else 1 if any(codes) else 0)
    tests = os.path.join(os.path.abspath(build), "tests")
    chosen = [u for u in units if (wanted in u["file"] if wanted else not u["file"].startswith(tests)
                                   and "/tests/" not in u["file"]) and not u["file"].endswith("cmake_pch.hxx.cxx")]
    if not chosen:
        sys.exit(f"{build}: no unit to compile")

    codes = compile_targets(chosen)
    if not wanted:
        codes += compile_alone(units, FUZZ)
    print(f"{len(codes) - codes.count(0)} of {len(codes)} targets do not compile with clang")
    sys.exit(1 if any(codes) else 0)


main()
