"""Verbs that solve one scene in every pair of their options: scenes, grids, springs, references, outputs.

Twice a month somebody finds two options that never met. Rows cover all pairs; the size and the time are
printed (`pytest -s tests/test_matrix.py`). Fits are met by `calibrate`, on every scene and grid; the other
verbs: test_matrix_small.py.
"""

from itertools import combinations, product

import pytest
from matrix_options import GRIDS, OUTPUTS, SCENES, SPRINGS
from matrix_rows import named, pairwise

from sheetbench.choices import CALIBRATIONS, INTEGRATORS, MASSES

OWN = SPRINGS[::2]  # state spaces have the others
LITTLE = (("--json",), ("--out", "{folder}"), ())
EVERY_SCENE = SCENES[1:]
VERBS: dict[str, list[tuple[tuple[str, ...], ...]]] = {
    "compare --elements 2": [
        OWN,
        SCENES,
        (
            (),
            ("--model", "solid:elements=2"),
            ("--model", "plate:elements=2x3", "--model", "shell:elements=2,graded=false"),
            ("--model", "lumped-pair:grid=5"),
            ("--model", "lumped:grid=3,k=550"),
            ("--model", "lumped:grid=3,linear=true"),
        ),
        (
            ("--reference", "plate"),
            ("--reference", "shell"),
            ("--reference", "shell", "--law", "biot"),
            ("--reference", "solid", "--law", "neo-hookean"),
        ),
        OUTPUTS,
        GRIDS,
        ((), ("--uncertainty",), ("--no-uncertainty",)),
    ],
    "modes": [
        SPRINGS[::3],
        EVERY_SCENE,
        ((), ("--about", "deformed")),
        ((), *(("--masses", name) for name in MASSES)),
        (
            ("--reference", "plate", "--elements", "2"),
            ("--reference", "shell", "--elements", "2x3"),
            ("--reference", "solid", "--elements", "2"),
        ),
        LITTLE,
        (("--grid", "3"), ("--grid", "3x4"), ("--grid", "3x3x3")),
        (("--count", "2"), ("--count", "12")),
    ],
    "modes --state-space": [
        SPRINGS[1::2],
        EVERY_SCENE,
        (("3",), ("0",), ("4", "--reduce", "balanced:2")),
        ((), ("--about", "flat")),
        LITTLE,
        GRIDS[:3],
    ],
    "simulate --duration 0.002": [
        tuple(("--integrator", name) for name in (*INTEGRATORS, "auto", "reduced")),
        EVERY_SCENE,
        SPRINGS[1::3],
        ((), ("--step", "1e-4"), ("--every", "1e-3")),
        OUTPUTS[1:],
        GRIDS[:3],
    ],
    "calibrate --young 1e6 --poisson 0.4 --thickness 0.003": [
        tuple(("--calibration", name) for name in (*CALIBRATIONS, "auto")),
        (("two-edges-clamped",), ("curved-edge",), ("{springs}",), ("{weightless}",), ("--side", "0.1")),
        (("--grid", "3"), ("--grid", "3x4"), ("--grid", "3x3x3")),
        ((), ("--k", "550"), ("--layer-distance", "0.002"), ("--grading", "0.4"), ("--grading", "auto")),
        (*OUTPUTS[1:3], ("--toml",), ("--export", "{export}"), ("--out", "{folder}", "--for", "mujoco")),
    ],
    "tradeoff": [
        (("one-edge-clamped",), ("{weightless}",)),
        (("--tolerance", "0.9"), ("--budget", "5ms")),
        (("--json",), ()),
    ],
    "check": [EVERY_SCENE, LITTLE],
}
ROWS = {verb: pairwise(dimensions) for verb, dimensions in VERBS.items()}


def test_rows_have_every_pair():
    dimensions, rows = VERBS["compare --elements 2"], ROWS["compare --elements 2"]
    wanted = sum(len(a) * len(b) for a, b in combinations(dimensions, 2))
    assert len({(i, a, j, b) for row in rows for (i, a), (j, b) in combinations(enumerate(row), 2)}) == wanted
    assert len(rows) < 1.5 * len(OWN) * len(SCENES)
    assert {row[:2] for row in rows} == set(product(OWN, SCENES))


@pytest.mark.parametrize(
    ("verb", "row"),
    [pytest.param(verb, row, id=f"{verb} {named(row)}") for verb, rows in ROWS.items() for row in rows],
)
def test_verb(verb, row, ends):
    ends(*verb.split(), *(part for one in row for part in one))
