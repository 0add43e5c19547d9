"""`compare` in every pair of its options: scenes, grids, springs, references, more models, outputs.

Twice a month somebody finds two options that never met. Rows cover all pairs; the size and the time are
printed (`pytest -s tests/test_matrix.py`). The other verbs: test_matrix_verbs.py.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, product
from pathlib import Path

import pytest
from matrix_rows import Row, Tally, check, named, pairwise, tally

from sheetbench.choices import CALIBRATIONS

FITTED = tuple(name for name, method in CALIBRATIONS.items() if method.fitted)
SCENES = (
    *(("two-edges-clamped",), ("one-edge-clamped",), ("curved-edge",), ("curved-edge-down",)),
    *(("actuated-edge",), ("two-edges-settling",), ("{springs}",), ("{pressed}",), ("{weightless}",)),
)
GRIDS = (("--grid", "3"), ("--lumped", "3x4"), ("--grid", "3x3x3"), ("--grid", "5"))
SPRINGS = (
    (),
    *(("--calibration", name) for name in (*CALIBRATIONS, "auto")),
    ("--k", "550"),
    ("--k", "550", "--layer-distance", "0.004"),
    ("--layer-distance", "0.002"),
    *(("--grading", value) for value in ("0.4", "auto", "0.5:x0")),
    ("--calibration", "consistent-membrane", "--grading", "0.4:x0,y0"),
)
REFERENCES = (
    ("--reference", "plate"),
    ("--reference", "shell"),
    ("--reference", "shell", "--law", "biot"),
    ("--reference", "solid"),
    ("--reference", "solid", "--law", "neo-hookean"),
)
MORE = (
    (),
    ("--model", "solid:elements=2"),
    ("--model", "plate:elements=2x3", "--model", "shell:elements=2,graded=false"),
    ("--model", "lumped-pair:grid=5"),
    ("--model", "lumped:grid=3,k=550"),
    ("--model", "lumped:grid=3,linear=true"),
)
HOW = ((), ("--symmetry",), ("--uncertainty",), ("--no-uncertainty",))
OUTPUTS = (
    (),
    ("--json",),
    ("--out", "{folder}"),
    ("--out", "{folder}", "--figure", "svg:single"),
    ("--export", "{export}"),
)
ROWS = pairwise([SPRINGS, SCENES, MORE, REFERENCES, OUTPUTS, GRIDS, HOW])

FILES = {
    "springs": "[springs]\naxial = 5000.0\ndiagonal = 5000.0\ncross = 5000.0\ncross_diagonal = 5000.0\n"
    "vertical = 5000.0\nlayer_distance = 0.003\n",
    "pressed": '[[load]]\nkind = "pressure"\nvalue = 20.0\n[[load]]\nkind = "edge"\nedge = "x1"\n'
    "force_per_length = [0.1, 0.0, 0.05]\n",
    "weightless": "",
}
SHEET = """name = "{name}"
[sheet]
length_x = 0.12
length_y = 0.1
thickness = 0.003
[material]
young = 1e6
poisson = 0.4
density = 1000.0
{weight}
[[support]]
edge = "x0"
kind = "{kind}"
[[support]]
edge = "x1"
kind = "clamped"
"""
WEIGHT = "[gravity]\nacceleration = [0.0, 0.0, -9.81]\n"


@pytest.fixture(scope="module")
def places(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Files of scenes that the catalogue lacks, by the names in braces."""
    folder, found = tmp_path_factory.mktemp("scenes"), {}
    for name, more in FILES.items():
        weight, kind = ("" if name == "weightless" else WEIGHT), ("hinged" if more else "clamped")
        text = SHEET.format(name=name, weight=weight, kind=kind) + more
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
        found[name] = str(folder / f"{name}.toml")
    return found


@pytest.fixture(scope="module")
def counted() -> Iterator[Tally]:
    with tally() as found:
        yield found


def test_rows_have_every_pair() -> None:
    dimensions = [SPRINGS, SCENES, MORE, REFERENCES, OUTPUTS, GRIDS, HOW]
    wanted = sum(len(a) * len(b) for a, b in combinations(dimensions, 2))
    pairs = {(i, a, j, b) for row in ROWS for (i, a), (j, b) in combinations(enumerate(row), 2)}
    assert len(pairs) == wanted
    assert len(ROWS) < 1.5 * len(SPRINGS) * len(SCENES)
    assert {row[:2] for row in ROWS} == set(product(SPRINGS, SCENES))


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("row", ROWS, ids=named)
def test_compare(
    row: Row,
    places: dict[str, str],
    counted: Tally,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    springs, scene, *others = row
    named_places = {**places, "folder": str(tmp_path / "out"), "export": str(tmp_path / "export")}
    options = [part.format(**named_places) for part in (*springs, *(p for one in others for p in one))]
    check(
        ["compare", scene[0].format(**named_places), "--elements", "2", *options],
        counted,
        monkeypatch,
        capsys,
    )
