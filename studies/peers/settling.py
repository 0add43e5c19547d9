"""Habibi et al.'s settling run, two seconds of a 9 × 9 × 2 lattice: our integrators beside SciPy's BDF.

SciPy is given what we have: the compiled right-hand side and the sparse Jacobian of the same lattice,

    ẏ = (v, M⁻¹ (f_ext − f_int − f_damp)),    ∂ẏ/∂y = ( 0, 1; −M⁻¹ K, −M⁻¹ C )

so that only the integrator differs (K without the turning of dampers, as our own steps have it). Error: the
largest |u − u_ref| of P4 over all samples, by component, of the largest of u_ref, which is BDF's at a
tolerance of `TIGHT`. Time: the integration alone, warm.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from time import perf_counter
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.integrate import solve_ivp

import lumped
from comparisons.models.resolve import resolve
from comparisons.models.solve import simulate
from comparisons.models.spec import Lattice
from sheetbench.choices import INTEGRATORS
from sheetbench.scenes import Scene, load
from studies.peers.row import PeerRow, repeated

SCENE, GRID, PROBE = "two-edges-settling", 9, "P4"
DURATION, EVERY = 2.0, 0.005  # s
TIGHT, SMALLEST = 1e-6, 1e-3  # relative tolerance; absolute over relative [m, m/s]
TOLERANCES = (1e-3, 1e-4)
SLOW = ("midpoint",)  # of our integrators, which takes many times as long
COARSER = 1e-4  # error of a step of `esdirk` that brings the run's near that of BDF's looser tolerance


class Equations:
    """The lattice's motion as SciPy takes it: y = (free displacements, their velocities)."""

    def __init__(self, scene: Scene):
        springs = resolve(scene, Lattice(GRID)).springs
        self.system = lumped.System(scene, lumped.build_problem(scene, springs))
        self.free = self.system.moving_part
        self.mass = self.system.reduced_mass.diagonal()
        self.count = len(self.mass)
        lattice = self.system.assembly.lattice
        self._probe = lumped.MidSurface(lattice, np.array([scene.probes[PROBE]]))

    def place(self, y: np.ndarray, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Displacement and velocity of all masses, (n, 3)."""
        u = self.system.expand(y[: self.count]) + self.system.place(time)
        return u, self.system.expand(y[self.count :])

    def rate(self, time: float, y: np.ndarray) -> np.ndarray:
        """ẏ."""
        force = self.system.reduce(self.system.unbalanced(*self.place(y, time), time))
        return np.concatenate([y[self.count :], force / self.mass])

    def jacobian(self, time: float, y: np.ndarray) -> sp.csc_array:
        """∂ẏ/∂y."""
        lower = [self._reduced(y, time, 0.0, 1.0), self._reduced(y, time, 1.0, 0.0)]
        stiffness, damping = (sp.diags_array(-1.0 / self.mass) @ part for part in lower)
        return sp.csc_array(sp.block_array([[None, sp.eye_array(self.count)], [stiffness, damping]]))

    def _reduced(self, y: np.ndarray, time: float, damping: float, stiffness: float) -> sp.csr_array:
        blocks = self.system.matrix(*self.place(y, time), time, 0.0, damping, stiffness)
        pattern = self.system.assembly.pattern
        whole = sp.bsr_array((blocks, pattern.indices, pattern.indptr))
        return sp.csr_array(self.free.T @ sp.csr_array(whole) @ self.free)

    def solve(self, tolerance: float) -> tuple[np.ndarray, float]:
        """Displacement (samples, 3) [m] of the probe by BDF, and the time it took [s]."""
        began = perf_counter()
        solution: Any = solve_ivp(
            self.rate,
            (0.0, DURATION),
            np.zeros(2 * self.count),
            "BDF",
            t_eval=np.linspace(0.0, DURATION, round(DURATION / EVERY) + 1),
            jac=self.jacobian,
            rtol=tolerance,
            atol=tolerance * SMALLEST,
        )
        seconds = perf_counter() - began
        return np.array(
            [self._probe.of(self.place(y, t)[0])[0] for t, y in zip(solution.t, solution.y.T, strict=True)]
        ), seconds


def rows(say: Callable[[str], None]) -> Iterator[PeerRow]:
    """A row per integrator and tolerance; say: called with each."""
    scene = load(SCENE)
    equations = Equations(scene)
    say("SciPy's BDF, the reference")
    truth, _ = equations.solve(TIGHT)
    scale = np.abs(truth).max()
    ours: list[tuple[str, dict[str, float]]] = [(name, {}) for name in INTEGRATORS if name not in SLOW]
    for name, options in [*ours, ("esdirk", {"error": COARSER})]:
        size = ", ".join(f"{option} {value:.0e} a step" for option, value in options.items()) or "default"
        say(f"lattice, {name}, {size}")
        lattice = resolve(scene, Lattice(GRID), "motion")
        settings: dict[str, Any] = {"integrator": name, "every": EVERY, **options}
        simulate(lattice, 2 * EVERY, **settings)
        kept: list[Any] = []

        def once(
            settings: dict[str, Any] = settings, kept: list[Any] = kept, lattice: Any = lattice
        ) -> float:
            kept[:] = [simulate(lattice, DURATION, **settings)]
            return float(kept[0].solve_seconds)

        seconds = repeated(once)
        u = kept[0].probes[PROBE]
        off = float(np.abs(u - truth).max() / scale) if u.shape == truth.shape else None
        yield PeerRow("settling", f"lattice, {name}", size, True, off, seconds, str(kept[0].status))
    for tolerance in TOLERANCES:
        say(f"SciPy's BDF, {tolerance:g}")
        u, taken = equations.solve(tolerance)
        off = float(np.abs(u - truth).max() / scale) if u.shape == truth.shape else None
        status = "converged" if off is not None else "diverged"
        yield PeerRow(
            "settling", "SciPy's BDF, our Jacobian", f"rtol {tolerance:g}", False, off, (taken,), status
        )
