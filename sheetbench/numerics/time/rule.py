"""Generalised-α: coefficients, error and equation of a step, without its solution.

    M a₁ + f(u₁, v₁, t₁) = 0                               equilibrium at the step's end, constraints included
    (1 − αm) a'₁ + αm a'₀ = (1 − αf) a₁ + αf a₀            a': the algorithm's acceleration
    u₁ = u₀ + h v₀ + h² ((½ − β) a'₀ + β a'₁),   v₁ = v₀ + h ((1 − γ) a'₀ + γ a'₁)

    αm = (2ρ − 1)/(ρ + 1),  αf = ρ/(ρ + 1),  γ = ½ + αf − αm,  β = ¼ (γ + ½)²

ρ is the spectral radius at high frequencies. a' is the acceleration at t + (αm − αf) h. So the local error of
u is h² (β + ½ (αm − αf) − 1/6) |a'₁ − a'₀|, and a change of the length turns a' into a + (a' − a) h/h_before.
Source: Chung and Hulbert (1993) in the form of Arnold and Brüls (2007), of second order with constraints too.

Backward Euler, u₁ = u₀ + h v₁ and v₁ = v₀ + h a₁, has this form; its local error is ½ h² |a₁|. A step of
either rule with u₁ as its unknown has v₁ = v̂ + c₁ (u₁ − û) and a₁ = c₂ (u₁ − û) (`AlphaStep`).
"""

from typing import NamedTuple

import numpy as np

from sheetbench.errors import BadInput

LONGER = 2.5  # times the step before, up to which a' is carried over: controllers let steps grow by 2


class Rule(NamedTuple):
    """Coefficients of a step: αm, αf, γ, β, and `old`, the coefficient of h² a'₀ in u₁. order: of u's local
    error. error: the local error over h² |a'₁ − a'₀|, for backward Euler over h² |a₁|."""

    am: float
    af: float
    gamma: float
    beta: float
    old: float
    order: int
    error: float

    def by_a(self, h: float) -> float:
        """Return da₁/du₁ [1/s²] in a step of h [s]."""
        return (1.0 - self.am) / ((1.0 - self.af) * self.beta * h * h)

    def by_v(self, h: float) -> float:
        """Return dv₁/du₁ [1/s]."""
        return self.gamma / (self.beta * h)


BACKWARD_EULER = Rule(0.0, 0.0, 1.0, 1.0, 0.0, 2, 0.5)


def generalised(radius: float) -> Rule:
    """Return generalised-α's coefficients for a spectral radius at high frequencies in [0, 1]. Raises
    BadInput for other values."""
    if not 0.0 <= radius <= 1.0:
        raise BadInput(f"radius = {radius:g}: the spectral radius at high frequencies lies in [0, 1]")
    am, af = (2.0 * radius - 1.0) / (radius + 1.0), radius / (radius + 1.0)
    gamma = 0.5 + af - am
    beta = 0.25 * (gamma + 0.5) ** 2
    return Rule(am, af, gamma, beta, 0.5 - beta, 3, abs(beta + 0.5 * (am - af) - 1.0 / 6.0))


class AlphaStep(NamedTuple):
    """A step of h [s] with u₁ as its unknown: û, v̂ and â', the values of u₁, v₁ and a'₁ for a₁ = 0. by_v: c₁
    [1/s]. by_a: c₂ [1/s²]. to_a: (a'₁ − â')/a₁. guess: u₁ for a'₁ = a'₀."""

    base_u: np.ndarray
    base_v: np.ndarray
    base_a: np.ndarray
    by_v: float
    by_a: float
    to_a: float
    guess: np.ndarray

    def velocity(self, u: np.ndarray) -> np.ndarray:
        """Return v₁."""
        return self.base_v + self.by_v * (u - self.base_u)

    def acceleration(self, u: np.ndarray) -> np.ndarray:
        """Return a₁."""
        return self.by_a * (u - self.base_u)

    def algorithm(self, a: np.ndarray) -> np.ndarray:
        """Return a'₁ of a₁."""
        return self.base_a + self.to_a * a


def step_of(rule: Rule, h: float, u: np.ndarray, v: np.ndarray, a: np.ndarray, old: np.ndarray) -> AlphaStep:
    """Return the step of h [s] from u₀, v₀, a₀ and a'₀."""
    am, af, gamma, beta, by_old, *_ = rule
    base_a = (af * a - am * old) / (1.0 - am)
    start = u + h * v + h * h * by_old * old
    base_v = v + h * ((1.0 - gamma) * old + gamma * base_a)
    base_u, guess = start + h * h * beta * base_a, start + h * h * beta * old
    return AlphaStep(base_u, base_v, base_a, rule.by_v(h), rule.by_a(h), (1.0 - af) / (1.0 - am), guess)


def shifted(a: np.ndarray, algorithm: np.ndarray, h: float, before: float) -> np.ndarray:
    """Return a' for steps of h [s] from a and its value for steps of `before` [s], 0 without any; a itself
    after much shorter steps, as between the ends of a jump."""
    return a + h / before * (algorithm - a) if h <= LONGER * before else a
