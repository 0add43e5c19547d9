"""How good is a spring lattice of a soft sheet, which k belongs to its E, and what does the speed cost?

    import sheetbench as sb
    scene = sb.load("two-edges-clamped")      # a name of the catalogue, a path, or sb.Scene(…)
    both = sb.compare(scene, grid=9)          # the lattice beside the shell
    both.report().save("results")

A function takes a scene, a name or a path, and is loaded when it is first used. What stands behind them:
`sheetbench.scenes` (scenes), `lumped` (the lattice), `fem_reference` (the references), `comparisons`.
"""

from __future__ import annotations

from importlib import import_module as _import_module
from typing import TYPE_CHECKING as _TYPE_CHECKING

from sheetbench.choices import FUNCTIONS as _FUNCTIONS

if _TYPE_CHECKING:
    import sheetbench.scenes as scenes
    from comparisons.codes.cell import Cell
    from comparisons.codes.cell import cell_of as cell
    from comparisons.comparison.comparison import error
    from comparisons.identification.measurements import Displacements
    from comparisons.models.spec import Elements, External, Lattice
    from sheetbench.answers.history import History
    from sheetbench.answers.solution import Solution, Status
    from sheetbench.face import solve, study
    from sheetbench.face import verb as _verb
    from sheetbench.scenes import (
        BadInput,
        Chain,
        Clamped,
        Curved,
        EdgeLoad,
        EdgeMotion,
        Gravity,
        Held,
        Hinged,
        Implausible,
        Mass,
        Material,
        PointLoad,
        Pressure,
        Scene,
        SceneError,
        Sheet,
        Symmetric,
        catalogue,
        load,
    )

    calibrate = check = compare = crosscheck = identify = modes = new = report = score = _verb("")
    simulate = stability = sweep = tradeoff = verify = calibrate

_MODULES = {  # all else is of sheetbench.scenes
    "comparisons.codes.cell": "Cell cell",
    "comparisons.comparison.comparison": "error",
    "comparisons.identification.measurements": "Displacements",
    "comparisons.models.spec": "Elements External Lattice",
    "sheetbench.answers.history": "History",
    "sheetbench.answers.solution": "Solution Status",
    "sheetbench.face": "solve study",
}
_MODULE_OF = {name: module for module, names in _MODULES.items() for name in names.split()}
_NAME_THERE = {"cell": "cell_of"}

__all__ = [
    "BadInput", "Cell", "Chain", "Clamped", "Curved", "Displacements", "EdgeLoad", "EdgeMotion", "Elements",
    "External", "Gravity", "Held", "Hinged", "History", "Implausible", "Lattice", "Mass",
    "Material", "PointLoad", "Pressure", "Scene", "SceneError", "Sheet", "Solution", "Status", "Symmetric",
    "calibrate", "catalogue", "cell", "check", "compare", "crosscheck", "error", "identify", "load", "modes",
    "new", "report", "scenes", "score", "simulate", "solve", "stability", "study", "sweep", "tradeoff",
    "verify",
]  # fmt: skip


def __getattr__(name: str) -> object:
    if name == "__version__":
        from importlib.metadata import version  # not needed for help

        return version("sheetbench")
    if name == "scenes":
        return _import_module("sheetbench.scenes")
    if name not in __all__:
        raise AttributeError(f"module 'sheetbench' has no attribute {name!r}")
    if name in _FUNCTIONS:
        return _import_module("sheetbench.face").verb(name)
    module = _import_module(_MODULE_OF.get(name, "sheetbench.scenes"))
    return getattr(module, _NAME_THERE.get(name, name))


def __dir__() -> list[str]:
    return sorted([*__all__, *(name for name in globals() if name.startswith("__"))])
