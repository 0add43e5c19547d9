"""A plan mesh of quadrilaterals extruded into layers of 27-node bricks: columns of nodes over plan nodes.

Node (plan node j, level l) has the number j · levels + l, with 2 · layers + 1 levels from the bottom face to
the top one; the middle level is the mid-surface. Through the thickness the fields are piecewise quadratic,
N_l(ζ), and two averages of a column stand for the sheet as a surface:

    mean x̄ = 1/h ∫ x dζ        director D = 12/h³ ∫ ζ x dζ        (flat: the plan point and e_z)

Coordinates in metres.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from skfem import Basis, ElementHex2, ElementQuad2, MeshQuad

from fem_reference.surface.location import interpolate
from fem_reference.surface.mesh import Plan, quarters
from sheetbench.answers.solution import FieldMesh
from sheetbench.scenes import Sheet


@dataclass(frozen=True)
class Columns:
    """n plan nodes on a plan basis of `ElementQuad2`, extruded to a thickness [m] in layers; taper: by how
    much thicker each column is than that, (n,), or 1."""

    basis: Basis
    thickness: float
    layers: int
    taper: np.ndarray

    @classmethod
    def on(cls, mesh: MeshQuad, sheet: Sheet, layers: int) -> Columns:
        """The columns over any flat mesh of straight-sided quadrilaterals, of a sheet's thickness."""
        basis, taper = Basis(mesh, ElementQuad2()), np.ones(())
        if sheet.taper_x or sheet.taper_y:
            taper = sheet.thickness_at(*basis.doflocs) / sheet.thickness
        return cls(basis, sheet.thickness, layers, taper)

    @property
    def levels(self) -> int:
        return 2 * self.layers + 1

    @cached_property
    def plan(self) -> Plan:
        return Plan(self.basis.mesh, self.basis.element_dofs.T, self.basis.doflocs.T)

    @cached_property
    def heights(self) -> np.ndarray:
        """z of the levels, (levels,) [m], of columns of the sheet's thickness."""
        return np.linspace(-0.5, 0.5, self.levels) * self.thickness

    @cached_property
    def positions(self) -> np.ndarray:
        """Nodes by column, (n, levels, 3) [m]."""
        out = np.zeros((len(self.plan.nodes), self.levels, 3))
        out[:, :, :2] = self.plan.nodes[:, None]
        out[:, :, 2] = np.multiply.outer(self.taper, self.heights)
        return out

    @cached_property
    def averages(self) -> np.ndarray:
        """Weights of mean and director in a column's positions, (2, levels)."""
        out = np.zeros((2, self.levels))
        slab = self.thickness / self.layers
        for layer in range(self.layers):
            nodes = slice(2 * layer, 2 * layer + 3)
            share = slab * np.array([1.0, 4.0, 1.0]) / 6.0  # ∫ N dζ
            lever = slab**2 * np.array([-1.0, 0.0, 1.0]) / 12.0  # ∫ (ζ − ζ_middle) N dζ
            out[0, nodes] += share / self.thickness
            out[1, nodes] += 12.0 / self.thickness**3 * (self.heights[2 * layer + 1] * share + lever)
        return out

    @cached_property
    def stacks(self) -> np.ndarray:
        """Nodes of the bricks over every plan element, (m, 9 · levels), by column."""
        return (self.levels * self.plan.elements[:, :, None] + np.arange(self.levels)).reshape(
            len(self.plan.elements), -1
        )

    @cached_property
    def places(self) -> np.ndarray:
        """Where a stack holds the nodes of its bricks, (layers, 27), in the order of `ElementHex2`."""
        flat = {tuple(site): i for i, site in enumerate(ElementQuad2.doflocs)}
        column = np.array([flat[tuple(site[:2])] for site in ElementHex2.doflocs])
        level = np.rint(2.0 * ElementHex2.doflocs[:, 2]).astype(int)
        return np.array([self.levels * column + level + 2 * layer for layer in range(self.layers)])

    def edge(self, name: str) -> np.ndarray:
        """Plan nodes on an edge."""
        return self.basis.get_dofs(name).flatten()

    def sample(self, displacement: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Mid-surface displacement (p, 3) [m] at plan points (p, 2) [m] of nodal ones (n, levels, 3)."""
        return interpolate(self.plan.mesh, self.plan.elements, displacement[:, self.layers], points)

    def about_middle(self, displacement: np.ndarray, nodal: np.ndarray) -> np.ndarray:
        """Force and moment about the middle node (n, 6) of forces (n, levels, 3) on the displaced columns."""
        now = self.positions + displacement
        arm = now - now[:, [self.layers]]
        return np.concatenate([nodal.sum(axis=1), np.cross(arm, nodal).sum(axis=1)], axis=1)

    def field_mesh(self, displacement: np.ndarray) -> FieldMesh:
        """Nodes and trilinear eighths of the bricks, with displacement (n, levels, 3) [m]."""
        plan = quarters(self.basis.element_dofs)
        a, b, _, d = (self.plan.nodes[plan[:, corner]].T for corner in range(4))
        clockwise = (b - a)[0] * (d - a)[1] < (b - a)[1] * (d - a)[0]  # as scikit-fem numbers some meshes
        base = self.levels * np.where(clockwise[:, None], plan[:, ::-1], plan)
        cells = [np.concatenate([base + level, base + level + 1], axis=1) for level in range(self.levels - 1)]
        return FieldMesh(
            self.positions.reshape(-1, 3),
            [("hexahedron", np.concatenate(cells))],
            {"displacement": displacement.reshape(-1, 3)},
        )
