"""Natural frequencies and mode shapes of a sheet about its flat, stress-free state, or about its equilibrium.

    K φ = ω² M φ,    f = ω/2π,    φᵀ M φ = 1

K is the model's stiffness at rest and M its consistent mass, rotary inertia included. Loads, weight and
damping have no part in it, nor have actuators; curved supports and tilted clamps count as upright clamps.
About the deformed sheet (the shell only), K is the tangent of its equilibrium under the full load.
Lanczos iterations (ARPACK) on (K − σM)⁻¹ with the shift σ = −E h²/12ρ a⁴, below the spectrum and of the order
of the lowest ω², so that a free sheet's singular K needs no special care.

As many lowest modes as supports leave rigid motions free, whose frequency is zero, are left out, and their
number is reported.

Plate and shell are divided finer towards the edges, over `REACH` of their elements: there the clamps' ends
have singularities, but modes have waves in the middle too. The largest error of Habibi et al.'s sheet's first
ten frequencies on 16 × 16 elements, against 64 × 64, falls from 0.31 % (one edge clamped) and 0.23 % (two)
with equal elements to 0.05 and 0.09 %; graded over all elements it is 0.04 and 0.14 %, more on coarse meshes.

Masses: plate and shell, ρh on the displacements and ρh³/12 on the director's rotations; solid, ρ; and
payloads, on the mid-surface and the director (`surface.payloads`). SI units.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from fem_reference.discrete.answer import equilibrium
from fem_reference.discrete.items import FollowerLoad
from fem_reference.sheets import SHEETS, division_of
from fem_reference.surface.mesh import Elements
from sheetbench.answers.modes import NaturalModes
from sheetbench.answers.solution import About
from sheetbench.clock import now
from sheetbench.errors import BadInput, require_choice
from sheetbench.numerics.continuation.stability import require_stable
from sheetbench.numerics.eigenmodes import lowest_modes
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import AnyScene, free_rigid_motions, require_static, scene_of

REACH = 0.375  # share of the elements that are graded


@dataclass(frozen=True, repr=False)
class ReferenceModes(NaturalModes):
    """Natural modes of a reference; shapes at all nodes, φᵀ M φ = 1."""

    no_gradient = "for plate and shell without a section, not for {0.label}"
    label: str
    settings: dict[str, Any]
    solve_seconds: float
    sample: Callable[[np.ndarray], np.ndarray]

    def displacement(self, points: np.ndarray) -> np.ndarray:
        """Return the mid-surface displacement of every mode (count, p, 3) at plan points (p, 2) [m]."""
        return self.sample(np.asarray(points, dtype=float).reshape(-1, 2))

    def heading(self) -> tuple[str, str, str]:
        return f"{len(self.frequencies)} modes of {self.label}", "", ""


def modes(
    scene: AnyScene,
    model: str = "shell",
    elements: Elements = 16,
    count: int = 10,
    about: About = "flat",
    **options: Any,
) -> ReferenceModes:
    """Return the lowest elastic modes of a scene; without supports it is a free sheet.

    Parameters
    ----------
    scene : Scene, str or path
        A scene, the name of one in the catalogue, or a scene file.
    model : {"plate", "shell", "solid"}
        The reference model.
    elements : int or (int, int)
        Number of elements along the shorter side, or along x and y.
    count : int
        Number of elastic modes.
    about : {"flat", "deformed"}
        The flat, stress-free sheet alone, or its equilibrium under the scene's loads (the shell only, without
        actuators and loads that follow the sheet).
    **options : bool, str or Section
        `law` of strain of shell and solid, by default of the scene's rubber; `section` and `graded` of plate
        and shell (elements finer towards the edges, the default), as in `solve`.

    Returns
    -------
    ReferenceModes
        Frequencies (count,) [Hz], shapes (count, nodes, 3) and the number of rigid modes left out.

    Raises
    ------
    BadInput
        For an unknown model, or more modes than the mesh has.
    NoEquilibrium
        Where there is no stable equilibrium for "deformed".

    Notes
    -----
    Lanczos iterations with a shift below the spectrum; the module's docstring has the equations.

    Examples
    --------
    >>> import fem_reference
    >>> from sheetbench.scenes import load
    >>> fem_reference.modes(load("one-edge-clamped"), "plate", elements=4, count=2).frequencies.round(1)
    array([2.7, 6.1])
    """
    require_choice("model", model, SHEETS)
    scene = scene_of(scene)
    if about == "deformed":
        require_static(scene)
        if model != "shell" or scene.actuators:
            raise BadInput("--about = deformed: for the shell only, and without actuators")
    else:
        scene = scene.replace(actuators=(), obstacles=())
    division = division_of(scene, model, elements, **options)
    with one_blas_thread():
        sheet = division.sheet(reach=REACH)
        if about == "deformed":
            if any(isinstance(item, FollowerLoad) for item in sheet.items):
                raise BadInput(
                    "--about = deformed: not with pressure and edge moments, which follow the sheet"
                )
            (q, status, notes), at, rigid = equilibrium(sheet), 1.0, 0
            require_stable("shell", status, notes)
        else:
            q, at, rigid = np.zeros(sheet.size), 0.0, len(free_rigid_motions(scene))
        shape = sheet.shape(q, at)
        stiffness = sheet.tangent(shape, sheet.forces(shape), 0.0, 0.0)
        basis = sheet.basis(q, at)
        mass = (basis.T @ sheet.mass @ basis).tocsr()
        ready = now()
        if not 1 <= count < sheet.unknowns - rigid:
            raise BadInput(f"count = {count}: 1 to {sheet.unknowns - rigid - 1} on this mesh")
        material, longer = scene.material, max(scene.sheet.lengths)
        slow = scene.sheet.thickness / longer**2 * np.sqrt(material.young / (12.0 * material.density))
        values, vectors = lowest_modes(stiffness, mass, count + rigid, -(slow**2), dense=0)

    def gradient_of(number: int) -> Any:
        from fem_reference.mode_sensitivity import FrequencyGradient  # loaded when derivatives are requested

        mode = basis @ vectors[:, rigid + number - 1]
        return FrequencyGradient(sheet, q, at, mode, float(values[rigid + number - 1]))

    changes = (basis @ vectors[:, rigid:]).T
    return ReferenceModes(
        label="{} {} × {}".format(model, *division.counts),
        settings={"elements": list(division.counts), **division.options},
        frequencies=np.sqrt(np.maximum(values[rigid:], 0.0)) / (2.0 * np.pi),
        shapes=np.array([sheet.displacement(change) for change in changes]),
        rigid=rigid,
        unknowns=sheet.unknowns,
        solve_seconds=now() - ready,
        sample=lambda points: np.stack([shape.displacement_rate(points, change) for change in changes]),
        gradient_of=sheet.rebuild() and gradient_of,
    )
