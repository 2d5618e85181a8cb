#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Changes kernels one place at a time and asks whether the tests see it.

    mutate.py BUILD [COUNT [SEED]]  COUNT mutants (default 100), the same for one seed (default 1)
    mutate.py BUILD --only TEXT     all mutants of lines that hold TEXT
    mutate.py BUILD --selftest      that a known mutant is killed, and the unchanged kernels pass

A mutant is a copy of kernels/ and raster/ with one change, which programs of BUILD read instead of their own text
(KILOLUX_SOURCE_DIR). So only the device's side of kernels/shared is changed: the host keeps what it was built with.
A line for each mutant says which test killed it. One with which a kernel does not build counts as neither killed nor survived.
Survivors that change no result are in equivalent.txt, each with its reason. Exit status 1: another mutant survived, or one of the file cannot be made any more.
"""
import concurrent.futures
import os
import pathlib
import queue
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from mutants import mutants_of
from which_tests import steps_of

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
FOLDERS = ("shared", "device", "lights", "lists", "shading", "shadows", "surfaces", "tails", "picture")
# PoCL does not run these, see host/stages/shadows/cast_shadows.cpp; under oclgrind they take minutes.
NOT_RUN = ("cast_shadows_by_group.cl", "shadow_group.h", "area_group.h")
SECONDS = 120  # without output: an endless loop
CORES = 2  # for each mutant: tests share what PoCL and llvmpipe leave of them
WORKERS = max((os.cpu_count() or 1) // CORES, 1)  # mutants at a time
NO_BUILD = re.compile(r"build failed with CL_|: does not compile: ")


def sources():
    for folder in FOLDERS:
        yield from (path for path in sorted((ROOT / "kernels" / folder).rglob("*.*")) if path.name not in NOT_RUN)


def all_mutants():
    return [m for path in sources() for m in mutants_of(path.relative_to(ROOT).as_posix(), path.read_text())]


def chosen(mutants, count, seed):
    """Every n-th of the mutants, in random order within a file: a file's share is that of its mutants."""
    chance = random.Random(seed)
    order = sorted(mutants, key=lambda m: (m.file, chance.random()))
    step = max(len(order) / count, 1.0)
    offset = chance.random() * step
    return [order[int(offset + i * step)] for i in range(min(count, len(order)))]


def equivalents():
    """Blocks of equivalent.txt: a file, the line before (-) and after (+), the reason."""
    found = {}
    for block in (HERE / "equivalent.txt").read_text().split("\n\n"):
        lines = [line for line in block.splitlines() if not line.startswith("#")]
        if lines:
            found[lines[0], lines[1][2:], lines[2][2:]] = " ".join(lines[3:])
    return found


class Tests:
    """Runs test programs on a copy of the kernels."""

    def __init__(self, build, work):
        self.build = pathlib.Path(build).resolve()
        self.work = pathlib.Path(work)
        self.passes = {}  # of the unchanged kernels, by program and case
        self.copies = {name: self.work / name for name in ("unchanged", "mutant")}
        (self.work / "cache").mkdir(parents=True)
        for copy in self.copies.values():
            for folder in ("kernels", "raster"):
                shutil.copytree(ROOT / folder, copy / folder)

    def run(self, copy, program, cases):
        """A test's exit status and output; None: it is too slow."""
        environment = dict(os.environ, KILOLUX_SOURCE_DIR=str(self.copies[copy]), POCL_CACHE_DIR=str(self.work / "cache"),
                           POCL_MAX_PTHREAD_COUNT=str(CORES), LP_NUM_THREADS=str(CORES))
        command = [self.build / "tests" / program, f"--gtest_filter={cases}", "--gtest_fail_fast"]
        log = self.work / "log"
        with open(log, "wb") as out, subprocess.Popen(command, env=environment, stdout=out, stderr=subprocess.STDOUT,
                                                      start_new_session=True) as process:
            try:
                while process.poll() is None and time.time() - log.stat().st_mtime < SECONDS:
                    time.sleep(0.05)
            finally:
                slow = process.poll() is None
                if slow:
                    os.killpg(process.pid, signal.SIGKILL)
        return None if slow else process.returncode, log.read_text(errors="replace")

    def killed_by(self, program, cases):
        """What a step says of the mutant: the case that fails, `no build`, or an empty text."""
        status, output = self.run("mutant", program, cases)
        if status == 0:
            if "[  PASSED  ] 0 tests" in output:
                sys.exit(f"mutate: {program} has no case {cases}")
            return ""
        if NO_BUILD.search(output):
            return "no build"
        case = (re.findall(r"^\[  FAILED  \] (\S+?),? ", output, re.M)[:1] or
                re.findall(r"^\[ RUN      \] (\S+)", output, re.M)[-1:])
        if not case:
            sys.exit(f"mutate: {program} --gtest_filter={cases} does not run:\n{output}")
        if not self.unchanged_passes(program, case[0]):
            sys.exit(f"mutate: {program}: {case[0]} fails with unchanged kernels, too")
        return case[0] + ("" if status == 1 else " (too slow)" if status is None else " (crash)")

    def unchanged_passes(self, program, case):
        if (program, case) not in self.passes:
            self.passes[program, case] = self.run("unchanged", program, case)[0] == 0
        return self.passes[program, case]

    def verdict(self, mutant, steps):
        file = self.copies["mutant"] / mutant.file
        whole = file.read_text()
        file.write_text(mutant.text)
        try:
            return next(filter(None, (self.killed_by(*step) for step in steps)), "")
        finally:
            file.write_text(whole)


def stale(mutants):
    """Entries of equivalent.txt that no mutant makes."""
    made = {(m.file, m.before, m.after) for m in mutants}
    return [entry for entry in equivalents() if entry not in made]


def verdicts(mutants, build, work):
    """What the tests say of each mutant, in order, with its kind; WORKERS at a time, each with its own copy of the kernels."""
    known = equivalents()
    free = queue.SimpleQueue()
    for worker in range(WORKERS):
        free.put(Tests(build, pathlib.Path(work) / str(worker)))

    def verdict(mutant):
        if (mutant.file, mutant.before, mutant.after) in known:
            return "equivalent", ""
        tests = free.get()
        try:
            by = tests.verdict(mutant, steps_of(mutant.file))
        finally:
            free.put(tests)
        return "no build" if by == "no build" else "killed" if by else "SURVIVED", by

    with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
        yield from zip(mutants, pool.map(verdict, mutants))


def report(mutants, build, work):
    """Prints a line for each mutant; the number of survivors that are not known, and of known ones that are gone."""
    counts = dict.fromkeys(("killed", "no build", "equivalent", "SURVIVED"), 0)
    for mutant, (kind, by) in verdicts(mutants, build, work):
        counts[kind] += 1
        by = f" by {by}" if kind == "killed" else ""
        print(f"{kind}{by}: {mutant.file}:{mutant.line}\n    {mutant.before}\n    {mutant.after}", flush=True)
    gone = stale(all_mutants())
    for file, before, after in gone:
        print(f"equivalent.txt: no mutant of {file} is any more\n    {before}\n    {after}")
    print(f"{len(mutants)} mutants: " + ", ".join(f"{number} {kind}" for kind, number in counts.items()))
    return counts["SURVIVED"] + len(gone)


def selftest(tests):
    mutants = all_mutants()
    one = next(m for m in mutants if m.file == "kernels/lists/prefix_sum.cl" and m.kind == "arithmetic")
    steps = [("opencl_tests", "PrefixSum.*")]
    broken = one._replace(text=one.text + "\nint broken = ;\n")
    checks = {
        "unchanged kernels pass": tests.run("unchanged", *steps[0])[0] == 0,
        "a mutant of prefix_sum is killed": tests.verdict(one, steps).startswith("PrefixSum."),
        "a mutant that does not build is told apart": tests.verdict(broken, steps) == "no build",
        "the copy is whole again": (tests.copies["mutant"] / one.file).read_text() == (ROOT / one.file).read_text(),
        "another seed gives another choice": chosen(mutants, 100, 1) != chosen(mutants, 100, 2),
        "every file's tests are built": all((tests.build / "tests" / program).exists() for m in mutants
                                            for program, _ in steps_of(m.file)),
        "mutants of equivalent.txt can be made": not stale(mutants),
        "equivalent.txt has reasons": all(equivalents().values()),
    }
    for check, holds in checks.items():
        print("ok" if holds else "FAILED", check)
    return list(checks.values()).count(False)


def main(build, *words):
    if not (words in ((), ("--selftest",)) or words[0] == "--only" and len(words) == 2 or
            len(words) <= 2 and all(word.isdecimal() and int(word) > 0 for word in words)):
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as work:
        if words[:1] == ("--selftest",):
            return selftest(Tests(build, pathlib.Path(work) / "0")) != 0
        if words[:1] == ("--only",):
            mutants = [m for m in all_mutants() if words[1] in m.before]
        else:
            count, seed = (int(word) for word in (*words, *("100", "1")[len(words):]))
            mutants = chosen(all_mutants(), count, seed)
        return report(mutants, build, work) != 0


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
