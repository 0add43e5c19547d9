"""`sheetbench tradeoff SCENE`: error against time, over models, grids and calibrations."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from comparisons.cli.options import Json, Out, Scene, command_line

if TYPE_CHECKING:
    from comparisons.tradeoff.statics import Tradeoff

GRIDS = "3,5,9,17,33"


def command(
    scene: Scene,
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
        str, typer.Option(metavar="ELEMENTS", help="Elements of the linear plate along the shorter side.")
    ] = "8",
    shell: Annotated[
        str, typer.Option(metavar="ELEMENTS", help="Elements of the nonlinear shell, likewise.")
    ] = ("2,4,8,12,16"),
    solid: Annotated[
        str, typer.Option(metavar="ELEMENTS", help="Elements of the nonlinear solid, likewise.")
    ] = ("2,4,8"),
    model: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME:KEY=VALUE,…", help="A plug-in with its settings; may be repeated."),
    ] = None,
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
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="A dask scheduler, as tcp://host:8786.")
    ] = None,
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
    retry: Annotated[
        bool, typer.Option("--retry", help="Run again what failed in an earlier run.", show_default=False)
    ] = False,
    json: Json = False,
    out: Out = None,
) -> None:
    """Measure what each model of a scene gets wrong and what it costs; an interrupted run can be resumed.

    Give an empty list to leave a model out (--solid "").
    """
    import os
    from tempfile import TemporaryDirectory

    from comparisons.cli import console
    from comparisons.cli.app import NOT_CONVERGED
    from comparisons.comparison.comparison import load_static
    from comparisons.models.candidate import Candidate, items, lattices, parse_model, references
    from comparisons.report.files import folder, to_json
    from comparisons.runs.campaign import campaign
    from comparisons.runs.executors import pool_of
    from comparisons.tradeoff import tables
    from comparisons.tradeoff.statics import tradeoff
    from sheetbench.scenes.errors import BadInput

    if duration is not None:
        cores = workers or os.cpu_count() or 1
        _motion(scene, duration, lumped, items(integrator), cores, scheduler, retry, json, out)
        return
    asked = load_static(scene)
    candidates = lattices(asked.sheet, items(GRIDS if lumped is None else lumped), items(calibration))
    for name, sizes in (("plate", plate), ("shell", shell), ("solid", solid)):
        candidates += references(name, items(sizes))
    candidates += [parse_model(text) for text in model or ()]
    if not candidates:
        raise BadInput("no model left to measure")
    if elements is not None and elements < 2:
        raise BadInput(
            f"--elements = {elements}: at least 2, for the reference is solved on half as many too"
        )
    reference = Candidate("shell", {"elements": elements}) if elements is not None else None
    with (
        TemporaryDirectory() as scratch,
        campaign(folder(out) if out is not None else Path(scratch)) as store,
        pool_of(scheduler) as pool,
        console.campaign_progress() as progress,
    ):
        found = tradeoff(
            asked,
            candidates,
            store,
            reference=reference,
            repeats=repeats,
            workers=workers or os.cpu_count() or 1,
            pool=pool,
            retry=retry,
            progress=progress,
        )
    written = _write(found, out) if out is not None else []
    if json:
        print(to_json(found.as_dict()), end="")
    else:
        console.heading(asked.name, asked.title)
        console.show(tables.rows(found), leave_out=("set-up", "from", "to", "factorisations", "status"))
        console.show(tables.orders(found))
        console.note(tables.explanation(found))
        if written:
            console.note(f"Files in {out}: {', '.join(written)}")
    for row in found.rows:
        if row["status"] != "converged":
            console.warn(f"{row['label']}: {row['status']}: {row['message']}")
    if found.uncertainty is None:
        console.warn(f"no errors: the reference, {found.reference['label']}: {found.reference['status']}")
        raise typer.Exit(NOT_CONVERGED)


def _motion(
    name: str,
    duration: float,
    grid: str | None,
    integrators: list[str],
    workers: int,
    scheduler: str | None,
    retry: bool,
    json: bool,
    out: Path | None,
) -> None:
    """The trade of a motion: integrators and steps."""
    from tempfile import TemporaryDirectory

    from comparisons.cli import console
    from comparisons.report.files import folder, to_json, write_text
    from comparisons.runs.campaign import campaign
    from comparisons.runs.executors import pool_of
    from comparisons.runs.manifest import manifest
    from comparisons.tradeoff.motion import dynamic_tradeoff
    from sheetbench import scenes
    from sheetbench.scenes.errors import BadInput

    if not duration > 0.0:
        raise BadInput(f"--duration = {duration:g}: seconds, more than 0")
    asked = scenes.load(name)
    with (
        TemporaryDirectory() as scratch,
        campaign(folder(out) if out is not None else Path(scratch)) as store,
        pool_of(scheduler) as pool,
        console.campaign_progress() as progress,
    ):
        found = dynamic_tradeoff(
            asked,
            duration,
            store,
            grid=grid,
            integrators=integrators,
            workers=workers,
            pool=pool,
            retry=retry,
            progress=progress,
        )
    if out is not None:
        write_text(out / "motion.json", to_json(found.as_dict()))
        write_text(out / "motion.csv", found.table().to_csv())
        write_text(out / "motion.md", found.table().to_markdown())
        write_text(out / "manifest.json", to_json(manifest(asked, {"duration": duration}, command_line())))
    if json:
        print(to_json(found.as_dict()), end="")
        return
    console.heading(asked.name, asked.title)
    console.show(found.table(), leave_out=("steps", "status"))
    for row in found.rows:
        if row["status"] != "converged":
            console.warn(f"{row['integrator']}, step {row['step']:.3g} s: {row['status']}: {row['message']}")
    known = "unknown" if found.uncertainty is None else f"{100 * found.uncertainty:.2g} %"
    console.note(f"lowest period {found.lowest_period:.4g} s; uncertainty of the reference {known}")


def _write(found: Tradeoff, out: Path) -> list[str]:
    """The trade-off's files; their names."""
    from comparisons.report.files import to_json, write_text
    from comparisons.runs.manifest import manifest
    from comparisons.tradeoff import tables
    from comparisons.tradeoff.figure import draw

    shown = [tables.rows(found), tables.orders(found)]
    settings = {"reference": found.reference["settings"]}
    title = f"# {found.scene.name}\n\n{found.scene.title}\n"
    files = {
        "tradeoff.json": to_json(found.as_dict()),
        "tradeoff.csv": shown[0].to_csv(),
        "orders.csv": shown[1].to_csv(),
        "tradeoff.md": "\n".join(
            [title, *(t.to_markdown() for t in shown), tables.explanation(found) + "\n"]
        ),
        "tradeoff.tex": "\n".join(table.to_latex() for table in shown),
        "manifest.json": to_json(manifest(found.scene, settings, command_line())),
    }
    for name, text in files.items():
        write_text(out / name, text)
    pictures = ["tradeoff.png", "tradeoff.pdf"] if any(row["error"] for row in found.rows) else []
    if pictures:
        draw(found, [out / name for name in pictures])
    return [*files, *pictures, "campaign.sqlite"]
