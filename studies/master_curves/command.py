"""`sheetbench study master-curves`: the heavy cantilever and lateral buckling, without units."""

from __future__ import annotations

from typing import Any

from comparisons.cli.output import PictureOptions
from studies.master_curves.study import measure


def command(*, output: PictureOptions) -> Any:
    """Compare lattice and shell with two dimensionless curves. A cantilever under its own weight has one
    number, Γ = ρ_A g L³/B; so has a strip that stands on edge and buckles sideways. A code of other units can
    be laid over both."""
    with output.open() as out:
        return out.show(measure(out.progress))
