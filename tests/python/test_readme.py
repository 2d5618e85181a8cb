# SPDX-License-Identifier: Apache-2.0
"""The example of the documents runs as it stands."""
import os
import re
import subprocess
import sys
from pathlib import Path

from conftest import run


def test_the_example_runs():
    text = Path(os.environ["KILOLUX_ROOT"], "present/python/README.md").read_text(encoding="utf-8")
    example = re.search(r"```python\n(.*?)```", text, re.DOTALL).group(1)
    assert 8 <= len([line for line in example.splitlines() if line]) <= 12
    result = subprocess.run([sys.executable, "-c", example], capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr
    equal, error = result.stdout.splitlines()
    assert equal == "True 20000"
    assert 0 < float(error) < 1e-3
    assert result.stderr == ""


def test_the_lesson_commands_run(tmp_path):
    lesson = Path(os.environ["KILOLUX_ROOT"], "present/lesson/README.md").read_text(encoding="utf-8")
    commands = re.findall(r"^kilolux (render .* -o (\w+)\.png)$", lesson, re.MULTILINE)
    assert [name for _, name in commands] == ["slices", "clusters", "active", "lights", "difference"]
    for command, name in commands:
        result = run(*command.replace("480,270", "64,36").replace(f"{name}.png", str(tmp_path / f"{name}.png")).split())
        assert result.returncode == 0, result.stderr
        assert f"({name}.jpg)" in lesson
