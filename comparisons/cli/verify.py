"""`sheetbench verify`: the finite-element references against published values."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli.options import Json, Out, command_line


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
) -> None:
    """Check the references against published values, one row each: exit status 3 unless all pass."""
    from comparisons.cli import console
    from comparisons.cli.app import NOT_CONVERGED
    from comparisons.report.files import folder, to_json, write_text
    from comparisons.runs.manifest import record
    from comparisons.verification import tables as verification
    from fem_reference.verification import CASES, run
    from sheetbench.scenes.errors import BadInput, require_choice

    for name in case or ():
        require_choice("case", name, CASES)
    if locking and case:
        raise BadInput("--locking and --case: choose one")
    chosen = [name for name in CASES if name.startswith("locking-")] if locking else case
    target = folder(out) if out is not None else None
    with console.progress() as progress:
        rows = list(run(chosen, starting=lambda name: progress(f"verifying {name} …")))
    table = verification.table(rows)
    failed = [row for row in rows if not row.passed]
    if target is not None:
        write_text(target / "verification.json", to_json(verification.as_dict(rows)))
        write_text(target / "verification.csv", table.to_csv())
        write_text(target / "verification.md", table.to_markdown())
        write_text(target / "manifest.json", to_json(record(command_line())))
        if locking:
            from comparisons.verification.locking import picture

            picture(target / "locking.png", rows)
    if json:
        print(to_json(verification.as_dict(rows)), end="")
    else:
        for one in verification.by_case(rows):
            console.show(one, leave_out=("case", "mesh"))
        console.note(f"{len(rows) - len(failed)} of {len(rows)} rows pass")
    for row in failed:
        console.warn(f"{row.case}: {row.quantity}: {row.computed:g} instead of {row.published:g}")
    if failed:
        raise typer.Exit(NOT_CONVERGED)
