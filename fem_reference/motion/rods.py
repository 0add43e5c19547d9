"""Chains in motion: the elastic rods of `surface.rod` with their inertia, their dampers and their commands.

    ½ ρ_l ∫ |φ̇ + c ḋ|² + ¼ a² (|ḋ|² + |ṁ|²) ds,     s = S (e − e₀(t)) + τ S_elastic ė

A chain's cross-section is round, of radius a; c is the height of its axis, τ its `damping_time`, which acts
on what bends freely alone. e₀ follows the command over time; its change is work. The solid's third director t
has `LIGHT` of the inertia of the others, so that the mass is regular.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.motion.loads import Factor, factor_at
from fem_reference.surface.biquadratic import SIDE_MASS
from fem_reference.surface.bound_rods import BoundRods
from fem_reference.surface.rod import INPLANE, NORMAL
from fem_reference.surface.rod_elements import RodElements
from sheetbench.scenes import Chain, Scene
from sheetbench.scenes.actuators import CurvatureTable
from sheetbench.scenes.tables import PiecewiseLinear

LIGHT = 1e-3
BENT = {"normal": (NORMAL,), "inplane": (INPLANE,), "spatial": (NORMAL, INPLANE)}


def components_of(bound: BoundRods) -> np.ndarray:
    """Numbers (k, 3 a) of the components of the sides' vectors, where all vectors' are the coordinates."""
    k, a = bound.sites.shape
    return (3 * bound.sites[:, :, None] + np.arange(3)).reshape(k, 3 * a)


def at_rest(scene: Scene) -> Scene:
    """The scene with chains that no command bends."""
    slack = (a.replace(curvature=0.0) if isinstance(a, Chain) else a for a in scene.actuators)
    return scene.replace(actuators=tuple(slack))


class MovingRods:
    """The rods of a scene in a model of `size` coordinates.

    build: binds the rods of a scene with these chains to the model; rows: coordinates (k, 3 a) of the sides'
    Q, −1 for none; places: of φ, d and m (9,) in Q; linear: strains are those about the flat sheet.
    """

    def __init__(
        self,
        scene: Scene,
        build: Callable[[Scene], BoundRods],
        rows: Callable[[BoundRods], np.ndarray],
        size: int,
        places: np.ndarray | None = None,
        linear: bool = False,
    ):
        self._build, self._linear, self._size = build, linear, size
        still = at_rest(scene)
        self._bound = bound = build(still)
        self.elements: RodElements = bound.elements
        self._rows = rows(bound)
        self._commands: list[tuple[np.ndarray, Factor]] = [
            (build(alone).elements.intrinsic, factor) for alone, factor in _single_commands(scene)
        ]
        self._mass = self._side_masses(scene, np.arange(9) if places is None else places)
        self._viscous = self._dampers(scene)
        self._damped = bool(self._viscous.any())

    def __bool__(self) -> bool:
        return bool(self._bound.rods)

    def weight(self, scene: Scene) -> np.ndarray:
        """Dead forces (N,) of the chains under a scene's gravity."""
        return self._scattered(self._build(at_rest(scene)).elements.weight)

    def mass(self) -> csr_matrix:
        """The rods' mass (N, N)."""
        return self.matrix(self._inertia())

    def forces(self, q: np.ndarray, v: np.ndarray, time: float) -> np.ndarray:
        """Elastic and viscous forces (N,)."""
        change = self._gathered(q)
        gradient = self._gradient(change)
        rate = np.einsum("esic,eic->es", gradient, self._gathered(v)) if self._damped else 0.0
        return self._pull(gradient, self._strain(change), rate, time)

    def mean_forces(self, start: np.ndarray, end: np.ndarray, h: float, time: float) -> np.ndarray:
        """Those (N,) of a step's mean strains and their mean rate; time: the step's middle."""
        before, after = self._gathered(start), self._gathered(end)
        strains = self._strain(before), self._strain(after)
        gradient = self._gradient(0.5 * (before + after))
        return self._pull(gradient, 0.5 * (strains[0] + strains[1]), (strains[1] - strains[0]) / h, time)

    def tangent(self, q: np.ndarray, v: np.ndarray, time: float, by_a: float, by_v: float) -> np.ndarray:
        """by_a M + by_v C + K of the sides, (k, 3 a, 3 a)."""
        change = self._gathered(q)
        gradient = self._gradient(change)
        rate = np.einsum("esic,eic->es", gradient, self._gathered(v))
        stiff = replace(self.elements, stiffness=self.elements.stiffness + by_v * self._viscous)
        stress = 0.0 * rate if self._linear else self._stress(self._strain(change), rate, time)
        return stiff.tangent(gradient, stress) + by_a * self._inertia()

    def energy(self, q: np.ndarray, time: float) -> float:
        """Strain energy [J] from the shape that the commands ask for."""
        off = self._strain(self._gathered(q)) - self._intrinsic(time)
        return 0.5 * float(np.sum(self.elements.stiffness * off**2))

    def dissipated(self, q: np.ndarray, step: np.ndarray, rate: np.ndarray) -> float:
        """Δeᵀ τ S ė [J] of a step and a rate (N,) at q."""
        gradient = self._gradient(self._gathered(q))
        of_step, of_rate = (
            np.einsum("esic,eic->es", gradient, self._gathered(vector)) for vector in (step, rate)
        )
        return float(np.sum(self._viscous * of_step * of_rate))

    def matrix(self, sides: np.ndarray) -> csr_matrix:
        """The sum (N, N) of matrices of sides (k, 3 a, 3 a)."""
        width = self._rows.shape[1]
        rows, columns = np.repeat(self._rows, width, axis=1).ravel(), np.tile(self._rows, (1, width)).ravel()
        on = (rows >= 0) & (columns >= 0)
        return csr_matrix((sides.ravel()[on], (rows[on], columns[on])), (self._size, self._size))

    def _inertia(self) -> np.ndarray:
        k, a = self._mass.shape[:2]
        return np.einsum("eij,cd->eicjd", self._mass, np.eye(3)).reshape(k, 3 * a, 3 * a)

    def _gathered(self, q: np.ndarray) -> np.ndarray:
        return np.where(self._rows >= 0, q[self._rows], 0.0).reshape(self.elements.reference.shape)

    def _scattered(self, of_sides: np.ndarray) -> np.ndarray:
        on = self._rows >= 0
        return np.bincount(self._rows[on], of_sides.reshape(self._rows.shape)[on], self._size)

    def _gradient(self, change: np.ndarray) -> np.ndarray:
        return self.elements.gradient(np.zeros_like(change) if self._linear else change)

    def _strain(self, change: np.ndarray) -> np.ndarray:
        if self._linear:
            return np.einsum("esic,eic->es", self._gradient(change), change)
        return self.elements.strain(change)

    def _intrinsic(self, time: float) -> np.ndarray:
        total = np.zeros_like(self.elements.intrinsic)
        for shape, factor in self._commands:
            total += factor_at(factor, time) * shape
        return total

    def _stress(self, strain: np.ndarray, rate: np.ndarray | float, time: float) -> np.ndarray:
        return self.elements.stiffness * (strain - self._intrinsic(time)) + self._viscous * rate

    def _pull(
        self, gradient: np.ndarray, strain: np.ndarray, rate: np.ndarray | float, time: float
    ) -> np.ndarray:
        return self._scattered(self.elements.force(gradient, self._stress(strain, rate, time)))

    def _dampers(self, scene: Scene) -> np.ndarray:
        """τ S of what bends freely, (k, s); chains on one edge by their stiffness."""
        out = [np.zeros((0, self.elements.stiffness.shape[1]))]
        for rod, stiffness in zip(self._bound.rods, self._bound.by_rod(self.elements.stiffness), strict=True):
            chains = scene.chains()[rod.edge].values()
            rigidity = np.array([chain.bending_stiffness for chain in chains])
            tau = np.array([chain.damping_time for chain in chains]) @ rigidity / rigidity.sum()
            out.append(np.zeros_like(stiffness))
            for bent in BENT[next(iter(chains)).plane]:
                out[-1][:, bent] = tau * stiffness[:, bent]
        return np.concatenate(out)

    def _side_masses(self, scene: Scene, places: np.ndarray) -> np.ndarray:
        """Mass of the sides' vectors, (k, a, a)."""
        a = self.elements.reference.shape[1]
        out = [np.zeros((0, a, a))]
        for rod in self._bound.rods:
            ends = rod.elements.reference[:, [0, 2]]
            half = 0.5 * np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
            mass = np.zeros((len(rod.nodes), a, a))
            for chain in scene.chains()[rod.edge].values():
                height, rotary = chain.axis_height(scene.sheet.thickness), chain.radius**2 / 4.0
                kinds = np.diag([1.0, height**2 + rotary, rotary])
                kinds[0, 1] = kinds[1, 0] = height
                side = chain.line_density * half[:, None, None] * np.kron(kinds, SIDE_MASS)
                mass[:, places[:, None], places] += side
                third = np.arange(places[-1] + 1, a)
                mass[:, third[:, None], third] += LIGHT * side[:, 6:, 6:][:, : len(third), : len(third)]
            out.append(mass)
        return np.concatenate(out)


def _single_commands(scene: Scene) -> Iterator[tuple[Scene, Factor]]:
    """Scenes with one chain's command each, and its course over time."""
    still = at_rest(scene)
    for number, chain in enumerate(scene.actuators):
        if isinstance(chain, Chain):
            over_time = chain.curvature if isinstance(chain.curvature, CurvatureTable) else None
            bent = chain.replace(curvature=1.0) if over_time else chain
            actuators = (*still.actuators[:number], bent, *still.actuators[number + 1 :])
            factor = PiecewiseLinear(over_time.time, over_time.value) if over_time else None
            yield still.replace(actuators=actuators), factor
