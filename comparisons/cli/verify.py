"""`sheetbench verify`: the finite-element references against published values."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli.options import Json, Out, Overwrite


def command(
    case: Annotated[
        list[str] | None,
        typer.Option(
            "--case",
            metavar="NAME",
            help="Only this case; may be repeated. All unless given.",
            show_default=False,
        ),
    ] = None,
    locking: Annotated[
        bool, typer.Option("--locking", help="Only the locking sweeps; with --out, their picture.")
    ] = False,
    json: Json = False,
    out: Out = None,
    overwrite: Overwrite = False,
) -> None:
    """Check the references against published values, one row each: exit status 3 unless all pass."""
    from comparisons.cli.finish import finish
    from comparisons.verification import tables
    from fem_reference.verification import CASES, run
    from fem_reference.verification.locking import MODELS
    from sheetbench.scenes.errors import BadInput, require_choice

    for name in case or ():
        require_choice("case", name, CASES)
    if locking and case:
        raise BadInput("--locking and --case: choose one")
    chosen = list(MODELS) if locking else case
    with finish("verify", json, out, overwrite, apart={"--locking": locking}) as end:
        rows = list(run(chosen, starting=lambda name: end.progress(f"verifying {name} …")))
        end(tables.report(rows, locking))
