"""`sheetbench simulate SCENE`: the lattice in motion, from rest, gravity and loads on at t = 0."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from comparisons.cli.lattice_options import LatticeOptions
from comparisons.cli.options import Export, Large, Scene
from comparisons.cli.quantity import quantity_in
from comparisons.cli.verb import PictureOptions
from sheetbench.choices import INTEGRATOR, INTEGRATORS

FRAMES = 100


def command(
    scene: Scene,
    lattice: LatticeOptions,
    duration: Annotated[
        float, typer.Option(metavar="S", parser=quantity_in("s"), help="How long to simulate.")
    ] = 1.0,
    step: Annotated[
        float | None,
        typer.Option(
            metavar="S",
            parser=quantity_in("s"),
            help="Time step, never exceeded; from the stability limit or the error unless given.",
        ),
    ] = None,
    integrator: Annotated[
        str,
        typer.Option(
            metavar="NAME",
            help="; ".join(f"{name}: {summary}" for name, summary in INTEGRATORS.items())
            + "; auto: esdirk, or generalised-alpha where the sheet has chains.",
        ),
    ] = INTEGRATOR,
    every: Annotated[
        float | None,
        typer.Option(
            metavar="S",
            parser=quantity_in("s"),
            help="Time between samples; 1/100 of the lowest period unless given.",
        ),
    ] = None,
    measured: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Measured histories, CSV: time,probe,ux,uy,uz in s and m."),
    ] = None,
    animate: Annotated[bool, typer.Option("--animate", help="Also draw an animation (with --out).")] = False,
    export: Export = None,
    large: Large = False,
    *,
    output: PictureOptions,
) -> None:
    """Simulate the lattice from rest. With --out the run streams to a folder; the same command resumes it."""
    from comparisons.models.resolve import resolve
    from comparisons.models.solve import simulate
    from comparisons.motion.answer import Simulation
    from comparisons.motion.history import read_measured, require_within
    from comparisons.report import amounts
    from comparisons.report.work import Pace, Work
    from sheetbench import scenes
    from sheetbench.errors import BadInput

    loaded = scenes.load(scene)
    if animate and output.out is None:
        raise BadInput("--animate: needs --out, a folder to draw into")
    if animate and output.no_pictures:
        raise BadInput("--animate: draws, and --no-pictures says to draw nothing; leave one of them out")
    truth = {}
    if measured is not None:
        truth = read_measured(measured, list(loaded.probes))
        require_within(truth, duration, measured)
    model = resolve(loaded, lattice.spec, "motion")
    run = {"--integrator": integrator, **lattice.given(), "--step": step, "--every": every}
    with output.open(scene=loaded, variant=run, alone=True) as out:
        pace = Pace(duration)

        def reached(time: float) -> None:
            left = pace.left(time)
            soon = "" if left is None else f", {amounts.duration(left)} left"
            out.progress(f"simulated {time:.3g} of {duration:g} s ({100 * time / duration:.0f} %{soon})")

        out.progress(Work("setting up", model.size))
        history = simulate(
            model,
            duration,
            step=step,
            integrator=integrator,
            every=every,
            store=out.reserve("run/"),
            frames=FRAMES if output.out is not None else 0,
            progress=reached,
        )
        out.reserve("frames/")
        out.export(export, loaded, model.springs)
        out.show(Simulation(history, loaded, truth, animate))
