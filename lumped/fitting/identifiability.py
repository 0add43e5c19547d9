"""Identifiability of parameters fitted to data: singular values, intervals, and undetermined combinations.

The fit has residuals r (m,) and their Jacobian J (m, n) with respect to the parameters scaled to order one
(logarithms, or values over a scale). The covariance is s² (Jᵀ J)⁻¹, s² = r·r/(m − n), and a 95 % interval
± t_{0.975, m − n} times the standard deviation. If the residuals' standard deviation σ is given, the interval
is ± 1.96 times the standard deviation for max(s, σ); m = n has an interval only then. A singular value of J
below THRESHOLD of the largest is a combination of parameters that the data do not determine; the parameters
in it are named.
Source: Bates and Watts, Nonlinear Regression Analysis (1988), chapters 1–2.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from sheetbench.errors import BadInput

THRESHOLD = 1e-3  # of the largest singular value: below it a combination counts as undetermined
CORRELATED = 0.98  # |correlation| of two parameters from which on the data cannot distinguish them
CONFIDENCE = 0.95


@dataclass(frozen=True)
class Identifiability:
    """Singular values, intervals and undetermined combinations of fitted parameters.

    Parameters
    ----------
    singular_values : ndarray of shape (n,)
        Singular values of the scaled Jacobian, falling.
    half_widths : dict of str to float
        Half width of each scaled parameter's 95 % interval, inf if the data do not determine it, nan if there
        are as many residuals as parameters and their deviation is not given.
    warnings : tuple of str
        Sentences about undetermined and correlated parameters.
    """

    threshold: ClassVar[float] = THRESHOLD

    singular_values: np.ndarray
    half_widths: dict[str, float]
    warnings: tuple[str, ...]


def identifiability(
    names: list[str], jacobian: np.ndarray, residuals: np.ndarray, deviation: float = 0.0
) -> Identifiability:
    """Return singular values, intervals and undetermined combinations of fitted parameters.

    Parameters
    ----------
    names : list of str
        Names of the n parameters.
    jacobian : ndarray of shape (m, n)
        Derivatives of the residuals by the parameters scaled to order one, at the fit.
    residuals : ndarray of shape (m,)
        Residuals at the fit.
    deviation : float, default 0
        Standard deviation of the residuals, 0 if unknown.

    Returns
    -------
    Identifiability
        Singular values, half widths of the 95 % intervals and warnings.

    Raises
    ------
    BadInput
        If there are fewer residuals than parameters.

    Notes
    -----
    Bates and Watts, Nonlinear Regression Analysis (1988), chapters 1 and 2.

    Examples
    --------
    >>> import numpy as np
    >>> import lumped
    >>> jacobian, residuals = np.array([[1.0], [1.0], [1.0]]), np.array([0.1, -0.1, 0.0])
    >>> lumped.identifiability(["young"], jacobian, residuals).half_widths["young"].__round__(3)
    0.248
    """
    m, n = jacobian.shape
    if m < n:
        raise BadInput(f"{m} residuals cannot determine {n} parameters")
    _, singular, directions = np.linalg.svd(jacobian, full_matrices=False)
    determined = singular > THRESHOLD * singular[0]
    spread = (directions[determined] / singular[determined, None]).T  # (n, determined)
    covariance = spread @ spread.T
    from scipy.special import ndtri, stdtrit

    scatter = float(np.sqrt(residuals @ residuals / (m - n))) if m > n else 0.0
    if deviation:
        reach = float(ndtri(0.5 + CONFIDENCE / 2.0)) * max(scatter, deviation)
    else:
        reach = float(stdtrit(m - n, 0.5 + CONFIDENCE / 2.0)) * scatter if m > n else np.nan

    warnings, undetermined = [], np.zeros(n, dtype=bool)
    for direction in directions[~determined]:
        members = np.abs(direction) > 0.1
        undetermined |= members
        names_in = ", ".join(name for name, member in zip(names, members, strict=True) if member)
        warnings.append(
            f"the data do not determine a combination of {names_in}: changed together they do not change the "
            "measured values; seek fewer, or measure other points"
        )
    size = np.sqrt(np.diag(covariance))
    deviations = np.where(undetermined, 0.0, size)
    scale = np.outer(deviations, deviations)
    correlation = np.divide(covariance, scale, out=np.zeros_like(scale), where=scale > 0.0)
    for i, j in np.argwhere(np.tril(np.abs(correlation), -1) > CORRELATED):
        shown = f"{correlation[i, j]:+.3f}".replace("-", "−")
        warnings.append(f"the data cannot distinguish {names[j]} from {names[i]} (correlation {shown})")
    widths = np.where(undetermined, np.inf, reach * size)
    return Identifiability(singular, dict(zip(names, widths.tolist(), strict=True)), tuple(warnings))
