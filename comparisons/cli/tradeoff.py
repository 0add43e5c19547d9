"""`sheetbench tradeoff SCENE`: error against time, over models, grids and calibrations."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated

from comparisons.cli import options
from comparisons.cli.lattice_options import SpringOptions
from comparisons.cli.options import Large, Models, Symmetry, option
from comparisons.cli.verb import ClusterOptions, PictureOptions
from sheetbench.choices import AUTO, CALIBRATION, CALIBRATIONS, INTEGRATORS, REFERENCES, listed

if TYPE_CHECKING:
    from comparisons.tradeoff.answer import Tradeoff
    from comparisons.tradeoff.motion import DynamicTradeoff

GRIDS, PAIRS = "3,5,9,17,33", "5:9,9:17"
USUAL = f"{CALIBRATION},uniform"


def command(
    scene: options.Scene,
    lattice: SpringOptions,
    grid: Annotated[
        str | None,
        option(
            "Masses of lattices: along the shorter side with near-square cells, or NxM, NxMxL. "
            f"{GRIDS} unless given; with --duration one lattice, 9 unless given.",
            "GRIDS",
            "--lumped",
            "--grid",
        ),
    ] = None,
    lumped_pair: Annotated[
        str | None,
        option(
            "Pairs of grids, the coarser first, and one answer extrapolated from both, with its bar. "
            f"{PAIRS} unless grids or other springs are listed.",
            "PAIRS",
            "--lumped-pair",
        ),
    ] = None,
    calibration: Annotated[
        str | None,
        option(
            f"Calibrations of every grid: {listed(CALIBRATIONS)}; auto: by the scene. {USUAL} unless "
            "given; with --duration one.",
            "NAMES",
        ),
    ] = None,
    plate: Annotated[
        str, option("Elements of the linear plate along the shorter side, or NxM.", "ELEMENTS")
    ] = "8",
    shell: Annotated[str, option("Elements of the nonlinear shell, likewise.", "ELEMENTS")] = ("2,4,8,12,16"),
    solid: Annotated[str, option("Elements of the nonlinear solid, likewise.", "ELEMENTS")] = ("2,4,8"),
    model: Models = None,
    symmetry: Symmetry = False,
    elements: Annotated[
        str | None,
        option(
            "Elements of the reference shell along the shorter side, or 8x4 along x and y; twice the "
            "finest one's, 32 at least, unless given.",
            "N",
        ),
    ] = None,
    repeats: Annotated[int, option("Timed solves of every row, at least.", "N", min=1)] = 5,
    duration: Annotated[
        float | None,
        option(
            "Trade-off of integrators and steps instead: one lattice's motion over so many seconds.",
            "S",
            unit="s",
        ),
    ] = None,
    integrator: Annotated[
        str, option("With --duration: the integrators.", "NAMES", show_default=", ".join(sorted(INTEGRATORS)))
    ] = ",".join(sorted(INTEGRATORS)),
    large: Large = False,
    *,
    campaign: ClusterOptions,
    output: PictureOptions,
) -> None:
    """Measure what each model of a scene gets wrong and what it costs; an interrupted run can be resumed.

    Give an empty list to leave a model out (--solid "").
    """
    from comparisons.comparison.comparison import load_static
    from comparisons.models.spec import items
    from comparisons.tradeoff.asked import of_motion, of_statics
    from sheetbench.scenes import load

    measure: Callable[..., Tradeoff | DynamicTradeoff]
    if duration is not None:
        loaded = load(scene)
        one = lattice.spec.but(grid=grid, calibration=calibration)
        measure = of_motion(loaded, duration, one, integrator)
    else:
        loaded = load_static(scene)
        calibration = calibration or (USUAL if lattice.k is None else "uniform")
        if lumped_pair is None:
            usual = grid is None and not {CALIBRATION, AUTO}.isdisjoint(items(calibration))
            lumped_pair = PAIRS if usual else ""
        grids = GRIDS if grid is None else grid
        meshes = dict(zip(REFERENCES, (plate, shell, solid), strict=True))
        measure = of_statics(
            loaded,
            grids,
            calibration,
            lattice.spec,
            meshes,
            models=model or (),
            symmetry=symmetry,
            elements=elements,
            repeats=repeats,
            of_two=lumped_pair,
        )
    with output.open(scene=loaded) as out:
        with out.campaign(campaign) as run:
            trade = measure(**run)
        out.show(trade)
