"""What `live` answers to every pair of its panel's ends, as tests/test_matrix.py has it of `compare`."""

import json

import pytest
from matrix_rows import pairwise, require_balanced

from comparisons.live import server
from comparisons.live.panel import Panel
from comparisons.models.spec import Lattice
from sheetbench import load
from sheetbench.errors import BadInput

PANEL = Panel(load("curved-edge"), 2, Lattice(3, "uniform", k=550.0))
FEW = {"grid": (3, 4), "elements": (2, 3)}  # larger ones answer alike, later
ENDS = [
    tuple((name, value) for value in FEW.get(name, (slider.low, slider.high)))
    for name, slider in PANEL.sliders.items()
]
ROWS = pairwise([*ENDS, tuple(("calibration", name) for name in PANEL.calibrations)])


@pytest.mark.sweep(2)
@pytest.mark.parametrize("row", ROWS, ids=lambda row: " ".join(f"{name}={value}"[:24] for name, value in row))
def test_every_pair_of_ends_has_an_answer_or_a_reason(row):
    values = dict(row)
    message = json.dumps({"number": 1, "calibration": values.pop("calibration"), "values": values})
    question = PANEL.read(message)
    try:
        scene = PANEL.scene_of(question)
        solution = server.solved(scene, question)
    except BadInput as error:
        assert 0 < len(str(error)) < 300
        return
    require_balanced({**solution.document(scene), "label": solution.label})
    said = json.dumps(server.lattice(scene, question), allow_nan=False)
    assert f'"status": "{solution.status}"' in said
