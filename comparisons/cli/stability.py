"""`sheetbench stability`: maps of where each solver holds, degrades, refuses or breaks."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from comparisons.cli.options import Json, Out, command_line

if TYPE_CHECKING:
    from comparisons.stability.study import Row, Study


def command(
    study: Annotated[
        list[str] | None,
        typer.Option(
            "--study",
            metavar="NAME",
            help="Only this study, may be repeated: time-step, stiffness, slenderness, grid, load, damping, "
            "mass or curved-edge. All unless given.",
            show_default=False,
        ),
    ] = None,
    full: Annotated[bool, typer.Option("--full", help="Every cell: finer maps, grids to 257 × 257.")] = False,
    workers: Annotated[
        int | None, typer.Option(min=1, metavar="N", help="Cells measured side by side; one a core.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="A dask scheduler, as tcp://host:8786.")
    ] = None,
    retry: Annotated[
        bool, typer.Option("--retry", help="Run again what failed in an earlier run.", show_default=False)
    ] = False,
    json: Json = False,
    out: Out = None,
) -> None:
    """Measure the cells of every study, in the order of docs/stability.md; an interrupted run can be resumed.

    Every cell ends in a status. With --out the maps, tables and texts are written there.
    """
    import os
    from tempfile import TemporaryDirectory

    from comparisons.cli import console
    from comparisons.cli.app import NOT_CONVERGED
    from comparisons.report.files import folder, to_json
    from comparisons.runs.campaign import campaign
    from comparisons.runs.executors import pool_of
    from comparisons.stability import STUDIES, survey, texts
    from sheetbench.scenes.errors import require_choice

    names = [name.strip().replace(" ", "-") for name in study or STUDIES]
    for name in names:
        require_choice("study", name, STUDIES)
    chosen = [STUDIES[name] for name in dict.fromkeys(names)]
    target = folder(out) if out is not None else None
    with (
        TemporaryDirectory() as scratch,
        campaign(target or Path(scratch)) as store,
        pool_of(scheduler) as pool,
        console.campaign_progress() as progress,
    ):
        rows = survey(
            chosen,
            store,
            full=full,
            workers=workers or os.cpu_count() or 1,
            pool=pool,
            retry=retry,
            progress=progress,
        )
    written = _write(target, chosen, rows) if target is not None else []
    if json:
        print(to_json({"rows": rows}), end="")
    else:
        for one in chosen:
            mine = [row for row in rows if row["study"] == one.name]
            console.show(texts.table(one, mine), leave_out=("message", "single error", "single status"))
            console.note(texts.text(one, mine))
        if written:
            console.note(f"Files in {target}: {', '.join(written)}")
    broken = [row for row in rows if row["status"] in ("failed", "lost")]
    for row in broken:
        console.warn(f"{row['study']} {row['cell']}: {row['status']}: {row['message']}")
    if broken:
        raise typer.Exit(NOT_CONVERGED)


def _write(target: Path, studies: list[Study], rows: list[Row]) -> list[str]:
    """Maps, tables and texts; their names."""
    from comparisons.report.files import to_json, write_text
    from comparisons.runs.manifest import record
    from comparisons.stability import texts
    from comparisons.stability.figure import picture

    files = {"stability.json": to_json({"rows": rows}), "manifest.json": to_json(record(command_line()))}
    said, pictures = ["# Where the solvers hold\n"], []
    for study in studies:
        mine = [row for row in rows if row["study"] == study.name]
        table = texts.table(study, mine)
        files[f"{study.name}.csv"] = table.to_csv()
        names = [f"{study.name}.png", f"{study.name}.pdf"]
        picture(study, mine, [target / name for name in names])
        pictures += names
        said += [texts.text(study, mine), f"![{study.title}]({names[0]})\n", table.to_markdown()]
    files["stability.md"] = "\n".join(said)
    for name, text in files.items():
        write_text(target / name, text)
    return [*files, *pictures, "campaign.sqlite"]
