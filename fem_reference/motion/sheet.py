"""What all references in motion have in common: loads, supports that move, energies, the work of a step.

Viscous forces are those of the rate of strain under the elastic moduli, s = D (e + τ ė) with ė = B u̇ and τ
the material's `dashpot_time`, as every spring of a lattice has the damper τ k; `damping_rate` α adds α M u̇.
Their tangent leaves out how B changes with the shape, which is of the order of the turn in a step.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.motion.loads import Factor, factor_at, single_loads
from fem_reference.motion.moving import Energies, Motion
from fem_reference.surface.loads import Follower
from sheetbench.scenes import Scene, require_no_branches
from sheetbench.scenes.supports import held_axes
from sheetbench.scenes.tables import PiecewiseLinear

Loaded = tuple[np.ndarray, list[Follower]]  # dead nodal forces (n, 3) and follower loads


class Sheet(ABC):
    """A reference in motion, as `moving.Moving` has it; N coordinates q."""

    mass: csr_matrix
    unknowns: int

    def __init__(self, scene: Scene):
        require_no_branches(scene.material, "a moving reference")
        supports = tuple(support.replace(motion=None) for support in scene.supports)
        self.still = scene.replace(loads=(), gravity=None, supports=supports)
        self.tau, self.alpha = scene.material.dashpot_time, scene.material.damping_rate
        self.dead: list[tuple[np.ndarray, Factor]] = []
        self.followers: list[tuple[Follower, Factor]] = []
        self._motions = [
            (str(s.edge), held_axes(s), PiecewiseLinear(s.motion.time, s.motion.displacement))
            for s in scene.supports
            if s.motion is not None
        ]

    def load(self, scene: Scene, loaded: Callable[[Scene], Loaded]) -> None:
        """Take up a scene's loads; loaded: what a scene with one of them has."""
        for alone, factor in single_loads(scene):
            dead, followers = loaded(alone)
            self.dead += [(self.on_coordinates(dead), factor)] if dead.any() else []
            self.followers += [(follower, factor) for follower in followers]

    def shift(self, edges: dict[str, tuple[np.ndarray, np.ndarray]], time: float, rate: bool) -> np.ndarray:
        """Displacement (n, 3) [m] of supports that move, or its rate; edges: nodes and axes of each."""
        out = np.zeros((self.nodes, 3))
        for edge, axes, over_time in self._motions:
            value = over_time.slope(time) if rate else over_time.at(time)
            out[np.ix_(edges[edge][0], np.array(axes))] = value[list(axes)]
        return out

    @property
    @abstractmethod
    def nodes(self) -> int:
        """Nodes of the plan, n."""

    @abstractmethod
    def on_coordinates(self, dead: np.ndarray) -> np.ndarray:
        """Forces (N,) of dead ones on the mid-surface (n, 3)."""

    @abstractmethod
    def internal(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Elastic and viscous forces (N,)."""

    @abstractmethod
    def following(self, q: np.ndarray, load: Follower) -> np.ndarray:
        """Forces (N,) of a follower load."""

    @abstractmethod
    def elastic(self, q: np.ndarray) -> float:
        """Strain energy [J]."""

    @abstractmethod
    def stiffness_of(self, q: np.ndarray, step: np.ndarray) -> float:
        """Δeᵀ D Δe [J] of the strains of a step (N,) from q."""

    def of_supports(self, exerted: np.ndarray) -> np.ndarray:
        """What supports and motions exert (N,) of M ü + g, which has no part along what is free."""
        return exerted

    def centripetal(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """As `Moving` has it: coordinates that are held, not constrained, demand none."""
        return np.zeros_like(q)

    def moved(self, q: np.ndarray, step: np.ndarray) -> np.ndarray:
        """As `Moving` has it."""
        return q + step

    def mean_internal(self, start: np.ndarray, end: np.ndarray, h: float) -> np.ndarray:
        """Elastic and viscous forces (N,) of the mean strains of a step and their mean rate."""
        return self.internal(0.5 * (start + end), (end - start) / h)

    def forces(self, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        """As `Moving` has it."""
        return self._loaded(self.internal(q, v), q, v, time)

    def mean_forces(self, start: np.ndarray, end: np.ndarray, h: float, time: float) -> np.ndarray:
        """As `Moving` has it."""
        q, v = 0.5 * (start + end), (end - start) / h
        return self._loaded(self.mean_internal(start, end, h), q, v, time)

    def _loaded(self, out: np.ndarray, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        """Internal forces (N,) less loads, and the drag."""
        for force, factor in self.dead:
            out = out - factor_at(factor, time) * force
        for follower, factor in self.followers:
            out = out - factor_at(factor, time) * self.following(q, follower)
        return out + self.alpha * (self.mass @ v) if self.alpha else out

    def energies(self, q: np.ndarray, v: np.ndarray) -> Energies:
        """As `Moving` has it."""
        potential = -sum(float(force @ q) for force, factor in self.dead if factor is None)
        return Energies(0.5 * float(v @ (self.mass @ v)), self.elastic(q), potential)

    def spent(self, start: Motion, end: Motion) -> np.ndarray:
        """As `Moving` has it."""
        h, step, middle = end.time - start.time, end.q - start.q, 0.5 * (start.q + end.q)
        damped = self.tau * self.stiffness_of(middle, step) + self.alpha * float(step @ (self.mass @ step))
        exerted, half_way = 0.5 * (start.exerted + end.exerted), 0.5 * (start.time + end.time)
        work = float(self.of_supports(exerted) @ step)
        for force, factor in self.dead:
            if factor is not None:
                work += factor_at(factor, half_way) * float(force @ step)
        for follower, factor in self.followers:
            work += factor_at(factor, half_way) * float(self.following(middle, follower) @ step)
        return np.array([damped / h, work])
