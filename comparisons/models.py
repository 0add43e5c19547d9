"""The one place that knows both solvers: a name and settings in, a Solution out.

The solvers are imported when they are first used, so that asking for help stays quick.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING, Any

from comparisons.errors import BadInput, require_choice
from comparisons.grids import Grid, default_grid
from scenes import Material, Scene, Sheet, Solution

if TYPE_CHECKING:
    from lumped import Calibration

REFERENCES = ("plate", "shell", "solid")


def calibrate(
    sheet: Sheet,
    material: Material,
    *,
    grid: Grid | None = None,
    calibration: str = "consistent",
    k: float | None = None,
    layer_distance: float | None = None,
) -> Calibration:
    """Springs of a lattice; by default nine masses along the shorter side.

    k [N/m] and layer_distance [m] are the calibration's own options. Raises BadInput for a name that is
    not a calibration, and ValueError for settings that it cannot use.
    """
    import lumped

    require_choice("calibration", calibration, lumped.CALIBRATIONS)
    return lumped.calibrate(
        sheet,
        material,
        grid=grid or default_grid(sheet),
        method=calibration,
        k=k,
        layer_distance=layer_distance,
    )


def solve_lumped(scene: Scene, **settings: Any) -> Solution:
    """The lattice's static answer with the settings of `calibrate`, which count as set-up."""
    import lumped

    started = perf_counter()
    springs = calibrate(scene.sheet, scene.material, **settings)
    calibrating = perf_counter() - started
    solution = lumped.solve(scene, springs)
    return replace(solution, setup_seconds=solution.setup_seconds + calibrating)


def solve_reference(scene: Scene, *, model: str = "shell", elements: int = 16) -> Solution:
    """A finite-element reference's static answer; `elements` along the shorter side.

    Raises BadInput for a model or a number of elements that do not exist.
    """
    import fem_reference

    require_choice("reference", model, fem_reference.MODELS)
    if elements < 1:
        raise BadInput(f"elements = {elements}: at least 1")
    return fem_reference.solve(scene, model=model, elements=elements)


MODELS: dict[str, Callable[..., Solution]] = {
    "lumped": solve_lumped,
    **{name: partial(solve_reference, model=name) for name in REFERENCES},
}


def solve(scene: Scene, model: str, **settings: Any) -> Solution:
    """The answer of any model by its name, with that model's settings."""
    require_choice("model", model, MODELS)
    return MODELS[model](scene, **settings)
