"""A lattice linearised about an equilibrium: M q̈ + C q̇ + K q = F w + F′ ẇ, y = G q + H w.

q are the free unknowns, restricted to motions that the chains' constraints allow; w the inputs, small changes
of loads and commands:

    load N, gravity     as a share of the load [-]
    PROBE fx, fy, fz    a force at a probe [N]
    EDGE curvature      of a chain's command or of a bent support [1/m]
    natural.kxx, …      of the sheet's natural curvature, or of a patch's, a muscle's [1/m]
    EDGE x, y, z        of a held edge's place [m]; it reaches the sheet by springs and dampers, F and F′

M is the mass matrix of `lumped.simulate`, "gregory" in `lumped.modes`.
y are the displacements of the probes [m]. K is symmetric; the modes φ of K φ = ω² M φ, φᵀ M φ = 1, give the
state space of the states (ω η, η̇), which is as well scaled as the sheet is:

    ẋ = A x + B w,   y = C x + D w,   A = [0, Ω; −Ω, −φᵀ C φ]

For n modes instead of all, D contains the static response of the modes left out: slow inputs are answered
exactly. F′ ẇ is taken into the state, which is x − (0, φᵀ F′) w. `lumped.state_space` reduces it further.
Source: e.g. Craig and Kurdila, Fundamentals of Structural Dynamics, 2006, on modal truncation with static
correction.
"""

from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.linalg
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from lumped.calibration import Calibration, default
from lumped.dynamics.system import System
from lumped.gradient import Base, Equilibrium
from lumped.loads import Loads
from lumped.state_space import StateSpace
from lumped.statics.problem import Problem
from lumped.statics.solver import build_problem, stable_equilibrium
from sheetbench.answers.solution import About
from sheetbench.errors import BadInput
from sheetbench.numerics.direct import SingularMatrixError
from sheetbench.numerics.eigenmodes import lowest_modes
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import (
    AnyScene,
    Chain,
    Curved,
    Scene,
    Symmetric,
    require_no_branches,
    require_static,
    scene_of,
    tilt_axes,
)
from sheetbench.scenes.objects.supports import named

MODES = 20  # of the state space unless requested
LAST = 1e9  # s: every history has its last value, as in statics


@dataclass(frozen=True, eq=False)
class Linear:
    """A lattice linearised about an equilibrium, M q̈ + C q̇ + K q = F w + F′ ẇ, y = G q + H w.

    Parameters
    ----------
    mass, damping, stiffness : sparse array of shape (m, m)
        Matrices M, C and K of the free unknowns [kg, N·s/m, N/m].
    force, force_rate : ndarray of shape (m, inputs)
        Forces F and F′ [N, N·s, per unit of the input].
    output : ndarray of shape (outputs, m)
        Matrix G [-].
    direct : ndarray of shape (outputs, inputs)
        Matrix H [m per unit of the input].
    inputs, outputs : tuple of str
        Names of inputs and outputs.
    displacement : ndarray of shape (n, 3)
        Displacement [m] of the masses at the equilibrium.
    """

    mass: sp.csc_array
    damping: sp.csc_array
    stiffness: sp.csc_array
    force: np.ndarray
    force_rate: np.ndarray
    output: np.ndarray
    direct: np.ndarray
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    displacement: np.ndarray

    @cached_property
    def jacobian(self) -> np.ndarray:
        """Static response dy/dw, (outputs, inputs): one adjoint solve an output, Kᵀ a = Gᵀ."""
        adjoint = splu(sp.csc_array(self.stiffness.T)).solve(self.output.T)
        return adjoint.T @ self.force + self.direct

    def state_space(self, modes: int | None = MODES) -> StateSpace:
        """Return the state space of the lowest modes, of all for None. Raises BadInput for more modes than
        the lattice has."""
        size = self.mass.shape[0]
        count = size if modes is None else modes
        if not 1 <= count <= size:
            raise BadInput(f"modes = {count}: the lattice has {size}")
        with one_blas_thread():
            squares, shapes = self._lowest(count)
            omega = np.sqrt(squares)
            drag = shapes.T @ (self.damping @ shapes)
            a = np.block([[np.zeros((count, count)), np.diag(omega)], [-np.diag(omega), -drag]])
            rate = np.vstack([np.zeros((count, len(self.inputs))), shapes.T @ self.force_rate])
            b = np.vstack([np.zeros((count, len(self.inputs))), shapes.T @ self.force]) + a @ rate
            c = np.hstack([self.output @ shapes / omega, np.zeros((len(self.outputs), count))])
            d = self.direct.copy()
            if count < size:
                d = self.jacobian - (self.output @ shapes / squares) @ (shapes.T @ self.force)
        return StateSpace(a, b, c, d, omega / (2.0 * np.pi))

    def _lowest(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return ω² (count,) [1/s²] and shapes (m, count) of the lowest modes. Raises BadInput if K is not
        positive definite."""
        with suppress(SingularMatrixError):
            squares, shapes = lowest_modes(self.stiffness, self.mass, count)
            if squares[0] > 0.0:
                return squares, shapes
        raise BadInput("the equilibrium is not stable: it has no oscillations")


def linearise(scene: AnyScene, calibration: Calibration | None = None, about: About = "deformed") -> Linear:
    """Return the lattice of a scene, linearised about its equilibrium or about the flat sheet.

    Parameters
    ----------
    scene : Scene, str or Path
        Scene, the name of one in the catalogue, or the path of its file.
    calibration : Calibration, optional
        Springs; by default the scene's, or consistent ones on nine masses along the shorter side.
    about : {"deformed", "flat"}, default "deformed"
        State: the equilibrium under the scene's loads, or the flat sheet without loads.

    Returns
    -------
    Linear
        Matrices of the free unknowns, inputs (loads [-], forces at probes [N], curvatures [1/m], places of
        held edges [m]) and outputs (displacements of the probes [m]).

    Raises
    ------
    BadInput
        If loads follow the sheet or springs have a per-direction law, whose matrices are not symmetric, or a
        flat sheet has actuators.
    NoEquilibrium
        If there is no stable equilibrium.

    Notes
    -----
    Modal truncation with static correction: Craig and Kurdila, Fundamentals of Structural Dynamics (2006).
    """
    scene = _last_commands(scene_of(scene))
    require_static(scene, "a linear system about the flat sheet" if about == "flat" else "")
    if about == "flat":
        flat = (s.replace(curvature=0.0) if isinstance(s, Curved) else s for s in scene.supports)
        scene = scene.replace(supports=tuple(flat))
    require_no_branches(scene.material, "a linear system")
    calibration = calibration or default(scene)
    problem = build_problem(scene, calibration)
    if problem.loads.follow or not problem.conservative:
        raise BadInput(
            "linearise: pressure, edge moments and per-direction springs have unsymmetric tangents"
        )
    if about == "flat":
        if scene.actuators:
            raise BadInput("linearise: a flat sheet has no actuators; leave --about out")
        u = np.zeros_like(problem.loads.dead)
    else:
        u = stable_equilibrium(problem).u
    system = System(scene, problem)
    motions = _allowed_motions(system, u)
    rest = np.zeros_like(u)

    def reduced(mass: float, damping: float, stiffness: float) -> tuple[sp.csr_array, sp.csc_array]:
        blocks = system.matrix(u, rest, LAST, mass, damping, stiffness)
        pattern = problem.assembly.pattern
        full = sp.csr_array(sp.bsr_array((blocks, pattern.indices, pattern.indptr)))
        return full, sp.csc_array(motions.T @ full @ motions)

    (_, mass), (drag, damping), (spring, stiffness) = (reduced(*factors) for factors in np.eye(3).tolist())
    _, probes = problem.middle(u, scene.probe_points())
    outputs = [(name, axis) for name in scene.probes for axis in range(3)]
    observation = probes.matrix(len(u)).toarray()
    inputs, forces, rate_forces, displacements = _inputs(calibration, problem, u, observation, spring, drag)
    return Linear(
        mass=mass,
        damping=damping,
        stiffness=sp.csc_array(0.5 * (stiffness + stiffness.T)),
        force=motions.T @ forces,
        force_rate=motions.T @ rate_forces,
        output=np.asarray(observation @ motions),
        direct=observation @ displacements,
        inputs=inputs,
        outputs=tuple(f"{name} u{'xyz'[axis]}" for name, axis in outputs),
        displacement=u[: problem.assembly.lattice.mass_count],
    )


def _allowed_motions(system: System, u: np.ndarray) -> sp.csr_array:
    """Return the map T restricted to the motions that the actuators' constraints allow, the null space of
    their gradient."""
    if not system.constrained or system.coupling is None:
        return system.moving_part
    of_actuators = system.coupling.constraint_gradient(u)
    gradient = np.zeros((len(of_actuators), *u.shape))
    gradient[:, system.coupling.masses :] = of_actuators
    dense = gradient.reshape(len(gradient), -1) @ system.moving_part
    bound = np.flatnonzero(np.abs(dense).any(axis=0))
    free = np.setdiff1d(np.arange(dense.shape[1]), bound)
    kernel = scipy.linalg.null_space(dense[:, bound])
    basis = sp.lil_array((dense.shape[1], len(free) + kernel.shape[1]))
    basis[free, np.arange(len(free))] = 1.0
    basis[bound, len(free) :] = kernel
    return sp.csr_array(system.moving_part @ basis)


def _inputs(
    calibration: Calibration,
    problem: Problem,
    u: np.ndarray,
    observation: np.ndarray,
    spring: sp.csr_array,
    drag: sp.csr_array,
) -> tuple[tuple[str, ...], np.ndarray, np.ndarray, np.ndarray]:
    """Return the inputs' names, and force, force by rate and prescribed displacement g, (3 size, inputs)
    each; observation: (outputs, 3 size) map of displacements to the probes."""
    scene = problem.scene
    columns: list[tuple[str, np.ndarray, np.ndarray, np.ndarray]] = []
    zero, at = np.zeros(u.size), Equilibrium(Base(scene, calibration), u)
    for name, part in _loads(scene):
        columns.append((name, Loads(part, problem.assembly).force(u).ravel(), zero, zero))
    for number, row in enumerate(observation):
        probe = list(scene.probes)[number // 3]
        columns.append((f"{probe} f{'xyz'[number % 3]}", row, zero, zero))
    for edge in _bent_edges(scene):
        _, g, force = at.rates(f"curvature_{edge}")
        columns.append((f"{edge} curvature", force.ravel(), -drag @ g.ravel(), g.ravel()))
    for name, support in named(scene.supports).items():
        rows, axes = problem.constraints.holders[name]
        for axis in () if isinstance(support, Symmetric) else axes:
            unit, row = np.zeros_like(u), rows.ravel()
            free = ~problem.constraints.fixed[row, axis]
            unit[row if axis in tilt_axes(support) else row[free], axis] = 1.0
            g = unit.ravel()
            columns.append((f"{name} {'xyz'[axis]}", -spring @ g, -drag @ g, g))
    bent = [of for of in scene.natural_states if of != "temperature"]
    for name in (f"{of}.{key}" for of in bent for key in ("kxx", "kyy", "kxy")):
        *_, pull = at.rates(name)
        columns.append((name, pull.ravel(), zero, zero))
    names, *values = zip(*columns, strict=True)
    force, rate, displacement = (np.stack(value, axis=1) for value in values)
    return tuple(names), force, rate, displacement


def _last_commands(scene: Scene) -> Scene:
    """Return the scene with the last values of its chains' commands."""
    at_last = [
        a.replace(curvature=a.curvature.value[-1])
        if isinstance(a, Chain) and hasattr(a.curvature, "value")
        else a
        for a in scene.actuators
    ]
    return scene.replace(actuators=tuple(at_last))


def _loads(scene: Scene) -> list[tuple[str, Scene]]:
    """Return scenes with a single load each, by the load's name."""
    bare = scene.replace(gravity=None, loads=())
    scenes = [(f"load {n}", bare.replace(loads=(load,))) for n, load in enumerate(scene.loads, start=1)]
    if scene.gravity is not None:
        scenes.append(("gravity", bare.replace(gravity=scene.gravity)))
    return scenes


def _bent_edges(scene: Scene) -> list[str]:
    """Return the edges with one chain of one curvature, or bent by a support."""
    edges = [str(a.edge) for a in scene.actuators]
    chains = [str(a.edge) for a in scene.actuators if isinstance(a, Chain) and isinstance(a.curvature, float)]
    bent = [str(s.edge) for s in scene.supports if isinstance(s, Curved)]
    return [*(edge for edge in chains if edges.count(edge) == 1), *bent]
