"""The constants of a spring or damper set as arrays for computation; a scene's file has tables of them.

`Springs.read` converts a table (`scenes.objects.springs`) to arrays, `table` arrays to a table. A constant
has the shape (directions, rows, columns): one direction, or x and y, of Habibi et al.'s per-direction law x,
y and z; one row and column if all cells are alike, else rows of cells from y0 to y1, each from x0 to x1.
Constants of edges are columns along x0 and rows along y0, or one number for both.

The value of a constant that varies over cells is its mean. A new mean scales all values, or shifts them if
the constant may have either sign.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from sheetbench.errors import BadInput
from sheetbench.scenes import EDGES, PerDirection, SpringSet
from sheetbench.scenes.objects.grid import Grid
from sheetbench.scenes.objects.quantities import LARGEST
from sheetbench.scenes.objects.springs import CONSTANTS, DamperSet, Either

NEAR_EDGES = ("edge_shear", "strip_shear", "edge_coupling")
EDGES_OWN = (*NEAR_EDGES, *(f"far_{name}" for name in NEAR_EDGES))  # constants of edges, not of cells
COUPLINGS = ("coupling_xy", "coupling_x", "coupling_y")
MID_COUPLINGS = tuple(f"mid_{name}" for name in COUPLINGS)
RIMS_OWN = tuple(f"rim_{name}" for name in ("stretch_x", "stretch_y", "shear", *COUPLINGS))
OF_LAYER = {"axial": 2, "diagonal": 1, "area": 1, "stretch": 2, "shear": 1, **dict.fromkeys(COUPLINGS, 1)}
UPWARD = {  # increase from each layer to the next above, of a layer's springs, by direction
    name: tuple(f"upward_{name}{axis}" for axis in (("",), ("_x", "_y"))[count - 1])
    for name, count in OF_LAYER.items()
}
RUBBER_CONSTANTS = tuple(name for name in CONSTANTS if name.startswith(("neo_", "mooney_", "yeoh_", "gent_")))
STRAINS = {  # name and direction of the stiffness of ε1, ε2 and γ and the couplings ε1 ε2, ε1 γ and ε2 γ
    "area": (("stretch", 0), ("stretch", 1), ("shear", 0), *((name, 0) for name in COUPLINGS)),
    "rims": tuple((name, 0) for name in RIMS_OWN),
}
STRAINS["mid_area"] = tuple((f"mid_{name}", axis) for name, axis in STRAINS["area"])
FACES = ("face_shear", "face_diagonal_shear", "face_coupling")
SIGNED = ("area", "mid_area", "mid_shear", *COUPLINGS, *MID_COUPLINGS, *EDGES_OWN, *RIMS_OWN, "face_coupling")
SIGNED += tuple(key for keys in UPWARD.values() for key in keys)
ANY_SIGN = (*SIGNED, "mooney_rivlin", "yeoh_square")
REQUIRED = ("axial", "diagonal", "vertical", "cross", "cross_diagonal")
Parts = tuple[np.ndarray, ...]
NONE: Parts = (np.zeros((1, 1)),)


@dataclass(frozen=True, eq=False)
class Springs:
    """Constants of springs or dampers. of: arrays [N/m] of constants that are not all 0, by name: one or one
    a direction, each (rows, columns); constants of edges one for both, or along x0 (rows, 1) and along y0 (1,
    columns). layer_distance: [m], 0 of dampers; of several sheets, a row each, (rows, 1)."""

    of: dict[str, Parts]
    layer_distance: Any = 0.0

    @classmethod
    def made(cls, layer_distance: Any, **constants: Any) -> Springs:
        """Return springs from constants, numbers, (rows, columns) or (directions, rows, columns) each."""
        of = {k: tuple(np.array(value, float, ndmin=3)) for k, value in constants.items() if np.any(value)}
        return cls(of, layer_distance if np.ndim(layer_distance) else float(layer_distance))

    @classmethod
    def read(cls, table: SpringSet | DamperSet) -> Springs:
        """Return the constants of a table."""
        of: dict[str, Parts] = {}
        given = table.model_fields_set - {"layer_distance"}
        for name in (name for name in CONSTANTS if name in given):
            value = getattr(table, name)
            if value is None or (value == 0.0 and not name.startswith("far")):
                continue
            parts = {axis: np.array(part, dtype=float, ndmin=2) for axis, part in _parts(value)}
            if name in EDGES_OWN:
                of[name] = tuple(part.T if axis == "x" else part for axis, part in parts.items())
            elif any(map(np.any, parts.values())):
                of[name] = tuple(np.broadcast_arrays(*parts.values()))
        return cls(of, float(getattr(table, "layer_distance", 0.0)))

    def table(self) -> SpringSet:
        """Return the table of a scene's file. Raises SceneError for constants out of a table's range."""
        of_cells = {name: self[name] for name in self.of if name not in EDGES_OWN}
        values = np.concatenate([[0.0], *(array.ravel() for array in of_cells.values())])
        unsigned = [array.ravel() for name, array in of_cells.items() if name not in ANY_SIGN]
        valid = np.abs(values).max() <= LARGEST and np.concatenate([[0.0], *unsigned]).min() >= 0.0
        pair: Any = PerDirection.model_construct if valid else PerDirection
        whole: Any = SpringSet.model_construct if valid else SpringSet
        written: dict[str, Any] = dict.fromkeys(REQUIRED, 0.0)
        for name, parts in self.of.items():
            of_edges = name in EDGES_OWN
            ends = [_table_value(part.ravel() if of_edges else part) for part in parts]
            both = Either.model_construct if of_edges else pair
            written[name] = both(**dict(zip("xyz", ends, strict=False))) if len(ends) > 1 else ends[0]
        return whole(**written, layer_distance=self.layer_distance)

    def __getitem__(self, name: str) -> np.ndarray:
        return np.asarray(self.of.get(name, NONE))

    def along(self, name: str, axis: int) -> np.ndarray:
        """Return a constant of the springs along x, y or z (0, 1, 2), (rows, columns)."""
        parts = self[name]
        return np.asarray(parts[min(axis, len(parts) - 1)])

    def of_links(self, family: str, direction: str) -> np.ndarray:
        """Return the stiffness [N/m] (or damping [N·s/m]) of a family's links along a direction, (cells,
        components): the components x, y and z of Habibi et al.'s law, else one."""
        parts = self[family]
        if len(parts) == 3:
            return parts.reshape(3, -1).T
        if len(parts) == 2 and direction not in ("x", "y"):
            raise BadInput(
                f"springs.{family} = {{x, y}}: only axial and cross links run along x or y; give one number"
            )
        return self.along(family, "xy".find(direction)).reshape(-1, 1)

    def strains(self, cells: str) -> np.ndarray:
        """Return the stiffness [N/m] of ε1, ε2 and γ and of the couplings ε1 ε2, ε1 γ and ε2 γ, (rows,
        columns, 6), of the strain springs on the cells called "area" (each layer), "mid_area" (the
        mid-surface) or "rims"."""
        stiffness = np.zeros((*self.shape, 6))
        for number, (name, axis) in enumerate(STRAINS[cells]):
            if name in self.of:
                stiffness[..., number] = self.along(name, axis)
        return stiffness

    def split(self, count: int) -> list[Springs]:
        """Return the springs of each of several grids that are row after row (`GridCells.stacked`)."""

        def each(part: np.ndarray) -> np.ndarray:
            rows = part.reshape(min(count, part.size), -1, 1 if len(part) == 1 else part.shape[1])
            return np.broadcast_to(rows, (count, *rows.shape[1:]))

        of = {name: [*zip(*map(each, parts), strict=True)] for name, parts in self.of.items()}
        distances = np.broadcast_to(np.ravel(self.layer_distance), count).tolist()
        return [Springs({name: parts[n] for name, parts in of.items()}, z) for n, z in enumerate(distances)]

    @cached_property
    def upward(self) -> Springs:
        """Increase of the constants from each layer to the next above, as springs of a layer."""
        given = {name: keys for name, keys in UPWARD.items() if self.of.keys() & {*keys}}
        increase = {name: [self.along(key, 0) for key in keys] for name, keys in given.items()}
        of: dict[str, Parts] = {
            name: tuple(np.broadcast_arrays(*arrays)) for name, arrays in increase.items()
        }
        return Springs(of, self.layer_distance)

    @cached_property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of cells that differ, 1 and 1 if they are alike."""
        parts = (self.of[name][0].shape for name in self.of if name not in EDGES_OWN)
        rows, columns = np.broadcast_shapes((1, 1), *parts)
        return rows, columns

    @property
    def varies(self) -> bool:
        """Return whether any constant is given cell by cell."""
        return any(part.size > 1 for parts in self.of.values() for part in parts)

    @property
    def rubber(self) -> bool:
        """Return whether the layers' cells are rubber membranes."""
        return "neo_hookean_shear" in self.of or "mooney_rivlin" in self.of

    def scaled(self, factor: np.ndarray) -> Springs:
        """Return the constants of cells times a factor (rows, columns), without constants of edges."""
        times = {name: 1.0 if name == "gent_limit" else factor for name in self.of if name not in EDGES_OWN}
        return replace(self, of={name: tuple(self[name] * by) for name, by in times.items()})

    def names(self) -> list[str]:
        """Return the names of the constants that are not zero, one a direction if directions differ."""
        names: list[str] = []
        for name in CONSTANTS:
            parts = [*self.of.get(name, ())]
            if len(parts) > 1:
                names += [f"{name}_{axis}" for axis, part in zip("xy", parts, strict=False) if part.any()]
            elif parts and parts[0].any():
                names.append(name)
        return names

    def value(self, name: str) -> float:
        """Return the value of one constant (or layer_distance). Raises BadInput for an unknown name."""
        if name == "layer_distance":
            return self.layer_distance
        family, which = self._constant_of(name)
        return float(np.mean([part.mean() for part in self.of.get(family, NONE)[which]]))

    def changed(self, name: str, value: float) -> Springs:
        """Return the springs with one constant (or layer_distance) changed. Raises BadInput for an unknown
        name."""
        if name == "layer_distance":
            return replace(self, layer_distance=value)
        (family, which), was = self._constant_of(name), self.value(name)
        parts, shift = [*self.of.get(family, NONE)], family in SIGNED or was == 0.0
        parts[which] = [part + (value - was) if shift else part * (value / was) for part in parts[which]]
        return replace(self, of={**self.of, family: tuple(parts)})

    def _constant_of(self, name: str) -> tuple[str, slice]:
        """Return the constant of a name, and the slice of its directions."""
        if name in CONSTANTS:
            return name, slice(None)
        family, _, direction = name.rpartition("_")
        if len(self.of.get(family, NONE)) == 1 or direction not in ("x", "y"):
            raise BadInput(f"parameter {name!r}: unknown, or without a value of its own in these springs")
        return family, slice(0, 1) if direction == "x" else slice(1, 2)


def _parts(value: Any) -> Iterator[tuple[str, Any]]:
    """Yield (direction, value) of a constant of a table; the direction is empty for one value for all."""
    if isinstance(value, PerDirection | Either):
        yield from ((axis, part) for axis, part in value if part is not None)
    elif value is not None:
        yield "", value


def _table_value(cells: np.ndarray) -> Any:
    """Return an array as a number, or a row or rows of numbers."""
    if cells.size == 1 or not cells.any():
        return float(cells.flat[0])
    return tuple(map(tuple, cells.tolist())) if cells.ndim > 1 else tuple(cells.tolist())


def by_direction(x: Any, y: Any, alike: float = 1e-12) -> np.ndarray:
    """Return the stiffness along x and y, numbers or (rows, columns) each, as (directions, rows, columns):
    one direction if they are alike, 0 for negative values."""
    x, y = (np.atleast_2d(np.maximum(part, 0.0)) for part in (x, y))
    y = np.where(np.abs(x - y) <= alike * np.maximum(x, y), x, y)
    return x[None] if (x == y).all() else np.stack([x, y])


def either(x: np.ndarray, y: np.ndarray) -> Parts:
    """Return constants of edges along x0 and y0, of either sign, as parts; one number if all are alike."""
    if not (x.any() or y.any()):
        return NONE
    alike = x.size == y.size == 1 and abs(x[0] - y[0]) <= 1e-12 * max(abs(x[0]), abs(y[0]))
    return (x[:, None],) if alike else (x[:, None], y[None])


def of_rubber(
    springs: Springs,
    squares: np.ndarray,
    area: np.ndarray,
    twist: np.ndarray,
    select: Callable[[np.ndarray], np.ndarray],
) -> tuple[np.ndarray, np.ndarray]:
    """Return the stiffness (c, 4) [N/m] of small strains of a layer's plan cells that are rubber membranes,
    their axial links' stiffness subtracted, and the other parameters (c, 9) of rubber cells in
    `lumped.springs.laws`. squares: of the sides, (c, 2) [m²]; area: (c,) [m²]; twist: (c,) [N/m] that edges
    and rims add to the shear; select: selects the cells' values (c,) of a constant (rows, columns)."""
    shear, volume, c01, c20, c30, limit = (select(springs.along(name, 0)) for name in RUBBER_CONSTANTS)
    c10 = 0.5 * shear
    stiffening = 2.0 * c20 + np.divide(c10, limit, out=np.zeros_like(limit), where=limit > 0.0)
    modulus, lame = shear + 2.0 * c01, volume + 4.0 * (c01 + stiffening)
    axial = np.stack([select(springs.along("axial", axis)) for axis in (0, 1)])
    stretch = 2.0 * modulus - axial * squares.T / area
    ratio = np.divide(lame, modulus, out=np.zeros_like(lame), where=modulus > 0.0)
    stiffness = np.column_stack([2.0 * modulus * ratio / (2.0 + ratio), *stretch, modulus + twist])
    energy = np.column_stack([c10, c01, c20, c30, volume]) * area[:, None]
    return stiffness, np.column_stack([energy, limit, *axial, twist / area])


def of_faces(springs: Springs, squares: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the shear stiffness of a gap along x and y [N/m] by upright faces on the cells' sides and by
    faces over the diagonals, (rows, columns, 2) each. squares: of the sides (lx, ly), (rows, columns, 2)
    [m²]."""
    on_sides = np.stack([springs.along("face_shear", axis) for axis in (0, 1)], axis=-1)
    over = springs.along("face_diagonal_shear", 0) + 0.5 * np.abs(springs.along("face_coupling", 0))
    return on_sides, 2.0 * over[..., None] * squares / squares.sum(axis=-1, keepdims=True)


def rank_one(stiffness: Any, *strain: Any) -> np.ndarray:
    """Return the strain springs and couplings (…, 6) [N/m] (see `Springs.strains`) of energy ½ k (s·ε)² a0: k
    the stiffness (…) [N/m], s the weights (…) of ε1, ε2 and γ."""
    weights = np.zeros((*np.broadcast_shapes(*map(np.shape, strain), np.shape(stiffness)), 3))
    for number, of in enumerate(strain):
        weights[..., number] = of
    return (
        np.asarray(stiffness)[..., None] * weights[..., [0, 1, 2, 0, 0, 1]] * weights[..., [0, 1, 2, 1, 2, 2]]
    )


def along_edge(axis: int, stretch: Any) -> tuple[Any, Any, float]:
    """Return the weights of ε1, ε2 and γ at an edge normal to an axis: 1 of γ, r of the strain along it."""
    return (0.0, stretch, 1.0) if axis == 0 else (stretch, 0.0, 1.0)


def of_edge_cells(springs: Springs, grid: Grid, twisting: frozenset[str]) -> np.ndarray:
    """Return the strain springs and couplings of every cell of a layer by rims and by the edges along which
    nothing holds the director (`twisting`), (cells, 6) [N/m]; a cell at two of the edges has the sum."""
    cells = np.zeros((grid[1] - 1, grid[0] - 1, len(RIMS_OWN)))
    cells += springs.strains("rims")

    def of(name: str, axis: int, far: bool) -> np.ndarray:
        pair = springs.of.get(name, NONE)
        pair = springs.of.get(f"far_{name}", pair) if far else pair
        return pair[min(axis, len(pair) - 1)].ravel()

    for edge in twisting:
        axis, far = EDGES[edge].normal_axis, EDGES[edge].far_end
        opposite = next(e for e in EDGES if e != edge and EDGES[e].normal_axis == axis)
        stiffness = of("strip_shear" if opposite in twisting else "edge_shear", axis, far)
        row = -1 if far else 0
        strain = along_edge(axis, of("edge_coupling", axis, far))
        cells[(slice(None), row) if axis == 0 else (row, slice(None))] += rank_one(stiffness, *strain)
    return cells.reshape(-1, len(RIMS_OWN))


def require_cells(table: SpringSet, grid: Grid, whose: str) -> None:
    """Raise BadInput for a table of another grid's cells. whose: start of the message."""
    rows, columns = grid[1] - 1, grid[0] - 1
    along = {"x": (rows,), "y": (columns,)}
    for name in CONSTANTS:
        for axis, part in _parts(getattr(table, name)):
            if not isinstance(part, tuple):
                continue
            shape = along[axis] if name in EDGES_OWN else (rows, columns)
            lengths = {len(row) if isinstance(row, tuple) else None for row in part}
            if len(part) != shape[0] or lengths != {shape[1] if len(shape) > 1 else None}:
                key = f"{name}.{axis}" if axis else name
                cells = " rows of ".join(map(str, shape))
                raise BadInput(
                    f"{whose}springs.{key}: {cells} cells are needed on {grid[0]}x{grid[1]} masses"
                )
