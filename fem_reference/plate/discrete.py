"""Discrete plate: a shell whose strains, on the flat sheet, are linear in its coordinates.

    M ü + (τ K + α M) u̇ + K u = F

Loads act on the flat sheet with its upright directors: pressure along +z, an edge moment m as −m on the tilt
towards the outward normal. Supports have the first orders of `scenes.meaning.kinematics`: the shortening of a
bent edge's mid-line is of second order. A natural state leaves the strains e0 of the middle and −k0 in
bending without stress. Bending and membrane are independent; `fem_reference.plate.validity` checks where this
ceases to hold.

Along an edge without a held director (free, hinged, held) the twisting moment fades within a layer of width
√(D66/κGh) = h/√10, far less than an element. On equal elements the answer then converges like the width of
the elements there: on 16 × 16 of Habibi et al.'s sheet it is 0.06 to 0.4 % off with free or hinged edges, and
0.01 % with all edges clamped. Divided finer towards all edges it is 0.002 to 0.03 % off with free or hinged
edges, and 0.04 % with all edges clamped: so it is graded where an edge has no twisting moment. Source:
Hughes, The Finite Element Method (2000), ch. 5.
"""

from collections.abc import Callable
from functools import cached_property
from typing import ClassVar

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix
from skfem import MeshQuad

from fem_reference.discrete.shape import SheetShape
from fem_reference.discrete.sheet import Discrete
from fem_reference.plate.element import BENDING, MEMBRANE, PlateElements
from fem_reference.plate.validity import buckling_load, nonlinearity
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.surface.balance import Surface
from fem_reference.surface.biquadratic import AT_GAUSS
from fem_reference.surface.materials import Section, section_at
from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.path import Fault
from sheetbench.scenes import Scene, outside_model
from sheetbench.scenes.meaning.natural_state import NaturalState


class DiscretePlate(DiscreteShell):
    """Plate of a scene on any flat mesh of straight-sided quadrilaterals [m]; BadInput for folded ones.
    section: stiffness per width, by default of material and thickness."""

    model = "plate"
    linear: ClassVar[bool] = True
    creeps: ClassVar[bool] = False
    element: PlateElements
    moved, centripetal, inverted_element = Discrete.moved, Discrete.centripetal, Discrete.inverted_element

    def __init__(self, mesh: MeshQuad, scene: Scene, section: Section | None = None, moving: bool = False):
        super().__init__(mesh, scene, section, moving=moving)

    def elements_of(self, section: Section | None, law: str) -> tuple[PlateElements, NaturalState | None]:
        nodes = self.plan.corners
        elements = PlateElements.build(nodes, section or section_at(self.scene, nodes))
        return elements, self.natural_of(self.scene)

    def natural_form(self) -> tuple[np.ndarray, Callable[[np.ndarray, np.ndarray], np.ndarray]]:
        return AT_GAUSS[0] @ self.plan.corners, _natural_strains

    def directors(self, q: np.ndarray) -> np.ndarray:
        return self._upright

    def basis(self, q: np.ndarray, at: float = 0.0) -> csc_matrix:
        return self._constant_basis

    @cached_property
    def _constant_basis(self) -> csc_matrix:
        return super().basis(np.zeros(self.size))

    def change(self, at: float) -> np.ndarray:
        share, time = self.instant(at)
        out = np.zeros((2, self.nodes, 3))
        for driven in self.supports.driven:
            out[0, driven.nodes], out[1, driven.nodes] = driven.edge.linear(driven.points)
        out[0] += self.supports.shift(time)
        return share * out

    def surface(self, q: np.ndarray) -> Surface:
        return super().surface(np.zeros(self.size))

    def stiffness(
        self, shape: SheetShape, moduli: np.ndarray, stress: np.ndarray, residual: np.ndarray, by_a: float
    ) -> np.ndarray:
        stiffness = moduli[0, 0, 0] / self.element.stiffness[0, 0, 0] * self._stiffness
        return stiffness + by_a * self._mass if by_a else stiffness

    @cached_property
    def _stiffness(self) -> np.ndarray:
        """Data of K; moduli are one multiple of its stiffness everywhere."""
        return self.folded(self.element.tangent(self.element.stiffness)).data

    @cached_property
    def _mass(self) -> np.ndarray:
        return self.folded(self._inertia).data

    def folded(self, blocks: np.ndarray) -> csr_matrix:
        """Return the sum on all unknowns of matrices of the elements' vectors (m, 54, 54)."""
        flat, elements = self.shape(np.zeros(self.size), 0.0), np.arange(len(blocks))
        return self.pattern.matrix(self.fold(flat, elements, blocks.reshape(-1, 18, 3, 18, 3)))

    # validity of a state

    def fault(self, shape: SheetShape) -> Fault | None:
        share = buckling_load(shape)
        if share is None or share >= 1.0:
            return None
        return Fault(Status.UNSTABLE, f"its in-plane forces buckle it at {100.0 * share:.3g} % of the load")

    def stretch(self, shape: SheetShape) -> float:
        return nonlinearity(self.element, shape.change, shape.strain)

    def beyond(self, stretch: float) -> str:
        if not stretch > 1.0:
            return outside_model(self.scene, 0.0)
        ends = f"linear theory ends at {100.0 / stretch:.3g} % of the load or before"
        return f"slopes, turns or twice the strain of {stretch:.3g}, beyond 1: {ends}"


def _natural_strains(strain: np.ndarray, curvature: np.ndarray) -> np.ndarray:
    """Return the natural strains (9 m, 8) of e0 and k0 (m, 9, 2, 2)."""
    out = np.zeros((*strain.shape[:2], 8))
    for part, form in ((MEMBRANE, strain), (BENDING, -curvature)):
        out[..., part] = [1.0, 1.0, 2.0] * form[..., [0, 1, 0], [0, 1, 1]]
    return out.reshape(-1, 8)
