# SPDX-License-Identifier: Apache-2.0
"""Every option of the program is a keyword with a type, and means the same as on the command line."""
import ast
import inspect
import typing

import pytest
from kilolux import Lights, Renderer, _native, options, render
from kilolux.renderer import _words

SETTINGS = {setting["name"]: setting for setting in _native.settings()}
KEYWORDS = [name for name in SETTINGS if name != "scene"]
OTHER = {  # the keyword, and the text that it stands for
    "clip": (["none", "walk"], "none,walk"), "variant": ("red", "red"), "line_width": ("1%", "1%"),
    "resolution": ((64, 48), "64,48"), "background": ((0.5, 0.25, 0.0), "0.5,0.25,0"),
    "environment": ("sky", "sky"), "light_box": ((-1, -2, -3, 1, 2, 3), "-1,-2,-3,1,2,3"),
    "camera_index": ("auto", "auto"), "camera_position": ((1, 2, 3.5), "1,2,3.5"),
    "camera_focal_point": ((0, 1, 0.5), "0,1,0.5"), "camera_view_up": ((0, 0, 1), "0,0,1"),
    "device": ("pthread", "pthread"), "max_memory": ("1073741824", "1073741824"),
    "grid": ((8, 4, 2), "8,4,2"), "lanes": (4, "4"), "light_groups": ("a=b*,c=kind:spot", "a=b*,c=kind:spot"),
    "light_mix": ("a=2,rest=0.5:1,0.5,0.25", "a=2,rest=0.5:1,0.5,0.25"),
}


def other_value(setting):
    if setting["name"] in OTHER:
        return OTHER[setting["name"]]
    by_kind = {"flag": (True, "true"), "number": (0.75, "0.75"), "count": (9, "9")}
    if setting["kind"] in by_kind:
        return by_kind[setting["kind"]]
    word = next(word for word in setting["words"] if word != setting["value"])
    return ([word], word) if setting["kind"] == "list" else (word, word)


def values(words):
    return {setting["name"]: setting["value"] for setting in _native.settings(words)}


@pytest.mark.parametrize("name", KEYWORDS)
def test_keyword_means_what_the_command_line_says(name):
    if name in ("show", "reflections"):  # needs --reference; needs --environment
        pytest.skip("not alone")
    value, text = other_value(SETTINGS[name])
    quiet = {"quiet": False} if name == "verbose" else {}
    before = values(_words({"quiet": False}))
    after = values(_words({"quiet": False, name: value, **quiet}))
    assert after == {**before, name: text}


def test_keywords_are_typed():
    assert list(options.Options.__annotations__) == KEYWORDS
    for function in (Renderer.__init__, render, Renderer.change):
        assert inspect.signature(function).parameters["options"].annotation == "Unpack[Options]"
    types = typing.get_type_hints(options.Options, vars(options))
    assert types["exposure"] == float | typing.Literal["auto"] | None
    assert types["quiet"] == bool | None
    assert Lights in typing.get_args(types["lights"])
    assert set(SETTINGS["tonemap"]["words"]) == set(typing.get_args(typing.get_args(types["tonemap"])[0]))
    ast.parse(inspect.getsource(options))
