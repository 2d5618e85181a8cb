# SPDX-License-Identifier: Apache-2.0
"""Runs the program under test, and reads its files without code of ours."""
import os
import subprocess

import OpenImageIO
import pytest

SMALL = {"resolution": (64, 48), "lights": 60}
SMALL_WORDS = ["--resolution", "64,48", "--lights", "60", "-q"]


def run(*words):
    program = os.environ["KILOLUX_PROGRAM"]
    return subprocess.run([program, *map(str, words)], capture_output=True, text=True, check=False)


def read_image(file, kind="unknown"):
    """Channel names, and values of every channel [height, width, channels]."""
    image = OpenImageIO.ImageInput.open(str(file))
    names = image.spec().channelnames
    values = image.read_image(kind)
    image.close()
    return list(names), values


@pytest.fixture(scope="session")
def floor():
    """A floor of 4 x 4 m that faces +Y, in arrays."""
    positions = [[-2, 0, -2], [-2, 0, 2], [2, 0, 2], [2, 0, -2]]
    return positions, [[0, 1, 2], [0, 2, 3]]
