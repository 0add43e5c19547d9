"""Components of the solid's nodes held by supports, as a function of the load factor.

Hinged and held edges hold the mean of every column along the edge, and the face turns freely about it; a
held mid-line would be equivalent for a thin sheet, except for the dent of a line support, which grows without
bound as the mesh is refined. A hinge that holds the twist holds the component along the edge in the
whole face. A clamp holds the edge's face:

    "shell-like"  the face stays on the director, free to change its thickness along it: the components across
                  the director are held everywhere, the one along it on the mid-line only. This is the
                  clamp of a shell, and leaves no singular corner
    "mean"        like "shell-like", but the mean of every column's component along the director is held: with
                  the mid-line alone held, the shear force is a line load, and dents the face the more the
                  finer the mesh is. Four clamps, h/a 0.12, ν 0.45: 1.3, 5.8 and 7.0 % softer than a shell
                  with 1, 2 and 4 layers (one can hardly be dented), with the mean held 1.2, 1.0 % stiffer
                  with 2 and 4
    "full"        all three components of the whole face; the strain is singular at its rims

A plane of symmetry holds the component across it in the whole face.

The face of a rod bent by λκ follows the rod's director: held values are u = u_rod + ζ (d − e_z); the face of
a tilted clamp and of an edge moved rigidly follows its director too. An actuator's base holds its column as a
clamp does. A column's displacements are u = Z q, with q the components that are held or free: along the
face's axes (across the edge, along it, d), and on a hinged or held edge, and where clamps hold it, with the
column's mean in place of its middle node.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fem_reference.solid.mesh import Columns
from fem_reference.surface import supports
from fem_reference.surface.rod import Rod, hold_bases
from fem_reference.surface.supports import Supports
from sheetbench.errors import require_choice
from sheetbench.scenes import Scene, Symmetric, holds_director, tilt_axes
from sheetbench.scenes.objects.supports import named

CLAMPS = ("shell-like", "mean", "full")


@dataclass(frozen=True)
class ColumnSupports:
    """Components of columns held by supports. edges: name → components q that it holds (n, levels, 3);
    by_mean: (n,), columns whose mean is held."""

    line: Supports
    columns: Columns
    edges: dict[str, np.ndarray]
    by_mean: np.ndarray

    @cached_property
    def held(self) -> np.ndarray:
        """Components q held by any support (n, levels, 3)."""
        return sum(self.edges.values(), np.zeros(self.columns.positions.shape, dtype=bool))

    def spread(self, change: np.ndarray) -> np.ndarray:
        """Return columns' displacement (n, levels, 3) [m] from changes (2, n, 3) of middles and directors."""
        displacement, turn = change
        heights = np.multiply.outer(self.columns.taper, self.columns.heights)
        return displacement[:, None] + heights[..., None] * turn[:, None]

    def bases(self, load_factor: float) -> np.ndarray:
        """Return Z (n, 3 levels, 3 levels) of every column."""
        levels, middle = self.columns.levels, self.columns.layers
        axes = np.tile(np.eye(3), (len(self.by_mean), 1, 1))
        for driven in self.line.driven:
            axes[driven.nodes] = np.eye(3) + driven.edge.displaced(driven.points, load_factor).turn
        with_mean = np.eye(levels)
        with_mean[middle] = self.columns.averages[0]
        spread = np.where(self.by_mean[:, None, None], np.linalg.inv(with_mean), np.eye(levels))
        size = 3 * levels
        return np.einsum("nlm,nck->nlcmk", spread, axes).reshape(-1, size, size)

    @property
    def turned(self) -> np.ndarray:
        """Mask (n,) of plan nodes whose Z is not the identity."""
        mask = self.by_mean.copy()
        for driven in self.line.driven:
            mask[driven.nodes] = True
        return mask

    def reactions(self, nodal: np.ndarray, load_factor: float) -> dict[str, np.ndarray]:
        """Return the force [N] (3,) of each support from nodal forces; supports share a component."""
        bases = self.bases(load_factor)
        shared = applied(bases.swapaxes(1, 2), nodal) / np.maximum(sum(self.edges.values()), 1)
        levels = self.columns.levels
        rigid = np.linalg.solve(bases, np.tile(np.eye(3), (levels, 1)))  # q of the unit translations
        rigid = rigid.reshape(len(bases), levels, 3, 3)
        forces = {name: np.where(held, shared, 0.0) for name, held in self.edges.items()}
        return {name: np.einsum("nlk,nlkc->c", force, rigid) for name, force in forces.items()}


def applied(matrices: np.ndarray, nodal: np.ndarray) -> np.ndarray:
    """Return products of matrices (n, 3 levels, 3 levels) with (n, levels, 3): u = Z q, or Zᵀ r."""
    return (matrices @ nodal.reshape(*matrices.shape[:2], 1)).reshape(nodal.shape)


def of_scene(scene: Scene, columns: Columns, clamp: str, rods: Sequence[Rod] = ()) -> ColumnSupports:
    """Return the supports of a scene; rods: of its actuators. Raises BadInput for an unknown clamp."""
    require_choice("clamp", clamp, CLAMPS)
    line = hold_bases(supports.of_scene(scene, columns.plan), rods)
    kinds, edges = named(scene.supports), {}
    by_mean = np.zeros(len(columns.positions), dtype=bool)
    for name, on_line in line.edges.items():
        edges[name] = held = np.zeros(columns.positions.shape, dtype=bool)
        held[:, columns.layers], nodes = on_line, on_line.any(axis=1)
        support = kinds.get(name)  # None for motions and rods' bases, which hold like clamps
        if support is None or holds_director(support):
            held[nodes, :, : 3 if clamp == "full" else 2] = True
            by_mean[nodes] |= clamp == "mean"
            continue
        for axis in tilt_axes(support):
            held[nodes, :, axis] = True
        by_mean[nodes] |= not isinstance(support, Symmetric)
    return ColumnSupports(line, columns, edges, by_mean)
