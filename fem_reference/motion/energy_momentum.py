"""The energy–momentum rule: order two, and energy and momenta kept to rounding where nothing takes them.

    M (v₁ − v₀)/h + B(q̄)ᵀ D (½ (e₀ + e₁) + τ (e₁ − e₀)/h) = F,     q̄ = ½ (q₀ + q₁),
    ½ (v₀ + v₁) = (q₁ − q₀)/h

Strains are quadratic in q, so that B(q̄) (q₁ − q₀) = e₁ − e₀: a step's work is the change of the strain energy
and what the dampers take, to the last digit. |d| = 1 is kept by a force along ½ (d₀ + d₁), which does no
work since d₁ − d₀ is across it. Laws are those linear in Green's strain. Steps are of one length; one that
does not converge is halved. Nothing but the sheet's own dampers damps what is fast and not resolved.
Source: Simo & Tarnow, ZAMP 43 (1992) 757–792, and for shells Int. J. Numer. Meth. Eng. 37 (1994) 2527–2549.
"""

from __future__ import annotations

import numpy as np

from fem_reference.discrete.energies import SheetMotion
from fem_reference.motion.generalised_alpha import ConstrainedAlpha, Linear
from sheetbench.numerics.time.rule import MidpointStep

SOLVED = 1e-13  # last correction, relative to the displacement
CORRECTIONS = 30
REUSED = 0.3  # a correction's share of the one before, up to which factors are kept


class EnergyMomentum(ConstrainedAlpha):
    """Steps of a reference, of a fixed length."""

    def _advanced(self, motion: SheetMotion, h: float) -> SheetMotion:
        self.late = 0.5
        model, half_way, time = self._model, motion.time + 0.5 * h, motion.time + h
        rule = MidpointStep(h, motion.q, motion.v)

        def at(q: np.ndarray) -> SheetMotion:
            v, a = rule.velocity(q), rule.acceleration(q)
            return SheetMotion(time, q, v, a, a, model.mass @ a + model.mean_forces(motion.q, q, h, half_way))

        def linear(found: SheetMotion) -> Linear:
            middle, rate = rule.place(found.q), rule.rate(found.q)
            basis, shape = model.basis(middle), model.shape(middle, half_way, rate)
            return (
                basis,
                lambda: model.tangent(shape, found.exerted, 4.0 / h**2, 2.0 / h),
                2.0 * (basis.T @ found.exerted),
            )

        def solved(length: float, share: float, largest: float) -> bool:
            rounding = length <= 1e-10 * largest and share > REUSED
            return length <= SOLVED * largest or rounding

        guess = at(model.placed(motion.q + h * motion.v, time))
        return self._solved(h, guess, at, linear, solved, REUSED, CORRECTIONS)
