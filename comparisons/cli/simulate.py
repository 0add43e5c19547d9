"""`sheetbench simulate SCENE`: the lattice in motion, from rest, gravity and loads on at t = 0."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from comparisons.cli.options import Grid, Json, Out, Scene, command_line

if TYPE_CHECKING:
    from comparisons.motion.history import Measured
    from sheetbench.scenes import History

FRAMES = 100


def command(
    scene: Scene,
    duration: Annotated[float, typer.Option(metavar="S", help="How long to simulate.")] = 1.0,
    step: Annotated[
        float | None,
        typer.Option(
            metavar="S", help="Time step, never exceeded; from the stability limit or the error unless given."
        ),
    ] = None,
    integrator: Annotated[
        str, typer.Option(metavar="NAME", help="generalised-alpha, verlet, midpoint or projective.")
    ] = "generalised-alpha",
    lumped: Grid = None,
    calibration: Annotated[
        str | None, typer.Option(metavar="NAME", help="consistent, uniform, …; consistent unless given.")
    ] = None,
    every: Annotated[
        float | None,
        typer.Option(metavar="S", help="Time between samples; 1/100 of the lowest period unless given."),
    ] = None,
    measured: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Measured histories, CSV: time,probe,ux,uy,uz in s and m."),
    ] = None,
    animate: Annotated[bool, typer.Option("--animate", help="Also draw an animation (with --out).")] = False,
    json: Json = False,
    out: Out = None,
) -> None:
    """Simulate the lattice from rest. With --out the run streams to a folder; the same command resumes it."""
    from comparisons.cli import console
    from comparisons.cli.app import NOT_CONVERGED
    from comparisons.models.grids import scene_grid
    from comparisons.models.registry import simulate
    from comparisons.motion import history as histories
    from comparisons.report.files import folder, to_json
    from sheetbench import scenes

    asked = scenes.load(scene)
    truth = histories.read_measured(measured, list(asked.probes)) if measured is not None else {}
    grid = scene_grid(asked, lumped)
    last = 0

    with console.progress() as progress:

        def reached(time: float) -> None:
            nonlocal last
            if (percent := int(20 * time / duration) * 5) > last:
                last = percent
                progress(f"simulated {time:.3g} of {duration:g} s ({percent} %)")

        progress("setting up …")
        history = simulate(
            asked,
            duration,
            grid=grid,
            calibration=calibration,
            step=step,
            integrator=integrator,
            every=every,
            store=folder(out) / "run" if out is not None else None,
            frames=FRAMES if out is not None else 0,
            progress=reached,
        )
        written, missing = [], None
        if out is not None:
            written, missing = _write(out, asked, history, truth, animate, progress)
    if json:
        print(to_json(histories.as_dict(history, truth)), end="")
    else:
        console.heading(asked.name, asked.title)
        console.note(f"{history.label}, {history.integrator}, {history.steps} steps")
        if history.resumed_from:
            console.note(f"went on from {history.resumed_from:.4g} s, which an earlier run had reached")
        console.show(histories.summary(history, truth))
        spread = float(abs(history.balance - history.balance[0]).max())
        scale = max(float(abs(e).max()) for e in history.energies.values())
        console.note(
            f"energy balance held to {spread / scale if scale else spread:.1e} of the largest energy"
        )
        if out is not None:
            console.note(f"Files in {out}: {', '.join(written)}")
    if missing:
        console.warn(f"No animation: {missing}")
    if history.status is not scenes.Status.CONVERGED:
        console.warn(f"{history.status}: {history.message}")
        raise typer.Exit(NOT_CONVERGED)


def _write(out, asked, history: History, truth: dict[str, Measured], animate: bool, progress):
    """Write the run's files; their names, and why there is no animation if one was asked for."""
    from comparisons.motion import frames
    from comparisons.motion import history as histories
    from comparisons.report.files import to_json, write_text
    from comparisons.report.offscreen import why_not
    from comparisons.runs.manifest import manifest

    progress("writing files …")
    settings = {"integrator": history.integrator, **history.settings}
    write_text(out / "history.json", to_json(histories.as_dict(history, truth)))
    write_text(out / "history.csv", histories.series(history).to_csv())
    write_text(out / "manifest.json", to_json(manifest(asked, settings, command_line())))
    histories.plot(out / "history.png", history, asked.title or asked.name, truth)
    shown = frames.frames(asked, history)
    frames.write_series(out / "frames.pvd", shown)
    written = ["history.json", "history.csv", "history.png", "frames.pvd", "manifest.json"]
    missing = None
    if animate:
        missing = why_not()
        if missing is None:
            progress("drawing the animation …")
            frames.animate(out / "animation.gif", asked, shown)
            written.append("animation.gif")
    return written, missing
