"""Drawn sheets in other people's programs: CalculiX beside the shell, and what is refused by its word."""

from typing import Any

import pytest
from sheetbench_felupe import MODEL as FELUPE

import fem_reference
from comparisons.comparison.comparison import error
from comparisons.external.answer import ExternalCode
from comparisons.external.calculix.model import MODEL as CALCULIX
from comparisons.external.kratos.model import MODEL as KRATOS
from sheetbench.answers.solution import Status
from sheetbench.scenes import Clamped, Pressure, load

JUDGES: tuple[ExternalCode, ...] = (CALCULIX, KRATOS, FELUPE)
SEED = load("two-edges-clamped")
FIBRES = {"kind": "orthotropic", "young_1": 9e6, "young_2": 3e6, "poisson_12": 0.3, "shear_12": 1e6,
          "shear_23": 1e6, "angle": 0.5, "density": 1000.0}  # fmt: skip
DISC = {"circle": {"centre": (0.09, 0.1), "radius": 0.05}}
FIN = [(0.0, 0.0), (0.188, 0.05), (0.188, 0.138), (0.0, 0.188)]
DRAWINGS: dict[str, dict[str, Any]] = {
    "fin": {
        "sheet": SEED.sheet.replace(outline=FIN, taper_x=(0.003, 0.002)),
        "supports": (Clamped(edge="x0"),),
    },
    "pouch": {
        "supports": tuple(Clamped(edge=edge) for edge in ("x0", "x1", "y0", "y1")),
        "gravity": None,
        "loads": (Pressure(value=2000.0, where=DISC),),
    },
    "fibres": {
        "sheet": SEED.sheet.replace(outline=FIN),
        "material": FIBRES,
        "supports": (Clamped(edge="x0"),),
        "gravity": {"acceleration": (0.0, 0.0, -1.0)},
    },
    "slab": {
        "patches": [{"shape": {"rectangle": {"x": (0.0, 0.188), "y": (0.0, 0.1)}}, "young": 1e8}]
    },
}  # fmt: skip


@pytest.mark.sweep(4)
@pytest.mark.parametrize("drawing", DRAWINGS)
def test_the_shell_is_the_bricks_of_calculix_on_drawn_sheets(drawing):
    """Bricks of 6, 8 and 10 across are 0.56, 0.18, 0.14 % (fin) and 0.36, 0.55, 0.26 % (pouch) off a shell of
    24 elements."""
    if CALCULIX.version() is None:
        pytest.skip(f"needs {CALCULIX.needs}")
    scene = SEED.replace(**DRAWINGS[drawing], probes={})
    points = scene.probe_points()
    found = CALCULIX.solve(scene, {**CALCULIX.settings, "elements": 10})
    assert found.status is Status.CONVERGED, found.message
    off = error(
        found.displacement(points), fem_reference.solve(scene, "shell", elements=12).displacement(points)
    )
    assert off is not None and off < 0.005


@pytest.mark.parametrize("judge", JUDGES, ids=lambda judge: judge.name)
def test_a_drawn_sheet_is_refused_by_the_word_that_a_judge_does_not_know(judge):
    if judge.version() is None:
        pytest.skip(f"needs {judge.needs}")
    thick = SEED.replace(patches=[{"shape": DISC, "thickness": 0.004}])
    plies = SEED.replace(layers=[{"thickness": 0.001, "angle": a} for a in (0.0, 1.0, 0.0)], material=FIBRES)
    for scene, word in ((thick, "patch"), (plies, "layer")):
        found = judge.solve(scene, {**judge.settings, "elements": 3})
        assert found.status is Status.REFUSED and word in found.message
