"""`sheetbench verify`: the finite-element references against published values."""

from __future__ import annotations

from typing import TYPE_CHECKING

from comparisons.cli.output import PictureOptions

if TYPE_CHECKING:
    from fem_reference.verification.cases import Verification


def command(
    case: list[str] | None = None,
    *,
    output: PictureOptions,
) -> Verification:
    """Check the references against published values.

    Each case is a row; exit status 3 unless all pass.

    Args:
        case (NAMES): A selection of cases. Default: all.
    """
    from fem_reference.verification import verify

    with output.open(variant={"--case": sorted(case) if case else None}) as out:
        return out.show(verify(case, starting=lambda name: out.progress(f"verifying {name} …")))
