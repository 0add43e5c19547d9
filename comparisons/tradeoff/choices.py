"""Models of a trade-off, from lists of grids, meshes and calibrations."""

from collections.abc import Mapping, Sequence

from comparisons.models.resolve import resolve_each
from comparisons.models.spec import Lattice, Spec, items, lattices, references
from comparisons.tradeoff.usual import GRIDS, SPRINGS
from sheetbench.scenes import Scene


def of_lattices(
    scene: Scene, lattice: Lattice, grid: Sequence[str] | None, calibration: Sequence[str] | None
) -> tuple[list[Lattice], tuple[str, ...]]:
    """Return lattices on every grid with every calibration, or on the defaults, and the reasons for choices.

    lattice: settings of all, its grading if the calibration takes one. The calibration "auto" is chosen by
    the scene (`comparisons.models.method`). Raises BadInput for an invalid list.
    """
    methods = calibration or items(SPRINGS if lattice.k is None else "uniform")
    listed = lattices(scene, items(GRIDS) if grid is None else grid, methods, lattice)
    resolved, reasons = resolve_each(scene, listed, lattice.grading)
    return list(dict.fromkeys(resolved)), reasons


def moving_lattices(
    lattice: Lattice, grid: Sequence[str] | None, calibration: Sequence[str] | None
) -> list[Lattice]:
    """Return lattices on every grid with every calibration; a missing list leaves the setting open."""
    methods, grids = ([None] if listed is None else listed for listed in (calibration, grid))
    return [lattice.but(grid=size, calibration=name) for name in methods for size in grids]


def of_references(meshes: Mapping[str, Sequence[str] | None], default: Mapping[str, str]) -> list[Spec]:
    """Return references on the meshes listed by name; a missing list stands for the default."""
    sizes = {name: items(default[name]) if listed is None else listed for name, listed in meshes.items()}
    return [spec for name, listed in sizes.items() for spec in references(name, listed)]
