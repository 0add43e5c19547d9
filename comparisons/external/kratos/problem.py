"""The problem that Kratos solves, as arrays: triangles of a flat sheet, supports and forces.

Cells of a grid in halves, diagonals by turns, so that the mesh mirrors itself where the number of cells is
even. A node has the unknowns of displacement and rotation vector. A clamp holds all six, a hinge the
displacement. SI.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from scipy.spatial.transform import Rotation

from comparisons.external.bricks import point_loads
from sheetbench.scenes import (
    EDGES,
    EdgeLoad,
    Pressure,
    Scene,
    Symmetric,
    held_axes,
    holds_director,
)
from sheetbench.scenes.meaning.kinematics import DrivenEdge, MovedEdge, bent_or_tilted
from sheetbench.scenes.objects.grid import near_square
from sheetbench.scenes.objects.sheet import Sheet


@dataclass(frozen=True)
class Triangles:
    """x (nx + 1,), y (ny + 1,): lines between the cells [m]; node (i, j) has the number i (ny + 1) + j."""

    KIND: ClassVar = "triangle"
    x: np.ndarray
    y: np.ndarray

    @classmethod
    def of(cls, sheet: Sheet, elements: int) -> Triangles:
        """Elements along the shorter side, near-square and of one size."""
        counts = near_square(sheet, elements)
        x, y = (np.linspace(0.0, length, n + 1) for length, n in zip(sheet.lengths, counts, strict=True))
        return cls(x, y)

    @property
    def counts(self) -> tuple[int, int]:
        """Cells along x and y."""
        return len(self.x) - 1, len(self.y) - 1

    @property
    def label(self) -> str:
        """How many triangles there are, in words."""
        return f"{' × '.join(map(str, self.counts))} × 2 triangles"

    @cached_property
    def positions(self) -> np.ndarray:
        """(n, 3) [m]."""
        x, y = np.meshgrid(self.x, self.y, indexing="ij")
        return np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])

    @cached_property
    def elements(self) -> np.ndarray:
        """Nodes of the triangles (2 nx ny, 3), normal along +z."""
        nx, ny = self.counts
        i, j = (a.ravel() for a in np.meshgrid(range(nx), range(ny), indexing="ij"))
        a = i * (ny + 1) + j
        b, c, d = a + ny + 1, a + ny + 2, a + 1
        rising = (i + j) % 2 == 0
        first = np.where(rising[:, None], np.column_stack([a, b, c]), np.column_stack([a, b, d]))
        second = np.where(rising[:, None], np.column_stack([a, c, d]), np.column_stack([b, c, d]))
        return np.vstack([first, second])

    def edge(self, name: str) -> np.ndarray:
        """Nodes on an edge, along it."""
        number = np.arange(len(self.x) * len(self.y)).reshape(len(self.x), len(self.y))
        across = np.moveaxis(number, EDGES[name].normal_axis, 0)
        return across[-1 if EDGES[name].far_end else 0]

    def weights(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Corners of the cells at plan points (p, 2) [m], and their bilinear shares, (p, 4)."""
        places = []
        for lines, at in zip((self.x, self.y), points.T, strict=True):
            i = np.clip(np.searchsorted(lines, at, side="right") - 1, 0, len(lines) - 2)
            places.append((i, (at - lines[i]) / (lines[i + 1] - lines[i])))
        (i, s), (j, t) = places
        a = i * len(self.y) + j
        nodes = np.column_stack([a, a + len(self.y), a + len(self.y) + 1, a + 1])
        return nodes, np.column_stack([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t])

    def sample(self, displacement: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Displacement (p, 3) [m] at plan points (p, 2) [m] of nodal ones (n, 3)."""
        nodes, weights = self.weights(points)
        return np.einsum("pk,pkc->pc", weights, displacement[nodes])


def problem(
    scene: Scene, mesh: Triangles, load_factors: np.ndarray, times: np.ndarray | None = None
) -> dict[str, np.ndarray]:
    """Return the arrays that `comparisons.external.kratos.process` reads; times [s] of a motion's steps."""
    held, value = _held(scene, mesh, load_factors)
    material, none = scene.material, np.zeros(3)
    return {
        "positions": mesh.positions,
        "elements": mesh.elements,
        "material": np.array([material.young, material.poisson, material.density, scene.sheet.thickness]),
        "acceleration": none if scene.gravity is None else np.array(scene.gravity.last_acceleration),
        "force": _forces(scene, mesh),
        "pressure": np.array(sum(p.last_factor * p.value for p in scene.loads if isinstance(p, Pressure))),
        "held": held,
        "value": value,
        "load_factors": load_factors,
    } | ({} if times is None else {"times": times})


def _held(scene: Scene, mesh: Triangles, load_factors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return which unknowns are held (n, 6), and at what at every load factor (steps, n, 6) [m, rad]."""
    held = np.zeros((len(mesh.positions), 6), dtype=bool)
    value = np.zeros((len(load_factors), *held.shape))
    for support in scene.supports:
        nodes = mesh.edge(support.edge)
        held[nodes[:, None], held_axes(support)] = True
        if isinstance(support, Symmetric):
            held[nodes[:, None], (3 + EDGES[support.edge].along_axis, 5)] = True
        elif holds_director(support):
            held[nodes, 3:] = True
    driven: list[DrivenEdge] = [*bent_or_tilted(scene.supports, scene.sheet)]
    driven += [MovedEdge(motion, scene.sheet) for motion in scene.motions().values()]
    for edge in driven:
        nodes = mesh.edge(edge.edge)
        held[nodes] = True
        for step, load_factor in enumerate(load_factors.tolist()):
            placed = edge.placed(mesh.positions[nodes, :2], load_factor)
            value[step, nodes, :3] = placed.displacement
            value[step, nodes, 3:] = Rotation.from_matrix(np.eye(3) + placed.turn).as_rotvec()
    return held, value


def _forces(scene: Scene, mesh: Triangles) -> np.ndarray:
    """Point loads and edge forces on the nodes (n, 3) [N]."""
    out = point_loads(scene, mesh)
    for load in scene.loads:
        if isinstance(load, EdgeLoad):
            nodes = mesh.edge(load.edge)
            spans = np.linalg.norm(np.diff(mesh.positions[nodes], axis=0), axis=1)
            pull = load.last_factor * np.outer(spans, load.force_per_length)
            out[nodes[:-1]] += 0.5 * pull
            out[nodes[1:]] += 0.5 * pull
    return out
