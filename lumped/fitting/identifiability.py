"""What data can tell about the parameters fitted to them: singular values, intervals, and what stays unknown.

With residuals r (m,) at the fit, and their Jacobian J (m, n) with respect to the parameters scaled to order
one (here logarithms, or values over a scale), the covariance is s² (Jᵀ J)⁻¹, s² = r·r/(m − n), and a 95 %
interval ± t_{0.975, m − n} times the standard deviation. Where the residuals' standard deviation σ is given
the interval is ± 1.96 times that of max(s, σ); with m = n there is one then alone. A singular value of J
below THRESHOLD of the largest is a combination of parameters that the data do not see; the parameters in it
are named.
Source: Bates and Watts, Nonlinear Regression Analysis (1988), chapters 1–2.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from sheetbench.errors import BadInput

THRESHOLD = 1e-3  # of the largest singular value: below it a combination counts as not seen
CORRELATED = 0.98  # |correlation| of two parameters from which on the data cannot distinguish them
CONFIDENCE = 0.95


@dataclass(frozen=True)
class Identifiability:
    """singular_values: (n,) of the scaled Jacobian; half_widths: parameter → half width of its 95 % interval
    in the scaled parameter, inf where the data do not see it, nan where m = n and σ is not known; warnings:
    sentences."""

    threshold: ClassVar[float] = THRESHOLD

    singular_values: np.ndarray
    half_widths: dict[str, float]
    warnings: tuple[str, ...]


def identifiability(
    names: list[str], jacobian: np.ndarray, residuals: np.ndarray, deviation: float = 0.0
) -> Identifiability:
    """Of parameters whose scaled Jacobian (m, n) and residuals (m,) at the fit are given; deviation: the
    residuals' standard deviation, 0 where it is not known.

    Raises BadInput where there are fewer residuals than parameters.
    """
    m, n = jacobian.shape
    if m < n:
        raise BadInput(f"{m} residuals cannot determine {n} parameters")
    _, singular, directions = np.linalg.svd(jacobian, full_matrices=False)
    seen = singular > THRESHOLD * singular[0]
    spread = (directions[seen] / singular[seen, None]).T  # (n, seen)
    covariance = spread @ spread.T
    from scipy.special import ndtri, stdtrit

    scatter = float(np.sqrt(residuals @ residuals / (m - n))) if m > n else 0.0
    if deviation:
        reach = float(ndtri(0.5 + CONFIDENCE / 2.0)) * max(scatter, deviation)
    else:
        reach = float(stdtrit(m - n, 0.5 + CONFIDENCE / 2.0)) * scatter if m > n else np.nan

    warnings, unseen = [], np.zeros(n, dtype=bool)
    for direction in directions[~seen]:
        members = np.abs(direction) > 0.1
        unseen |= members
        names_in = ", ".join(name for name, member in zip(names, members, strict=True) if member)
        warnings.append(
            f"the data do not see a combination of {names_in}: changed together they leave what was measured "
            "as it is; seek fewer, or measure what distinguishes them"
        )
    size = np.sqrt(np.diag(covariance))
    known = np.where(unseen, 0.0, size)
    scale = np.outer(known, known)
    correlation = np.divide(covariance, scale, out=np.zeros_like(scale), where=scale > 0.0)
    for i, j in np.argwhere(np.tril(np.abs(correlation), -1) > CORRELATED):
        shown = f"{correlation[i, j]:+.3f}".replace("-", "−")
        warnings.append(f"the data cannot tell {names[j]} from {names[i]} (correlation {shown})")
    widths = np.where(unseen, np.inf, reach * size)
    return Identifiability(singular, dict(zip(names, widths.tolist(), strict=True)), tuple(warnings))
