"""`sheetbench transfer`: calibrations judged on scenes that they were not made on."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli.options import Json, Large, Out, Overwrite, Retry


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
    retry: Retry = False,
    large: Large = False,
    json: Json = False,
    out: Out = None,
    overwrite: Overwrite = False,
) -> None:
    """Measure every calibration on many scenes, statics and frequencies, as the grid is refined.

    With --out an interrupted study is resumed.
    """
    import os

    from comparisons.cli.finish import finish
    from comparisons.models.candidate import items
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
    with finish("transfer", json, out, overwrite) as end:
        with end.campaign() as (store, pool, progress):
            found = transfer(
                store,
                methods=chosen["methods"][0],
                grids=sizes,
                scenes=chosen["scenes"][0],
                parts=chosen["part"][0],
                elements=elements,
                workers=workers or os.cpu_count() or 1,
                pool=pool,
                retry=retry,
                large=large,
                progress=progress,
            )
        end(found.report())


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
