"""`sheetbench scenes`: lists the catalogue."""

from __future__ import annotations

from comparisons.cli.options import Json, Out


def command(json: Json = False, out: Out = None) -> None:
    """List the scenes that come with sheetbench; --out copies their files, to start from."""
    from comparisons.check.catalogue import report
    from comparisons.cli.finish import finish

    with finish("scenes", json, out) as end:
        end(report())
