"""`sheetbench tradeoff SCENE`: error against time, over models, grids and calibrations."""

from __future__ import annotations

from typing import Annotated, Any

from comparisons.cli.options import ClusterOptions, Large, Models, Scene, SpringOptions, Symmetry, option
from comparisons.cli.output import PictureOptions
from comparisons.tradeoff.usual import GRIDS, MESHES, MOVING, PAIRS, REPEATS, SPRINGS
from sheetbench.choices import CALIBRATIONS, INTEGRATORS, REFERENCES, listed


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
            f"Calibrations of every grid: {listed(CALIBRATIONS)}; auto: by the scene. Default: {SPRINGS}; "
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
        int | None,
        option("Least number of timed solves of every row at rest.", "N", show_default=str(REPEATS), min=1),
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
    from comparisons.tradeoff.choices import trade

    loaded, measure = trade(
        scene,
        lattice.spec,
        grid=grid,
        lumped_pair=lumped_pair,
        calibration=calibration,
        meshes=dict(zip(REFERENCES, (plate, shell, solid), strict=True)),
        models=model or (),
        symmetry=symmetry,
        elements=elements,
        repeats=repeats,
        duration=duration,
        integrator=integrator,
        option="--",
    )
    with output.open(scene=loaded) as out:
        with out.campaign(campaign) as run:
            found = measure(**run)
        out.show(found)
