"""`sheetbench transfer`: calibrations judged on scenes that they were not made on."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from comparisons.cli.options import Json, Out, command_line

if TYPE_CHECKING:
    from comparisons.transfer.study import Transfer


def command(
    methods: Annotated[
        str | None,
        typer.Option(
            metavar="NAMES", help="Calibrations, with commas; all unless given.", show_default=False
        ),
    ] = None,
    grids: Annotated[
        str,
        typer.Option(
            "--grids",
            "--grid",
            "--lumped",
            metavar="N,N,…",
            help="Masses along the shorter side, 4 n + 1, coarsest first.",
        ),
    ] = "9,17,33",
    scenes: Annotated[
        str | None,
        typer.Option(metavar="NAMES", help="Scenes of the study; all unless given.", show_default=False),
    ] = None,
    part: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="static, limits, modal, aspect or left-out; may be repeated. All unless given.",
            show_default=False,
        ),
    ] = None,
    elements: Annotated[
        int, typer.Option(min=1, metavar="N", help="Elements of the shell along a side.")
    ] = 24,
    workers: Annotated[
        int | None, typer.Option(min=1, metavar="N", help="Processes; one a core unless given.")
    ] = None,
    retry: Annotated[
        bool, typer.Option("--retry", help="Run again what failed in an earlier run.", show_default=False)
    ] = False,
    json: Json = False,
    out: Out = None,
) -> None:
    """Measure every calibration on many scenes, statics and frequencies, as the grid is refined.

    With --out an interrupted study is resumed.
    """
    import os
    from tempfile import TemporaryDirectory

    from comparisons.cli import console
    from comparisons.cli.app import NOT_CONVERGED
    from comparisons.models.candidate import items
    from comparisons.report.files import folder, to_json
    from comparisons.runs.campaign import campaign
    from comparisons.transfer import tables
    from comparisons.transfer.scenes import transfer_scenes
    from comparisons.transfer.study import METHODS, PARTS, transfer
    from sheetbench.scenes.errors import require_choice

    chosen = {
        "methods": (items(methods) if methods is not None else list(METHODS), METHODS),
        "scenes": (items(scenes) if scenes is not None else list(transfer_scenes()), transfer_scenes()),
        "part": (part or list(PARTS), PARTS),
    }
    for option, (names, known) in chosen.items():
        for name in names:
            require_choice(f"--{option}", name, known)
    sizes = _grids(grids)
    with (
        TemporaryDirectory() as scratch,
        campaign(folder(out) if out is not None else Path(scratch)) as store,
        console.campaign_progress() as progress,
    ):
        found = transfer(
            store,
            methods=chosen["methods"][0],
            grids=sizes,
            scenes=chosen["scenes"][0],
            parts=chosen["part"][0],
            elements=elements,
            workers=workers or os.cpu_count() or 1,
            retry=retry,
            progress=progress,
        )
    written = _write(found, out) if out is not None else []
    if json:
        print(to_json(found.as_dict()), end="")
    else:
        for table in tables.tables(found):
            console.show(table, group_by=0)
        console.note(tables.explanation(found))
        if written:
            console.note(f"Files in {out}: {', '.join(written)}")
    for failure in found.failed:
        console.warn(failure)
    if found.failed:
        raise typer.Exit(NOT_CONVERGED)


def _grids(text: str) -> list[int]:
    """Masses a side. Raises BadInput unless every one is 4 n + 1 and they grow."""
    from comparisons.models.candidate import items
    from sheetbench.scenes.errors import BadInput

    try:
        sizes = [int(part) for part in items(text)]
    except ValueError:
        sizes = []
    if not sizes or sizes != sorted(set(sizes)) or any(n < 5 or n % 4 != 1 for n in sizes):
        raise BadInput(f"--grids = '{text}': masses a side, 4 n + 1 of them and rising, as 9,17,33")
    return sizes


def _write(found: Transfer, out: Path) -> list[str]:
    """The study's files; their names."""
    from comparisons.report.files import to_json, write_text
    from comparisons.runs import manifest
    from comparisons.transfer import tables

    made = manifest.machine()
    footer = (
        f"sheetbench {manifest.version()}, Python {made['python']}, {made['processor']}, "
        f"{made['cpu_count']} processors, {manifest.today()}.\n"
    )
    shown = tables.tables(found)
    files = {
        "transfer.json": to_json(found.as_dict()),
        "transfer.md": "\n".join([*(t.to_markdown() for t in shown), tables.explanation(found), "", footer]),
        "transfer.tex": "\n".join(table.to_latex() for table in shown),
        "manifest.json": to_json(manifest.record(command_line())),
    }
    for name, text in files.items():
        write_text(out / name, text)
    return [*files, "campaign.sqlite"]
