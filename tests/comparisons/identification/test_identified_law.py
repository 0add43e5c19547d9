"""Values found with a shell are those of its law of strain."""

from typing import Any

import numpy as np
import pytest

import fem_reference
from comparisons.identification.identification import identify
from comparisons.identification.measurements import Displacements
from fem_reference.pulled_strip import pulled
from sheetbench import scenes
from sheetbench.errors import BadInput


def test_the_law_of_strain_that_made_the_data_finds_its_e():
    """Pulled by 5 % of E h a strip of rubber is some 10 % softer than St Venant–Kirchhoff's."""
    sheet = scenes.Sheet(length_x=0.1, length_y=0.1, thickness=0.002)
    rubber = scenes.Material(young=1e6, poisson=0.45, density=1000.0)
    strip = pulled((0.05 * 1e6 * sheet.thickness, 0.0), sheet, rubber)
    points = np.array([[0.1, 0.05], [0.1, 0.1], [0.05, 0.1]])
    shell: dict[str, Any] = {"model": "shell", "elements": 1}
    made = fem_reference.solve(strip, "shell", elements=1, law="neo-hookean").displacement(points)
    rng = np.random.default_rng(5)
    data = Displacements(points, made + rng.normal(0.0, 1e-7, made.shape))
    right = identify(strip, data, law="neo-hookean", **shell)
    assert right.unknowns["young"].value == pytest.approx(1e6, rel=1e-3)
    assert right.settings["law"] == "neo-hookean"
    wrong = identify(strip, data, **shell)
    assert wrong.unknowns["young"].value < 0.95e6
    (said,) = [one for one in wrong.warnings if "st-venant-kirchhoff" in one]
    assert "of soft silicones, which are rubbers, take --law neo-hookean" in said
    with pytest.raises(BadInput, match="law: no effect with the model lumped"):
        identify(strip, data, law="biot")
