#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that X.cpp defines what X.h declares: header_rules.py [ROOT].

Prints each function, and each member function of a class, that a header declares and the .cpp of
another name or folder defines, and exits with 1. Reads C++ that clang-format has formatted.
"""
import re
import sys
from pathlib import Path

ROOMS = ("host", "raster", "present")
APART = ("host/example/", "host/install/")  # not part of the program
NO_NAME = {"if", "for", "while", "switch", "return", "catch", "static_assert", "requires", "decltype", "alignas", "noexcept"}


def bare(text):
    """The text without comments, preprocessor's lines and the contents of strings."""
    text = re.sub(r'R"(\w*)\(.*?\)\1"', '""', text, flags=re.S)
    text = re.sub(r'"(?:\\.|[^"\\\n])*"|' + r"(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])'", '""', text)
    text = re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S)
    return re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", "", text, flags=re.M)


def name_of(head):
    """The function that a declaration or definition begins with; None: it is no function."""
    if re.match(r"\s*(using|typedef|friend|enum|static_assert)\b", head):
        return None
    depth = 0
    for at, sign in enumerate(head):
        if sign == "=" and depth == 0 and not re.search(r"operator\s*[=!<>+\-*/|&]?$", head[:at]):
            return None
        if sign == "(" and depth == 0:
            found = re.search(r"((?:\w+::)*(?:~?\w+|operator\s*(?:\(\)|\[\]|[^\s\w(]+|[\w:& *]+)))\s*$", head[:at])
            return None if not found or found[1] in NO_NAME else re.sub(r"\s", "", found[1])
        depth += (sign in "<{[") - (sign in ">}]")
    return None


def functions(text):
    """Pairs (name, is a definition) outside unnamed namespaces; names of members begin with their classes."""
    scopes = []  # name of a namespace's or class's scope; None: of another kind or without a name
    start = depth = 0  # of parentheses
    for at, sign in enumerate(text):
        depth += (sign == "(") - (sign == ")")
        if sign not in "{};" or depth:
            continue
        head = re.sub(r"^\s*(?:(?:public|private|protected)\s*:\s*)*", "", text[start:at])
        start = at + 1
        visible = all(scope is not None for scope in scopes)
        prefix = "".join(scope + "::" for scope in scopes if scope)
        if sign == "}":
            scopes.pop()
            continue
        head = re.sub(r"^\s*(?:template\s*<[^{;]*?>\s*(?:requires[^\n]*)?)", "template ", head)
        is_template = head.startswith("template ")
        head = head.removeprefix("template ")
        if sign == "{":
            named = re.search(r"(?:^|\s)namespace\b\s*([\w:]*)\s*$", head)
            of_class = re.match(r"\s*(?:class|struct|union)\s+(?:alignas\(\d+\)\s+)?(\w+)[^()]*$", head)
            if named:
                scopes.append("" if named[1] else None)
            elif of_class and not is_template:
                scopes.append(of_class[1])
            else:
                name = name_of(head)
                if visible and name and not is_template and not re.match(r"\s*(static|constexpr|inline)\b", head):
                    yield prefix + name, True
                scopes.append(None)
        elif visible and not is_template:
            name = name_of(head)
            if name and not re.match(r"\s*extern \"", head) and not re.search(r"=\s*(default|delete|0)\s*$", head):
                yield prefix + name, "= default" in head


def strays(root):
    declared, defined = {}, []
    for file in sorted(file for room in ROOMS for file in (root / room).rglob("*") if file.suffix in {".h", ".cpp"}):
        name = file.relative_to(root).as_posix()
        if name.startswith(APART):
            continue
        for function, is_definition in functions(bare(file.read_text())):
            if file.suffix == ".h" and not is_definition:
                declared.setdefault(function, set()).add(name)
            elif file.suffix == ".cpp" and is_definition:
                defined.append((function, name))
    for function, file in defined:
        own = re.sub("cpp$", "h", file)
        if function in declared and own not in declared[function]:
            yield f"{file}: defines {function}() of {', '.join(sorted(declared[function]))}"


def main(root):
    found = sorted(set(strays(root)))
    print("\n".join(found), end="\n" if found else "")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent)))
