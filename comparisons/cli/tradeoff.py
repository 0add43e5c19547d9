"""`sheetbench tradeoff SCENE`: error against time, over models, grids and calibrations."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any

from comparisons.cli.options import ClusterOptions, Large, Models, Scene, SpringOptions, Symmetry, option
from comparisons.cli.output import PictureOptions
from sheetbench.choices import AUTO, CALIBRATION, CALIBRATIONS, INTEGRATORS, REFERENCES, listed

if TYPE_CHECKING:
    from comparisons.tradeoff.answer import Tradeoff
    from comparisons.tradeoff.motion_answer import DynamicTradeoff

GRIDS, PAIRS = "3,5,9,17,33", "5:9,9:17"
MESHES = {"plate": "8", "shell": "2,4,8,12,16", "solid": "2,4,8"}
MOVING = {"plate": "8", "shell": "2,4,8", "solid": "2,4"}  # with --duration
USUAL = f"{CALIBRATION},uniform"


def _elements(name: str, what: str) -> Any:
    """The option of a reference's meshes."""
    usual = f"default: {MESHES[name]}; {MOVING[name]} with --duration"
    return option(f"Elements of the {what} along the shorter side, or NxM; {usual}.", "ELEMENTS")


def command(
    scene: Scene,
    lattice: SpringOptions,
    grid: Annotated[
        str | None,
        option(
            "Masses of lattices: along the shorter side with near-square cells, or NxM, NxMxL. "
            f"Default: {GRIDS}; 9 with --duration.",
            "GRIDS",
            "--lumped",
            "--grid",
        ),
    ] = None,
    lumped_pair: Annotated[
        str | None,
        option(
            "Pairs of grids, the coarser first, and one answer extrapolated from both, with its error "
            f"bar. Default: {PAIRS}, none where grids or other springs are listed.",
            "PAIRS",
        ),
    ] = None,
    calibration: Annotated[
        str | None,
        option(
            f"Calibrations of every grid: {listed(CALIBRATIONS)}; auto: by the scene. Default: {USUAL}; "
            "with --duration that of `simulate`.",
            "NAMES",
        ),
    ] = None,
    plate: Annotated[str | None, _elements("plate", "linear plate")] = None,
    shell: Annotated[str | None, _elements("shell", "nonlinear shell")] = None,
    solid: Annotated[str | None, _elements("solid", "nonlinear solid")] = None,
    model: Models = None,
    symmetry: Symmetry = False,
    elements: Annotated[
        str | None,
        option(
            "Elements of the reference shell along the shorter side, or 8x4 along x and y; default: "
            "twice the finest one's, at least 32; 16 with --duration.",
            "N",
        ),
    ] = None,
    repeats: Annotated[
        int | None, option("Least number of timed solves of every row at rest.", "N", show_default="5", min=1)
    ] = None,
    duration: Annotated[
        float | None,
        option(
            "Trade-off of the motion over this time instead: lattices by integrator and step, the other "
            "models by their error per step.",
            "S",
            unit="s",
        ),
    ] = None,
    integrator: Annotated[
        str | None,
        option("With --duration: the integrators.", "NAMES", show_default=", ".join(sorted(INTEGRATORS))),
    ] = None,
    large: Large = False,
    *,
    campaign: ClusterOptions,
    output: PictureOptions,
) -> None:
    """Measure what each model of a scene gets wrong and what it costs; an interrupted run can be resumed.

    An empty list leaves a model out: --solid "".
    """
    from comparisons.comparison.comparison import load_static
    from comparisons.models.spec import items
    from comparisons.tradeoff.choices import of_motion, of_statics
    from sheetbench.errors import require_effect
    from sheetbench.scenes import load

    measure: Callable[..., Tradeoff | DynamicTradeoff]
    meshes = dict(MESHES if duration is None else MOVING)
    given = dict(zip(REFERENCES, (plate, shell, solid), strict=True))
    meshes |= {name: sizes for name, sizes in given.items() if sizes is not None}
    if duration is not None:
        statics = {"--symmetry": symmetry, "--lumped-pair": lumped_pair, "--repeats": repeats}
        require_effect("with --duration", statics)
        loaded = load(scene)
        integrators = integrator or ",".join(sorted(INTEGRATORS))
        measure = of_motion(
            loaded, duration, grid, calibration, lattice.spec, integrators, meshes, model or (), elements
        )
    else:
        require_effect("without --duration", {"--integrator": integrator})
        loaded = load_static(scene)
        calibration = calibration or (USUAL if lattice.k is None else "uniform")
        if lumped_pair is None:
            usual = grid is None and not {CALIBRATION, AUTO}.isdisjoint(items(calibration))
            lumped_pair = PAIRS if usual else ""
        grids = GRIDS if grid is None else grid
        measure = of_statics(
            loaded,
            grids,
            calibration,
            lattice.spec,
            meshes,
            models=model or (),
            symmetry=symmetry,
            elements=elements,
            repeats=repeats or 5,
            of_two=lumped_pair,
        )
    with output.open(scene=loaded) as out:
        with out.campaign(campaign) as run:
            trade = measure(**run)
        out.show(trade)
