"""The constants of a spring or damper set by family and direction, and by name.

A constant that every cell has its own of goes by its mean over the cells. Given another mean, all its values
scale; those that may have either sign shift. Tables of cells are rows from y0 to y1, each from x0 to x1;
edge_shear, strip_shear, edge_coupling and those of the far edges have lists along the edges. One number is
every cell's.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from sheetbench.errors import BadInput
from sheetbench.scenes import EDGES, PerDirection, SpringSet
from sheetbench.scenes.grid import Grid
from sheetbench.scenes.springs import DamperSet, Either

EDGES_OWN = (
    "edge_shear",
    "strip_shear",
    "edge_coupling",
    "far_edge_shear",
    "far_strip_shear",
    "far_edge_coupling",
)
RIMS_OWN = (  # in the order of `of_strains`
    "rim_stretch_x",
    "rim_stretch_y",
    "rim_shear",
    "rim_coupling_xy",
    "rim_coupling_x",
    "rim_coupling_y",
)
RUBBER_CONSTANTS = (
    "neo_hookean_shear",
    "neo_hookean_volume",
    "mooney_rivlin",
    "yeoh_square",
    "yeoh_cube",
    "gent_limit",
)
COUPLINGS = ("coupling_xy", "coupling_x", "coupling_y")
MID_COUPLINGS = ("mid_coupling_xy", "mid_coupling_x", "mid_coupling_y")
SIGNED = ("area", "mid_area", "mid_shear", *COUPLINGS, *MID_COUPLINGS, *EDGES_OWN, *RIMS_OWN)


def number(table: SpringSet | DamperSet, family: str, direction: str) -> float | None:
    """Return what `along` does where that is one number for all components and cells, else None."""
    value: Any = getattr(table, family)
    if isinstance(value, PerDirection):
        if value.z is not None or direction not in ("x", "y"):
            return None
        value = value.x if direction == "x" else value.y
    return None if isinstance(value, tuple) else float(value)


def along(table: SpringSet | DamperSet, family: str, direction: str) -> np.ndarray:
    """Stiffness [N/m] (or damping [N·s/m]) of the links of a family that run in a direction, by components x,
    y, z, (3,): three equal ones but for Habibi et al.'s per-direction law, where the scene gives x, y and z.
    Where every cell has its own, (cells, 1)."""
    value: Any = getattr(table, family)
    if isinstance(value, PerDirection):
        if value.z is not None:
            return np.array([value.x, value.y, value.z], dtype=float)
        if direction not in ("x", "y"):
            raise BadInput(
                f"springs.{family} = {{x, y}}: only axial and cross links run along x or y; give one number"
            )
        value = value.x if direction == "x" else value.y
    return of_cells(value, 0)[:, None] if isinstance(value, tuple) else np.full(3, float(value))


def of_strains(springs: SpringSet, cells: str, count: int = 1) -> tuple[str, np.ndarray]:
    """Name and stiffness (count, 6) [N/m], of ε1, ε2 and γ and of what couples ε1 ε2, ε1 γ and ε2 γ, of the
    strain springs on the `count` plan cells called "area" (each layer) or "mid_area" (the mid-surface)."""
    name, stretch, shear, couplings = "mid_strain", springs.mid_stretch, springs.mid_shear, MID_COUPLINGS
    if cells == "area":
        name, stretch, shear, couplings = "strain", springs.stretch, springs.shear, COUPLINGS
    values = [*along_each(stretch, count), *(of_cells(getattr(springs, own), count) for own in couplings)]
    return name, np.stack([*values[:2], of_cells(shear, count), *values[2:]], axis=1)


def along_each(value: Any, count: int) -> np.ndarray:
    """Values along x and along y of a constant of `count` cells, (2, count)."""
    pair = (value.x, value.y) if isinstance(value, PerDirection) else (value, value)
    return np.stack([of_cells(each, count) for each in pair])


def of_faces(springs: SpringSet, spacing: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    """What the upright faces of a cell of sides (lx, ly) [m] add to the shear stiffness of a gap along x and
    y [N/m]: those on its sides, those over its diagonals, (2,) each."""
    square = np.array([spacing[0] ** 2, spacing[1] ** 2])
    diagonal = 2.0 * of_cells(springs.face_diagonal_shear, 1)[0] * square / square.sum()
    return along_each(springs.face_shear, 1)[:, 0], diagonal


def of_rubber(
    springs: SpringSet, sides: np.ndarray, area: np.ndarray, twist: np.ndarray, kept: Any = slice(None)
) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness (c, 4) [N/m] of the small strains of a layer's plan cells that are rubber membranes, less
    that of their axial links, and what else `lumped.springs.laws` takes of them (c, 9). sides (c, 2, 3)
    [m], area (c,) [m²]; twist: [N/m] that edges and rims add to the shear of all cells, of which `kept` are
    (c,)."""
    count = len(twist)
    shear, volume, c01, c20, c30, limit = (
        of_cells(getattr(springs, name), count)[kept] for name in RUBBER_CONSTANTS
    )
    twist = twist[kept]
    c10 = 0.5 * shear
    stiffening = 2.0 * c20 + np.divide(c10, limit, out=np.zeros_like(limit), where=limit > 0.0)
    modulus, lame = shear + 2.0 * c01, volume + 4.0 * (c01 + stiffening)
    axial, lengths = along_each(springs.axial, count)[:, kept], (sides**2).sum(axis=2).T
    stretch = 2.0 * modulus - axial * lengths / area
    ratio = lame / modulus
    stiffness = np.column_stack([2.0 * modulus * ratio / (2.0 + ratio), *stretch, modulus + twist])
    energy = np.column_stack([c10, c01, c20, c30, volume]) * area[:, None]
    return stiffness, np.column_stack([energy, limit, *axial, twist / area])


def rank_one(stiffness: Any, *strain: Any) -> np.ndarray:
    """The strain springs and couplings (…, 6) [N/m], as `of_strains` has them, of energy ½ k (s·ε)² a0: k the
    stiffness (…) [N/m], s what each of ε1, ε2 and γ counts (…)."""
    x, y, shear = strain
    products = np.broadcast_arrays(x * x, y * y, shear * shear, x * y, x * shear, y * shear)
    return np.asarray(np.asarray(stiffness)[..., None] * np.stack(products, axis=-1))


def of_edge_cells(springs: SpringSet, grid: Grid, twisting: frozenset[str]) -> np.ndarray:
    """The strain springs and couplings that the edges along which nothing holds the director (`twisting`) add
    to every cell of a layer, and rims, (cells, 6) [N/m]; to a cell at two of them the sum."""
    shape = grid[1] - 1, grid[0] - 1
    cells = np.stack([of_cells(getattr(springs, name), shape[0] * shape[1]) for name in RIMS_OWN], axis=-1)
    cells = cells.reshape(*shape, len(RIMS_OWN))
    for edge in twisting:
        axis = EDGES[edge].normal_axis
        opposite = next(e for e in EDGES if e != edge and EDGES[e].normal_axis == axis)
        far = EDGES[edge].far_end
        stiffness = _of_edge(springs, "strip_shear" if opposite in twisting else "edge_shear", axis, far)
        stretch = _of_edge(springs, "edge_coupling", axis, far)
        strain = (0.0, stretch, 1.0) if axis == 0 else (stretch, 0.0, 1.0)
        row = -1 if far else 0
        cells[(slice(None), row) if axis == 0 else (row, slice(None))] += rank_one(stiffness, *strain)
    return cells.reshape(-1, len(RIMS_OWN))


def _of_edge(springs: SpringSet, name: str, axis: int, far: bool) -> np.ndarray:
    """A constant of the cells along an edge: of the one normal to an axis, the far one or that before it."""
    value: Any = getattr(springs, name)
    if far and (own := getattr(springs, f"far_{name}")) is not None:
        value = own
    return np.asarray((value.x, value.y)[axis] if isinstance(value, Either) else value)


def names(springs: SpringSet) -> list[str]:
    """Names of the spring constants that are not zero, one a direction where directions differ."""
    found: list[str] = []
    for name, value in springs:
        if isinstance(value, PerDirection | Either):
            found.extend(f"{name}_{direction}" for direction in "xy" if np.any(getattr(value, direction)))
        elif np.any(value) and name != "layer_distance":
            found.append(name)
    return found


def changed(springs: SpringSet, name: str, value: float) -> SpringSet:
    """The spring set with one constant (or layer_distance) changed. Raises BadInput for an unknown name."""
    if name in SpringSet.model_fields:
        return springs.model_copy(update={name: _with_mean(name, getattr(springs, name), value)})
    family, _, direction = name.rpartition("_")
    pair = getattr(springs, family, None)
    if not isinstance(pair, PerDirection | Either) or direction not in ("x", "y"):
        raise BadInput(f"parameter {name!r}: unknown, or without a value of its own in these springs")
    moved = _with_mean(family, getattr(pair, direction), value)
    return springs.model_copy(update={family: pair.model_copy(update={direction: moved})})


def value_of(springs: SpringSet, name: str) -> float:
    """The value of one spring constant (or layer_distance) by name."""
    if name in SpringSet.model_fields:
        return float(np.mean(getattr(springs, name)))
    family, _, direction = name.rpartition("_")
    return float(np.mean(getattr(getattr(springs, family), direction)))


def _with_mean(name: str, old: Any, value: float) -> Any:
    """The number, or the cells' values with this mean, as they were given."""
    if not isinstance(old, tuple):
        return value
    was = np.array(old)
    mean = was.mean()
    cells = was + (value - mean) if name in SIGNED else was * (value / mean)
    return tuple(map(tuple, cells.tolist())) if cells.ndim == 2 else tuple(cells.tolist())


def varies(springs: SpringSet) -> bool:
    """Whether any constant is given cell by cell."""
    return any(isinstance(value, tuple) for _, _, value in _numbers(springs))


def of_cells(value: Any, count: int) -> np.ndarray:
    """The value of each of `count` cells, (count,)."""
    return np.array(value, dtype=float).ravel() if isinstance(value, tuple) else np.full(count, float(value))


def of_cell(springs: SpringSet, row: int, column: int) -> SpringSet:
    """One cell's springs, all of them numbers; without those of edges."""
    return _mapped(
        springs.model_copy(update=dict.fromkeys(EDGES_OWN, 0.0)),
        lambda value, _: value[row][column] if isinstance(value, tuple) else value,
    )


def gathered(kinds: Sequence[SpringSet], which: np.ndarray, factor: np.ndarray) -> SpringSet:
    """The springs of a lattice from those of its kinds of cells: which kind every cell is, (rows, columns),
    rows from y0 to y1, and how many times as stiff; one layer distance for all."""
    found: dict[str, Any] = {"layer_distance": kinds[0].layer_distance}
    for name in SpringSet.model_fields:
        values = [getattr(kind, name) for kind in kinds]
        if name in (*found, *EDGES_OWN):
            continue
        times = np.ones_like(factor) if name == "gent_limit" else factor
        if any(isinstance(value, PerDirection) for value in values):
            x, y = (_table(times * np.array([_along(v, axis) for v in values])[which]) for axis in "xy")
            found[name] = x if x == y else PerDirection(x=x, y=y)
        else:
            found[name] = _table(times * np.array(values)[which])
    return SpringSet(**found)


def _along(value: Any, axis: str) -> Any:
    return getattr(value, axis) if isinstance(value, PerDirection) else value


def _table(values: np.ndarray) -> float | tuple[tuple[float, ...], ...]:
    """Zero where all are zero."""
    return tuple(map(tuple, values.tolist())) if values.any() else 0.0


def cut(springs: SpringSet, rows: int, columns: int) -> SpringSet:
    """The springs of the first rows and columns of cells."""

    def part(value: Any, axis: str) -> Any:
        if not isinstance(value, tuple):
            return value
        if isinstance(value[0], tuple):
            return tuple(row[:columns] for row in value[:rows])
        return value[: rows if axis == "x" else columns]

    return _mapped(springs, part)


def require_cells(springs: SpringSet, grid: Grid, whose: str) -> None:
    """Raise BadInput for a table that is not one of the grid's cells. whose: how the message begins."""
    rows, columns = grid[1] - 1, grid[0] - 1
    along = {"x": (rows,), "y": (columns,)}
    for name, axis, value in _numbers(springs):
        if not isinstance(value, tuple):
            continue
        wanted = along[axis] if name in EDGES_OWN else (rows, columns)
        if _shape(value) != wanted:
            key = f"{name}.{axis}" if axis else name
            cells = " rows of ".join(map(str, wanted))
            raise BadInput(f"{whose}springs.{key}: {cells} cells are wanted on {grid[0]}x{grid[1]} masses")


def _shape(value: tuple[Any, ...]) -> tuple[int, ...] | None:
    """Rows and columns of a table, or the length of a list; None where rows differ in length."""
    if not value or not isinstance(value[0], tuple):
        return (len(value),)
    lengths = {len(row) for row in value}
    return (len(value), lengths.pop()) if len(lengths) == 1 else None


def _numbers(springs: SpringSet) -> list[tuple[str, str, Any]]:
    """(name, direction, value) of every constant; the direction is empty where there is one for all."""
    found = []
    for name, value in springs:
        if isinstance(value, PerDirection | Either):
            found += [(name, axis, getattr(value, axis)) for axis in "xy"]
        else:
            found.append((name, "", value))
    return found


def _mapped(springs: SpringSet, change: Any) -> SpringSet:
    """The springs with change(value, direction) for every constant."""
    changed: dict[str, Any] = {}
    for name, value in springs:
        if isinstance(value, PerDirection | Either):
            pair = {axis: change(getattr(value, axis), axis) for axis in "xy"}
            changed[name] = value.model_copy(update=pair)
        else:
            changed[name] = change(value, "")
    return springs.model_copy(update=changed)
