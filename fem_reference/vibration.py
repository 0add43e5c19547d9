"""Natural frequencies and mode shapes of a sheet about its flat, stress-free state, or about its equilibrium.

    K φ = ω² M φ,    f = ω/2π,    φᵀ M φ = 1

K is the model's stiffness at rest and M its consistent mass, rotary inertia included. Loads, weight and
damping have no part in it, nor have actuators; a curved support and a tilted clamp count as upright clamps.
About the deformed sheet, which the shell alone knows, K is the tangent of its equilibrium under the full
load.
Lanczos iterations (ARPACK) on (K − σM)⁻¹ with the shift σ < 0 below the spectrum, so that a free sheet's
singular K needs no special care.

The rigid motions that the supports leave free are counted exactly (the null space of their values at
the held unknowns); so many lowest modes, whose frequency is zero, are left out and their number is reported.

Plate and shell are divided finer towards the edges, over `REACH` of their elements: there the clamps' ends
have singularities, but modes have waves in the middle too. Of the first ten frequencies of Habibi et al.'s
sheet on 16 × 16 elements the largest error, against 64 × 64, falls from 0.31 % (one edge clamped) and 0.23 %
(two) of even elements to 0.05 and 0.09 %; graded over all elements it is 0.04 and 0.14 %, more on coarse
meshes.

Masses: plate and shell, ρh on the displacements and ρh³/12 on the director's rotations; solid, ρ; and
payloads, on the mid-surface and the director (`surface.carried`). SI units.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from inspect import signature
from typing import Any, NamedTuple

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.defaults import with_defaults
from fem_reference.plate import statics as plate
from fem_reference.shell import inertia
from fem_reference.shell import statics as shell
from fem_reference.solid import statics as solid
from fem_reference.solid import supports as column_supports
from fem_reference.surface import carried
from fem_reference.surface.location import interpolate
from fem_reference.surface.materials import Section
from fem_reference.surface.mesh import Elements, Plan, divisions, mesh_of
from sheetbench.choices import STRAIN_LAW
from sheetbench.clock import now
from sheetbench.errors import BadInput
from sheetbench.numerics.continuation.stability import require_stable
from sheetbench.numerics.eigenmodes import lowest_modes
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import About, AnyScene, Scene, require_static, scene_of
from sheetbench.scenes.modes import NaturalModes

REACH = 0.375  # of the grading


class RestState(NamedTuple):
    """A model about its undeformed state; n nodes with k unknowns each.

    stiffness, mass: (n k, n k); held: (n, k) unknowns that supports hold; rigid: (n k, 6) the sheet's
    rigid motions, None where none is free; sample: unknowns (n, k), plan points (p, 2) [m] → mid-surface
    displacement (p, 3).
    """

    stiffness: csr_matrix
    mass: csr_matrix
    held: np.ndarray
    rigid: np.ndarray | None
    sample: Callable[[np.ndarray, np.ndarray], np.ndarray]


@dataclass(frozen=True, repr=False)
class Modes(NaturalModes):
    """The lowest modes, rigid motions left out; rigid_modes is the number of those.

    frequencies: (count,) [Hz], rising; shapes: (count, n, k), nodal unknowns scaled to φᵀ M φ = 1.
    """

    model: str
    label: str
    settings: dict[str, Any]
    frequencies: np.ndarray
    shapes: np.ndarray
    rigid_modes: int
    unknowns: int
    setup_seconds: float
    solve_seconds: float
    sample: Callable[[np.ndarray, np.ndarray], np.ndarray]

    def displacement(self, mode: int, points: np.ndarray) -> np.ndarray:
        """Mid-surface displacement (n, 3) of one mode, counted from 0, at plan points (n, 2) [m]."""
        return self.sample(self.shapes[mode], np.asarray(points, dtype=float).reshape(-1, 2))

    def heading(self) -> tuple[str, str, str]:
        return f"{len(self.frequencies)} modes of {self.label}", "", ""

    @property
    def left_out(self) -> int:
        return self.rigid_modes


def modes(
    scene: AnyScene,
    model: str = "shell",
    elements: Elements = 16,
    count: int = 10,
    about: About = "flat",
    **options: Any,
) -> Modes:
    """The `count` lowest elastic modes; a scene without supports is a free sheet.

    about: the flat, stress-free sheet, or its equilibrium under the scene's loads (the shell only; no
    actuators, no follower loads).

    options: the model's own; of shell and solid the `law` of strain, that of the scene's rubber unless given,
    of plate and shell `section`, as in their `solve`, and `graded`, whether they
    are divided finer towards the edges (they are by default).

    Raises BadInput for an unknown model or a count that the mesh cannot give, NoEquilibrium where there is
    none to be about.

    >>> import fem_reference
    >>> from sheetbench.scenes import load
    >>> fem_reference.modes(load("one-edge-clamped"), "plate", elements=4, count=2).frequencies.round(1)
    array([2.7, 6.1])
    """
    if model not in REST_STATES:
        raise BadInput(f"model = {model!r}: known are {', '.join(REST_STATES)}")
    begin = now()
    scene = scene_of(scene)
    if about == "deformed":
        require_static(scene)
        if model != "shell" or scene.actuators:
            raise BadInput("--about = deformed: of the references the shell alone, and without actuators")
    scene = scene.replace(actuators=())
    at_rest = _shell_deformed if about == "deformed" else REST_STATES[model]
    options = with_defaults(scene, signature(at_rest).parameters, options)
    along_x, along_y = divisions(scene.sheet, elements)
    with one_blas_thread():
        rest = at_rest(scene, (along_x, along_y), **options)
        ready = now()
        free = np.flatnonzero(~rest.held)
        rigid = _free_rigid_motions(rest)
        if not 1 <= count < len(free) - rigid:
            raise BadInput(f"count = {count}: 1 to {len(free) - rigid - 1} on this mesh")
        stiffness, mass = (matrix[free][:, free] for matrix in (rest.stiffness, rest.mass))
        values, vectors = lowest_modes(stiffness, mass, count + rigid, -(_slow(scene) ** 2), dense=0)
        done = now()
    shapes = np.zeros((count, rest.held.size))
    shapes[:, free] = vectors[:, rigid:].T
    return Modes(
        model=model,
        label=f"{model} {along_x} × {along_y}",
        settings={"elements": [along_x, along_y], **options},
        frequencies=np.sqrt(np.maximum(values[rigid:], 0.0)) / (2.0 * np.pi),
        shapes=shapes.reshape(count, *rest.held.shape),
        rigid_modes=rigid,
        unknowns=len(free),
        setup_seconds=ready - begin,
        solve_seconds=done - ready,
        sample=rest.sample,
    )


def _slow(scene: Scene) -> float:
    """An angular frequency [rad/s] of the order of the sheet's lowest: √(E h²/12ρ)/a², a the longer side."""
    material, sheet = scene.material, scene.sheet
    return np.sqrt(material.young / (12.0 * material.density)) * sheet.thickness / max(sheet.lengths) ** 2


def _free_rigid_motions(rest: RestState) -> int:
    """How many independent rigid motions vanish at every held unknown."""
    if rest.rigid is None:
        return 0
    size = np.linalg.norm(rest.rigid, axis=0)
    singular = np.linalg.svd(rest.rigid[rest.held.ravel()] / size, compute_uv=False)
    return 6 - int(np.sum(singular > 1e-9))


def _plate_at_rest(
    scene: Scene, elements: tuple[int, int], section: Section | None = None, graded: bool = True
) -> RestState:
    model = plate.Plate.on(mesh_of(scene, elements, graded, REACH))
    _, held, _ = plate.constrain(scene, model)
    x, y = (model.nodes - model.nodes.mean(axis=0)).T
    rigid = np.zeros((6, len(x), 5))
    for axis in range(3):
        rigid[axis, :, axis] = 1.0
    rigid[3, :, 2], rigid[3, :, 4] = y, -1.0
    rigid[4, :, 2], rigid[4, :, 3] = -x, 1.0
    rigid[5, :, 0], rigid[5, :, 1] = -y, x
    return RestState(
        stiffness=plate.stiffness_matrix(scene, model, section),
        mass=plate.mass_matrix(scene, model),
        held=held,
        rigid=rigid.reshape(6, -1).T,
        sample=lambda fields, points: model.sample(fields[:, :3], points),
    )


def _shell_at_rest(
    scene: Scene,
    elements: tuple[int, int],
    section: Section | None = None,
    graded: bool = True,
    law: str = STRAIN_LAW,
) -> RestState:
    """The tangent of the shell that nothing holds or loads; the last two fields turn the director."""
    bare = scene.replace(supports=(), loads=(), actuators=(), gravity=None)
    structure, _ = shell.discretise(mesh_of(scene, elements, graded, REACH), bare, section, law)
    rest = structure.rest()
    stiffness, _ = structure.system(rest, structure.forces(rest, 0.0), 0.0, mixed=False)
    return _plate_at_rest(scene, elements, graded=graded)._replace(stiffness=stiffness)


def _shell_deformed(
    scene: Scene,
    elements: tuple[int, int],
    section: Section | None = None,
    graded: bool = True,
    law: str = STRAIN_LAW,
) -> RestState:
    """The shell about its equilibrium, on its free unknowns alone: displacements u and rotations β of
    directors, δd = T β, with K = ∂R/∂(u, β) at full load, geometric stiffness and dead loads' part included,
    and M = ∫ ρh N_i N_j on u, ∫ ρh³/12 N_i N_j T_iᵀ T_j on β. Raises BadInput for loads that follow the
    sheet, NoEquilibrium where there is no stable equilibrium under the full load."""
    mesh = mesh_of(scene, elements, graded, REACH)
    structure, nodes = shell.discretise(mesh, scene, section, law)
    if structure.followers:
        raise BadInput("--about = deformed: pressure and edge moments follow the sheet: it has no modes then")
    state, status, notes = shell.trace_on(scene, structure)
    require_stable("shell", status, notes)
    stiffness, _ = structure.system(state, structure.forces(state, 1.0), 1.0, mixed=False)
    basis = inertia.Basis(structure).at(structure.frames(state))
    whole = inertia.mass(
        structure, inertia.products(structure, scene, Plan(mesh, structure.element_nodes, nodes))
    )

    def sample(shape: np.ndarray, points: np.ndarray) -> np.ndarray:
        number = structure.number[:, :3]
        moved = np.where(number >= 0, shape.ravel()[number], 0.0)
        return interpolate(mesh, structure.element_nodes, moved, points)

    mass = (basis.T @ whole @ basis).tocsr()
    return RestState(stiffness, mass, np.zeros((mass.shape[0], 1), bool), None, sample)


def _solid_at_rest(
    scene: Scene,
    elements: tuple[int, int],
    layers: int = 1,
    clamp: str = "shell-like",
    grading: str = "edges",
    law: str = STRAIN_LAW,
) -> RestState:
    """The tangent of the solid that nothing holds or loads."""
    bare = scene.replace(supports=(), loads=(), actuators=(), gravity=None)
    mesh = solid.plan_mesh(scene, elements, grading)
    structure = solid.discretise(mesh, bare, layers, law)
    rest = structure.rest()
    stiffness, _ = structure.system(rest, structure.forces(rest, 0.0), 0.0, mixed=False)
    columns = structure.columns
    supports = column_supports.of_scene(scene, columns, clamp)
    bases = supports.bases(0.0)
    basis = supports.basis(0.0).tocsr()
    arms = columns.positions - columns.positions.mean(axis=(0, 1))
    moves = [np.broadcast_to(axis, arms.shape) for axis in np.eye(3)]
    turns = [np.cross(axis, arms) for axis in np.eye(3)]
    rigid = [column_supports.components(bases, motion).ravel() for motion in moves + turns]

    def sample(fields: np.ndarray, points: np.ndarray) -> np.ndarray:
        displacement = column_supports.vectors(bases, fields.reshape(columns.positions.shape))
        return columns.sample(displacement, points)

    return RestState(
        stiffness=(basis.T @ stiffness @ basis).tocsr(),
        mass=(basis.T @ structure.mass(carried.of_scene(scene, columns.plan)) @ basis).tocsr(),
        held=supports.held.reshape(len(columns.plan.nodes), -1),
        rigid=np.array(rigid).T,
        sample=sample,
    )


REST_STATES: dict[str, Callable[..., RestState]] = {
    "plate": _plate_at_rest,
    "shell": _shell_at_rest,
    "solid": _solid_at_rest,
}
