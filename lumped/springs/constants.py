"""The constants of a spring or damper set by family and direction, and by name."""

from __future__ import annotations

import numpy as np

from sheetbench.scenes import EDGES, PerDirection, SpringSet
from sheetbench.scenes.errors import BadInput
from sheetbench.scenes.springs import DamperSet, Either


def along(table: SpringSet | DamperSet, family: str, direction: str) -> tuple[float, float, float]:
    """Stiffness [N/m] (or damping [N·s/m]) of the links of a family that run in a direction, by components x,
    y, z: three equal ones but for the seed's per-direction law, where the scene gives x, y and z."""
    value = getattr(table, family)
    if not isinstance(value, PerDirection):
        return (value, value, value)
    if value.z is not None:
        return (value.x, value.y, value.z)
    if direction not in ("x", "y"):
        raise BadInput(
            f"springs.{family} = {{x, y}}: only axial and cross links run along x or y; give one number"
        )
    one = value.x if direction == "x" else value.y
    return (one, one, one)


def of_strains(springs: SpringSet, cells: str) -> tuple[str, tuple[float, float, float]]:
    """Name and stiffness [N/m], of ε1, ε2 and γ, of the strain springs on the cells called "area"
    (each layer) or "mid_area" (the mid-surface)."""
    if cells == "area":
        return "shear", (0.0, 0.0, springs.shear)
    stretch = springs.mid_stretch
    x, y = (stretch.x, stretch.y) if isinstance(stretch, PerDirection) else (stretch, stretch)
    return "mid_strain", (x, y, springs.mid_shear)


def of_edge_cells(springs: SpringSet, grid: tuple[int, int, int], twisting: frozenset[str]) -> np.ndarray:
    """Stiffness [N/m] against shear that the edges along which nothing holds the director (`twisting`) add to
    every cell of a layer, (cells,); to a cell at two of them the sum."""
    cells = np.zeros((grid[1] - 1, grid[0] - 1))
    for edge in twisting:
        axis = EDGES[edge].normal_axis
        opposite = next(e for e in EDGES if e != edge and EDGES[e].normal_axis == axis)
        value = springs.strip_shear if opposite in twisting else springs.edge_shear
        if isinstance(value, Either):
            value = (value.x, value.y)[axis]
        row = -1 if EDGES[edge].far_end else 0
        cells[(slice(None), row) if axis == 0 else (row, slice(None))] += value
    return cells.ravel()


def names(springs: SpringSet) -> list[str]:
    """Names of the spring constants that are not zero, one a direction where directions differ."""
    found: list[str] = []
    for name, value in springs:
        if isinstance(value, PerDirection | Either):
            found.extend(f"{name}_{direction}" for direction in "xy" if getattr(value, direction))
        elif value and name != "layer_distance":
            found.append(name)
    return found


def changed(springs: SpringSet, name: str, value: float) -> SpringSet:
    """The spring set with one constant (or layer_distance) changed. Raises BadInput for an unknown name."""
    if name in SpringSet.model_fields:
        return springs.model_copy(update={name: value})
    family, _, direction = name.rpartition("_")
    pair = getattr(springs, family, None)
    if not isinstance(pair, PerDirection | Either) or direction not in ("x", "y"):
        raise BadInput(f"parameter {name!r}: unknown, or without a value of its own in these springs")
    return springs.model_copy(update={family: pair.model_copy(update={direction: value})})


def value_of(springs: SpringSet, name: str) -> float:
    """The value of one spring constant (or layer_distance) by name."""
    if name in SpringSet.model_fields:
        return float(getattr(springs, name))
    family, _, direction = name.rpartition("_")
    return float(getattr(getattr(springs, family), direction))
