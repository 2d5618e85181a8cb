# SPDX-License-Identifier: Apache-2.0
"""The notebook's cells run in their order, without Jupyter, and what it says of the results holds."""
import json
import os
from pathlib import Path

import kilolux
import numpy as np
import pytest

os.environ["MPLBACKEND"] = "Agg"  # where there is matplotlib, it opens no window
NOTEBOOK = json.loads(Path(os.environ["KILOLUX_ROOT"], "present/python/tour.ipynb").read_text(encoding="utf-8"))
CODE = [cell for cell in NOTEBOOK["cells"] if cell["cell_type"] == "code"]


@pytest.fixture(scope="module")
def tour():
    """The names that the cells leave behind."""
    names = {"__name__": "__main__"}
    for cell in CODE:
        exec(compile("".join(cell["source"]), f"tour.ipynb: {cell['id']}", "exec"), names)
    return names


def test_no_outputs_are_stored():
    assert len(CODE) >= 5
    for cell in CODE:
        assert cell["outputs"] == [] and cell["execution_count"] is None, cell["id"]


def test_lists_are_short(tour):
    assert tour["frame"].radiance.shape == (180, 320, 3)
    assert tour["drawn"].mean() > 0.5
    assert 0 < tour["listed"][tour["drawn"]].mean() < 500


def test_only_lights_are_made_anew(tour):
    assert tour["stages"][0] and "resolve_surfaces" not in tour["stages"][-1]
    first, *_, last = tour["moved"]
    assert first.stats["lights"]["used"] == 2000
    assert not np.array_equal(first.radiance, last.radiance)


def test_errors_are_as_the_text_says(tour):
    assert tour["picture"].max() > 0.1
    assert tour["same"]
    assert 0 < tour["error"] < 1e-10
    assert kilolux.relmse(1.01 * tour["picture"], tour["reference"].radiance) > 1e-10


def test_a_pixel_by_hand(tour):
    assert len(tour["probe"].lights["range"]) > 0
    np.testing.assert_allclose(tour["picture"][tour["y"], tour["x"]], tour["by_hand"], rtol=1e-4)


def test_the_gbuffer_is_lit_as_by_hand(tour):
    lit = tour["lit"]
    assert lit.radiance.shape == (120, 200, 3)
    assert tour["expected"].min() > 0
    np.testing.assert_allclose(lit.radiance[tour["here"]], tour["expected"], rtol=1e-4)
    assert 0 < lit.covering.mean() <= lit.evaluated.mean() < 500
    background = ~np.isfinite(tour["depth"])
    assert background.any() and lit.radiance[background].max() == 0
