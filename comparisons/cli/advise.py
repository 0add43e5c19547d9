"""`sheetbench advise SCENE`: the cheapest model that is good enough."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from comparisons.cli.options import Calibration, Large, Scene, SpringOptions, option
from comparisons.cli.output import OutputOptions


def command(
    scene: Scene,
    lattice: SpringOptions,
    tolerance: Annotated[
        float | None,
        option("Error allowed, as 0.01 or 1%; 0.01 unless a budget alone is given.", "FRACTION", unit=""),
    ] = None,
    budget: Annotated[
        float | None, option("Time allowed for a solve, set-up not included.", "SECONDS", unit="s")
    ] = None,
    models: Annotated[
        str | None,
        option("Only these: lumped, plate, shell; several with commas. Default: all.", "NAMES"),
    ] = None,
    calibration: Calibration = None,
    large: Large = False,
    *,
    output: OutputOptions,
) -> None:
    """Name the cheapest model that meets a tolerance, or the most accurate one within a budget.

    A few quick solves measure this machine and this scene. Lattices with the springs of --calibration,
    --k, --layer-distance and --grading are candidates beside the usual ones. Exit status 3 where no model
    meets the tolerance.
    """
    from comparisons.advice.advisor import advise
    from comparisons.comparison.comparison import load_static

    loaded = load_static(scene)
    with output.open(scene=loaded) as out:
        advice = advise(loaded, tolerance, budget, lattice.spec, models=models, calibration=calibration)
        out.show(replace(advice, called=scene))
