"""`sheetbench study simulators`: other simulators with what is exported for them."""

from __future__ import annotations

from comparisons.cli.output import OutputOptions
from studies.simulators.study import study


def command(*, output: OutputOptions) -> None:
    """Run MuJoCo on exported lattices, and compare its rest with ours."""

    with output.open() as out:
        out.show(study(out.progress))
