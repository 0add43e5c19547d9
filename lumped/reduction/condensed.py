"""A sheet in its lowest modes, everything else following statically: implicit condensation and expansion.

    u = Φ q + Ψ(q),   E = ½ Σ ωᵢ² qᵢ² + Σ eₘ qᵐ (third and fourth degree),   C(q) = Gᵀ C(u) G,   G = ∂u/∂q

Static answers of the lattice to loads M Φ p, alone and in twos and threes, as large as the motion's own, are
what e is fitted to (∂E/∂q = p), and Ψ, which is orthogonal to Φ in the mass and of second and third degree.
Stretching, turning and thinning go with bending in Ψ as the lattice itself has them; what they weigh in
motion is left out. Source: McEwan et al. (2001), Hollkamp and Gordon (2008).
"""

from __future__ import annotations

from itertools import combinations, product
from typing import NamedTuple

import numpy as np
from scipy.sparse.linalg import LinearOperator, eigsh

from lumped.dynamics.system import System
from lumped.reduction.monomials import gradients, monomials, values
from sheetbench.scenes.errors import BadInput

REACH = 1.2  # of the loads on the modes, for the largest static answers
LEAST = 0.05  # of the largest amplitude: how far modes that are not loaded are tried
LOAD_STEPS, CORRECTIONS, CLOSE = 4, 30, 1e-9


class Condensed(NamedTuple):
    """The model of r coordinates. modes (unknowns, r), orthonormal in the mass; squares (r,) [1/s²]; energy
    and weights: its monomials and their factors; expansion and shapes: monomials and Ψ's coefficients
    (m, unknowns); damping: C at rest (r, r), monomials and their coefficients (m, r, r)."""

    modes: np.ndarray
    squares: np.ndarray
    energy: np.ndarray
    weights: np.ndarray
    expansion: np.ndarray
    shapes: np.ndarray
    damping_at_rest: np.ndarray
    damping: np.ndarray
    damping_weights: np.ndarray


def condense(system: System, count: int) -> Condensed:
    """The model in `count` modes. Raises BadInput where the lattice has no static answers to fit it to."""
    nothing = np.zeros((system.assembly.pattern.size, 3))
    mass, size = system.reduced_mass, system.reduced_mass.shape[0]
    blocks = system.matrix(nothing, nothing, 0.0, 0.0, 0.0, 1.0)
    factor = system.problem.factor(blocks)
    squares, modes = eigsh(
        system.problem.system.matrix(blocks), count, mass, sigma=0.0,
        OPinv=LinearOperator((size, size), matvec=lambda b: factor.solve(b.ravel()), dtype=float),
        v0=np.random.default_rng(0).standard_normal(size),
    )  # fmt: skip
    loads = REACH * (modes.T @ system.reduce(system.external(nothing, 0.0)))
    static = np.abs(loads) / squares
    loads = np.maximum(static, LEAST * static.max()) * squares
    answers = [
        answer for pull in _pulls(loads) for answer in _answers(system, mass @ (modes * pull).sum(axis=1))
    ]
    x = np.array([unknowns for unknowns, _ in answers])
    p = np.array([force for _, force in answers]) @ modes
    q = x @ (mass @ modes)
    expansion = monomials(count, (2, 3))
    terms = np.array([values(expansion, each) for each in q])
    shapes = _fitted(terms, x - q @ modes.T)
    shapes -= (shapes @ (mass @ modes)) @ modes.T
    energy = monomials(count, (3, 4))
    slopes = np.array([gradients(energy, each) for each in q])  # (samples, m, r)
    weights = _fitted(slopes.transpose(0, 2, 1).reshape(-1, len(energy)), (p - squares * q).reshape(-1, 1))[
        :, 0
    ]
    damping = monomials(count, (1, 2))

    def dampers(at: np.ndarray) -> np.ndarray:
        here = modes + (gradients(expansion, at).T @ shapes).T
        u = system.expand(modes @ at + values(expansion, at) @ shapes)
        matrix = system.problem.system.matrix(system.matrix(u, nothing, 0.0, 0.0, 1.0, 0.0))
        return np.asarray(here.T @ (matrix @ here))

    rest = dampers(np.zeros(count))
    changes = np.array([dampers(each) - rest for each in q]).reshape(len(q), -1)
    of_dampers = _fitted(np.array([values(damping, each) for each in q]), changes).reshape(-1, count, count)
    return Condensed(modes, squares, energy, weights, expansion, shapes, rest, damping, of_dampers)


def _pulls(loads: np.ndarray) -> list[np.ndarray]:
    """Loads on each mode both ways, and on two and three of them together, both ways each."""
    found = []
    for together in (1, 2, 3):
        for which in combinations(range(len(loads)), together):
            for signs in product((1.0, -1.0), repeat=together):
                pull = np.zeros(len(loads))
                pull[list(which)] = np.array(signs) * loads[list(which)]
                found.append(pull)
    return found


def _answers(system: System, force: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Unknowns of the static answers to a growing force (unknowns,), and the forces."""
    found, x, still = [], np.zeros(len(force)), np.zeros((system.assembly.pattern.size, 3))
    for step in range(1, LOAD_STEPS + 1):
        share = step / LOAD_STEPS * force
        for _ in range(CORRECTIONS):
            u = system.expand(x)
            left = share - system.reduce(system.elastic(u, 0.0)[1])
            factor = system.problem.factor(system.matrix(u, still, 0.0, 0.0, 0.0, 1.0))
            correction = factor.solve(left)
            x = x + correction
            if np.abs(correction).max() < CLOSE * system.problem.size:
                break
        else:
            raise BadInput("integrator = 'reduced': the lattice has no static answer to its own loads")
        found.append((x.copy(), share))
    return found


def _fitted(terms: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Least squares, the columns scaled to each other."""
    scale = np.abs(terms).max(axis=0)
    found: np.ndarray = np.linalg.lstsq(terms / scale, right, rcond=1e-9)[0] / scale[:, None]
    return found
