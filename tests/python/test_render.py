# SPDX-License-Identifier: Apache-2.0
"""Pictures in arrays are those of the program, bit for bit."""
import json

import kilolux
import numpy as np
import pytest
from conftest import SMALL, SMALL_WORDS, read_image, run


def test_arrays_hold_the_bits_of_the_files(tmp_path):
    aovs = ["depth", "normal", "light-count"]
    frame = kilolux.render("grid", aov=aovs, bloom=0.1, exposure=0.5, **SMALL)
    for file, more in (("a.exr", ["--aov", ",".join(aovs)]), ("a.png", ["--bloom", "0.1", "--exposure", "0.5"])):
        assert run("render", "grid", *SMALL_WORDS, *more, "-o", tmp_path / file).returncode == 0
    names, exr = read_image(tmp_path / "a.exr")
    at = names.index
    assert frame.radiance.dtype == np.float32 and frame.radiance.shape == (48, 64, 3)
    np.testing.assert_array_equal(frame.radiance, exr[..., [at("R"), at("G"), at("B")]])
    np.testing.assert_array_equal(frame.aovs["depth"], exr[..., at("Z")])
    np.testing.assert_array_equal(frame.aovs["normal"], exr[..., [at("N.X"), at("N.Y"), at("N.Z")]])
    assert frame.aovs["light-count"].dtype == np.uint32
    # OpenImageIO scales whole numbers of 32 bits to 0..1.
    ids = np.rint(exr[..., at("light-count")].astype(np.float64) * (2**32 - 1))
    small = ids < 2**16
    assert 0 < small.sum()
    np.testing.assert_array_equal(frame.aovs["light-count"][small], ids[small])
    _, png = read_image(tmp_path / "a.png", "uint8")
    assert frame.display.dtype == np.uint8 and frame.display.shape == (48, 64, 4)
    np.testing.assert_array_equal(frame.display[..., :3], png)
    assert (frame.display[..., 3] == 255).all()


def test_arrays_are_views_that_outlive_the_frame():
    frame = kilolux.render("grid", **SMALL)
    radiance, display = frame.radiance, frame.display
    assert not radiance.flags.owndata and not display.flags.owndata
    before = radiance.copy()
    del frame
    kilolux.render("grid", **SMALL)
    np.testing.assert_array_equal(radiance, before)


def test_stats_are_those_of_the_program(tmp_path):
    result = run("render", "grid", *SMALL_WORDS, "--stats", "-", "-o", tmp_path / "a.png")
    expected = json.loads(result.stdout)
    counted = kilolux.render("grid", counts=True, **SMALL).stats
    assert counted.keys() == expected.keys()
    assert counted["program"]["version"] == expected["program"]["version"]
    for key in ("device", "plan", "lights", "clusters", "evaluations", "tuning"):
        assert counted[key] == expected[key], key
    assert [stage["name"] for stage in counted["stages"]] == [stage["name"] for stage in expected["stages"]]
    assert kilolux.render("grid", **SMALL).stats["evaluations"]["useful_per_pixel"] is None


def test_options_are_those_of_the_command_line(tmp_path):
    frame = kilolux.render("corridor", camera_position=(-1, 1.5, 2.5), camera_focal_point=np.array([0, 1, 0]),
                           no_reuse=True, renderer="deferred-all", strict=False, time=1.5, **SMALL)
    words = ["--camera-position=-1,1.5,2.5", "--camera-focal-point=0,1,0", "--renderer", "deferred-all", "--time", "1.5"]
    assert run("render", "corridor", *SMALL_WORDS, *words, "-o", tmp_path / "a.exr").returncode == 0
    np.testing.assert_array_equal(frame.radiance, read_image(tmp_path / "a.exr")[1])


@pytest.mark.parametrize("scene, options", [
    ("grid", {"lihgts": 3}),
    ("grid", {"resolution": (0, 1)}),
    ("grid", {"camera_index": 7}),
    ("nosuch", {}),
    ("nosuch.glb", {}),
    ("grid", {"clip": "walk"}),
    ("grid", {"quiet": True, "verbose": True}),
    ("grid", {"device": "no such device"}),
])
def test_errors_carry_the_words_of_the_program(scene, options, tmp_path):
    words = [f"--{name.replace('_', '-')}" + ("" if value is True else f"={value}".strip("()").replace("(", ""))
             for name, value in options.items()]
    result = run("render", scene, *(word.replace(", ", ",") for word in words), "-o", tmp_path / "a.png")
    assert result.returncode in (1, 2)
    with pytest.raises(kilolux.Error) as caught:
        kilolux.render(scene, **options)
    assert result.stderr == f"kilolux: {caught.value}\n"
