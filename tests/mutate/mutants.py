# SPDX-License-Identifier: Apache-2.0
"""The changes that mutate.py makes to a text of OpenCL C: one place of one line."""
import re
import zlib
from collections import namedtuple

# `before` and `after`: the line, without its indentation; `text`: the whole file after the change.
Mutant = namedtuple("Mutant", "file line kind before after text")

# Binary operators stand between spaces, or at a line's end: clang-format sees to it.
SWAPS = {
    "comparison": {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "=="},
    "logic": {"&&": "||", "||": "&&", "&": "|", "|": "&", "<<": ">>", ">>": "<<"},
    "arithmetic": {"+": "-", "-": "+", "*": "+", "/": "*", "+=": "-=", "-=": "+=", "*=": "/=", "|=": "&=", "&=": "|="},
}
CALLS = {"min": "max", "max": "min", "fmin": "fmax", "fmax": "fmin", "floor": "ceil", "ceil": "floor", "fabs": "",
         "lane_not": ""}
# Calls of which the first argument alone, or two arguments in the other order, compile, too.
CLAMPS = ("min", "max", "fmin", "fmax", "clamp")
SWAPPED = {"lane_select": (1, 2), "lane_select_uint": (1, 2), "select3": (1, 2), "select": (0, 1), "sub3": (0, 1),
           "cross3": (0, 1), "lane_divide": (0, 1)}
# Components, indices and constants are so many that they would be most mutants: a fourth of them, chosen by the line's text.
KEPT_ONE_IN = 4
COMPONENTS = {"x": "y", "y": "x", "z": "y"}
# Layouts are checked where they are compiled; an array may be longer.
NO_RESULT = re.compile(r"SHARED_ASSERT|__attribute__|^\s*((local|const) )*(?!return)[a-zA-Z]\w* \w+\[[^=]*;\s*$")


def device_lines(text):
    """Numbers and texts of the lines that are code of kernels; comments are blanked."""
    skipped = []  # for each open #if: whether its branch is C++
    for number, line in enumerate(text.splitlines()):
        code = re.sub(r"//.*|/\*.*?\*/|\"[^\"]*\"", lambda m: " " * len(m.group()), line)
        directive = re.match(r"\s*#\s*(\w+)(.*)", code)
        word = directive.group(1) if directive else ""
        if word in ("if", "ifdef", "ifndef"):
            skipped.append(False)
        if word in ("if", "elif", "else"):
            skipped[-1] = bool(re.search(r"(?<!!)defined\(__cplusplus\)", directive.group(2)))
        if word == "endif":
            skipped.pop()
        macro = re.match(r"\s*#define \w+(\([^)]*\))?(?=\s+\S)", code)
        code = " " * macro.end() + code[macro.end():] if macro else code
        if not any(skipped) and (not word or macro) and not NO_RESULT.search(code):
            yield number, code


def arguments_of(code, start):
    """The ranges of a call's arguments from the place behind its bracket on; none if they go on in the next line."""
    depth, begin, found = 0, start, []
    for at in range(start, len(code)):
        if code[at] in "([{":
            depth += 1
        elif code[at] in ")]}" and depth > 0:
            depth -= 1
        elif code[at] == ")":
            return found + [(begin, at)]
        elif code[at] == "," and depth == 0:
            found.append((begin, at))
            begin = at + 1
    return []


def operator_changes(code):
    for kind, swaps in SWAPS.items():
        for match in re.finditer(r"(?<= )([-+*/<>=!&|]+)(?= |$)", code):
            if match.group() in swaps:
                yield kind, match.span(), swaps[match.group()]
    for match in re.finditer(r"(?<=[(\[])-(?=[a-z(])|(?<=[,=] )-(?=[a-z(])|(?<=return )-(?=[a-z(])", code):
        yield "sign", match.span(), ""
    for match in re.finditer(r"!(?=[a-z(])|~(?=[a-z(])", code):
        yield "negation", match.span(), ""


def call_changes(code):
    for match in re.finditer(r"\b(\w+)\(", code):
        name, places = match.group(1), arguments_of(code, match.end())
        if name in CALLS:
            yield "call", match.span(1), CALLS[name]
        if name == "fma":
            minus = code[match.end():match.end() + 1] == "-"
            yield "fma", (match.end(), match.end() + minus), "" if minus else "-"
        if name in CLAMPS and len(places) == (3 if name == "clamp" else 2):
            yield "clamp", (match.start(), places[-1][1] + 1), "(" + code[slice(*places[0])] + ")"
        if name in SWAPPED and len(places) > max(SWAPPED[name]):
            (a, b), (c, d) = (places[i] for i in SWAPPED[name])
            yield "arguments", (a, d), " " * (a > match.end()) + f"{code[c:d].strip()}, {code[a:b].strip()}"


def constant_changes(code):
    for match in re.finditer(r"\[(\w+)\]", code):
        declared = re.match(r"\s*((local|const|__constant) )*(?!return)[a-zA-Z]\w* \w+$", code[:match.start()])
        if not declared:
            yield "index", match.span(1), match.group(1) + " + 1"
    for match in re.finditer(r"(?<![\w.])(\d+)(u?)(?![\w.])", code):
        yield "integer", match.span(), str(int(match.group(1)) + 1) + match.group(2)
    for match in re.finditer(r"(?<![\w.])(\d+\.?\d*(?:e[-+]?\d+)?)f\b", code):
        value = float(match.group(1))
        # Smaller ones keep a division from 0; twice as much does that, too.
        if value == 0.0 or value > 1e-9:
            yield "float", match.span(), repr(2.0 * value) + "f" if value else "1.0f"
    for match in re.finditer(r"(?<=\.)[xyz]\b", code):
        yield "component", match.span(), COMPONENTS[match.group()]


def mutants_of(file, text):
    lines = text.split("\n")
    found = []
    for number, code in device_lines(text):
        for kind, (begin, end), new in (*operator_changes(code), *call_changes(code), *constant_changes(code)):
            if kind in ("component", "index", "integer", "float"):
                if zlib.crc32(f"{begin} {lines[number]}".encode()) % KEPT_ONE_IN:
                    continue
            after = lines[number][:begin] + new + lines[number][end:]
            whole = "\n".join(lines[:number] + [after] + lines[number + 1:])
            found.append(Mutant(file, number + 1, kind, lines[number].strip(), after.strip(), whole))
    return found
