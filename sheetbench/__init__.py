"""Comparison of a spring lattice of a soft sheet with finite elements: its k by E, its error, its speed.

    import sheetbench as sb
    scene = sb.load("two-edges-clamped")      # a name of the catalogue, a path, or sb.Scene(…)
    both = sb.compare(scene, grid=9)          # the lattice beside the shell
    both.report().save("results")

A function takes a scene, a name or a path, and is loaded when it is first used. The parts are
`sheetbench.scenes` (scenes), `lumped` (the lattice), `fem_reference` (the references), `comparisons`.
"""

from __future__ import annotations

from importlib import import_module as _import_module

from sheetbench.choices import FUNCTIONS as _FUNCTIONS

_MODULES = {  # `__init__.pyi`, which type checkers read, is made of these and of the verbs: make stubs
    "comparisons.codes.cell": "Cell cell_of=cell",
    "comparisons.identification.measurements": "Displacements",
    "comparisons.models.spec": "Elements External Lattice",
    "comparisons.sweep.differences": "error",
    "sheetbench.answers.history": "History",
    "sheetbench.answers.solution": "Solution Status",
    "sheetbench.face": "solve study",
    "sheetbench.scenes": (
        "Air AreaLoad BadInput Box Chain Circle Clamped CurvatureTable Curved Cutout Cylinder EdgeLoad "
        "EdgeMotion FactorTable Gravity Held Hinged Implausible Initial Layer Mass Material Motion Natural "
        "Patch PerDirection Plane Point PointLoad Pressure Rectangle Relaxation Scene SceneError Shape Sheet "
        "Sphere Symmetric Temperature DamperSet=Dampers SpringSet=Springs catalogue load"
    ),
}
_PLACES = {
    (entry.partition("=")[2] or entry): (module, entry.partition("=")[0])
    for module, names in _MODULES.items()
    for entry in names.split()
}
__all__ = sorted([*_PLACES, *_FUNCTIONS, "scenes"])


def __getattr__(name: str) -> object:
    if name == "__version__":
        from importlib.metadata import version  # not needed for help

        return version("sheetbench")
    if name == "scenes":
        return _import_module("sheetbench.scenes")
    if name in _FUNCTIONS:
        return _import_module("sheetbench.face").verb(name)
    if name not in _PLACES:
        raise AttributeError(f"module 'sheetbench' has no attribute {name!r}")
    module, there = _PLACES[name]
    return getattr(_import_module(module), there)


def __dir__() -> list[str]:
    return sorted([*__all__, *(name for name in globals() if name.startswith("__"))])
