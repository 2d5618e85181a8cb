# SPDX-License-Identifier: Apache-2.0
"""host/example/light_exr lights the EXR of another renderer: ours, under Blender's names."""
import os
import subprocess

import kilolux
import numpy as np
import OpenImageIO
import pytest
from conftest import read_image, run

DEGREES = "50"
BLENDER = {"Z": "ViewLayer.Depth.Z", "N.X": "ViewLayer.Normal.X", "N.Y": "ViewLayer.Normal.Y",
           "N.Z": "ViewLayer.Normal.Z", "albedo.R": "ViewLayer.Denoising Albedo.R",
           "albedo.G": "ViewLayer.Denoising Albedo.G", "albedo.B": "ViewLayer.Denoising Albedo.B"}


def light_exr(*words):
    program = os.path.join(os.environ["EXAMPLES"], "light_exr")
    return subprocess.run([program, *map(str, words)], capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def lights():
    random = np.random.default_rng(8)
    return kilolux.Lights(random.uniform((-4, 0, -4), (4, 3, 4), (400, 3)), random.uniform(0, 3, (400, 3)), 2.0)


@pytest.fixture(scope="module")
def csv(lights, tmp_path_factory):
    file = tmp_path_factory.mktemp("lights") / "lights.csv"
    rows = np.hstack([lights.position, np.full((400, 1), 2.0), lights.intensity])
    file.write_text("# x,y,z,range,red,green,blue\n" + "".join(",".join(map(repr, row)) + "\n" for row in rows.tolist()))
    return file


CAMERA = {"camera_position": (4, 2.5, 6), "camera_focal_point": (0, 0.5, 0), "camera_view_angle": DEGREES}


@pytest.fixture(scope="module")
def gbuffers(tmp_path_factory):
    """An EXR by our names, and the same by Blender's."""
    folder = tmp_path_factory.mktemp("gbuffers")
    words = [f"--{name.replace('_', '-')}=" + (value if isinstance(value, str) else ",".join(map(str, value)))
             for name, value in CAMERA.items()]
    result = run("render", "grid", "--resolution", "97,64", "--lights", "9", "--gbuffer", "full", "-q", *words, "--aov",
                 "depth,normal,albedo", "-o", folder / "ours.exr")
    assert result.returncode == 0, result.stderr
    buffer = OpenImageIO.ImageBuf(str(folder / "ours.exr"))
    names = tuple(BLENDER.get(name, f"ViewLayer.Combined.{name}") for name in buffer.spec().channelnames)
    renamed = OpenImageIO.ImageBufAlgo.channels(buffer, tuple(range(len(names))), newchannelnames=names)
    assert renamed.write(str(folder / "blender.exr")), renamed.geterror()
    return folder


@pytest.mark.parametrize("names", ["ours", "blender"])
def test_lights_as_the_renderer_does(names, gbuffers, csv, lights, tmp_path):
    result = light_exr(gbuffers / f"{names}.exr", csv, tmp_path / "lit.exr", DEGREES)
    assert result.returncode == 0, result.stderr
    assert result.stdout == "400 lights, 97x64 pixels\n"
    channels, lit = read_image(tmp_path / "lit.exr")
    assert channels == ["R", "G", "B"]
    frame = kilolux.render("grid", lights=lights, resolution=(97, 64), gbuffer="full", shading="lambert", ambient=0,
                           aov=["emissive"], **CAMERA)
    expected = frame.radiance - frame.aovs["emissive"]
    assert expected.max() > 0.1
    close = np.isclose(lit, expected, rtol=1e-3, atol=1e-4).all(axis=2)
    assert close.mean() > 0.99


def test_errors_are_one_line(gbuffers, csv, tmp_path):
    bad = tmp_path / "bad.csv"
    bad.write_text("0,1,2,3,4,5,6\n0,1,2,3,4,five,6\n")
    dark, more = tmp_path / "dark.csv", tmp_path / "more.csv"
    dark.write_text("0,1,2,nan,4,5,6\n")
    more.write_text("0,1,2,3,4,5,6,7\n")
    ours, lit = gbuffers / "ours.exr", tmp_path / "lit.exr"
    for words, said in (((ours, bad, lit, DEGREES), "bad.csv: line 2: '0,1,2,3,4,five,6' is not x,y,z"),
                        ((ours, dark, lit, DEGREES), "dark.csv: line 1: '0,1,2,nan,4,5,6' is not x,y,z,range > 0"),
                        ((ours, more, lit, DEGREES), "more.csv: line 1: '0,1,2,3,4,5,6,7' is not"),
                        ((ours, csv, lit, "wide"), "DEGREES must be between 0 and 180"),
                        ((ours, tmp_path / "none.csv", lit, DEGREES), "none.csv: cannot be read"),
                        ((tmp_path / "none.exr", csv, lit, DEGREES), "none.exr"),
                        ((ours, csv), "usage: light_exr")):
        result = light_exr(*words)
        assert result.returncode == 1
        assert said in result.stderr and result.stderr.count("\n") == 1, result.stderr
        assert not lit.exists()
