"""The shape of answers: rows whose fields carry their columns, and what follows from tables and figures."""

import re
import sys
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np
import pytest
from fake_solutions import history, solution
from matplotlib.figure import Figure

import fem_reference
import sheetbench as sb
from comparisons.cli.app import verb_group
from fem_reference import statics
from fem_reference.shell.validity import STRETCHED
from sheetbench import scenes
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import NoPicture, Picture
from sheetbench.answers.solution import Status
from sheetbench.answers.table import MILLIMETRES, NUMBER, PERCENT, Column, Table


@dataclass(frozen=True)
class Row:
    """A row of every kind of field."""

    model: str
    grid: tuple[int, ...]
    moved: Annotated[Mapping[str, float], MILLIMETRES("z.3f")]
    error: Annotated[float | None, PERCENT(".2f", "off by")]
    front: Annotated[bool, Column(words=("yes", ""))]
    steps: Annotated[int, NUMBER("d", detail=True)] = 3

    @property
    def twice(self) -> Annotated[int, NUMBER("d")]:
        return 2 * self.steps


ROWS = [
    Row("a", (9, 9, 2), {"ux": 1e-3, "uz": np.float64(-2e-3)}, 0.0123, True),
    Row("b", (5, 5), {"ux": 0.0, "uz": 0.0}, None, False),
]


def compose(answer, style):
    if not answer.drawn:
        raise NoPicture("nothing moves")
    figure = Figure()
    figure.add_subplot().plot([0.0, 1.0])
    return figure


@dataclass(frozen=True, repr=False)
class Pair(Answer):
    """An answer of two rows."""

    file_name = "pair"
    drawn: bool = True

    def document(self):
        return {"rows": len(ROWS)}

    def tables(self):
        return (Table.of(Row, ROWS, "Rows", "rows"), Table.of(Row, 9 * ROWS, "Many", "many"))

    def figures(self):
        return (Picture("line", f"{__name__}:compose", (self,), formats=("svg",)),)


def test_columns_are_those_of_the_fields():
    table = Table.of(Row, ROWS, "Rows", "rows")
    head = ["model", "grid", "ux [mm]", "uz [mm]", "off by [%]", "front", "steps"]
    assert [column.header(shown=True) for column in table.columns] == head
    assert table.shown_rows()[0] == ["a", "9×9×2", "1.000", "−2.000", "1.23", "yes", "3"]
    assert table.shown_rows()[1] == ["b", "5×5", "0.000", "0.000", "–", "", "3"]
    assert table.to_csv().splitlines()[:2] == [
        "model,grid,ux [m],uz [m],off by,front,steps", "a,9×9×2,0.001,-0.002,0.0123,yes,3",
    ]  # fmt: skip
    assert "steps" in table.to_markdown()


def test_fields_are_chosen_left_out_and_properties_may_be_columns():
    chosen = Table.of(Row, ROWS, "", fields=("twice", "model"))
    assert [c.name for c in chosen.columns] == ["twice", "model"] and chosen.rows[0] == (6, "a")
    left = Table.of(Row, ROWS, "", fields=("model", "error", "front"), details=("error",))
    assert [(c.name, c.detail) for c in left.columns][1:3] == [("off by", True), ("front", False)]
    names = ["model", "grid", "moved", "off by", "front", "steps"]
    assert [c.name for c in Table.of(Row, [], "").columns] == names


def test_pandas_files_a_figure_and_a_prompt_follow_from_it(tmp_path):
    assert Pair().to_pandas().loc[0, "uz [m]"] == -2e-3 and len(Pair().to_pandas("many")) == 18
    with pytest.raises(sb.BadInput, match="tables are rows, many"):
        Pair().to_pandas("none")
    assert Pair().save(tmp_path) == () and Pair(drawn=False).save(tmp_path) == ("nothing moves",)
    assert {path.name for path in tmp_path.iterdir()} == {
        "pair.json", "pair.md", "rows.csv", "many.csv", "line.svg",
    }  # fmt: skip
    assert "… and 12 more rows" in repr(Pair())


HISTORY = replace(
    history(np.linspace(0.0, 1.0, 5), {"P1": np.ones((5, 3)), "P2": np.zeros((5, 3))}),
    reactions={"x0": np.ones((5, 3))},
)


def test_a_history_goes_on_to_pandas_and_xarray(monkeypatch):
    assert list(HISTORY.to_pandas().columns[:3]) == ["time [s]", "P1.ux [m]", "P1.uy [m]"]
    assert list(HISTORY.to_pandas("probes")["probe"]) == ["P1", "P2"]
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(sb.BadInput, match="pip install xarray"):
        HISTORY.to_xarray()


def test_a_history_is_a_dataset():
    found = HISTORY.to_xarray()
    assert float(found.displacement.sel(probe="P1", axis="z", time=1.0)) == 1.0
    assert found.displacement.attrs == {"units": "m"} and found["reaction x0"].dims == ("time", "axis")


def test_answers_of_one_model_have_tables_and_figures():
    scene = sb.load("two-edges-clamped")
    solution = sb.solve(scene, grid=3)
    assert solution.document()["status"] == "converged" and solution.report().document["model"] == "lumped"
    assert {"solution", "reactions"} <= {table.name for table in solution.tables()}
    assert [axis.get_title()[-9:] for axis in solution.figures()[0].figure().axes] == ["converged", ""]
    assert len(HISTORY.figures()[0].figure().axes) == 3
    assert list(sb.calibrate(scene, grid=3).to_pandas("moduli").columns[:2]) == ["modulus", "unit"]


def test_the_message_is_fallback_snaps_and_notes_in_a_line():
    scene = scenes.load("one-edge-clamped")
    assert solution(scene).message == ""
    found = solution(scene, snaps=(0.25, 0.56789), fallback="divided evenly", remarks=("seen", "heard"))
    assert found.message == (
        "divided evenly; snapped at load factor 0.25; snapped at load factor 0.5679; seen; heard"
    )


def test_advice_names_options_that_compare_has():
    known = {
        option
        for command in verb_group().commands.values()
        if command.name == "compare"
        for parameter in command.params
        for option in parameter.opts
    }
    named = {option for status in Status for option in re.findall(r"--[a-z-]+", status.advice)}
    assert named == {"--lumped", "--elements", "--branch"} and named <= known
    assert not any("steps" in status.advice for status in (Status.DIVERGED, Status.INVERTED))


def test_a_sheet_divided_evenly_after_all_says_so_in_a_field(monkeypatch):
    scene = scenes.load("one-edge-clamped")
    even = fem_reference.solve(scene, "shell", elements=4, graded=False)
    monkeypatch.setattr(statics, "stretched", lambda path: STRETCHED)
    found = fem_reference.solve(scene, model="shell", elements=4)
    assert found.fallback == found.message == "elements of one size, for the bending" and not even.fallback
    assert found.settings == even.settings and found.status is Status.CONVERGED
    assert found.iterations > even.iterations and len(found.history) > len(even.history)
    assert (found.displacement([scene.probes["P4"]]) == even.displacement([scene.probes["P4"]])).all()
