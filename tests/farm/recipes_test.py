# SPDX-License-Identifier: Apache-2.0
"""The commands of the recipes that no engine runs here: recipes_test.py KILOLUX RECIPES"""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

PROGRAM, RECIPES = sys.argv[1], Path(sys.argv[2])
VALUES = {"Param.Scene": "grid", "Param.Frames": "3", "Task.Param.Frame": "3", "Param.Resolution": "64,36"}
INDICES = {"SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX", "AWS_BATCH_JOB_ARRAY_INDEX", "OMPI_COMM_WORLD_RANK", "PARALLEL_SEQ"}
ENGINES = {  # file: environment of a task, names of its files, a line that it prints
    "openjd_template.yaml": ({}, {"frame.0003.exr"}, "openjd_progress: 100.0"),
    "kubernetes_job.yaml": ({"JOB_COMPLETION_INDEX": "1"}, {"frame.0001.png"}, "shard 1/8 by JOB_COMPLETION_INDEX"),
}

for name, (variables, files, line) in ENGINES.items():
    with tempfile.TemporaryDirectory() as folder:
        text = (RECIPES / name).read_text(encoding="utf-8")
        listed = re.search(r"args: \[([^\]]*)\]", text).group(1)
        words = [word.strip().strip('"') for word in re.findall(r'"[^"]*"|[^,]+', listed) if word.strip()]
        values = VALUES | {"Param.Folder": folder}
        words = [re.sub(r"\{\{([^}]*)\}\}", lambda found: values[found.group(1)], word) for word in words]
        words = ["grid" if word == "/work/scene.glb" else word.replace("/work", folder) for word in words]
        words = ["0:7" if word == "0:239" else word for word in words]
        mine = {key: value for key, value in os.environ.items() if key not in INDICES}
        ran = subprocess.run([PROGRAM, *words, "--lights", "9", "--resolution", "64,36"], capture_output=True, text=True,
                             check=False, env=mine | variables)
        assert ran.returncode == 0, f"{name}: {ran.stderr}"
        assert set(os.listdir(folder)) == files, f"{name}: {os.listdir(folder)}"
        assert line in ran.stdout + ran.stderr, f"{name}: {ran.stdout}{ran.stderr}"
