"""`sheetbench study simulators`: other simulators with what is exported for them."""

from __future__ import annotations

from comparisons.cli.finish import finish
from comparisons.cli.options import Json, Out
from studies.simulators.study import study


def command(json: Json = False, out: Out = None) -> None:
    """Run MuJoCo on exported lattices, and compare its rest with ours."""

    with finish("simulators", json, out) as end:
        end(study(end.progress))
