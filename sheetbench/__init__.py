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
from types import FunctionType as _Function
from typing import TYPE_CHECKING as _TYPE_CHECKING

if _TYPE_CHECKING:
    import sheetbench.scenes as scenes
    from comparisons.advice.advisor import advise
    from comparisons.cells.answer import homogenise
    from comparisons.cells.cell import Cell
    from comparisons.cells.meshes import cell_of as cell
    from comparisons.check.check import check
    from comparisons.comparison.comparison import error
    from comparisons.identification.identification import identify
    from comparisons.identification.measurements import Displacements
    from comparisons.linearisation.linearisation import linearise
    from comparisons.models.spec import Elements, External, Lattice, LatticePair
    from comparisons.modes.spectra import spectra as modes
    from comparisons.reproduction.reproduction import reproduce
    from comparisons.scoring.suite import suite
    from comparisons.verification.answer import verify
    from sheetbench.face import calibrate, compare, simulate, solve, tradeoff
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
        History,
        Implausible,
        Mass,
        Material,
        PointLoad,
        Pressure,
        Scene,
        SceneError,
        Sheet,
        Solution,
        Status,
        Symmetric,
        catalogue,
        load,
    )  # fmt: skip
    from sheetbench.verbs import crosscheck, export, report, schema, score, stability

_MODULES = {  # all else is of sheetbench.scenes
    "comparisons.advice.advisor": "advise",
    "comparisons.cells.answer": "homogenise",
    "comparisons.cells.cell": "Cell",
    "comparisons.cells.meshes": "cell",
    "comparisons.check.check": "check",
    "comparisons.comparison.comparison": "error",
    "comparisons.identification.identification": "identify",
    "comparisons.identification.measurements": "Displacements",
    "comparisons.linearisation.linearisation": "linearise",
    "comparisons.models.spec": "Elements External Lattice LatticePair",
    "comparisons.modes.spectra": "modes",
    "comparisons.reproduction.reproduction": "reproduce",
    "comparisons.scoring.suite": "suite",
    "comparisons.verification.answer": "verify",
    "sheetbench.face": "calibrate compare simulate solve tradeoff",
    "sheetbench.verbs": "crosscheck export report schema score stability",
}
_MODULE_OF = {name: module for module, names in _MODULES.items() for name in names.split()}
_NAME_THERE = {"cell": "cell_of", "modes": "spectra"}

__all__ = [
    "BadInput", "Cell", "Chain", "Clamped", "Curved", "Displacements", "EdgeLoad", "EdgeMotion", "Elements",
    "External", "Gravity", "Held", "Hinged", "History", "Implausible", "Lattice", "LatticePair", "Mass",
    "Material", "PointLoad", "Pressure", "Scene", "SceneError", "Sheet", "Solution", "Status", "Symmetric",
    "advise", "calibrate", "catalogue", "cell", "check", "compare", "crosscheck", "error", "export",
    "homogenise", "identify", "linearise", "load", "modes", "report", "reproduce", "scenes", "schema",
    "score", "simulate", "solve", "stability", "suite", "tradeoff", "verify",
]  # fmt: skip


def __getattr__(name: str) -> object:
    if name == "__version__":
        from importlib.metadata import version  # not needed for help

        return version("sheetbench")
    if name == "scenes":
        return _import_module("sheetbench.scenes")
    if name not in __all__:
        raise AttributeError(f"module 'sheetbench' has no attribute {name!r}")
    module = _import_module(_MODULE_OF.get(name, "sheetbench.scenes"))
    found = getattr(module, _NAME_THERE.get(name, name))
    if isinstance(found, _Function) and name in _MODULE_OF:
        from sheetbench.keywords import in_words

        return in_words(name, found)
    return found


def __dir__() -> list[str]:
    return sorted([*__all__, *(name for name in globals() if name.startswith("__"))])
