"""The study's answer: its tables and pictures of rows, with the block and without."""

import json

import numpy as np
import pytest

from sheetbench.answers.table import unit
from studies.rubber.answer import Rubber
from studies.rubber.beam import Block, Curve, Fitted, Swing
from studies.rubber.study import STRETCHES, Constant, Square, Strip


@pytest.mark.parametrize("let_go", [False, True])
def test_every_row_is_in_the_answer(let_go):
    errors = {f"{100 * at:g} %": -at for at in STRETCHES}
    time = np.linspace(0.0, 1.0, 5)
    block = Block(
        (Swing("52 g", "measured a", 4.36, 0.059, 0.0168),),
        (Fitted("52 g", "a", 283e3, 279e3, 287e3, 0.17, 0.15, 0.19, 1.5e-3, 3.8e-3, 2.6e-3),),
        tuple(Curve("52 g", what, time, -1e-3 * time) for what in ("measured", "fitted to it")),
    )
    found = Rubber(
        (Constant("silicone", "2.50", "gent", 0.01, "shear", unit("Pa"), 15.6e3, 15.3e3, 16.0e3),),
        tuple(Strip("silicone", way, errors) for way in ("pulled", "hung")),
        (Square(0.01, 0.008, 5.436e-3, 5.482e-3, 0.0085),),
        block if let_go else None,
    )
    shown = str(found)
    assert "silicone" in shown and ("52 g" in shown) == let_go
    assert json.loads(json.dumps(found.document()))["fitted"] == found.document()["fitted"]
    drawn = [picture.figure() for picture in found.figures()]
    assert [len(one.axes) for one in drawn] == [3, 1][: 1 + let_go]
    assert [len(axis.lines) for axis in drawn[0].axes] == [1, 1, 1]
