"""Constraints of the actuators in explicit dynamics: Φ(u) = 0 and J v = 0 by M⁻¹-weighted projections.

Only the actuators' rows appear in Φ, and the mass matrix couples them with nothing else, so that a small
dense matrix J M⁻¹ Jᵀ does it all. Source: Ryckaert et al. (1977), Andersen (1983): SHAKE and RATTLE.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg
import scipy.sparse as sp

from lumped.dynamics.system import System

ITERATIONS = 30
TIGHT = 1e-13  # Φ relative to its scale (the constraint's gradient times the sheet's side)


class Projection:
    """Projections of a system with constraints; without any it leaves everything as it is."""

    def __init__(self, system: System):
        self._system = system
        self.active = system.constrained
        if not self.active or system.coupling is None:
            return
        masses, rows = system.coupling.masses, system.coupling.size - system.coupling.masses
        rows_of = sp.csc_array(system.moving_part[3 * masses :])
        self._unknown = np.flatnonzero(np.diff(rows_of.indptr))
        self._map = rows_of[:, self._unknown].toarray()  # identity but for rows that follow others
        block = system.reduced_mass[self._unknown][:, self._unknown].toarray()
        self._inverse_mass = np.linalg.inv(block)
        self._rows = rows
        self._order = np.flatnonzero(system.coupling.algebraic[masses:].ravel())

    def jacobian(self, u: np.ndarray) -> np.ndarray:
        """J on the actuators' unknowns, (multipliers, c)."""
        assert self._system.coupling is not None
        gradient = self._system.coupling.constraint_gradient(u)
        reduced: np.ndarray = gradient.reshape(len(gradient), -1) @ self._map
        return reduced

    def residual(self, u: np.ndarray, time: float) -> np.ndarray:
        """Φ, (multipliers,)."""
        coupling = self._system.coupling
        assert coupling is not None
        force = np.zeros_like(u)
        coupling.add_force(u, self._system.drive(time), force)
        return force[coupling.masses :].ravel()[self._order]

    def onto_constraints(self, u: np.ndarray, jacobian: np.ndarray, time: float) -> np.ndarray:
        """Displacement u + M⁻¹ J₀ᵀ μ that satisfies Φ = 0. Raises ArithmeticError if none is found."""
        weighted = self._inverse_mass @ jacobian.T
        factors = scipy.linalg.cho_factor(jacobian @ weighted)
        tolerance = TIGHT * float(np.abs(jacobian).max()) * self._system.problem.size
        for _ in range(ITERATIONS):
            miss = self.residual(u, time)
            if np.abs(miss).max() < tolerance:
                return u
            if not np.isfinite(miss).all():
                break
            u = u - self._spread(weighted @ scipy.linalg.cho_solve(factors, miss))
        raise ArithmeticError("the actuators' constraints found no solution: use smaller steps")

    def tangential(self, vector: np.ndarray, jacobian: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The vector (size, 3) less M⁻¹ Jᵀ μ, so that J times it vanishes; and μ in its rows (size, 3)."""
        weighted = self._inverse_mass @ jacobian.T
        own = self._system.contract(vector)[self._unknown]
        multipliers = scipy.linalg.solve(jacobian @ weighted, jacobian @ own, assume_a="pos")
        rows = np.zeros(vector.size)
        rows[vector.size - 3 * self._rows + self._order] = multipliers
        return vector - self._spread(weighted @ multipliers), rows.reshape(vector.shape)

    def _spread(self, values: np.ndarray) -> np.ndarray:
        unknowns = np.zeros(self._system.reduced_mass.shape[0])
        unknowns[self._unknown] = values
        return self._system.expand(unknowns)
