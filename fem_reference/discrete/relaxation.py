"""Maxwell branches of a reference in motion (`scenes.objects.relaxation`), as functions of its memory.

A motion's memory (1 + b, 2, m) holds the strains and elastic stresses at its time and the branches' parts of
them; a step from it gives the branches' stresses at its end.
"""

from __future__ import annotations

import numpy as np

from sheetbench.scenes import Branches
from sheetbench.scenes.objects.relaxation import BranchStep

Strained = tuple[np.ndarray, np.ndarray]  # strains and their elastic stresses, of any shape


def remembered(branches: Branches, strained: Strained, step: BranchStep | None = None) -> np.ndarray:
    """Return the memory at the end of a step, of branches at rest without one; empty without branches."""
    if not branches.times:
        return np.zeros(0)
    x = np.stack([part.ravel() for part in strained[::-1]])
    return branches.at_rest(x) if step is None else step.after(x)


def gain(step: BranchStep | None) -> float:
    """Return d(added stress)/d(elastic stress)."""
    return 0.0 if step is None else step.gain - 1.0


def with_branches(stress: np.ndarray, step: BranchStep | None) -> np.ndarray:
    """Return elastic stresses with those of the branches beside them."""
    if step is None:
        return stress
    return stress + (gain(step) * stress + step.past.reshape(stress.shape))
