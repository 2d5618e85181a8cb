# SPDX-License-Identifier: Apache-2.0
"""A renderer that is kept: every picture is the one that a new renderer would make."""
import functools
import os
import signal
import subprocess
import sys
import threading
import time

import kilolux
import numpy as np
import pytest
from conftest import SMALL, read_image


def same(a, b):
    return np.array_equal(a.radiance, b.radiance) and np.array_equal(a.display, b.display)


def test_changes_give_the_pictures_of_new_renderers():
    renderer = kilolux.Renderer("grid", **SMALL)
    first = renderer.render()
    so_far = dict(SMALL)
    for change in ({"camera_position": (3, 3, 3)}, {"time": 2.0}, {"exposure": 1.0}, {"lights": 90},
                   {"resolution": (80, 40)}, {"renderer": "forward"}, {"renderer": "deferred"},
                   {"ambient": 0.5}, {"rig": "studio", "lights": None}, {"rig": None, "lights": 60}):
        renderer.change(**change)
        so_far = {name: value for name, value in {**so_far, **change}.items() if value is not None}
        assert same(renderer.render(), kilolux.render("grid", **so_far)), change
    assert not same(first, renderer.render())


@pytest.mark.parametrize("count", [129, 200])
def test_automatic_tails_follow_lights_and_shadows(count):
    lights = kilolux.Lights([[2.0 * (i % 20) - 19.0, 2.0, 2.0 * (i // 20) - 9.0] for i in range(count)], 0.01)
    options = {"resolution": (64, 48), "ambient": 0, "lights": lights, "emissive_lights": "off"}

    glow = kilolux.render("grid", **{**options, "lights": []}).radiance.sum()  # the scene's own

    @functools.cache
    def light(**more):
        return kilolux.render("grid", **options, **more).radiance.sum() - glow

    renderer = kilolux.Renderer("grid", **{**options, "lights": kilolux.Lights([[0, 2, 0]], 1.0)})
    renderer.change(lights=lights)
    for shadows in ("off", "exact", "off"):
        renderer.change(shadows=shadows)
        exact = light(tails="exact", shadows=shadows)
        assert light(tails="bounded", shadows=shadows) < 0.8 * exact, "the lights are chosen badly for this test"
        assert renderer.render().radiance.sum() - glow == pytest.approx(exact, rel=0.1)
        assert light(shadows=shadows) == pytest.approx(exact, rel=0.1)


def test_time_of_a_picture():
    renderer = kilolux.Renderer("grid", **SMALL)
    later = renderer.render(time=1.5)
    assert same(later, kilolux.render("grid", time=1.5, **SMALL))
    assert same(renderer.render(), kilolux.render("grid", **SMALL))
    assert not same(later, renderer.render())


def test_a_change_that_fails_changes_nothing():
    renderer = kilolux.Renderer("grid", **SMALL)
    before = renderer.render()
    for bad in ({"exposure": "bright"}, {"camera_index": 9}, {"lights": 70, "rig": "none", "samples": 0},
                {"clip": "walk"}, {"lights": kilolux.Lights([[0, 1, 0]], kind="area")}):
        with pytest.raises(kilolux.Error):
            renderer.change(**bad)
        assert same(renderer.render(), before), bad
    with pytest.raises(kilolux.Error, match="keeps its scene"):
        renderer.change(strict=True)
    with pytest.raises(kilolux.Error, match="--exposure: 'true' is not 'auto' or a number"):
        renderer.change(exposure=True)
    with pytest.raises(kilolux.Error, match="--list-devices is for the command line"):
        renderer.change(list_devices=True)
    with pytest.raises(kilolux.Error, match="lights: must be Lights or a list of them, not of ndarray"):
        renderer.change(lights=np.zeros((3, 3)))
    assert same(renderer.render(), before)


def test_lights_in_arrays_replace_each_other():
    random = np.random.default_rng(3)
    arrays = [kilolux.Lights(random.uniform(-3, 3, (n, 3)), random.uniform(0, 2, (n, 3)), 2.0) for n in (50, 20)]
    options = {"resolution": (64, 48), "emissive_lights": "off"}
    renderer = kilolux.Renderer("grid", lights=arrays[0], **options)
    assert renderer.render().stats["lights"] == {"given": 50, "used": 50, "rejected": 0, "dropped": 0}
    spot = kilolux.Lights([[0, 3, 0]], 40.0, 9.0, direction=(0, -2, 0), outer_cone=0.9, kind="spot")
    sun = kilolux.Lights([[0, 0, 0]], 1.0, direction=(1, -1, 0), kind="directional")
    for lights, given in ((arrays[1], 20), ([arrays[1], spot, sun], 22), ([], 0), (60, 60), (arrays[0], 50)):
        renderer.change(lights=lights)
        frame = renderer.render()
        assert frame.stats["lights"]["given"] == given
        assert same(frame, kilolux.render("grid", lights=lights, **options))
    with_swarm = kilolux.render("grid", lights=arrays[0], rig="swarm", **options)
    assert with_swarm.stats["lights"]["given"] == 5050
    dark = kilolux.Lights([[0, 1, 0], [np.nan, 0, 0]], 1.0, 2.0)
    with pytest.warns(UserWarning, match="position of light 1 is"):
        assert kilolux.render("grid", lights=dark, **options).stats["lights"]["rejected"] == 1


def test_lights_edited_in_place_count_when_they_are_given_again():
    lights = kilolux.Lights(np.array([[0.0, 1.0, 0.0]]), 1.0, 3.0)
    renderer = kilolux.Renderer("grid", lights=lights, resolution=(64, 48))
    dim = renderer.render()
    lights.intensity = 50.0
    lights.position[0, 1] = 1.5
    renderer.change(lights=lights)
    bright = renderer.render()
    assert bright.radiance.mean() > 2 * dim.radiance.mean()
    assert same(bright, kilolux.render("grid", lights=lights, resolution=(64, 48)))


def test_a_picture_shows_itself_in_a_notebook(tmp_path):
    frame = kilolux.render("grid", aov=["depth"], **SMALL)
    assert repr(frame).startswith("<Frame 64x48, ") and repr(frame).endswith(" ms, aovs: depth>")
    (tmp_path / "frame.png").write_bytes(frame._repr_png_())
    channels, codes = read_image(tmp_path / "frame.png", "uint8")
    assert channels == ["R", "G", "B", "A"]
    np.testing.assert_array_equal(codes, frame.display)


def test_surfaces_stay_while_only_lights_change():
    def stages(frame):
        return {stage["name"] for stage in frame.stats["stages"]}

    lights = [kilolux.Lights(np.random.default_rng(i).uniform(-3, 3, (30, 3)), 1.0, 2.0) for i in (1, 2)]
    renderer = kilolux.Renderer("grid", lights=lights[0], resolution=(64, 48))
    assert "resolve_surfaces" in stages(renderer.render())
    renderer.change(lights=lights[1])
    assert "resolve_surfaces" not in stages(renderer.render())
    renderer.change(camera_position=(3, 3, 3))
    assert "resolve_surfaces" in stages(renderer.render())


def test_a_probe_says_what_lights_a_pixel():
    renderer = kilolux.Renderer("grid", aov=["depth", "position", "light-count"], **SMALL)
    frame = renderer.render()
    y, x = np.unravel_index(np.argmax(frame.aovs["light-count"] * (frame.aovs["light-count"] < 1000)), (48, 64))
    probe = renderer.probe(int(x), int(y))
    assert probe.drawn and len(probe.lights["range"]) == frame.aovs["light-count"][y, x] > 0
    assert probe.depth == pytest.approx(frame.aovs["depth"][y, x])
    np.testing.assert_allclose(probe.position, frame.aovs["position"][y, x], atol=1e-4)
    assert probe.lights["position"].shape == (len(probe.lights["range"]), 3)
    distance = np.linalg.norm(probe.lights["position"] - probe.position, axis=1)
    # A list's lights reach the box of its cluster's pixels, if not this one.
    assert (distance < probe.lights["range"] + 2.0).all()
    assert same(renderer.render(), frame)
    with pytest.raises(kilolux.Error, match="pixel 64,0 is not in the picture of 64x48"):
        renderer.probe(64, 0)


def test_a_reference_in_float64_agrees():
    renderer = kilolux.Renderer("grid", **SMALL)
    reference = renderer.reference()
    assert reference.radiance.dtype == np.float64 and reference.radiance.shape == (48, 64, 3)
    radiance = renderer.render().radiance
    # Float32's rounding of some ten lights a pixel.
    assert kilolux.relmse(radiance, reference.radiance) < 1e-10
    renderer.change(camera_position=(3, 3, 3))
    assert kilolux.relmse(radiance, renderer.reference().radiance) > 1e-3


def test_a_reference_has_the_shadows_and_the_shading_of_its_picture():
    lit = kilolux.Renderer("grid", **SMALL).render().radiance
    renderer = kilolux.Renderer("grid", **SMALL, shadows="exact")
    radiance, reference = renderer.render().radiance, renderer.reference().radiance
    # Rays in float32 and float64 differ at a few edges of shadows.
    assert kilolux.relmse(lit, reference) > 1e-2
    assert np.isclose(radiance, reference, rtol=1e-4, atol=1e-6).all(axis=2).mean() > 0.99
    # Of a scene a hundredth as large, d_min is smaller, too.
    near = kilolux.Lights([[0, 0.004, 0]], intensity=1e-6)
    floor = kilolux.Mesh([[-.01, 0, -.01], [-.01, 0, .01], [.01, 0, .01], [.01, 0, -.01]], [[0, 1, 2], [0, 2, 3]])
    renderer = kilolux.Renderer(kilolux.Scene([floor], lights=near), resolution=(64, 48),
                                camera_position=(0.01, 0.02, 0.01), camera_focal_point=(0, 0, 0))
    assert kilolux.relmse(renderer.render().radiance, renderer.reference().radiance) < 1e-10


def test_a_reference_refuses_what_it_does_not_model():
    for word, options in {"samples": {"samples": 2}, "background": {"background": "0.5,0.5,0.5"},
                          "reflections": {"environment": "sky", "background": "none", "reflections": True}}.items():
        renderer = kilolux.Renderer("grid", **SMALL, **options)
        renderer.render()
        with pytest.raises(kilolux.Error, match=f"the picture has {word}, which its reference does not model"):
            renderer.reference()
        renderer.change(samples=1, background="none", reflections=False)
        assert kilolux.relmse(renderer.render().radiance, renderer.reference().radiance) < 1e-6


def test_two_renderers_in_two_threads():
    def work(scene, out):
        renderer = kilolux.Renderer(scene, **SMALL)
        out[scene] = [renderer.render(time=0.25 * i).radiance for i in range(6)]

    together, alone = {}, {}
    threads = [threading.Thread(target=work, args=(scene, together)) for scene in ("grid", "corridor")]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for scene in ("grid", "corridor"):
        work(scene, alone)
        assert len(together[scene]) == 6
        np.testing.assert_array_equal(together[scene], alone[scene])


def test_one_renderer_serves_any_thread():
    renderer = kilolux.Renderer("grid", **SMALL)
    expected = renderer.render().radiance
    frames = []
    threads = [threading.Thread(target=lambda: frames.append(renderer.render())) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(frames) == 4
    for frame in frames:
        np.testing.assert_array_equal(frame.radiance, expected)


def test_an_interruption_from_the_keyboard_ends_the_work():
    script = ("import kilolux, sys\n"
              "r = kilolux.Renderer('grid', resolution=(64, 48), lights=60)\n"
              "r.render(); print('ready', flush=True)\n"
              "try:\n"
              "    while True: r.render()\n"
              "except KeyboardInterrupt:\n"
              "    print(r.render().radiance.shape); sys.exit(7)\n")
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout.readline() == "ready\n"
        time.sleep(0.3)
        os.kill(child.pid, signal.SIGINT)
        assert child.stdout.read() == "(48, 64, 3)\n"
        assert child.wait(60) == 7


def test_a_forked_process_is_told_to_be_spawned():
    script = """
import os, kilolux
renderer = kilolux.Renderer('plain', lights=5, resolution=(16, 16))
renderer.render()
child = os.fork()
if child == 0:
    for attempt in (renderer.render, lambda: kilolux.render('plain', resolution=(16, 16))):
        try:
            attempt()
            print('rendered')
        except kilolux.Error as error:
            print(error)
else:
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120, check=True)
    lines = done.stdout.splitlines()
    assert lines[2] == "0" and all("'spawn'" in line for line in lines[:2]), done


def test_an_interruption_comes_at_once_and_ends_no_other_call():
    """The picture takes minutes; another thread's is made meanwhile, and both renderers go on."""
    script = ("import kilolux, sys, threading, time\n"
              "slow = kilolux.Renderer('grid', resolution=(320, 240), lights=20000, samples=2000,\n"
              "                        renderer='deferred-all')\n"
              "other = kilolux.Renderer('grid', resolution=(64, 48), lights=60)\n"
              "made, failed, done = [other.render()], [], []\n"
              "def work():\n"
              "    try:\n"
              "        while not done: made.append(other.render())\n"
              "    except BaseException as error: failed.append(error)\n"
              "thread = threading.Thread(target=work); thread.start()\n"
              "print('ready', flush=True)\n"
              "try:\n"
              "    while True: slow.render()\n"
              "except KeyboardInterrupt:\n"
              "    print('stopped', len(made) > 1, flush=True)\n"
              "done.append(1); thread.join()\n"
              "slow.change(resolution=(32, 24), lights=60, samples=1)\n"
              "print(len(failed), slow.render().radiance.shape)\n")
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout.readline() == "ready\n"
        time.sleep(2.0)
        start = time.monotonic()
        os.kill(child.pid, signal.SIGINT)
        assert child.stdout.readline() == "stopped True\n"
        taken = time.monotonic() - start
        assert child.stdout.readline() == "0 (24, 32, 3)\n"
        assert child.wait(120) == 0
        assert taken < 20.0
