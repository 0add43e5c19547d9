"""The path tracer on thirty lattices: the displacements that there were, in as few factorisations.

Displacements within 1e-9 of the largest follow from residuals of 1e-11 of the forces; what rounding leaves is
more in single precision, whose forces have seven digits. Two rows are this tracer's own: two clamps pushed
2 mm together, which the one before left flat and unstable, and 20 mm, where the sheet snaps earlier.
"""

import json

import numpy as np
import pytest
from thirty_scenes import FILE, NAMES, answer

from sheetbench.scenes import catalogue

BEFORE = json.loads(FILE.read_text(encoding="utf-8"))
WITHIN = {"single precision": 1e-4}  # of the largest displacement


def test_the_table_has_every_scene_of_the_catalogue():
    assert list(BEFORE) == NAMES and set(catalogue()) < BEFORE.keys()


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name", NAMES)
def test_the_answer_stays_and_costs_no_more(name):
    found, before = answer(name), BEFORE[name]
    displacement, known = np.array(found.pop("displacement")), np.array(before["displacement"])
    np.testing.assert_allclose(
        displacement, known, rtol=0.0, atol=WITHIN.get(name, 1e-9) * np.abs(known).max()
    )
    assert (found["status"], found["load_factor"]) == (before["status"], before["load_factor"])
    np.testing.assert_allclose(found["snaps"], before["snaps"], atol=0.02)
    assert found["factorisations"] <= before["factorisations"] + (name not in catalogue())
