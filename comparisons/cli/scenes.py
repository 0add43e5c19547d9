"""`sheetbench scenes`: lists the catalogue."""

from __future__ import annotations

from comparisons.cli.output import OutputOptions


def command(*, output: OutputOptions) -> None:
    """List the scenes that come with sheetbench; --out copies their files, to start from."""
    from comparisons.check.catalogue import Catalogue

    with output.open() as out:
        out.show(Catalogue())
