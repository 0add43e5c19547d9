"""The constants of a spring or damper set as arrays: what is computed with, beside the table that is written.

`Springs.read` makes arrays of a table (`scenes.objects.springs`), `table` a table of them. A constant has
the shape (directions, rows, columns): one direction, or x and y, of Habibi et al.'s per-direction law x, y
and z; one row and column where all cells are alike, else rows of cells from y0 to y1, each from x0 to x1.
Those of edges are columns along x0 and rows along y0, or one number for both.

By name a constant that every cell has its own of goes by its mean over the cells. Given another mean, all its
values scale; those that may have either sign shift.
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
from sheetbench.scenes.objects.springs import CONSTANTS, LATTICE, DamperSet, Either

NEAR_EDGES = ("edge_shear", "strip_shear", "edge_coupling")
EDGES_OWN = (*NEAR_EDGES, *(f"far_{name}" for name in NEAR_EDGES))
COUPLINGS = ("coupling_xy", "coupling_x", "coupling_y")
MID_COUPLINGS = tuple(f"mid_{name}" for name in COUPLINGS)
RIMS_OWN = tuple(f"rim_{name}" for name in ("stretch_x", "stretch_y", "shear", *COUPLINGS))
OF_LAYER = {"axial": 2, "diagonal": 1, "area": 1, "stretch": 2, "shear": 1, **dict.fromkeys(COUPLINGS, 1)}
UPWARD = {  # of a layer's springs, and as many directions, what each layer has more than that below
    name: tuple(f"upward_{name}{axis}" for axis in (("",), ("_x", "_y"))[count - 1])
    for name, count in OF_LAYER.items()
}
RUBBER_CONSTANTS = tuple(name for name in CONSTANTS if name.startswith(("neo_", "mooney_", "yeoh_", "gent_")))
STRAINS = {  # name and direction of what resists ε1, ε2 and γ and couples ε1 ε2, ε1 γ and ε2 γ
    "area": (("stretch", 0), ("stretch", 1), ("shear", 0), *((name, 0) for name in COUPLINGS)),
    "rims": tuple((name, 0) for name in RIMS_OWN),
}
STRAINS["mid_area"] = tuple((f"mid_{name}", axis) for name, axis in STRAINS["area"])
FACES = ("face_shear", "face_diagonal_shear", "face_coupling")
SIGNED = ("area", "mid_area", "mid_shear", *COUPLINGS, *MID_COUPLINGS, *EDGES_OWN, *RIMS_OWN, "face_coupling")
SIGNED += tuple(key for keys in UPWARD.values() for key in keys)
ANY_SIGN = (*SIGNED, "mooney_rivlin", "yeoh_square")
REQUIRED = ("axial", "diagonal", "vertical", "cross", "cross_diagonal")
NO_STIFFNESS = {*LATTICE, "layer_distance"}
Parts = tuple[np.ndarray, ...]
NONE: Parts = (np.zeros((1, 1)),)


@dataclass(frozen=True, eq=False)
class Springs:
    """of: the constants [N/m] that are not all 0, one or one a direction, each (rows, columns), and those of
    edges, one for both or along x0 (rows, 1) and along y0 (1, columns); layer_distance [m], 0 of dampers."""

    of: dict[str, Parts]
    layer_distance: float = 0.0

    @classmethod
    def made(cls, layer_distance: float, **constants: Any) -> Springs:
        """Of numbers, (rows, columns) or (directions, rows, columns)."""
        of = {k: tuple(np.array(value, float, ndmin=3)) for k, value in constants.items() if np.any(value)}
        return cls(of, float(layer_distance))

    @classmethod
    def read(cls, table: SpringSet | DamperSet) -> Springs:
        """Of a table."""
        of: dict[str, Parts] = {}
        for name, value in table:
            if value is None or name in NO_STIFFNESS or (value == 0.0 and not name.startswith("far")):
                continue
            parts = {axis: np.array(part, dtype=float, ndmin=2) for axis, part in _parts(value)}
            if name in EDGES_OWN:
                of[name] = tuple(part.T if axis == "x" else part for axis, part in parts.items())
            elif any(map(np.any, parts.values())):
                of[name] = tuple(np.broadcast_arrays(*parts.values()))
        return cls(of, float(getattr(table, "layer_distance", 0.0)))

    def table(self) -> SpringSet:
        """As the table that is written. Raises SceneError for what it cannot hold."""
        inside = {name: self[name] for name in self.of if name not in EDGES_OWN}
        every = np.concatenate([[0.0], *(array.ravel() for array in inside.values())])
        links = [array.ravel() for name, array in inside.items() if name not in ANY_SIGN]
        known = np.abs(every).max() <= LARGEST and np.concatenate([[0.0], *links]).min() >= 0.0
        pair, whole = (
            (PerDirection.model_construct, SpringSet.model_construct) if known else (PerDirection, SpringSet)
        )
        written: dict[str, Any] = dict.fromkeys(REQUIRED, 0.0)
        for name, parts in self.of.items():
            of_edges = name in EDGES_OWN
            ends = [_written(part.ravel() if of_edges else part) for part in parts]
            both = Either.model_construct if of_edges else pair
            written[name] = both(**dict(zip("xyz", ends, strict=False))) if len(ends) > 1 else ends[0]
        return whole(**written, layer_distance=self.layer_distance)

    def __getitem__(self, name: str) -> np.ndarray:
        return np.asarray(self.of.get(name, NONE))

    def along(self, name: str, axis: int) -> np.ndarray:
        """A constant of the springs along x, y or z (0, 1, 2), (rows, columns)."""
        found = self[name]
        return np.asarray(found[min(axis, len(found) - 1)])

    def of_links(self, family: str, direction: str) -> np.ndarray:
        """Stiffness [N/m] (or damping [N·s/m]) of the links of a family that run in a direction, (cells,
        components): the components x, y and z of Habibi et al.'s law, else one."""
        found = self[family]
        if len(found) == 3:
            return found.reshape(3, -1).T
        if len(found) == 2 and direction not in ("x", "y"):
            raise BadInput(
                f"springs.{family} = {{x, y}}: only axial and cross links run along x or y; give one number"
            )
        return self.along(family, "xy".find(direction)).reshape(-1, 1)

    def strains(self, cells: str) -> np.ndarray:
        """Stiffness [N/m] of ε1, ε2 and γ and of what couples ε1 ε2, ε1 γ and ε2 γ, of the strain springs on
        the cells called "area" (each layer), "mid_area" (the mid-surface) or "rims", (rows, columns, 6)."""
        found = np.zeros((*self.shape, 6))
        for number, (name, axis) in enumerate(STRAINS[cells]):
            if name in self.of:
                found[..., number] = self.along(name, axis)
        return found

    @cached_property
    def upward(self) -> Springs:
        """What each layer has more than that below, as springs of a layer; none of layers that are alike."""
        own = {name: tuple(self.along(key, 0) for key in keys) for name, keys in UPWARD.items()}
        parts = {name: tuple(np.broadcast_arrays(*each)) for name, each in own.items()}
        return Springs({name: each for name, each in parts.items() if np.any(each)}, self.layer_distance)

    @cached_property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of cells that differ, 1 and 1 where they are alike."""
        parts = (self.of[name][0].shape for name in self.of if name not in EDGES_OWN)
        rows, columns = np.broadcast_shapes((1, 1), *parts)
        return rows, columns

    @property
    def varies(self) -> bool:
        """Whether any constant is given cell by cell."""
        return any(part.size > 1 for parts in self.of.values() for part in parts)

    @property
    def rubber(self) -> bool:
        """Whether the layers' cells are rubber membranes."""
        return "neo_hookean_shear" in self.of or "mooney_rivlin" in self.of

    def scaled(self, factor: np.ndarray) -> Springs:
        """So many times as stiff, (rows, columns); without those of edges."""
        times = {name: 1.0 if name == "gent_limit" else factor for name in self.of if name not in EDGES_OWN}
        return replace(self, of={name: tuple(self[name] * by) for name, by in times.items()})

    def names(self) -> list[str]:
        """Names of the constants that are not zero, one a direction where directions differ."""
        found: list[str] = []
        for name in CONSTANTS:
            parts = [*self.of.get(name, ())]
            if len(parts) > 1:
                found += [f"{name}_{axis}" for axis, part in zip("xy", parts, strict=False) if part.any()]
            elif parts and parts[0].any():
                found.append(name)
        return found

    def value(self, name: str) -> float:
        """The value of one constant (or layer_distance) by name. Raises BadInput for an unknown name."""
        if name == "layer_distance":
            return self.layer_distance
        family, which = self._named(name)
        return float(np.mean([part.mean() for part in self.of.get(family, NONE)[which]]))

    def changed(self, name: str, value: float) -> Springs:
        """The springs with one constant (or layer_distance) changed. Raises BadInput for an unknown name."""
        if name == "layer_distance":
            return replace(self, layer_distance=value)
        (family, which), was = self._named(name), self.value(name)
        parts, shift = [*self.of.get(family, NONE)], family in SIGNED or was == 0.0
        parts[which] = [part + (value - was) if shift else part * (value / was) for part in parts[which]]
        return replace(self, of={**self.of, family: tuple(parts)})

    def _named(self, name: str) -> tuple[str, slice]:
        """The constant, and which of its directions are meant."""
        if name in CONSTANTS:
            return name, slice(None)
        family, _, direction = name.rpartition("_")
        if len(self.of.get(family, NONE)) == 1 or direction not in ("x", "y"):
            raise BadInput(f"parameter {name!r}: unknown, or without a value of its own in these springs")
        return family, slice(0, 1) if direction == "x" else slice(1, 2)


def _parts(value: Any) -> Iterator[tuple[str, Any]]:
    """(direction, value) of a constant of a table; the direction is empty where there is one for all."""
    if isinstance(value, PerDirection | Either):
        yield from ((axis, part) for axis, part in value if part is not None)
    elif value is not None:
        yield "", value


def _written(cells: np.ndarray) -> Any:
    """A number, or a row or rows of them."""
    if cells.size == 1 or not cells.any():
        return float(cells.flat[0])
    return tuple(map(tuple, cells.tolist())) if cells.ndim > 1 else tuple(cells.tolist())


def by_direction(x: Any, y: Any, alike: float = 1e-12) -> np.ndarray:
    """Stiffness along x and y, numbers or (rows, columns), (directions, rows, columns): one direction where
    they are alike; what rounding put below zero is zero."""
    x, y = (np.atleast_2d(np.maximum(part, 0.0)) for part in (x, y))
    y = np.where(np.abs(x - y) <= alike * np.maximum(x, y), x, y)
    return x[None] if (x == y).all() else np.stack([x, y])


def either(x: np.ndarray, y: np.ndarray) -> Parts:
    """Constants of edges along x0 and y0, of either sign: one number where all are alike."""
    if not (x.any() or y.any()):
        return NONE
    alike = x.size == y.size == 1 and abs(x[0] - y[0]) <= 1e-12 * max(abs(x[0]), abs(y[0]))
    return (x[:, None],) if alike else (x[:, None], y[None])


def of_rubber(
    springs: Springs,
    squares: np.ndarray,
    area: np.ndarray,
    twist: np.ndarray,
    chosen: Callable[[np.ndarray], np.ndarray],
) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness (c, 4) [N/m] of the small strains of a layer's plan cells that are rubber membranes, less
    that of their axial links, and what else `lumped.springs.laws` takes of them (c, 9). squares: of the
    sides, (c, 2) [m²]; area (c,) [m²]; twist: [N/m] that edges and rims add to their shear, (c,); chosen:
    gives of a constant (rows, columns) that of these cells, (c,)."""
    shear, volume, c01, c20, c30, limit = (chosen(springs.along(name, 0)) for name in RUBBER_CONSTANTS)
    c10 = 0.5 * shear
    stiffening = 2.0 * c20 + np.divide(c10, limit, out=np.zeros_like(limit), where=limit > 0.0)
    modulus, lame = shear + 2.0 * c01, volume + 4.0 * (c01 + stiffening)
    axial = np.stack([chosen(springs.along("axial", axis)) for axis in (0, 1)])
    stretch = 2.0 * modulus - axial * squares.T / area
    ratio = np.divide(lame, modulus, out=np.zeros_like(lame), where=modulus > 0.0)
    stiffness = np.column_stack([2.0 * modulus * ratio / (2.0 + ratio), *stretch, modulus + twist])
    energy = np.column_stack([c10, c01, c20, c30, volume]) * area[:, None]
    return stiffness, np.column_stack([energy, limit, *axial, twist / area])


def of_faces(springs: Springs, squares: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What the upright faces of cells add to the shear stiffness of a gap along x and y [N/m]: those on their
    sides, those over their diagonals, (rows, columns, 2) each. squares: of the sides (lx, ly) [m²], the
    same."""
    beside = np.stack([springs.along("face_shear", axis) for axis in (0, 1)], axis=-1)
    over = springs.along("face_diagonal_shear", 0) + 0.5 * np.abs(springs.along("face_coupling", 0))
    return beside, 2.0 * over[..., None] * squares / squares.sum(axis=-1, keepdims=True)


def rank_one(stiffness: Any, *strain: Any) -> np.ndarray:
    """The strain springs and couplings (…, 6) [N/m], as `Springs.strains` has them, of energy ½ k (s·ε)² a0:
    k the stiffness (…) [N/m], s what each of ε1, ε2 and γ counts (…)."""
    x, y, shear = strain
    products = np.broadcast_arrays(x * x, y * y, shear * shear, x * y, x * shear, y * shear)
    return np.asarray(np.asarray(stiffness)[..., None] * np.stack(products, axis=-1))


def along_edge(axis: int, stretch: Any) -> tuple[Any, Any, float]:
    """What ε1, ε2 and γ count towards an edge normal to an axis: γ, and r of the strain along it."""
    return (0.0, stretch, 1.0) if axis == 0 else (stretch, 0.0, 1.0)


def of_edge_cells(springs: Springs, grid: Grid, twisting: frozenset[str]) -> np.ndarray:
    """The strain springs and couplings that the edges along which nothing holds the director (`twisting`) add
    to every cell of a layer, and rims, (cells, 6) [N/m]; to a cell at two of them the sum."""
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
    """Raise BadInput for a table that is not one of the grid's cells. whose: how the message begins."""
    rows, columns = grid[1] - 1, grid[0] - 1
    along = {"x": (rows,), "y": (columns,)}
    for name in CONSTANTS:
        for axis, part in _parts(getattr(table, name)):
            if not isinstance(part, tuple):
                continue
            wanted = along[axis] if name in EDGES_OWN else (rows, columns)
            lengths = {len(row) if isinstance(row, tuple) else None for row in part}
            if len(part) != wanted[0] or lengths != {wanted[1] if len(wanted) > 1 else None}:
                key = f"{name}.{axis}" if axis else name
                cells = " rows of ".join(map(str, wanted))
                raise BadInput(
                    f"{whose}springs.{key}: {cells} cells are wanted on {grid[0]}x{grid[1]} masses"
                )
