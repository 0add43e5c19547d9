"""Where a shell stands, and the forces there."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fem_reference.surface.rod_elements import Strained


@dataclass(frozen=True)
class State:
    """change: q (2, n, 3); aside: of the rods' m (q, 3); stress (m, 54) and rod_stress (k, s): extrapolated,
    the elements' own where None."""

    change: np.ndarray
    aside: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    stress: np.ndarray | None = None
    rod_stress: np.ndarray | None = None


@dataclass(frozen=True)
class Forces:
    """At a state: of the elements Q (m, 18, 3), s (m, 54), D (m, 54, 54); T (n + q, 3, 2) of the directors; B
    and s of the rods; residuals R (2, n, 3) on the sheet and aside (q, 3) on the rods' m; size of the forces
    that balance [N]; short: the step (2n + q, 3) to what is prescribed."""

    vectors: np.ndarray
    stress: np.ndarray
    moduli: np.ndarray
    frames: np.ndarray
    rods: Strained
    residual: np.ndarray
    aside: np.ndarray
    size: float
    short: np.ndarray
