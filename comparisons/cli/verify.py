"""`sheetbench verify`: the finite-element references against published values."""

from __future__ import annotations

from typing import Annotated

from comparisons.cli.options import option
from comparisons.cli.verb import PictureOptions


def command(
    case: Annotated[
        list[str] | None, option("Only this case; may be repeated. Default: all.", "NAME", "--case")
    ] = None,
    locking: Annotated[
        bool, option("Only the locking sweeps; with --out, their picture.", None, "--locking")
    ] = False,
    laws: Annotated[
        bool, option("Only the laws of strain, with a table of what they change.", None, "--laws")
    ] = False,
    *,
    output: PictureOptions,
) -> None:
    """Check the references against published values, one row each: exit status 3 unless all pass."""
    from comparisons.verification.answer import Verification
    from fem_reference.verification import CASES, run
    from fem_reference.verification.locking import MODELS
    from sheetbench.errors import BadInput, require_choice

    for name in case or ():
        require_choice("case", name, CASES)
    parts = {"--locking": locking, "--laws": laws, "--case": bool(case)}
    if len(both := [option for option, given in parts.items() if given]) > 1:
        raise BadInput(f"{' and '.join(both)}: choose one")
    chosen = list(MODELS) if locking else ["strain-laws"] if laws else case
    with output.open(variant={key: parts[key] for key in list(parts)[:2]}) as out:
        rows = list(run(chosen, starting=lambda name: out.progress(f"verifying {name} …")))
        out.show(Verification(rows, locking, laws))
