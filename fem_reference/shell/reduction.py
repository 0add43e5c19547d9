"""Tangents of follower loads in the unknowns of the shell's elements: displacements of nine nodes, then two
rotations of nine directors.

A director turns in its tangent plane, δd = T β; frames: T (m, 9, 3, 2) of the nodes of the elements.
"""

from __future__ import annotations

import numpy as np


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
