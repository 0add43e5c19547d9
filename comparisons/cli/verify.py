"""`sheetbench verify`: the finite-element references against published values."""

from __future__ import annotations

from typing import Annotated, Any

from comparisons.cli.options import option
from comparisons.cli.output import PictureOptions


def command(
    case: Annotated[
        list[str] | None, option("Only this case; may be repeated. Default: all.", "NAME")
    ] = None,
    *,
    output: PictureOptions,
) -> Any:
    """Check the references against published values.

    One row each: exit status 3 unless all pass. The sweeps locking-plate, locking-shell and locking-solid
    have a picture (with --out), strain-laws a table of what the laws change.
    """
    from fem_reference.verification import run
    from fem_reference.verification.answer import Verification

    with output.open(variant={"--case": sorted(case) if case else None}) as out:
        return out.show(
            Verification(list(run(case, starting=lambda name: out.progress(f"verifying {name} …"))))
        )
