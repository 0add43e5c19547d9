"""What is to be traded, from lists of grids, meshes and calibrations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from comparisons.models.resolve import resolve_each
from comparisons.models.spec import Lattice, Spec, items, lattices, references
from comparisons.tradeoff.usual import GRIDS, SPRINGS
from sheetbench.scenes import Scene


def of_lattices(
    scene: Scene, lattice: Lattice, grid: Sequence[str] | None, calibration: Sequence[str] | None
) -> tuple[list[Lattice], tuple[str, ...]]:
    """Return lattices on every grid with every calibration, of what is usual where nothing is listed, and the
    reasons for what is chosen.

    lattice: what all have, the grading where their calibration takes one. The calibration "auto" is the one
    for the scene (`comparisons.models.method`). Raises BadInput for what cannot be read.
    """
    methods = calibration or items(SPRINGS if lattice.k is None else "uniform")
    listed = lattices(scene, items(GRIDS) if grid is None else grid, methods, lattice)
    resolved, reasons = resolve_each(scene, listed, lattice.grading)
    return [one for i, one in enumerate(resolved) if one not in resolved[:i]], reasons


def moving_lattices(
    lattice: Lattice, grid: Sequence[str] | None, calibration: Sequence[str] | None
) -> list[Lattice]:
    """Return lattices on every grid with every calibration, left open where nothing is listed."""
    methods, grids = ([None] if listed is None else listed for listed in (calibration, grid))
    return [lattice.but(grid=size, calibration=name) for name in methods for size in grids]


def of_references(meshes: Mapping[str, Sequence[str] | None], usual: Mapping[str, str]) -> list[Spec]:
    """Return references on meshes by name, the usual ones where nothing is listed."""
    sizes = {name: items(usual[name]) if listed is None else listed for name, listed in meshes.items()}
    return [one for name, listed in sizes.items() for one in references(name, listed)]
