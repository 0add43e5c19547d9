"""A linear system ẋ = A x + B w, y = C x + D w: poles, responses, and as few states as a tolerance allows.

Balanced truncation. Inputs are scaled by W, so that each alone moves the outputs at rest by a vector of norm
1 m. The Gramians P and Q of A P + P Aᵀ + B W W Bᵀ = 0 and Aᵀ Q + Q A + Cᵀ C = 0 measure controllability and
observability of the states. Both are diag(σ), Hankel's singular values, in balanced coordinates; states of
small σ matter little. They follow quasi-statically, so that slow inputs are answered exactly (singular
perturbation), and the error of any order r is bounded beforehand:

    max over ω of ‖(G − G_r)(iω) W‖₂ ≤ 2 (σ_{r+1} + … + σ_n)

The bound holds for each input alone, at all frequencies, as a share of its response at rest.
Sources: Moore 1981; Enns 1984 and Glover 1984 on the bound; Liu and Anderson 1989 on states at rest; Laub,
Heath, Paige and Ward 1987 on balancing by square roots.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg

from sheetbench.errors import BadInput
from sheetbench.numerics.threads import one_blas_thread

MOST = 1000  # states with dense Gramians: some ten seconds


@dataclass(frozen=True, eq=False)
class StateSpace:
    """A linear system ẋ = A x + B w, y = C x + D w.

    Parameters
    ----------
    a : ndarray of shape (s, s)
        Matrix A [1/s].
    b : ndarray of shape (s, inputs)
        Matrix B, in units of the states per second and of the inputs.
    c : ndarray of shape (outputs, s)
        Matrix C, in units of the outputs and of the states.
    d : ndarray of shape (outputs, inputs)
        Matrix D, in units of the outputs and of the inputs.
    frequencies : ndarray of shape (k,)
        Frequencies [Hz], undamped ones of modes, |poles|/2π of a reduced system.
    """

    a: np.ndarray
    b: np.ndarray
    c: np.ndarray
    d: np.ndarray
    frequencies: np.ndarray

    @cached_property
    def poles(self) -> np.ndarray:
        """Eigenvalues of A [rad/s], the slowest first, positive imaginary parts before their conjugates."""
        values = np.linalg.eigvals(self.a)
        return values[np.lexsort((-values.imag, np.round(abs(values), 9)))]

    def response(self, frequencies: np.ndarray) -> np.ndarray:
        """Return C (iω − A)⁻¹ B + D at frequencies (f,) [Hz], (f, outputs, inputs)."""
        unit = np.eye(len(self.a))
        at = 2j * np.pi * np.asarray(frequencies)
        return np.stack([self.c @ np.linalg.solve(s * unit - self.a, self.b) + self.d for s in at])

    def balanced(self, order: int | None = None, tolerance: float | None = None) -> Balanced:
        """Return the system reduced to `order` states, or to as few as keep the bound within `tolerance`.

        Raises BadInput without either or with both, for an order out of range, for more than MOST states, and
        for an undamped motion, which has no Gramians.
        """
        size = len(self.a)
        if (order is None) == (tolerance is None):
            raise BadInput("balanced: give an order or a tolerance")
        if order is not None and not 1 <= order <= size:
            raise BadInput(f"order = {order}: from 1 to {size} states")
        if tolerance is not None and not tolerance > 0.0:
            raise BadInput(f"tolerance = {tolerance:g}: above 0")
        if size > MOST:
            raise BadInput(f"{size} states: balanced up to {MOST}; take fewer modes or masses")
        if self.poles.real.max() > -1e-12 * np.abs(self.poles).max():
            raise BadInput("balanced: some motion is not damped; give a damping_time or damping_rate")
        with one_blas_thread():
            return _balanced(self, order, tolerance)


@dataclass(frozen=True, eq=False)
class Balanced:
    """A reduced system by balanced truncation.

    Parameters
    ----------
    space : StateSpace
        System of the states kept.
    hankel : ndarray of shape (s,)
        Hankel's singular values σ of all states, falling.
    scale : ndarray of shape (inputs,)
        Scale W of the inputs [units of the inputs/m].
    """

    space: StateSpace
    hankel: np.ndarray
    scale: np.ndarray

    @property
    def order(self) -> int:
        """Number of states kept."""
        return len(self.space.a)

    @property
    def bound(self) -> float:
        """Bound of the error, 2 Σ σ of the states left out."""
        return float(2.0 * self.hankel[self.order :].sum())

    def order_within(self, tolerance: float) -> int:
        """Return the lowest order with a bound within a tolerance."""
        return _order_within(self.hankel, tolerance)


def _order_within(hankel: np.ndarray, tolerance: float) -> int:
    bounds = np.append(2.0 * np.cumsum(hankel[:0:-1])[::-1], 0.0)  # of 1, 2, … states
    return 1 + int(np.argmax(bounds <= tolerance))


def _balanced(space: StateSpace, order: int | None, tolerance: float | None) -> Balanced:
    at_rest = np.linalg.norm(space.response(np.zeros(1))[0].real, axis=0)
    scale = 1.0 / np.where(at_rest > 0.0, at_rest, 1.0)
    b = space.b * scale
    control = _root(scipy.linalg.solve_continuous_lyapunov(space.a, -b @ b.T))
    observation = _root(scipy.linalg.solve_continuous_lyapunov(space.a.T, -space.c.T @ space.c))
    left, hankel, right = np.linalg.svd(observation.T @ control)
    if order is None:
        assert tolerance is not None
        order = _order_within(hankel, tolerance)
    minimal = int(np.count_nonzero(hankel > 1e-14 * hankel[0]))  # others are uncontrollable or unobservable
    order = min(order, minimal)
    weight = np.sqrt(hankel[:minimal])
    to, back = observation @ left[:, :minimal] / weight, control @ right.T[:, :minimal] / weight
    a, b, c = to.T @ space.a @ back, to.T @ space.b, space.c @ back
    retained, truncated = slice(0, order), slice(order, minimal)
    follow = np.linalg.solve(a[truncated, truncated], np.hstack([a[truncated, retained], b[truncated]]))
    small_a = a[retained, retained] - a[retained, truncated] @ follow[:, :order]
    small = StateSpace(
        small_a,
        b[retained] - a[retained, truncated] @ follow[:, order:],
        c[:, retained] - c[:, truncated] @ follow[:, :order],
        space.d - c[:, truncated] @ follow[:, order:],
        np.sort(np.abs(np.linalg.eigvals(small_a))) / (2.0 * np.pi),
    )
    if small.poles.real.max() >= 0.0:
        raise BadInput(f"order = {order}: separates two states of equal weight; take {order + 1}")
    return Balanced(small, hankel, scale)


def _root(gramian: np.ndarray) -> np.ndarray:
    """Return L of a Gramian L Lᵀ, without eigenvalues that rounding made negative."""
    values, vectors = np.linalg.eigh(0.5 * (gramian + gramian.T))
    return vectors * np.sqrt(np.clip(values, 0.0, None))
