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
    assert frame.aovs["light-count"].max() > 0
    np.testing.assert_array_equal(frame.aovs["light-count"], exr[..., at("light-count")])
    _, png = read_image(tmp_path / "a.png", "uint8")
    assert frame.display.dtype == np.uint8 and frame.display.shape == (48, 64, 4)
    np.testing.assert_array_equal(frame.display[..., :3], png)
    assert (frame.display[..., 3] == 255).all()


def test_light_groups_add_up_to_the_picture(tmp_path):
    options = {**SMALL, "lights": 60}
    frame = kilolux.render("lanterns", light_groups="globes=*globe,swarm=from:generated", **options)
    assert list(frame.lights) == ["globes", "swarm", "rest"]
    assert all(light.shape == (48, 64, 3) and light.max() > 0 for light in frame.lights.values())
    np.testing.assert_allclose(sum(frame.lights.values()), frame.radiance, rtol=2e-6, atol=1e-7)
    assert run("render", "grid", *SMALL_WORDS, "--lights", "60", "--light-groups", "a=from:generated", "-o",
               tmp_path / "a.exr").returncode == 0
    names, exr = read_image(tmp_path / "a.exr")
    of_swarm = kilolux.render("grid", light_groups="a=from:generated", **options).lights["a"]
    np.testing.assert_array_equal(of_swarm, exr[..., [names.index(f"light.a.{c}") for c in "RGB"]])
    refused = run("render", "grid", *SMALL_WORDS, "--light-groups", "a=kind:point", "-o", tmp_path / "a.png")
    assert refused.returncode == 2 and "--light-groups: " in refused.stderr and "cannot hold layers" in refused.stderr
    with pytest.raises(kilolux.Error, match="no light is in 'a' \\(lamp\\)"):
        kilolux.render("grid", light_groups="a=lamp", **SMALL)


def test_gains_mix_the_light_of_groups(tmp_path):
    options = {**SMALL, "lights": 60, "light_groups": "globes=*globe,swarm=from:generated"}
    plain = kilolux.render("lanterns", **options)
    mix = "globes=0.5:1,0.5,0.25,swarm=2"
    renderer = kilolux.Renderer("lanterns", no_light_layers=True, **options)
    np.testing.assert_array_equal(renderer.render().radiance, plain.radiance)
    renderer.change(light_mix=mix)
    mixed = renderer.render()
    assert not mixed.lights
    factors = {"globes": np.float32([0.5, 0.25, 0.125]), "swarm": np.float32(2.0), "rest": np.float32(1.0)}
    expected = sum(factors[name] * light for name, light in plain.lights.items())
    np.testing.assert_allclose(mixed.radiance, expected, rtol=1e-5, atol=1e-6)
    whole = kilolux.render("lanterns", light_mix=mix, **options)
    np.testing.assert_array_equal(whole.radiance, mixed.radiance)
    np.testing.assert_array_equal(whole.lights["swarm"], 2.0 * plain.lights["swarm"])
    words = ["lanterns", *SMALL_WORDS, "--lights", "60", "--light-groups", options["light_groups"], "--light-mix", mix]
    assert run("render", *words, "-o", tmp_path / "a.png").returncode == 0
    _, png = read_image(tmp_path / "a.png", "uint8")
    np.testing.assert_array_equal(png, mixed.display[..., :3])
    assert run("render", *words, "--no-light-layers", "--samples", "auto", "--max-samples", "8", "-o",
               tmp_path / "b.exr").returncode == 0
    assert not [name for name in read_image(tmp_path / "b.exr")[0] if name.startswith("light.")]
    renderer.change(light_mix=None)
    np.testing.assert_array_equal(renderer.render().radiance, plain.radiance)
    with pytest.raises(kilolux.Error, match="'globe' is none of the light groups globes, swarm, rest; did you mean"):
        renderer.change(light_mix="globe=2")


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
    # The module reads the radiance, too; the program's PNG is made by shading.
    assert {stage["name"] for stage in counted["stages"]} == {stage["name"] for stage in expected["stages"]} | {"tonemap"}
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


def test_ies_profiles_have_the_bits_of_the_program(tmp_path):
    """A wall washer's web, narrower to one side, over the plain."""
    assert run("export", "plain", "--rig", "none", "-q", "-o", tmp_path / "lit.gltf").returncode == 0
    candela = "\n".join(" ".join(str(max(0, 900 - v * (4 + h / 30))) for v in range(0, 100, 10)) for h in range(0, 361, 90))
    (tmp_path / "lamp.ies").write_text(
        "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 10 5 1 2 0 0 0\n1 1 30\n0 10 20 30 40 50 60 70 80 90\n0 90 180 270 360\n" + candela)
    gltf = json.loads((tmp_path / "lit.gltf").read_text())
    gltf.setdefault("extensionsUsed", []).append("EXT_lights_ies")
    gltf.setdefault("extensions", {})["EXT_lights_ies"] = {"lights": [{"uri": "lamp.ies"}]}
    down = [-(0.5**0.5), 0, 0, 0.5**0.5]
    for x in (-2, 2):
        gltf["scenes"][0]["nodes"].append(len(gltf["nodes"]))
        gltf["nodes"].append({"translation": [x, 3, 0], "rotation": down,
                              "extensions": {"EXT_lights_ies": {"light": 0, "multiplier": 0.1}}})
    (tmp_path / "lit.gltf").write_text(json.dumps(gltf))
    settings = {"resolution": (64, 48), "rig": "none", "shadows": "exact"}
    frame = kilolux.render(str(tmp_path / "lit.gltf"), **settings)
    words = ["--resolution", "64,48", "--rig", "none", "--shadows", "exact", "-q"]
    assert run("render", tmp_path / "lit.gltf", *words, "-o", tmp_path / "a.exr").returncode == 0
    names, exr = read_image(tmp_path / "a.exr")
    np.testing.assert_array_equal(frame.radiance, exr[..., [names.index(c) for c in "RGB"]])
    every_light = kilolux.render(str(tmp_path / "lit.gltf"), renderer="deferred-all", **settings)
    np.testing.assert_array_equal(frame.radiance, every_light.radiance)
    assert np.count_nonzero(frame.radiance > 0.1) > 100
    renderer = kilolux.Renderer(str(tmp_path / "lit.gltf"), **settings)
    np.testing.assert_array_equal(renderer.render().radiance, frame.radiance)
