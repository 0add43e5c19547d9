"""A mesh of a sheet of 20-node bricks, with its supports and loads, for programs that solve solids.

Nodes lie at corners and mid-edges of nx × ny × layers bricks, layers an even number, so that the mid-surface
is a plane of eight-node faces. A column is the nodes over one plan point; its middle node is the mid-surface.
Held is what a shell's support holds (`sheetbench.scenes.supports`): at a clamp every column keeps to its
director and may stretch along it, at a hinge the mean of the column alone is held: a line of nodes gives
way in a solid without end as bricks get smaller. A column may have axes of its own, turned as
`sheetbench.scenes.kinematics` turns the edge.

Numbering in an element is that of Abaqus, CalculiX and VTK: corners below, corners above, mid-edges below,
above, upright. SI units. Nothing here is shared with our own solid.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from comparisons.external.point_loads import point_loads
from sheetbench.scenes import EDGES, EdgeLoad, Scene, Symmetric, held_axes, holds_director
from sheetbench.scenes.grid import near_square
from sheetbench.scenes.kinematics import DrivenEdge, MovedEdge, bent_or_tilted
from sheetbench.scenes.sheet import Sheet

GRADINGS = ("edges", "uniform")


@dataclass(frozen=True)
class Bricks:
    """x (nx + 1,), y (ny + 1,), z (layers + 1,): planes between the bricks [m]."""

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray

    CORNERS: ClassVar = [
        (0, 0, 0),
        (2, 0, 0),
        (2, 2, 0),
        (0, 2, 0),
        (0, 0, 2),
        (2, 0, 2),
        (2, 2, 2),
        (0, 2, 2),
    ]
    BETWEEN: ClassVar = [
        (0, 1),
        (1, 2),
        (2, 3),
        (3, 0),
        (4, 5),
        (5, 6),
        (6, 7),
        (7, 4),
        (0, 4),
        (1, 5),
        (2, 6),
        (3, 7),
    ]

    @classmethod
    def of(cls, sheet: Sheet, elements: int, layers: int, grading: str) -> Bricks:
        """elements: along the shorter side, near-square; grading "edges": Chebyshev's points, finest
        there."""
        x, y = (
            length * fractions(n, grading)
            for length, n in zip(sheet.lengths, near_square(sheet, elements), strict=True)
        )
        return cls(x, y, np.linspace(-0.5, 0.5, layers + 1) * sheet.thickness)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Bricks along x, y and through the thickness."""
        return len(self.x) - 1, len(self.y) - 1, len(self.z) - 1

    @cached_property
    def number(self) -> np.ndarray:
        """Of the node at every half step (2 nx + 1, 2 ny + 1, 2 layers + 1), −1 where there is none."""
        odd = (np.indices([2 * n + 1 for n in self.shape]) % 2).sum(axis=0)
        out = np.full(odd.shape, -1)
        out[odd <= 1] = np.arange(np.sum(odd <= 1))
        return out

    @cached_property
    def sites(self) -> np.ndarray:
        """Half steps of the nodes (n, 3)."""
        return np.argwhere(self.number >= 0)

    @cached_property
    def positions(self) -> np.ndarray:
        """(n, 3) [m]."""
        lines = [_halved(planes) for planes in (self.x, self.y, self.z)]
        return np.column_stack([line[at] for line, at in zip(lines, self.sites.T, strict=True)])

    @cached_property
    def elements(self) -> np.ndarray:
        """Nodes of the bricks (m, 20), those of the lowest layer first."""
        corners = np.array(self.CORNERS)
        local = np.vstack([corners, [(corners[a] + corners[b]) // 2 for a, b in self.BETWEEN]])
        nx, ny, layers = self.shape
        k, j, i = (a.ravel() for a in np.meshgrid(range(layers), range(ny), range(nx), indexing="ij"))
        first = 2 * np.column_stack([i, j, k])
        return self.number[tuple((first[:, None] + local).transpose(2, 0, 1))]

    @property
    def middle(self) -> int:
        """The half step of the mid-surface."""
        return self.shape[2]

    def edge(self, name: str) -> np.ndarray:
        """Nodes of all columns on an edge."""
        edge = EDGES[name]
        last = 2 * self.shape[edge.normal_axis]
        return np.flatnonzero(self.sites[:, edge.normal_axis] == (last if edge.far_end else 0))

    def columns(self, nodes: np.ndarray) -> list[np.ndarray]:
        """Return the nodes by column, the middle one first."""
        by_place: dict[tuple[int, int], list[int]] = {}
        for node in sorted(nodes, key=lambda n: int(self.sites[n, 2] != self.middle)):
            by_place.setdefault((int(self.sites[node, 0]), int(self.sites[node, 1])), []).append(int(node))
        return [np.array(column) for column in by_place.values()]

    def mean(self, column: np.ndarray) -> np.ndarray:
        """Weights of a column's nodes in the mean through the thickness: Simpson's rule where it has nodes
        between the layers' planes, else the trapezoidal one."""
        steps = self.sites[column, 2]
        inside = np.where(steps % 2 == 1, 4.0, 2.0)
        rule = np.where(np.isin(steps, (0, steps.max())), 1.0, inside)
        mean: np.ndarray = rule / rule.sum()
        return mean

    def faces(self, name: str) -> np.ndarray:
        """Eight nodes of every brick's face on an edge (f, 8): corners in turn, mid-edges after them."""
        on = np.isin(self.elements, self.edge(name))
        rows = np.flatnonzero(on.sum(axis=1) == 8)
        nodes = self.elements[rows][on[rows]].reshape(-1, 8)
        odd = np.any(self.sites[nodes] % 2 == 1, axis=2)
        return np.take_along_axis(nodes, np.argsort(odd, axis=1, kind="stable"), axis=1)

    def weights(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Nodes of the mid-surface's faces at plan points (p, 2) [m], and their shape functions, (p, 8)."""
        (i, xi), (j, eta) = (
            _place(planes, at) for planes, at in zip((self.x, self.y), points.T, strict=True)
        )
        at = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
        nodes = np.column_stack([self.number[2 * i + a, 2 * j + b, self.middle] for a, b in at])
        return nodes, np.column_stack([_serendipity(xi, eta, a - 1, b - 1) for a, b in at])

    def sample(self, displacement: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Mid-surface displacement (p, 3) [m] at plan points (p, 2) [m] of nodal ones (n, 3)."""
        nodes, weights = self.weights(points)
        return np.einsum("pk,pkc->pc", weights, displacement[nodes])


@dataclass(frozen=True)
class Tie:
    """Σ weights · u[nodes] = 0 along an axis; nodes (k,), the column's middle first; weights (k,)."""

    axis: int
    nodes: np.ndarray
    weights: np.ndarray


@dataclass(frozen=True)
class Held:
    """Components of the nodes' displacement along their axes (n, 3, 3), one a row: which are fixed (n, 3),
    and at what (n, 3) [m]; `tied`: the means of columns at hinges; `turned`: whether a node's axes are not
    x, y and z (n,)."""

    axes: np.ndarray
    fixed: np.ndarray
    value: np.ndarray
    tied: tuple[Tie, ...]

    @property
    def turned(self) -> np.ndarray:
        return np.any(self.axes != np.eye(3), axis=(1, 2))


def held(scene: Scene, bricks: Bricks, linear: bool = False) -> Held:
    """Return what supports and motions hold; linear: to first order in the load."""
    n = len(bricks.positions)
    axes, fixed, value = np.tile(np.eye(3), (n, 1, 1)), np.zeros((n, 3), dtype=bool), np.zeros((n, 3))
    middle = bricks.sites[:, 2] == bricks.middle
    driven: dict[str, DrivenEdge] = {edge.edge: edge for edge in bent_or_tilted(scene.supports, scene.sheet)}
    driven |= {m.edge: MovedEdge(m, scene.sheet) for m in scene.motions().values()}
    ties: dict[tuple[int, int], Tie] = {}
    for support in scene.supports:
        nodes, along = bricks.edge(support.edge), held_axes(support)
        if isinstance(support, Symmetric):
            fixed[nodes[:, None], along] = True
        elif not holds_director(support):
            for column in bricks.columns(nodes):
                mean = bricks.mean(column)
                ties |= {(int(column[0]), axis): Tie(axis, column, mean) for axis in along}
        elif support.edge not in driven:
            fixed[nodes, :2] = fixed[nodes[middle[nodes]], 2] = True
    for edge in driven.values():
        nodes = bricks.edge(edge.edge)
        plan, height = bricks.positions[nodes, :2], bricks.positions[nodes, 2:]
        if linear:
            moved, change = edge.linear(plan)
            own = np.eye(3)
        else:
            placed = edge.placed(plan)
            moved, change = placed.displacement, placed.director
            own = np.swapaxes(np.eye(3) + placed.turn, -1, -2)
        axes[nodes] = own
        fixed[nodes, :2] = fixed[nodes[middle[nodes]], 2] = True
        value[nodes] = np.einsum(
            "...rc,kc->kr" if own.ndim == 2 else "krc,kc->kr", own, moved + height * change
        )
    tied = tuple(tie for (node, axis), tie in ties.items() if not fixed[node, axis])
    return Held(axes, fixed, value, tied)


def forces(scene: Scene, bricks: Bricks) -> np.ndarray:
    """Point loads and edge forces on the nodes (n, 3) [N]; of weight and pressure nothing."""
    out = point_loads(scene, bricks)
    for load in scene.loads:
        if isinstance(load, EdgeLoad):
            faces = bricks.faces(load.edge)
            span = np.ptp(bricks.positions[faces], axis=1)
            share = span[:, EDGES[load.edge].along_axis] * span[:, 2] / scene.sheet.thickness
            weights = np.repeat([-1.0 / 12.0, 1.0 / 3.0], 4)
            pull = load.last_factor * np.array(load.force_per_length)
            np.add.at(out, faces, share[:, None, None] * weights[:, None] * pull)
    return out


def fractions(count: int, grading: str) -> np.ndarray:
    """Planes between elements, as fractions (count + 1,) of a side."""
    even = np.arange(count + 1) / count
    return 0.5 * (1.0 - np.cos(np.pi * even)) if grading == "edges" else even


def _halved(planes: np.ndarray) -> np.ndarray:
    """Return the planes and their middles, in turn."""
    out = np.empty(2 * len(planes) - 1)
    out[::2], out[1::2] = planes, 0.5 * (planes[:-1] + planes[1:])
    return out


def _place(planes: np.ndarray, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the interval of positions (p,), and where in it, −1 to 1."""
    i = np.clip(np.searchsorted(planes, at, side="right") - 1, 0, len(planes) - 2)
    return i, 2.0 * (at - planes[i]) / (planes[i + 1] - planes[i]) - 1.0


def _serendipity(xi: np.ndarray, eta: np.ndarray, a: int, b: int) -> np.ndarray:
    """Shape function of the eight-node square's node at (a, b)."""
    if a and b:
        out: np.ndarray = 0.25 * (1 + a * xi) * (1 + b * eta) * (a * xi + b * eta - 1)
    elif b:
        out = 0.5 * (1 - xi**2) * (1 + b * eta)
    else:
        out = 0.5 * (1 + a * xi) * (1 - eta**2)
    return out
