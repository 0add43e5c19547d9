"""`sheetbench tradeoff SCENE`: error against time, over models, grids and calibrations."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Annotated

import typer

from comparisons.cli import options
from comparisons.cli.options import Json, Large, Models, Out, Overwrite, Retry, Scheduler, Symmetry, Wait

if TYPE_CHECKING:
    from comparisons.tradeoff.motion import DynamicTradeoff
    from comparisons.tradeoff.statics import Tradeoff
    from sheetbench.scenes import Scene

GRIDS = "3,5,9,17,33"


def command(
    scene: options.Scene,
    lumped: Annotated[
        str | None,
        typer.Option(
            "--lumped",
            "--grid",
            metavar="GRIDS",
            help="Masses of lattices: along the shorter side with near-square cells, or NxM, NxMxL. "
            "3,5,9,17,33 unless given; with --duration one lattice, 9 unless given.",
            show_default=False,
        ),
    ] = None,
    calibration: Annotated[str, typer.Option(metavar="NAMES", help="Calibrations of every grid.")] = (
        "consistent,uniform"
    ),
    plate: Annotated[
        str,
        typer.Option(metavar="ELEMENTS", help="Elements of the linear plate along the shorter side, or NxM."),
    ] = "8",
    shell: Annotated[
        str, typer.Option(metavar="ELEMENTS", help="Elements of the nonlinear shell, likewise.")
    ] = ("2,4,8,12,16"),
    solid: Annotated[
        str, typer.Option(metavar="ELEMENTS", help="Elements of the nonlinear solid, likewise.")
    ] = ("2,4,8"),
    model: Models = None,
    symmetry: Symmetry = False,
    elements: Annotated[
        int | None,
        typer.Option(
            metavar="N", help="Elements of the reference shell; twice the finest one's, 32 at least."
        ),
    ] = None,
    repeats: Annotated[
        int, typer.Option(min=1, metavar="N", help="Timed solves of every row, at least.")
    ] = 5,
    workers: Annotated[
        int | None, typer.Option(min=1, metavar="N", help="Processes for what is not timed; one a core.")
    ] = None,
    scheduler: Scheduler = None,
    wait: Wait = False,
    duration: Annotated[
        float | None,
        typer.Option(
            metavar="S",
            help="Trade of the motion over so many seconds instead: integrators and steps, on one lattice.",
        ),
    ] = None,
    integrator: Annotated[
        str, typer.Option(metavar="NAMES", help="With --duration: the integrators.")
    ] = "generalised-alpha,midpoint,projective,verlet",
    retry: Retry = False,
    large: Large = False,
    json: Json = False,
    out: Out = None,
    overwrite: Overwrite = False,
) -> None:
    """Measure what each model of a scene gets wrong and what it costs; an interrupted run can be resumed.

    Give an empty list to leave a model out (--solid "").
    """
    import os

    from comparisons.cli.finish import finish
    from comparisons.comparison.comparison import load_static
    from comparisons.models.candidate import Candidate, items, lattices, parse_model, references
    from comparisons.tradeoff.statics import tradeoff
    from sheetbench import scenes
    from sheetbench.scenes.errors import BadInput

    measure: Callable[..., Tradeoff | DynamicTradeoff]
    if duration is not None:
        asked = scenes.load(scene)
        measure = _of_motion(asked, duration, lumped, items(integrator))
    else:
        asked = load_static(scene)
        candidates = lattices(asked.sheet, items(GRIDS if lumped is None else lumped), items(calibration))
        for name, sizes in (("plate", plate), ("shell", shell), ("solid", solid)):
            candidates += references(name, items(sizes))
        if symmetry:
            candidates = [c if c.model == "solid" else c.but(symmetry=True) for c in candidates]
        candidates += [parse_model(text) for text in model or ()]
        if not candidates:
            raise BadInput("no model left to measure")
        if elements is not None and elements < 2:
            raise BadInput(
                f"--elements = {elements}: at least 2, for the reference is solved on half as many too"
            )
        judge = Candidate("shell", {"elements": elements}) if elements is not None else None
        measure = partial(tradeoff, asked, candidates, reference=judge, repeats=repeats)
    with finish("tradeoff", json, out, overwrite, scene=asked) as end:
        with end.campaign(scheduler, wait) as (store, pool, progress):
            found = measure(
                store=store,
                workers=workers or os.cpu_count() or 1,
                pool=pool,
                retry=retry,
                large=large,
                progress=progress,
            )
        end(found.report())


def _of_motion(
    scene: Scene, duration: float, grid: str | None, integrators: list[str]
) -> Callable[..., DynamicTradeoff]:
    """The trade of a motion, integrators and steps, to be carried out through a store."""
    from comparisons.tradeoff.motion import dynamic_tradeoff
    from sheetbench.scenes.errors import BadInput

    if not duration > 0.0:
        raise BadInput(f"--duration = {duration:g}: seconds, more than 0")
    return partial(dynamic_tradeoff, scene, duration, grid=grid, integrators=integrators)
