"""Chains of a sheet: the elastic rods of `surface.rod` with their inertia, dampers and commands.

    e = ½ Qᵀ H Q − ½ Q₀ᵀ H Q₀,     energy ½ Σ S (e − λ e₀)²,     δe = B δQ,  B = H Q
    ½ ρ_l ∫ |φ̇ + c ḋ|² + ¼ a² (|ḋ|² + |ṁ|²) ds,     s = S (e − e₀) + τ S_elastic ė

with Q the vectors of a side of the edge, e₀ the intrinsic curvature and λ the load factor: the force is Bᵀ s,
its tangent Bᵀ S B + Σ s H.

A chain's cross-section is round, of radius a; c is the height of its axis, τ its `damping_time`, which acts
on its free bending alone. e₀ follows the command; its change is work. The solid's third director t has
`LIGHT` of the inertia of the others, so that the mass is regular.

On the linear plate strains are linear about the flat sheet, B q. They are, per length, with s along the edge,
t outwards, tilt β and the axis at the height c,

    axial u_s,s + c β_s,s    shear w,s + β_s    aside u_t,s + c β_t,s + m_s    twist β_t,s    square β_t + m_z
    bending −β_s,s out of the plane, −m_s,s in it

so that a rod off the mid-surface couples bending and membrane, as it should; the effect of the initial moment
EI κ₀ on a deflected rod is of second order.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.discrete.course import Factor, factor_at
from fem_reference.discrete.shape import SheetShape
from fem_reference.surface.biquadratic import SIDE_MASS
from fem_reference.surface.rod import INPLANE, NORMAL, BoundRods, RodElements
from sheetbench.numerics.sparsity import Pattern
from sheetbench.scenes import Scene

LIGHT = 1e-3
BENT = {"normal": (NORMAL,), "inplane": (INPLANE,), "spatial": (NORMAL, INPLANE)}


class Rods:
    """The rods of a scene's chains among the coordinates (N,) of a sheet. bound: rods bound to the sheet's
    vectors; size: N; commands: the curvatures' factors; places: of φ, d, m (9,) in Q; linear: strains are
    linear about the flat sheet. rows: coordinates (k, 3 a) of the sides' Q."""

    def __init__(
        self,
        scene: Scene,
        bound: BoundRods,
        size: int,
        commands: Sequence[Factor],
        places: np.ndarray | None = None,
        linear: bool = False,
    ):
        self.bound, self._linear, self._size = bound, linear, size
        self._commands = commands if bound.rods else ()
        places = np.arange(9) if places is None else places
        self._line, self._directors = places[:3], places[3:6]
        k, a = bound.sites.shape
        self.rows = (3 * bound.sites[:, :, None] + np.arange(3)).reshape(k, 3 * a)
        self.elements: RodElements = bound.elements
        self._mass = self._side_masses(scene, places)
        self._viscous = self._dampers()

    def weight(self, scene: Scene) -> np.ndarray:
        """Return dead forces (k, a, 3) of a scene's gravity on the sides' vectors."""
        acceleration = np.zeros(3) if scene.gravity is None else scene.gravity.last_acceleration
        return np.multiply.outer(self._mass[:, :, self._line].sum(axis=2), acceleration)

    def mass(self) -> csr_matrix:
        """Return the rods' mass (N, N)."""
        return Pattern(self.rows, size=self._size).matrix(_by_axis(self._mass))

    def stress(self, shape: SheetShape) -> np.ndarray:
        """Return elastic and viscous stresses (k, s)."""
        change = self.gather(shape.q)
        rate = 0.0 if shape.v is None else self._step(self._gradient(change), shape.v)
        off = self._strain(change) - self._intrinsic(shape.at)
        return self.elements.stiffness * off + self._viscous * rate

    def pull(self, q: np.ndarray, stress: np.ndarray) -> np.ndarray:
        """Return Bᵀ s (k, a, 3) on the sides' vectors at q (N,)."""
        return np.einsum("es,esic->eic", stress, self._gradient(self.gather(q)))

    def extrapolated(self, shape: SheetShape, stress: np.ndarray, move: np.ndarray) -> np.ndarray:
        """Return stresses (k, s) linear in a step (N,) from a shape with stresses `stress`."""
        return stress + self.elements.stiffness * self._step(self._gradient(self.gather(shape.q)), move)

    def tangent(
        self, shape: SheetShape, stress: np.ndarray, by_a: float = 0.0, by_v: float = 0.0
    ) -> np.ndarray:
        """Return by_a M + by_v C + K (k, 3 a, 3 a) of the sides under stresses."""
        gradient, stiff = self._gradient(self.gather(shape.q)), self.elements.stiffness + by_v * self._viscous
        flat, form = gradient.reshape(*stiff.shape, 3 * gradient.shape[2]), by_a * self._mass
        if not self._linear:
            form = form + np.einsum("es,esij->eij", stress, self.elements.forms)
        return flat.swapaxes(1, 2) @ (stiff[:, :, None] * flat) + _by_axis(form)

    def inertial(self, a: np.ndarray) -> np.ndarray:
        """Return the inertial forces M a (k, a, 3) on the sides' vectors for accelerations (N,)."""
        return np.einsum("eij,ejc->eic", self._mass, self.gather(a))

    def driving(self, shape: SheetShape) -> np.ndarray:
        """Return the force of the commands on the sides' vectors (k, a, 3)."""
        return self.pull(shape.q, self.elements.stiffness * self._intrinsic(shape.at))

    def energy(self, q: np.ndarray, at: float) -> float:
        """Return the strain energy [J], zero in the shape that the commands prescribe."""
        off = self._strain(self.gather(q)) - self._intrinsic(at)
        return 0.5 * float(np.sum(self.elements.stiffness * off**2))

    def dissipated(self, q: np.ndarray, step: np.ndarray, rate: np.ndarray) -> float:
        """Return Δeᵀ τ S ė [J] of a step and a rate (N,) at q."""
        gradient = self._gradient(self.gather(q))
        return float(np.sum(self._viscous * self._step(gradient, step) * self._step(gradient, rate)))

    def magnitudes(self, q: np.ndarray, stress: np.ndarray) -> np.ndarray:
        """Return Σ |B| |s| (k, a, 3), the magnitudes of the terms of forces on the sides' vectors."""
        return np.einsum("es,esic->eic", np.abs(stress), np.abs(self._gradient(self.gather(q))))

    def creep_step(self, shape: SheetShape, drag: float) -> Rods:
        """Return the rods for a creep step against drag σ from a shape's strains e_n: their stresses are (1 +
        σ) S e − σ S e_n − S e₀."""
        past = self._intrinsic(shape.at) + drag * self._strain(self.gather(shape.q))
        slow = copy(self)
        stiffness, intrinsic = (1.0 + drag) * self.elements.stiffness, past[..., None] / (1.0 + drag)
        slow.elements = self.elements._replace(stiffness=stiffness, intrinsic=intrinsic)
        slow._commands = [None]
        return slow

    def gather(self, q: np.ndarray) -> np.ndarray:
        """Return the sides' vectors (k, a, 3) from coordinates (N,)."""
        return q[self.rows].reshape(self.elements.reference.shape)

    def scatter(self, of_sides: np.ndarray) -> np.ndarray:
        """Assemble forces (N,) from forces (k, a, 3) on the sides."""
        return np.bincount(self.rows.ravel(), of_sides.ravel(), self._size)

    def directors(self, q: np.ndarray) -> np.ndarray:
        """Return d (k, 3, 3) at the sides' nodes."""
        return self._vectors(self.gather(q))[:, self._directors]

    def _gradient(self, change: np.ndarray) -> np.ndarray:
        """Return B = H Q (k, s, a, 3) at Q₀ + change (k, a, 3)."""
        return np.einsum("esij,ejc->esic", self.elements.forms, self._vectors(change))

    def _vectors(self, change: np.ndarray) -> np.ndarray:
        """Return the vectors Q (k, a, 3) at which B is evaluated."""
        return self.elements.reference + (0.0 if self._linear else change)

    def _step(self, gradient: np.ndarray, step: np.ndarray) -> np.ndarray:
        return np.einsum("esic,eic->es", gradient, self.gather(step))

    def _strain(self, change: np.ndarray) -> np.ndarray:
        return np.einsum("esic,eic->es", self._gradient(0.5 * change), change)

    def _intrinsic(self, at: float) -> np.ndarray:
        return self.elements.intrinsic @ [factor_at(factor, at) for factor in self._commands]

    def _dampers(self) -> np.ndarray:
        """Return τ S (k, s) of free bending; chains on one edge are weighted by their stiffness."""
        stiffness, out = self.elements.stiffness, np.zeros_like(self.elements.stiffness)
        for rod, on in zip(self.bound.rods, self.bound.by_rod(np.arange(len(out))), strict=True):
            chains = rod.chains.values()
            rigidity = np.array([chain.bending_stiffness for chain in chains])
            tau = np.array([chain.damping_time for chain in chains]) @ rigidity / rigidity.sum()
            for bent in BENT[rod.chain.plane]:
                out[on, bent] = tau * stiffness[on, bent]
        return out

    def _side_masses(self, scene: Scene, places: np.ndarray) -> np.ndarray:
        """Return the mass (k, a, a) of the sides' vectors."""
        k, a = self.elements.reference.shape[:2]
        out, third = np.zeros((k, a, a)), np.arange(places[-1] + 1, a)
        for rod, on in zip(self.bound.rods, self.bound.by_rod(np.arange(k)), strict=True):
            ends = rod.elements.reference[:, [0, 2]]
            half = 0.5 * np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
            for chain in rod.chains.values():
                height, rotary = chain.axis_height(scene.sheet.thickness), chain.radius**2 / 4.0
                kinds = np.array([[1.0, height, 0.0], [height, height**2 + rotary, 0.0], [0.0, 0.0, rotary]])
                side = chain.line_density * half[:, None, None] * np.kron(kinds, SIDE_MASS)
                out[np.ix_(on, places, places)] += side
                out[np.ix_(on, third, third)] += LIGHT * side[:, 6 : 6 + len(third), 6 : 6 + len(third)]
        return out


def _by_axis(of_vectors: np.ndarray) -> np.ndarray:
    """Return matrices (k, 3 a, 3 a) of components, from matrices (k, a, a) of vectors."""
    k, a = of_vectors.shape[:2]
    return np.einsum("eij,cd->eicjd", of_vectors, np.eye(3)).reshape(k, 3 * a, 3 * a)
