"""A sheet as a mesh of 20-node bricks, with its supports and loads, for programs that solve solids.

The shell's plan mesh (`fem_reference.surface.mesh`) is extruded: nodes lie at corners and mid-edges of
layers of bricks. The number of layers is even, so that the mid-surface is a plane of eight-node faces. A
column consists of the nodes over one plan node; its middle node lies in the mid-surface.
Supports hold a shell's motions (`scenes.objects.supports`). At a clamp every column stays on its director and
may stretch along it. At a hinge only the mean of a column is held, because the deflection of a solid that is
held along a line of nodes grows without bound as bricks get smaller. The axes of a column follow the rotation
of its edge (`sheetbench.scenes.meaning.kinematics`).

Nodes of an element are numbered as in Abaqus, CalculiX and VTK: corners below, corners above, mid-edges
below, above, upright. SI units. The plan mesh is the only part shared with the solid of `fem_reference`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np
from skfem import MeshQuad

from fem_reference.surface.biquadratic import GAUSS, areas
from fem_reference.surface.borders import has_lines
from fem_reference.surface.loads import orientation
from fem_reference.surface.location import locate
from fem_reference.surface.mesh import divisions, facets_on, mesh_of, plan_of
from sheetbench.scenes import (
    AreaLoad,
    EdgeLoad,
    Material,
    PointLoad,
    Scene,
    held_axes,
    holds_director,
    tilt_axes,
)
from sheetbench.scenes.meaning.composition import weights
from sheetbench.scenes.meaning.kinematics import DrivenEdge, MovedEdge, bent_or_tilted
from sheetbench.scenes.objects.shapes import Shape
from sheetbench.scenes.objects.supports import AnySupport, place

GRADINGS = ("edges", "uniform")
SITES = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0)])  # of a face's nodes
REVERSED = [0, 3, 2, 1, 7, 6, 5, 4]  # a face's nodes in the opposite sense of rotation


@dataclass(frozen=True)
class Bricks:
    """The mesh of bricks. plan: straight-sided or biquadratic; counts: requested elements along x and y; z (2
    layers + 1,): heights of a column's nodes [m]; taper (p,): thickness over each plan node divided by the
    sheet's thickness."""

    plan: MeshQuad
    counts: tuple[int, int]
    z: np.ndarray
    taper: np.ndarray

    KIND: ClassVar = "hexahedron20"

    @classmethod
    def of(cls, scene: Scene, elements: int, layers: int, grading: str) -> Self:
        """Extrude the shell's plan mesh. elements: number along the shorter side; grading "edges": finest at
        the edges, for meshes made of lines along x and y."""
        counts = divisions(scene.sheet, elements)
        plan = mesh_of(scene, counts, grading == "edges" and has_lines(scene))
        heights = np.linspace(-0.5, 0.5, 2 * layers + 1) * scene.sheet.thickness
        taper = scene.sheet.thickness_at(*plan_of(plan).nodes.T) / scene.sheet.thickness
        return cls(plan, counts, heights, taper)

    @property
    def layers(self) -> int:
        """Number of bricks through the thickness; also the index of the mid-surface among the node levels."""
        return len(self.z) // 2

    @property
    def label(self) -> str:
        """The number of bricks in words."""
        count = self.plan.nelements
        plan = self.counts if np.prod(self.counts) == count else (count,)
        return f"{' × '.join(map(str, (*plan, self.layers)))} bricks"

    @cached_property
    def faces(self) -> np.ndarray:
        """Plan nodes of the elements (m, 8), corners and then mid-edges, counter-clockwise."""
        plan = plan_of(self.plan)
        upright = orientation(plan.corners)[:, None] > 0
        return np.where(upright, plan.elements[:, :8], plan.elements[:, REVERSED])

    @cached_property
    def number(self) -> np.ndarray:
        """Node numbers by column and level (p, 2 layers + 1), −1 where a level has no node."""
        exists = np.zeros((len(plan_of(self.plan).nodes), len(self.z)), dtype=bool)
        exists[self.faces[:, :4]] = True
        exists[self.faces[:, 4:], ::2] = True
        out = np.full(exists.shape, -1)
        out[exists] = np.arange(exists.sum())
        return out

    @cached_property
    def sites(self) -> np.ndarray:
        """Plan nodes and levels of the nodes (n, 2)."""
        return np.argwhere(self.number >= 0)

    @cached_property
    def positions(self) -> np.ndarray:
        """Positions of the nodes (n, 3) [m]."""
        column, level = self.sites.T
        return np.column_stack([plan_of(self.plan).nodes[column], self.z[level] * self.taper[column]])

    @cached_property
    def elements(self) -> np.ndarray:
        """Nodes of the bricks (layers m, 20), the lowest layer first."""
        corners, middles = self.faces[:, :4], self.faces[:, 4:]
        layers = [
            [self.number[part, level] for part, level in parts]
            for low in range(0, len(self.z) - 1, 2)
            for parts in [
                [(corners, low), (corners, low + 2), (middles, low), (middles, low + 2), (corners, low + 1)]
            ]
        ]
        return np.concatenate([np.concatenate(parts, axis=1) for parts in layers])

    def inside(self, shape: Shape | None) -> np.ndarray:
        """Plan elements (k,) inside a shape, all of them without a shape."""
        return plan_of(self.plan).within(shape)

    def edge(self, name: str) -> np.ndarray:
        """Return the nodes of all columns on an edge."""
        return self._over(plan_of(self.plan).on_boundary(name))

    def supported(self, support: AnySupport) -> np.ndarray:
        """Return the nodes of all columns on a support's edge, or in its shape."""
        shape = place(support)
        return self.edge(support.edge) if shape is None else self._over(plan_of(self.plan).touching(shape))

    def _over(self, plan_nodes: np.ndarray) -> np.ndarray:
        return np.flatnonzero(np.isin(self.sites[:, 0], plan_nodes))

    def columns(self, nodes: np.ndarray) -> list[np.ndarray]:
        """Return the nodes by column, the middle one first."""
        columns = [self.number[at][self.number[at] >= 0] for at in np.unique(self.sites[nodes, 0])]
        return [np.roll(column, -(len(column) // 2)) for column in columns]

    def mean(self, column: np.ndarray) -> np.ndarray:
        """Return the weights of a column's nodes in the mean through the thickness: Simpson's rule for
        columns with nodes inside the layers, the trapezoidal rule for the others."""
        steps = self.sites[column, 1]
        inside = np.where(steps % 2 == 1, 4.0, 2.0)
        rule = np.where(np.isin(steps, (0, steps.max())), 1.0, inside)
        return np.asarray(rule / rule.sum())

    def sides(self, load: EdgeLoad) -> tuple[np.ndarray, np.ndarray]:
        """Return the nodes of the loaded side faces of bricks (f, 8), corners and then mid-edges; and the
        faces' areas divided by the thickness (f,) [m]."""
        on = facets_on(self.plan, load)
        (first, last), middle = self.plan.facets[:, on], self.plan.nvertices + on
        faces = [
            np.column_stack([self.number[at, low + up] for at, up in (
                (first, 0), (last, 0), (last, 2), (first, 2), (middle, 0), (last, 1), (middle, 2), (first, 1)
            )])
            for low in range(0, len(self.z) - 1, 2)
        ]  # fmt: skip
        lengths = np.linalg.norm(np.diff(self.plan.p[:, [first, last]], axis=1)[:, 0], axis=0)
        return np.concatenate(faces), np.tile(lengths / self.layers, self.layers)

    def weights(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return nodes and shape functions (p, 8) of mid-surface faces at plan points (p, 2) [m]."""
        element, place = locate(self.plan, points)
        return self.number[plan_of(self.plan).elements[element, :8], self.layers], serendipity(*place)


@dataclass(frozen=True)
class Tie:
    """Σ weights · u[nodes] = 0 along an axis; nodes (k,), the column's middle first; weights (k,)."""

    axis: int
    nodes: np.ndarray
    weights: np.ndarray


@dataclass(frozen=True)
class Held:
    """Supported components of the nodes' displacement. axes (n, 3, 3): a node's axes, one per row; fixed (n,
    3): whether a component along an axis is prescribed; value (n, 3): its prescribed displacement [m]; tied:
    constraints on column means at hinges; turned (n,): whether a node's axes differ from x, y, z."""

    axes: np.ndarray
    fixed: np.ndarray
    value: np.ndarray
    tied: tuple[Tie, ...]

    @property
    def turned(self) -> np.ndarray:
        return np.any(self.axes != np.eye(3), axis=(1, 2))


def held(scene: Scene, bricks: Bricks) -> Held:
    """Return the displacements prescribed by supports and edge motions."""
    n = len(bricks.positions)
    axes, fixed, value = np.tile(np.eye(3), (n, 1, 1)), np.zeros((n, 3), dtype=bool), np.zeros((n, 3))
    middle = bricks.sites[:, 1] == bricks.layers
    driven: dict[str, DrivenEdge] = {edge.edge: edge for edge in bent_or_tilted(scene.supports, scene.sheet)}
    driven |= {m.edge: MovedEdge(m, scene.sheet) for m in scene.motions().values()}
    ties: dict[tuple[int, int], Tie] = {}
    for support in scene.supports:
        nodes, along = bricks.supported(support), held_axes(support)
        if not holds_director(support):
            fixed[nodes[:, None], tilt_axes(support)] = True
            for column in bricks.columns(nodes):
                mean = bricks.mean(column)
                ties |= {(int(column[0]), axis): Tie(axis, column, mean) for axis in along}
        elif support.edge not in driven:
            fixed[nodes, :2] = fixed[nodes[middle[nodes]], 2] = True
    for edge in driven.values():
        nodes = bricks.edge(edge.edge)
        motion, height = edge.displaced(bricks.positions[nodes, :2]), bricks.positions[nodes, 2:]
        axes[nodes] = np.swapaxes(np.eye(3) + motion.turn, -1, -2)
        fixed[nodes, :2] = fixed[nodes[middle[nodes]], 2] = True
        moved = motion.displacement + height * motion.director
        value[nodes] = np.einsum("krc,kc->kr", axes[nodes], moved)
    tied = tuple(tie for (node, axis), tie in ties.items() if not fixed[node, axis])
    return Held(axes, fixed, value, tied)


def materials(scene: Scene, bricks: Bricks) -> list[tuple[Material, np.ndarray]]:
    """Return the materials of a sheet, each with its plan elements (k,)."""
    plan = plan_of(bricks.plan)
    middles = plan.nodes[plan.elements[:, 8]]
    patched = [patch.shape.contains(middles) for patch in scene.patches]
    parts: dict[tuple[bool, ...], list[int]] = {}
    for element in range(len(middles)):
        parts.setdefault(tuple(bool(inside[element]) for inside in patched), []).append(element)
    return [(_material(scene, inside), np.array(on)) for inside, on in parts.items()]


def _material(scene: Scene, inside: Sequence[bool]) -> Material:
    """Return the material at a place; inside: which of the scene's patches cover it."""
    changes: dict[str, Any] = {}
    for patch in (patch for patch, covers in zip(scene.patches, inside, strict=True) if covers):
        changes |= patch.own
    changes.pop("thickness", None)
    if scene.material.kind == "orthotropic" and "young" in changes:
        return Material(**{"density": scene.material.density, **changes})
    return scene.material.replace(**changes)


def forces(scene: Scene, bricks: Bricks) -> np.ndarray:
    """Return nodal forces (n, 3) [N] of point, edge and area loads and of the payloads' weight, without the
    sheet's weight and pressure."""
    out = point_loads(scene, bricks)
    plan = plan_of(bricks.plan)
    for load in (*scene.loads, *weights(scene)):
        if isinstance(load, EdgeLoad):
            faces, share = bricks.sides(load)
            shares = share[:, None] * np.repeat([-1.0 / 12.0, 1.0 / 3.0], 4)
            pull = load.force_per_length
        elif isinstance(load, AreaLoad):
            on = plan.elements[bricks.inside(load.where)]
            faces = bricks.number[on[:, :8], bricks.layers]
            shares = areas(plan.nodes[on]) @ serendipity(*GAUSS)
            pull = load.force_per_area
        else:
            continue
        np.add.at(out, faces, load.last_factor * shares[..., None] * np.array(pull))
    return out


def serendipity(r: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Return the shape functions (n, 8) of the eight-node square at points of [−1, 1]²."""
    (a, b), r, s = SITES.T, r[:, None], s[:, None]
    corner = 0.25 * (1 + a * r) * (1 + b * s) * (a * r + b * s - 1)
    middle = 0.5 * np.where(a == 0, (1 - r**2) * (1 + b * s), (1 + a * r) * (1 - s**2))
    return np.where(a * b != 0, corner, middle)


def point_loads(scene: Scene, mesh: Any) -> np.ndarray:
    """Return nodal forces (n, 3) [N] of point loads and point payloads, for any mesh with `weights`."""
    out = np.zeros_like(mesh.positions)
    for load in (*scene.loads, *weights(scene)):
        if isinstance(load, PointLoad):
            nodes, shares = mesh.weights(np.array([load.at]))
            out[nodes[0]] += load.last_factor * np.outer(shares[0], load.force)
    return out
