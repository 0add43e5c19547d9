"""Verbs that ask one lattice in every pair of their options, as test_matrix.py has it for `compare`.

Fits are met by `calibrate`, on every scene and grid.
"""

import pytest
from matrix_options import GRIDS, OUTPUTS, SCENES, SPRINGS
from matrix_rows import named, pairwise

from sheetbench.choices import CALIBRATIONS, INTEGRATORS, MASSES

LITTLE = (("--json",), ("--out", "{folder}"), ())
EVERY_SCENE = SCENES[1:]
METHODS = tuple(("--calibration", name) for name in (*CALIBRATIONS, "auto"))
VERBS: dict[str, list[tuple[tuple[str, ...], ...]]] = {
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
    "simulate": [
        (*((("--integrator", name)) for name in (*INTEGRATORS, "auto", "reduced")),),
        EVERY_SCENE,
        SPRINGS[1::3],
        ((), ("--step", "1e-4"), ("--every", "1e-3")),
        OUTPUTS[1:],
        GRIDS[:3],
    ],
    "calibrate": [
        METHODS,
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
MORE = {
    "simulate": ("--duration", "0.002"),
    "calibrate": ("--young", "1e6", "--poisson", "0.4", "--thickness", "0.003"),
}
ROWS = [(verb, row) for verb, dimensions in VERBS.items() for row in pairwise(dimensions)]


@pytest.mark.parametrize(("verb", "row"), ROWS, ids=[f"{verb} {named(row)}" for verb, row in ROWS])
def test_verb(verb, row, ends):
    ends(*verb.split(), *(part for one in row for part in one), *MORE.get(verb, ()))
