"""Constants of the laws of rubber from curves of incompressible sheets, with intervals.

Engineering stress is 2 (f′(x) + c₀₁ m)(λ − w), with x = I₁ − 3 and f, c₀₁ of `scenes.objects.material`:

    uniaxial     m = 1/λ    w = λ⁻²    I₁ = λ² + 2/λ
    pure shear   m = 1      w = λ⁻³    I₁ = λ² + 1 + λ⁻²
    equibiaxial  m = λ²     w = λ⁻⁵    I₁ = 2λ² + λ⁻⁴

Least squares of the misfit over each curve's largest stress, within the bounds of laws that pull at any
stretch (c1, c2 of mooney-rivlin, c1 and c3 of yeoh not below 0). Misfits of neighbouring rows are
correlated: n rows count as n (1 − ρ)/(1 + ρ) independent ones, ρ the correlation of a row's misfit with the
next one's (AR(1)), in the degrees of freedom of Student's intervals. Sources: Treloar, The
Physics of Rubber Elasticity (1975); Bates and Watts, Nonlinear Regression Analysis (1988).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, isfinite, log

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import t as student

from comparisons.identification.tensile.curves import Curve
from sheetbench.errors import BadInput
from sheetbench.scenes import Material
from sheetbench.scenes.objects.material import WORDS, Energy

POISSON = 0.499  # written beside constants of incompressible sheets
AS_GOOD, GOOD = 1.5, 0.01  # times the least misfit, or of the largest stress: then few constants will do
LIMITS = (1e-6, 1e3)  # of gent's limit over the largest I₁ − 3, less 1: beyond, it is not seen
LAWS = ("neo-hookean", *WORDS)
POWERS = {"neo-hookean": (0,), "mooney-rivlin": (0, 0), "yeoh": (0, 1, 2)}  # of x in what the keys multiply
KEYS = {"neo-hookean": ("young",), **{law: words.keys for law, words in WORDS.items()}}


def energy(law: str, constants: Sequence[float]) -> Energy:
    """Return the energy of a law's constants; neo-Hooke's is Young's modulus of an incompressible sheet."""
    return Energy(constants[0] / 6.0) if law == "neo-hookean" else WORDS[law].energy(*constants)


def kinematics(test: str, stretch: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return m, w and I₁ − 3, (n,) each."""
    return {
        "uniaxial": (1.0 / stretch, stretch**-2.0, stretch**2 + 2.0 / stretch - 3.0),
        "pure-shear": (np.ones_like(stretch), stretch**-3.0, stretch**2 + stretch**-2.0 - 2.0),
        "equibiaxial": (stretch**2, stretch**-5.0, 2.0 * stretch**2 + stretch**-4.0 - 3.0),
    }[test]


def stress(of: Energy, test: str, stretch: np.ndarray) -> np.ndarray:
    """Return engineering stress (n,) [Pa] of an incompressible sheet."""
    m, w, x = kinematics(test, stretch)
    slope = of.c10 / (1.0 - x / of.limit) if of.limit else of.c10 + 2.0 * of.c20 * x + 3.0 * of.c30 * x * x
    return np.asarray(2.0 * (slope + of.c01 * m) * (stretch - w))


@dataclass(frozen=True)
class Fit:
    """A law's constants with 95 % intervals; young: of small strains [Pa]; rms and largest misfit over the
    largest stress; independent: number of independent rows; correlation: of its first two constants;
    unstable: the reason why no material may have the constants, "" if one may; bound: constants at their
    bounds."""

    law: str
    constants: dict[str, float]
    intervals: dict[str, tuple[float, float]]
    young: float
    rms: float
    largest: float
    independent: float
    correlation: float
    unstable: str
    bound: tuple[str, ...]

    @property
    def energy(self) -> Energy:
        return energy(self.law, list(self.constants.values()))


def fit(law: str, curves: Sequence[Curve]) -> Fit | None:
    """Return the law's constants nearest to the curves, or None if there are too few rows."""
    scales = [float(np.abs(curve.stress).max()) for curve in curves]
    rows, keys = sum(len(curve.stretch) for curve in curves), KEYS[law]
    if rows < len(keys) + (3 if len(keys) > 1 else 2):
        return None
    modulus = max(s / float(np.abs(c.stretch - 1.0).max()) for s, c in zip(scales, curves, strict=True)) / 6.0
    invariant = max(float(kinematics(c.test, c.stretch)[2].max()) for c in curves)

    def constants(q: np.ndarray) -> list[float]:
        if law == "gent":
            return [modulus * float(q[0]), invariant * (1.0 + float(np.exp(q[1])))]
        return [modulus * float(v) / invariant**k for k, v in zip(POWERS[law], q, strict=True)]

    def misfit(q: np.ndarray) -> np.ndarray:
        law_energy = energy(law, constants(q))
        pairs = zip(curves, scales, strict=True)
        return np.concatenate([(stress(law_energy, c.test, c.stretch) - c.stress) / s for c, s in pairs])

    bounds = tuple(map(np.array, _BOUNDS[law]))
    start = np.clip([1.0, *[0.01] * (len(keys) - 1)], *bounds)
    solution = least_squares(misfit, start, bounds=bounds, x_scale="jac", xtol=1e-12, ftol=1e-12, gtol=1e-12)
    misfits, rss = solution.fun, float(solution.fun @ solution.fun)
    splits = np.cumsum([len(curve.stretch) for curve in curves])[:-1]
    independent = max(sum(map(_count_independent, np.split(misfits, splits))), len(keys) + 2.0)
    variance = rss / (rows - len(keys)) * rows / independent
    covariance = np.linalg.pinv(solution.jac.T @ solution.jac) * variance
    half_widths = float(student.ppf(0.975, independent - len(keys))) * np.sqrt(np.diag(covariance))
    intervals = {}
    for i, key in enumerate(keys):
        change = half_widths[i] * np.eye(len(keys))[i]
        low_end, high_end = (constants(np.clip(solution.x + step, *bounds))[i] for step in (-change, change))
        intervals[key] = low_end, high_end
    at_bound = np.isclose(solution.x, bounds[0], atol=1e-5) | np.isclose(solution.x, bounds[1], rtol=1e-3)
    best = solution.x if law == "gent" else np.where(at_bound, 0.0, solution.x)
    values = dict(zip(keys, constants(best), strict=True))
    product = float(np.sqrt(np.prod(np.diag(covariance)[:2])))
    return Fit(
        law=law,
        constants=values,
        intervals=intervals,
        young=3.0 * energy(law, list(values.values())).shear,
        rms=float(np.sqrt(rss / rows)),
        largest=float(np.abs(misfits).max()),
        independent=independent,
        correlation=float(covariance[0, 1]) / product if len(keys) > 1 and product > 0.0 else 0.0,
        unstable=_find_instability(law, values),
        bound=tuple(key for key, held in zip(keys, at_bound, strict=True) if held),
    )


def chosen(fits: Sequence[Fit], curves: Sequence[Curve]) -> Fit | None:
    """Return the law with the fewest constants among the laws that fit well, None without one. One kind of
    test cannot distinguish c1 from c2 of mooney-rivlin, which is then left out; so is a limit beyond the
    data."""
    several_tests = len({curve.test for curve in curves}) > 1
    candidates = [f for f in fits if not f.unstable and "limit" not in f.bound]
    candidates = [f for f in candidates if several_tests or f.law != "mooney-rivlin"]
    if not candidates:
        return None
    allowed = max(AS_GOOD * min(f.rms for f in candidates), GOOD)
    return min((f for f in candidates if f.rms <= allowed), key=lambda f: (len(f.constants), f.rms))


_BOUNDS = {
    "neo-hookean": ([0.0], [inf]),
    "mooney-rivlin": ([0.0, 0.0], [inf, inf]),
    "yeoh": ([0.0, -inf, 0.0], [inf, inf, inf]),
    "gent": ([0.0, log(LIMITS[0])], [inf, log(LIMITS[1])]),
}


def _count_independent(misfits: np.ndarray) -> float:
    """Return the number of independent rows with as much information as correlated misfits."""
    total = float(misfits @ misfits)
    correlation = float(misfits[1:] @ misfits[:-1]) / total if total > 0.0 else 0.0
    correlation = min(max(correlation, 0.0), 1.0 - 1.0 / len(misfits))
    return len(misfits) * (1.0 - correlation) / (1.0 + correlation)


def _find_instability(law: str, constants: dict[str, float]) -> str:
    try:
        Material.model_validate({"law": law, "poisson": POISSON, "density": 1000.0, **constants})
    except (BadInput, ValueError) as error:
        reason = error.errors()[0]["msg"] if hasattr(error, "errors") else str(error)
        return str(reason).removeprefix("Value error, ")
    return "" if all(map(isfinite, constants.values())) else "not finite"
