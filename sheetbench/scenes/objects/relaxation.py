"""Maxwell branches beside a spring: storage and loss over frequency, and a loss factor kept over a band.

    E(t) = E∞ + Σ E_i exp(−t/τ_i),    E_i = g_i E₀,    E₀ = E∞ + Σ E_i = E∞/(1 − Σ g_i)

with shares g_i of the instantaneous modulus E₀, as in the Prony series of Abaqus and CalculiX, and

    E'/E∞ = 1 + Σ a_i x²/(1 + x²),    E''/E∞ = Σ a_i x/(1 + x²),    x = ω τ_i,    η = E''/E'

a_i = E_i/E∞. A constant η, Σ a_i (x − η x²)/(1 + x²) = η, is a condition linear in a_i: it is solved by
nonnegative least squares over the band, each equation divided by E' of the previous solution, so that errors
of η are relative. Times lie evenly on a logarithmic scale, two a decade and at least two, from just below
1/ω_high to just above 1/ω_low.

For motion, at m places with X = (elastic stress s, strain e), every branch of stiffness a keeps R, adds the
stress a R_s and stores ½ a R_s·R_e:

    Ṙ + R/τ = Ẋ,    which in a step of length h is    R = w X + c,    w = (1 − β) τ/h,   β = exp(−h/τ),
    c = β R₀ − w X₀,

of second order, exact where X is linear in time. Source: Simo and Hughes, Computational Inelasticity (1998),
10.3. The state between steps is a `memory` (1 + b, 2, m): X, then R of every branch.
"""

from functools import cache
from math import ceil, log10, pi
from typing import Annotated, NamedTuple

import numpy as np

from sheetbench.errors import BadInput
from sheetbench.scenes.objects.quantities import Frozen, Positive, Real, Unit

A_DECADE = 2  # branches
HELD_WITHIN = 0.1  # of the loss factor, over the band
WIDEST = 6  # decades
BEYOND = np.linspace(0.2, 1.2, 6)  # how far times reach beyond the band, in ln τ; the best is taken
SAMPLES, SWEEPS = 100, 6


class Relaxation(Frozen):
    """A Maxwell branch of every spring and every modulus: a share of the stiffness that relaxes."""

    share: Annotated[float, Real(gt=0, lt=1)]
    """The branch's part of the instantaneous modulus; the shares add up to less than 1, and `young` is the
    modulus left in the end."""
    time: Annotated[Positive, Unit("s")]
    """Relaxation time τ: the branch's stress fades as exp(−t/τ)."""


class BranchStep(NamedTuple):
    """Branches within a step or stage: R = w X + c of each. weight: w (b,). constant: c (b, 2, m). gain: 1 +
    Σ a w, the factor of the elastic stress. past: Σ a c_s (m,), the stress added to it."""

    weight: np.ndarray
    constant: np.ndarray
    gain: float
    past: np.ndarray

    def after(self, x: np.ndarray) -> np.ndarray:
        """Return the memory with X (2, m) at the end."""
        return np.concatenate([x[None], self.weight[:, None, None] * x + self.constant])


class Branches(NamedTuple):
    """Maxwell branches: their stiffnesses over the long-time one, and their relaxation times [s]."""

    stiffness: tuple[float, ...]
    times: tuple[float, ...]

    @property
    def shares(self) -> np.ndarray:
        """Return the shares of the instantaneous modulus (n,)."""
        return np.array(self.stiffness) / (1.0 + sum(self.stiffness))

    def storage_and_loss(self, frequency: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
        """Return E'/E∞ and E''/E∞ at frequencies [Hz]."""
        x = 2.0 * pi * np.asarray(frequency, dtype=float)[..., None] * np.array(self.times)
        k = np.array(self.stiffness)
        return 1.0 + (x * x / (1.0 + x * x)) @ k, (x / (1.0 + x * x)) @ k

    def pole(self, omega: float, damping_time: float = 0.0, damping_rate: float = 0.0) -> complex:
        """Return the root s [1/s] of a mode whose long-time stiffness gives ω [rad/s], with dampers:

            s² + damping_rate s + ω² (E(s)/E∞ + damping_time s) = 0,

        an eigenvalue of ω q, q̇ and ω times the strains of the branches' springs; if the mode does not swing,
        its slowest root.
        """
        size = 2 + len(self.times)
        rates = np.zeros((size, size))
        rates[1, 0], rates[1, 1] = -omega, -damping_rate - omega**2 * damping_time
        rates[1, 2:] = -omega * np.array(self.stiffness)
        rates[0, 1] = rates[2:, 1] = omega
        rates[range(2, size), range(2, size)] = -1.0 / np.array(self.times)
        roots = np.linalg.eigvals(rates)
        return complex(roots[np.lexsort((roots.real, roots.imag))[-1]])

    def stepped(self, weight: np.ndarray, constant: np.ndarray) -> BranchStep:
        """Return a step or stage of weights (b,) and constants (b, 2, m)."""
        stiffness = np.array(self.stiffness)
        gain, past = 1.0 + float(stiffness @ weight), np.tensordot(stiffness, constant[:, 0], 1)
        return BranchStep(weight, constant, gain, past)

    def step(self, memory: np.ndarray, ahead: float) -> BranchStep:
        """Return the step from a memory to `ahead` [s] later."""
        x = ahead / np.array(self.times)
        weight = -np.expm1(-x) / x if ahead > 0.0 else np.ones_like(x)
        constant = np.exp(-x)[:, None, None] * memory[1:] - weight[:, None, None] * memory[0]
        return self.stepped(weight, constant)

    def at_rest(self, x: np.ndarray) -> np.ndarray:
        """Return the memory at X (2, m) after full relaxation."""
        return np.concatenate([x[None], np.zeros((len(self.times), *x.shape))])

    def stored(self, memory: np.ndarray) -> float:
        """Return the energy [J] in the branches' springs."""
        return 0.5 * float(np.array(self.stiffness) @ (memory[1:, 0] * memory[1:, 1]).sum(axis=1))

    def dissipated(self, before: np.ndarray, after: np.ndarray) -> float:
        """Return the energy [J] that the branches dissipate from one memory to the next. It is the work of
        their mean stresses less the increase of their stored energy."""
        mean = 0.5 * np.tensordot(np.array(self.stiffness), before[1:, 0] + after[1:, 0], 1)
        work = float(mean @ (after[0, 1] - before[0, 1]))
        return work - self.stored(after) + self.stored(before)


@cache
def constant_loss(loss_factor: float, low: float, high: float) -> Branches:
    """Return branches that keep a loss factor from a low to a high frequency [Hz]. Raises BadInput for an
    empty or too wide band, and if they miss the loss factor by more than HELD_WITHIN."""
    band = f"band = [{low:g}, {high:g}] Hz"
    if not low < high:
        raise BadInput(f"{band}: the second frequency must be the higher one")
    decades = log10(high / low)
    if decades > WIDEST:
        raise BadInput(f"{band}: {decades:.3g} decades; {WIDEST} at most")
    count = max(2, ceil(A_DECADE * decades - 1e-9))
    frequency = np.geomspace(low, high, SAMPLES)
    fits = (_fit(loss_factor, frequency, count, beyond) for beyond in BEYOND)
    error, best = min(fits, key=lambda fit: fit[0])
    if error > HELD_WITHIN:
        raise BadInput(
            f"{band}, loss_factor = {loss_factor:g}: {count} branches miss it by {100 * error:.0f} % within "
            f"the band, more than {100 * HELD_WITHIN:.0f} %: give a smaller loss_factor or "
            "[[material.relaxation]]"
        )
    return best


def _fit(loss_factor: float, frequency: np.ndarray, count: int, beyond: float) -> tuple[float, Branches]:
    """Return the largest relative error of the loss factor within the band, and the branches."""
    from scipy.optimize import nnls

    factor = np.exp(beyond)
    times = np.geomspace(1.0 / (factor * frequency[-1]), factor / frequency[0], count) / (2.0 * pi)
    x = 2.0 * pi * frequency[:, None] * times
    rows, weight = (x - loss_factor * x * x) / (1.0 + x * x), np.ones(len(frequency))
    for _ in range(SWEEPS):
        shares, _ = nnls(rows * weight[:, None], loss_factor * weight)
        branches = Branches(tuple(map(float, shares)), tuple(map(float, times)))
        storage, loss = branches.storage_and_loss(frequency)
        weight = 1.0 / storage
    return float(np.abs(loss / storage / loss_factor - 1.0).max()), branches
