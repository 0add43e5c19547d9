"""Natural frequencies of a lattice about the flat, stress-free state, or about equilibrium: K φ = ω² M φ.

K is the tangent in that state, M the mass matrix (`lumped.masses`). A lattice whose supports leave rigid
motions free has zero frequencies: they are computed with a small shift, counted, and left out.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import scipy.sparse as sp

from lumped.calibration import Calibration, default
from lumped.gradient import Base, Equilibrium
from lumped.masses import Inertia, mass_matrix
from lumped.mid_surface import MidSurface
from lumped.mode_sensitivity import ModeGradient
from lumped.payloads import pairs_of, rotary_masses
from lumped.statics.build import build_problem
from lumped.statics.problem import Problem
from lumped.statics.solver import stable_equilibrium
from sheetbench.answers.modes import NaturalModes
from sheetbench.answers.solution import About
from sheetbench.errors import BadInput
from sheetbench.numerics.direct import Factor
from sheetbench.numerics.eigenmodes import lowest_modes
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import AnyScene, Scene, free_rigid_motions, require_static, scene_of


@dataclass(frozen=True, repr=False)
class Modes(NaturalModes):
    """Natural modes of a lattice.

    Parameters
    ----------
    frequencies : ndarray of shape (count,)
        Natural frequencies [Hz], rising.
    shapes : ndarray of shape (count, n, 3)
        Displacements of the masses, with the largest component 1.
    rigid : int
        Number of rigid motions, which are left out.
    unknowns : int
        Number of free unknowns.
    surface : callable
        Function of plan points (p, 2) [m] that returns places of the mid-surface there, and the map of its
        changes.
    gradient_of : callable, optional
        Function of a mode's number that returns the derivatives of its frequency.
    """

    no_gradient = "not for a flat sheet with a natural state"
    surface: Callable[[np.ndarray], tuple[np.ndarray, MidSurface]]

    def displacement(self, points: np.ndarray) -> np.ndarray:
        """Return the mid-surface displacement of every mode (count, p, 3) at plan points (p, 2) [m]."""
        _, at = self.surface(points)
        return np.stack([at.of(shape) for shape in self.shapes])

    def heading(self) -> tuple[str, str, str]:
        return f"{len(self.frequencies)} modes of the lattice", "", ""


def modes(
    scene: AnyScene,
    calibration: Calibration | None = None,
    count: int = 10,
    distribution: Inertia | None = None,
    about: About = "flat",
) -> Modes:
    """Return the lowest natural modes of a scene's sheet on a lattice.

    Parameters
    ----------
    scene : Scene, str or Path
        Scene, the name of one in the catalogue, or the path of its file.
    calibration : Calibration, optional
        Springs; by default the scene's, or consistent ones on nine masses along the shorter side.
    count : int, default 10
        Number of modes, rigid motions not counted.
    distribution : {"tributary", "gregory", "higher-order"}, optional
        Distribution of the mass (`lumped.masses`); by default `usual_masses(calibration)`.
    about : {"flat", "deformed"}, default "flat"
        State of the sheet: flat and stress-free, without actuators and loads, or the equilibrium under the
        scene's loads, with the tangent of that state.

    Returns
    -------
    Modes
        Frequencies (count,) [Hz], rising, and shapes (count, n, 3).

    Raises
    ------
    BadInput
        If the lattice has fewer than `count` modes, or about "deformed" a scene has actuators, follower loads
        or springs of a per-direction law.
    NoEquilibrium
        If about "deformed" there is no stable equilibrium.

    Notes
    -----
    The eigenproblem is K φ = ω² M φ, with the tangent K and the mass matrix M of the free unknowns.

    Examples
    --------
    >>> import lumped
    >>> from sheetbench.scenes import load
    >>> scene = load("one-edge-clamped")
    >>> modes = lumped.modes(scene, lumped.calibrate(scene.sheet, scene.material, grid=5), 2)
    >>> modes.frequencies.round(2)
    array([2.72, 6.19])
    """
    scene = scene_of(scene)
    calibration = calibration or default(scene)
    if about == "deformed":
        require_static(scene)
    else:
        scene = scene.replace(actuators=(), obstacles=())
    problem = build_problem(scene, calibration)
    at = np.zeros_like(problem.loads.dead)
    if about == "deformed":
        if scene.actuators or problem.loads.follow or not problem.conservative:
            raise BadInput(
                "--about = deformed: not with actuators, pressure, edge moments and per-direction springs"
            )
        at = stable_equilibrium(problem).u
    rigid = len(free_rigid_motions(scene)) if about == "flat" else 0  # an equilibrium has none
    unknowns = problem.system.unknowns
    if not 1 <= count <= unknowns - rigid:
        raise BadInput(f"count = {count}: 1 to {unknowns - rigid} on this lattice")
    shared = distribution or usual_masses(calibration)
    inertia, bodies, mass = _masses(problem, shared, calibration)
    blocks = problem.tangent(at, float(about == "deformed"))
    stiffness = problem.system.matrix(blocks)
    total, shift = count + rigid, _shift(scene)

    def factor() -> Factor:
        shifted, shared = blocks.copy(), problem.assembly.pattern.slots(*inertia.coords)
        shifted[shared] -= shift * inertia.data[:, None, None] * np.eye(3)
        shifted[problem.assembly.pattern.slots(*pairs_of(bodies))] -= shift * bodies.data
        return problem.system.factor(shifted)

    with one_blas_thread():
        values, vectors = lowest_modes(stiffness, mass, total, shift, factor)
    order = np.arange(rigid, total)
    shapes = np.stack([problem.expand(vectors[:, k]) for k in order])
    shapes /= np.abs(shapes).max(axis=(1, 2), keepdims=True)
    frequencies = np.sqrt(np.maximum(values[order], 0.0)) / (2.0 * np.pi)
    loaded = about == "deformed"
    bare = scene if loaded else scene.replace(loads=(), gravity=None)

    def mass_of(problem: Problem, springs: Calibration) -> Any:
        return _masses(problem, shared, springs)[2]

    def gradient(number: int) -> ModeGradient:
        mode, squared = vectors[:, rigid + number - 1], float(values[rigid + number - 1])
        of = Equilibrium(Base.of(bare, calibration), at, share=float(loaded))
        return ModeGradient(of, mode / np.sqrt(mode @ (mass @ mode)), squared, mass_of)

    gradient_of = None if problem.prestrained and not loaded else gradient
    surface = partial(problem.middle, at)
    return Modes(frequencies, shapes, rigid, unknowns, surface, gradient_of=gradient_of)


def _masses(problem: Problem, shared: Inertia, calibration: Calibration) -> tuple[Any, Any, Any]:
    """Return the masses and bodies of a lattice, and Tᵀ M T."""
    scene, transform = problem.scene, problem.constraints.transform
    inertia = mass_matrix(scene, problem.assembly.lattice, shared, calibration.cells)
    bodies = rotary_masses(scene, problem.assembly.lattice)
    mass = transform.T @ (sp.kron(inertia, sp.eye_array(3)) + bodies) @ transform
    return inertia, bodies, sp.csc_array(mass)


def usual_masses(calibration: Calibration) -> Inertia:
    """Return the default distribution of mass for natural modes.

    Parameters
    ----------
    calibration : Calibration
        Springs of the lattice.

    Returns
    -------
    {"tributary", "gregory", "higher-order"}
        The distribution of springs that were fitted to frequencies; otherwise "higher-order", or "gregory"
        for a sheet of unequal cells.
    """
    if calibration.masses != "tributary":
        return calibration.masses
    return "higher-order" if calibration.cells is None else "gregory"


def frequency_slopes(
    scene: Scene, calibration: Calibration, parameters: Sequence[str], count: int
) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Return the `count` lowest frequencies (count,) [Hz] and their derivatives by spring constants [Hz per
    N/m]. Coinciding frequencies have the derivative of their mean; motions that no spring resists, and
    constants that are 0, have the derivative 0."""
    lowest, none = modes(scene, calibration, count, calibration.masses), np.zeros(count)
    slopes, known = {name: none.copy() for name in parameters}, calibration.constants.names()
    for number in np.flatnonzero(lowest.frequencies):
        gradient = lowest.gradient_of(int(number) + 1)  # type: ignore[misc]  # it is flat, without a state
        for name in slopes.keys() & {*known}:
            slopes[name][number] = gradient[name]
    return lowest.frequencies, slopes


def _shift(scene: Scene) -> float:
    """Return the shift σ = −100 E h²/(12 ρ a⁴) [1/s²], as far below zero as the lowest elastic eigenvalue of
    a plate is above it (12 to 1300 of E h²/(12 ρ a⁴), by its supports). Eigenvalues of a free sheet are wrong
    by ε λ_max/|σ|, K − σM having the condition λ_max/|σ|: no more than by the rounding of K, ε λ_max/λ."""
    sheet, material = scene.sheet, scene.material
    slope = sheet.thickness / max(sheet.lengths) ** 2
    return -100.0 * slope**2 * material.young / (12.0 * material.density)
