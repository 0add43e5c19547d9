"""A probe's measured history, and how far a simulated one is from it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

COMPONENTS = ("ux", "uy", "uz")


@dataclass(frozen=True)
class Measured:
    """One probe's measured history: time (n,) [s], displacement (n, 3) [m], nan where not measured."""

    time: np.ndarray
    displacement: np.ndarray

    def within(self, start: float, end: float) -> np.ndarray:
        """Which times (n,) lie between two [s]."""
        within: np.ndarray = (self.time >= start) & (self.time <= end)
        return within

    def error(self, time: np.ndarray, displacement: np.ndarray) -> float | None:
        """The error of a simulated history, times (m,) [s] and displacements (m, 3) [m], linear between them:
        the largest |component of (simulated − measured)| within its times over the largest |measured
        component|; None where nothing is measured there, or nothing moves."""
        inside = self.within(time[0], time[-1])
        truth = self.displacement[inside]
        if not np.isfinite(truth).any() or np.nanmax(np.abs(truth)) == 0.0:
            return None
        simulated = np.column_stack(
            [np.interp(self.time[inside], time, displacement[:, i]) for i in range(3)]
        )
        return float(np.nanmax(np.abs(simulated - truth)) / np.nanmax(np.abs(truth)))
