"""Function of strain with its derivatives: a law's energy, stress and tangent."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fem_reference.surface.materials import times


class Triad(NamedTuple):
    """Function of strains (…, k) with its first and second derivative: (…), (…, k), (…, k, k)."""

    value: np.ndarray
    first: np.ndarray
    second: np.ndarray

    def times(self, other: Triad) -> Triad:
        """Return the product with another function."""
        (a, a_by, a_twice), (b, b_by, b_twice) = self, other
        dyad = outer(a_by, b_by)
        twice = times(a, b_twice) + times(b, a_twice) + dyad + dyad.swapaxes(-1, -2)
        return Triad(a * b, a[..., None] * b_by + b[..., None] * a_by, twice)

    def power(self, exponent: float) -> Triad:
        """Return the power, nan for values below zero unless the exponent is whole."""
        with np.errstate(invalid="ignore"):
            value = self.value**exponent
        slope = exponent * value / self.value
        bend = (exponent - 1.0) * slope / self.value
        twice = times(slope, self.second) + times(bend, outer(self.first, self.first))
        return Triad(value, slope[..., None] * self.first, twice)


def outer(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return a ⊗ b (…, k, l) of vectors (…, k) and (…, l)."""
    return np.asarray(a[..., :, None] * b[..., None, :])
