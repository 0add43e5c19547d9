"""How good is a spring lattice of a soft sheet, which k belongs to its E, and what does the speed cost?

    import sheetbench as sb
    scene = sb.load("two-edges-clamped")      # a name of the catalogue, a path, or sb.Scene(…)
    both = sb.compare(scene, grid=9)          # the lattice beside the shell
    both.report().save("results")

Every verb takes a scene, a name or a path, and is loaded when it is first used. What stands behind them:
`sheetbench.scenes` (what is asked), `lumped` (the lattice), `fem_reference` (the references), `comparisons`.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import sheetbench.scenes as scenes
    from comparisons.advice.advisor import advise
    from comparisons.check.check import check
    from comparisons.comparison.comparison import compare
    from comparisons.identification.identification import identify
    from comparisons.modes.spectra import spectra as modes
    from sheetbench.face import calibrate, simulate, solve, tradeoff
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
    )

VERBS = {  # name: module and the function there
    "advise": ("comparisons.advice.advisor", "advise"),
    "calibrate": ("sheetbench.face", "calibrate"),
    "check": ("comparisons.check.check", "check"),
    "compare": ("comparisons.comparison.comparison", "compare"),
    "identify": ("comparisons.identification.identification", "identify"),
    "modes": ("comparisons.modes.spectra", "spectra"),
    "simulate": ("sheetbench.face", "simulate"),
    "solve": ("sheetbench.face", "solve"),
    "tradeoff": ("sheetbench.face", "tradeoff"),
}

__all__ = [
    "BadInput",
    "Chain",
    "Clamped",
    "Curved",
    "EdgeLoad",
    "EdgeMotion",
    "Gravity",
    "Held",
    "Hinged",
    "History",
    "Implausible",
    "Material",
    "PointLoad",
    "Pressure",
    "Scene",
    "SceneError",
    "Sheet",
    "Solution",
    "Status",
    "Symmetric",
    "advise",
    "calibrate",
    "catalogue",
    "check",
    "compare",
    "identify",
    "load",
    "modes",
    "scenes",
    "simulate",
    "solve",
    "tradeoff",
]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version  # not needed for help

        return version("sheetbench")
    if name == "scenes":
        return import_module("sheetbench.scenes")
    if name not in __all__:
        raise AttributeError(f"module 'sheetbench' has no attribute {name!r}")
    module, function = VERBS.get(name, ("sheetbench.scenes", name))
    return getattr(import_module(module), function)


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
