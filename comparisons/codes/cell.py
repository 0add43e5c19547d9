"""A repeated cell of a discrete sheet: nodes, and the triangles, hinges and springs between them.

A node of the cell or of a neighbour is (node, i, j): the node's number and how many periods away. Energies of
small displacements u, per element:

    triangle  ½ A e:C:e, plane stress of λ and μ times thickness [N/m]   (constant strain; St Venant–Kirchhoff
              and neo-Hookean triangles, and Delingette's (2008) triangle springs, have it at small strain)
    hinge     ½ k w θ² over an edge that two triangles share, θ the angle between them; the weight w is 1
              ("angle", k in N·m), the edge's length L ("length", k in N) or 3 L²/(A₁ + A₂) ("height", k in
              N·m: discrete shells, Grinspun et al. 2003, quadratic bending, Bergou et al. 2006, but a factor)
    spring    ½ k (change of length)²  [N/m]
    brick     ½ ∫ e:C:e of λ and μ [Pa], eight corners, trilinear, integrated in full: the first
              four below, in turn, the others above them

The meshes that cloth and shell codes are given have cells by name.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import sqrt
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import Delaunay

from sheetbench.errors import BadInput, foreign, require_effect

Place = tuple[int, int, int]  # node, periods along the first and the second
HINGES: Mapping[str, Callable[[float, float], float]] = {
    "angle": lambda length, area: 1.0,
    "length": lambda length, area: length,
    "height": lambda length, area: 3.0 * length**2 / area,
}
HINGE_UNITS = {"angle": "N·m", "length": "N", "height": "N·m"}
KEYS = {"name", "periods", "nodes", "triangles", "hinge", "springs", "bricks"}
CORNERS = np.array([(x, y, z) for z in (-1, 1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


@dataclass(frozen=True)
class Element:
    """Nodes of an element, and its stiffness matrix (3 n, 3 n) per unit of each of its coefficients."""

    places: tuple[Place, ...]
    stiffness: Mapping[str, np.ndarray]


@dataclass(frozen=True)
class Cell:
    """A repeated cell of a sheet. Raises BadInput for an invalid cell.

    Parameters
    ----------
    name : str
        Name for tables and messages.
    periods : ndarray, (2, 2) [m]
        The two periods in the plane.
    nodes : ndarray, (n, 3) [m]
        Nodes of the cell, z from the mid-surface.
    triangles : tuple of three places each, optional
        Triangles between nodes, which may lie in neighbouring cells.
    hinge : {"", "angle", "length", "height"}, optional
        Weight of the hinges between triangles, "" for none.
    springs : tuple of two places and a name each, optional
        Springs with the names of their coefficients.
    bricks : tuple of eight places each, optional
        Bricks between nodes.
    """

    name: str
    periods: np.ndarray
    nodes: np.ndarray
    triangles: tuple[tuple[Place, ...], ...] = ()
    hinge: str = ""
    springs: tuple[tuple[Place, Place, str], ...] = ()
    bricks: tuple[tuple[Place, ...], ...] = ()

    def __post_init__(self) -> None:
        if abs(np.linalg.det(self.periods)) == 0.0 or not np.all(np.isfinite(self.nodes)):
            raise BadInput(f"{self.name}: periods must span an area, and nodes be finite")
        if self.hinge and self.hinge not in HINGES:
            raise BadInput(f"{self.name}: hinge = {self.hinge!r}: one of {', '.join(HINGES)}, or none")
        if not self.triangles and not self.springs and not self.bricks:
            raise BadInput(f"{self.name}: has no triangles, springs or bricks")
        places = [p for element in (*self.triangles, *self.bricks) for p in element]
        places += [p for a, b, _ in self.springs for p in (a, b)]
        for node, *_ in places:
            if not 0 <= node < len(self.nodes):
                raise BadInput(f"{self.name}: node {node}: there are {len(self.nodes)}, counted from 0")
        for triangle in self.triangles:
            if abs(_area(self.at(triangle))) < 1e-12 * abs(np.linalg.det(self.periods)):
                raise BadInput(f"{self.name}: triangle {list(triangle)}: has no area")
        for a, b, _ in self.springs:
            if a == b:
                raise BadInput(f"{self.name}: spring {list(a)}: has no length")

    @property
    def area(self) -> float:
        """The plan area of a cell [m²]."""
        return float(abs(np.linalg.det(self.periods)))

    def at(self, places: tuple[Place, ...]) -> np.ndarray:
        """Return the positions (n, 3) of places [m]."""
        shift = np.array([[i, j] for _, i, j in places]) @ self.periods
        return self.nodes[[node for node, _, _ in places]] + np.column_stack([shift, np.zeros(len(places))])

    def units(self) -> dict[str, str]:
        """Return the cell's coefficients with their units."""
        membrane = {"lambda_h": "N/m", "mu_h": "N/m"} if self.triangles else {}
        hinge = {"hinge": HINGE_UNITS[self.hinge]} if self.hinge else {}
        solid = {"lambda": "Pa", "mu": "Pa"} if self.bricks else {}
        return membrane | hinge | {name: "N/m" for _, _, name in self.springs} | solid

    def elements(self) -> list[Element]:
        """Return the elements, those shared with a neighbour once."""
        triangles = [Element(t, _triangle(self.at(t))) for t in self.triangles]
        springs = [Element((a, b), {name: _spring(self.at((a, b)))}) for a, b, name in self.springs]
        hinges = [Element(p, {"hinge": _hinge(self.at(p), HINGES[self.hinge])}) for p in self._hinges()]
        return triangles + springs + hinges + [Element(b, _brick(self.at(b))) for b in self.bricks]

    def _hinges(self) -> list[tuple[Place, ...]]:
        """Return the ends of each shared edge and the corners opposite it, each edge once; none without
        hinges."""
        found = sides_of(self.triangles if self.hinge else ())
        for edge, corners in found.items():
            if len(corners) != 2:
                raise BadInput(f"{self.name}: edge {list(edge)}: {len(corners)} triangles; a hinge has two")
        return [(*edge, *first, *second) for edge, (first, second) in found.items()]


def sides_of(elements: Iterable[Sequence[Place]]) -> dict[tuple[Place, Place], list[list[Place]]]:
    """Return every pair of corners of elements once, shifted so that the first lies in the cell itself, with
    the remaining corners of each element that contains the pair."""
    found: dict[tuple[Place, Place], list[list[Place]]] = {}
    for element in elements:
        for a, b in combinations(element, 2):
            first, second = sorted((a, b))
            others = (place for place in element if place not in (a, b))
            start, end, *rest = [(n, i - first[1], j - first[2]) for n, i, j in (first, second, *others)]
            found.setdefault((start, end), []).append(rest)
    return found


def from_toml(path: Path) -> Cell:
    """Return the cell of a file, with lengths in metres. Raises BadInput with the file and the fault."""
    try:
        data: dict[str, Any] = tomllib.loads(path.read_text(encoding="utf-8"))
        if unknown := set(data) - KEYS:
            raise BadInput(f"{path}: {', '.join(sorted(unknown))}: a cell has {', '.join(sorted(KEYS))}")
        nodes = np.array([[*node, 0.0][:3] for node in data["nodes"]], dtype=float)
        springs = tuple((tuple(a), tuple(b), str(name)) for a, b, name in data.get("springs", ()))
        triangles = tuple(tuple(tuple(place) for place in t) for t in data.get("triangles", ()))
        periods = np.array(data["periods"], dtype=float)
        bricks = tuple(tuple(tuple(place) for place in b) for b in data.get("bricks", ()))
        name, hinge = data.get("name", path.stem), data.get("hinge", "")
        return Cell(name, periods, nodes, triangles, hinge, springs, bricks)
    except (OSError, tomllib.TOMLDecodeError, KeyError, ValueError, TypeError, IndexError) as error:
        raise BadInput(f"{path}: not a cell: {foreign(error)}") from None


def _area(corners: np.ndarray) -> float:
    (ax, ay, _), (bx, by, _) = corners[1] - corners[0], corners[2] - corners[0]
    return float(0.5 * (ax * by - ay * bx))


def _spring(ends: np.ndarray) -> np.ndarray:
    along = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    row = np.concatenate([-along, along])
    return np.outer(row, row)


def _lame(slopes: np.ndarray, size: float) -> np.ndarray:
    """Return the matrices of (∇·u)² and 2 e:e, integrated over a length, area or volume `size`, (2, 3 n, 3
    n). slopes: of the shares of n nodes along x, y and z, (n, 3); those along z are 0 in a plane, whose e
    then is in it."""
    axes = np.diag(slopes.any(axis=0).astype(float))
    turned = np.einsum("nl,mj->njml", slopes, slopes).reshape(2 * [slopes.size])
    return size * np.array([np.outer(slopes, slopes), np.kron(slopes @ slopes.T, axes) + turned])


def _triangle(corners: np.ndarray) -> dict[str, np.ndarray]:
    """Return the matrices of λ (∇·u)² + 2 μ e:e over the area; corners at one height."""
    inverse = np.linalg.inv((corners[1:, :2] - corners[0, :2]).T)
    slopes = np.pad(np.vstack([-inverse.sum(axis=0), inverse]), ((0, 0), (0, 1)))
    return dict(zip(("lambda_h", "mu_h"), _lame(slopes, abs(_area(corners))), strict=True))


def _brick(corners: np.ndarray) -> dict[str, np.ndarray]:
    """Return the matrices of λ (∇·u)² + 2 μ e:e over the volume, by 2 × 2 × 2 points."""
    total = np.zeros((2, 24, 24))
    for point in CORNERS / 3.0**0.5:
        shares = (1.0 + CORNERS * point) / 2.0  # (corner, direction)
        others = [np.prod(np.delete(shares, q, axis=1), axis=1) for q in range(3)]
        rates = 0.5 * CORNERS * np.column_stack(others)
        jacobian = corners.T @ rates
        total += _lame(rates @ np.linalg.inv(jacobian), abs(float(np.linalg.det(jacobian))))
    return dict(zip(("lambda", "mu"), total, strict=True))


def _hinge(points: np.ndarray, weight: Callable[[float, float], float]) -> np.ndarray:
    """Return the matrix of a hinge's angle θ, linear in the heights of its points: both ends of the edge,
    then the opposite corners."""
    start, end, *opposite = points
    length = float(np.linalg.norm(end - start))
    along = (end - start) / length
    row, area = np.zeros(12), 0.0
    for corner, point in enumerate(opposite, start=2):
        share = float((point - start) @ along) / length
        height = float(np.linalg.norm(point - start - share * length * along))
        row[3 * corner + 2] = 1.0 / height
        row[[2, 5]] -= np.array([1.0 - share, share]) / height
        area += 0.5 * length * height
    return weight(length, area) * np.outer(row, row)


SEED, SIDE, JITTER = 7, 5, 0.25  # of the unstructured mesh: points along a side, their shift over the spacing


def cell_of(
    cell: str, spacing: float | None = None, thickness: float | None = None, hinge: str | None = None
) -> Cell:
    """Return the repeated cell of a mesh by its name, or of a TOML file.

    Parameters
    ----------
    cell : str
        A name of a mesh, or a path that ends in .toml.
    spacing : float [m], optional
        Distance of neighbouring nodes; necessary for a name.
    thickness : float [m], optional
        Thickness of bricks, one of which is in the thickness.
    hinge : {"angle", "length", "height"}, optional
        Energy of the hinges of other meshes, "length" unless given.

    Returns
    -------
    Cell
        The cell.

    Raises
    ------
    BadInput
        An unknown name, or an argument that is missing or has no effect on the cell.
    """
    if cell.endswith(".toml"):
        require_effect(f"on {cell}, which has its own", {"spacing": spacing, "hinge": hinge})
        return from_toml(Path(cell))
    if cell not in NAMES:
        raise BadInput(f"cell = {cell!r}: one of {', '.join(NAMES)}, or a file")
    if not (isinstance(spacing, float | int) and spacing > 0.0):
        raise BadInput(f"spacing = {str(spacing)[:20]}: the distance of nodes, in metres, is needed")
    if cell == BRICKS:
        require_effect(f"on {BRICKS}, which have no hinges", {"hinge": hinge})
        if not thickness:
            raise BadInput(f"thickness = {thickness}: of bricks, in metres, is needed")
        return _bricks(spacing, thickness)
    periods, nodes, triangles = MESHES[cell]()
    nodes = np.column_stack([nodes, np.zeros(len(nodes))])
    return Cell(
        cell, spacing * np.asarray(periods, dtype=float), spacing * nodes, triangles, hinge or "length"
    )


_Parts = tuple[np.ndarray, np.ndarray, tuple[tuple[Place, ...], ...]]


def cut_squares(number: np.ndarray, odd: np.ndarray) -> Iterator[tuple[int, int, int]]:
    """Yield the triangles of squares with numbered corners (m, n), cut by one diagonal, or by the other in
    the squares `odd` (m − 1, n − 1)."""
    for (i, j), other in np.ndenumerate(odd):
        a, d, b, c = number[i : i + 2, j : j + 2].ravel().tolist()
        yield from ((a, b, d), (b, c, d)) if other else ((a, b, c), (a, c, d))


def _squares(side: int) -> _Parts:
    """Return squares cut by a diagonal, in a period of `side` squares; with side 2 the diagonals
    alternate."""
    lines = range(side + 1)
    places = [(i % side * side + j % side, i // side, j // side) for i in lines for j in lines]
    number, (i, j) = np.arange(len(places)).reshape(side + 1, -1), np.indices((side, side))
    triangles = (tuple(places[n] for n in corners) for corners in cut_squares(number, (i + j) % 2 == 1))
    return side * np.eye(2), np.column_stack([i.ravel(), j.ravel()]).astype(float), tuple(triangles)


def _equilateral() -> _Parts:
    triangles = (((0, 0, 0), (0, 1, 0), (0, 0, 1)), ((0, 1, 0), (0, 1, 1), (0, 0, 1)))
    return np.array([[1.0, 0.0], [0.5, sqrt(0.75)]]), np.zeros((1, 2)), triangles


def _unstructured() -> _Parts:
    """Return Delaunay triangles of a grid's points moved at random, equal on every machine."""
    grid = np.array([[i, j] for i in range(SIDE) for j in range(SIDE)], dtype=float)
    points = (grid + JITTER * np.random.default_rng(SEED).uniform(-1.0, 1.0, grid.shape)) % SIDE
    tiles = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    tiled = np.vstack([points + SIDE * np.array(tile) for tile in tiles])
    triangles = []
    for corners in Delaunay(tiled).simplices:
        middle = tiled[corners].mean(axis=0)
        if np.all((middle >= 0.0) & (middle < SIDE)):
            triangles.append(tuple((int(c % len(grid)), *tiles[c // len(grid)]) for c in corners))
    return SIDE * np.eye(2), points, tuple(triangles)


MESHES: Mapping[str, Callable[[], _Parts]] = {
    "one-diagonal": lambda: _squares(1),
    "alternate-diagonals": lambda: _squares(2),
    "equilateral": _equilateral,
    "unstructured": _unstructured,
}
BRICKS = "bricks"
NAMES = (*MESHES, BRICKS)


def _bricks(spacing: float, thickness: float) -> Cell:
    nodes = np.array([[0.0, 0.0, -thickness / 2.0], [0.0, 0.0, thickness / 2.0]])
    corners = tuple((layer, i, j) for layer in (0, 1) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)))
    return Cell(BRICKS, spacing * np.eye(2), nodes, bricks=(corners,))
