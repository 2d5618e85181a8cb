# SPDX-License-Identifier: Apache-2.0
"""The example of the documents runs as it stands."""
import os
import re
import subprocess
import sys
from pathlib import Path


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
