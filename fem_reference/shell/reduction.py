"""The shell's elements in their unknowns: displacements of nine nodes, then two rotations of nine directors.

A director turns in its tangent plane, δd = T β; frames: T (m, 9, 3, 2) of the nodes of the elements.
"""

from __future__ import annotations

import numpy as np

from fem_reference.shell.element import STRAINS


def reduced(gradient: np.ndarray, frames: np.ndarray) -> np.ndarray:
    """B (m, 54, 18, 3) on the unknowns, (m, 54, 45)."""
    m = len(gradient)
    turning = gradient[:, :, 9:].swapaxes(1, 2) @ frames  # (m, 9, 54, 2)
    return np.concatenate(
        [gradient[:, :, :9].reshape(m, STRAINS, 27), turning.swapaxes(1, 2).reshape(m, STRAINS, 18)], axis=2
    )


def add_geometric(stiffness: np.ndarray, form: np.ndarray, frames: np.ndarray) -> None:
    """Adds Σ s_k H_k ⊗ I (m, 18, 18) to matrices (m, 45, 45); H has no director–director part."""
    m = len(stiffness)
    positions = stiffness[:, :27, :27].reshape(m, 9, 3, 9, 3)
    for axis in range(3):
        positions[:, :, axis, :, axis] += form[:, :9, :9]
    stiffness[:, :27, :27] = positions.reshape(m, 27, 27)
    mixed = np.einsum("eij,ejck->eicjk", form[:, :9, 9:], frames).reshape(m, 27, 18)
    stiffness[:, :27, 27:] += mixed
    stiffness[:, 27:, :27] += mixed.swapaxes(1, 2)


def projected(tangent: np.ndarray, frames: np.ndarray) -> np.ndarray:
    """Full matrices (m, 18, 3, 18, 3) on the unknowns, (m, 45, 45)."""
    m = len(tangent)
    right = np.concatenate(
        [
            tangent[:, :, :, :9].reshape(m, 18, 3, 27),
            np.einsum("eicjd,ejdb->eicjb", tangent[:, :, :, 9:], frames).reshape(m, 18, 3, 18),
        ],
        axis=3,
    )
    lower = np.einsum("eicb,eica->eiab", right[:, 9:], frames).reshape(m, 18, 45)
    return np.concatenate([right[:, :9].reshape(m, 27, 45), lower], axis=1)
