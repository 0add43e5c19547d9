"""The mechanics of rods: elements whose strains are quadratic forms of a few nodal vectors.

    e = ½ Qᵀ H Q − ½ Q₀ᵀ H Q₀,     energy ½ Σ S (e − λ e₀)²,     δe = B δQ,  B = H Q

with Q the vectors of a side of the edge (see `rod`), e₀ the intrinsic curvature and λ the load factor. So the
force is Bᵀ s, s = S (e − λ e₀), and its tangent Bᵀ S B + Σ s H, whatever a model calls its unknowns.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np


@dataclass(frozen=True)
class RodElements:
    """k sides with s strains of a vectors each.

    reference: Q₀ (k, a, 3); forms: H (k, s, a, a); stiffness: S (k, s); intrinsic: e₀ (k, s); weight: dead
    force on Q (k, a, 3) [N, N·m].
    """

    reference: np.ndarray
    forms: np.ndarray
    stiffness: np.ndarray
    intrinsic: np.ndarray
    weight: np.ndarray

    @classmethod
    def joined(cls, parts: Sequence[RodElements], vectors: int) -> RodElements:
        """All parts in one; none at all are no sides of so many vectors."""
        none = cls(
            *(np.zeros((0, *n)) for n in ((vectors, 3), (1, vectors, vectors), (1,), (1,), (vectors, 3)))
        )
        of = [[getattr(part, field.name) for part in parts or (none,)] for field in fields(cls)]
        return cls(*(np.concatenate(arrays) for arrays in of))

    def gradient(self, change: np.ndarray) -> np.ndarray:
        """B = H Q (k, s, a, 3) at Q₀ + change (k, a, 3)."""
        return np.einsum("esij,ejc->esic", self.forms, self.reference + change)

    def strain(self, change: np.ndarray) -> np.ndarray:
        """Strains (k, s) of the change (k, a, 3)."""
        return np.einsum("esic,eic->es", self.gradient(0.5 * change), change)

    def force(self, gradient: np.ndarray, stress: np.ndarray) -> np.ndarray:
        """Bᵀ s (k, a, 3)."""
        return np.einsum("es,esic->eic", stress, gradient)

    def tangent(self, gradient: np.ndarray, stress: np.ndarray) -> np.ndarray:
        """Bᵀ S B + Σ s H ⊗ I, (k, 3 a, 3 a)."""
        k, strains, vectors = gradient.shape[:3]
        flat = gradient.reshape(k, strains, 3 * vectors)
        full = flat.swapaxes(1, 2) @ (self.stiffness[:, :, None] * flat)
        form = np.einsum("es,esij->eij", stress, self.forms)
        by_axis = full.reshape(k, vectors, 3, vectors, 3)
        for axis in range(3):
            by_axis[:, :, axis, :, axis] += form
        return full

    @staticmethod
    def product(tangent: np.ndarray, step: np.ndarray) -> np.ndarray:
        """A tangent (k, 3 a, 3 a) times a step (k, a, 3)."""
        k, vectors = step.shape[:2]
        return (tangent @ step.reshape(k, 3 * vectors, 1)).reshape(step.shape)
