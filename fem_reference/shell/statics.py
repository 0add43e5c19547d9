"""Geometrically nonlinear Reissner–Mindlin shell of the flat sheet: large displacements and rotations.

Position φ + ζ d with a unit director d at every node; membrane, bending and transverse-shear energies of
a plane-stress St Venant–Kirchhoff sheet, ½ h E:C:E + h³/24 κ:C:κ + ½ k h G γ·γ with k = 5/6, on nine-node
elements with assumed strains (`element`), or of another law of strain (`laws`, `hyperelastic`), under dead
and follower loads. Rotations may be large; the weight has no couple on the director.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from skfem import MeshQuad

from fem_reference.shell import coarse_start
from fem_reference.shell.balance import balance
from fem_reference.shell.coarse_start import Shape
from fem_reference.shell.element import Element
from fem_reference.shell.hyperelastic import HyperelasticElement
from fem_reference.shell.laws import LAWS
from fem_reference.shell.natural import NaturalElement
from fem_reference.shell.state import Forces, State
from fem_reference.shell.structure import UP, ShellStructure
from fem_reference.shell.validity import STRETCHED, inspector, judge, membrane_strain
from fem_reference.surface import loads, rod
from fem_reference.surface import supports as surface_supports
from fem_reference.surface.actuator_forces import Held, exerted, on_edges
from fem_reference.surface.balance import Surface
from fem_reference.surface.biquadratic import cross
from fem_reference.surface.borders import borders_of
from fem_reference.surface.bound_rods import on_surface
from fem_reference.surface.location import interpolate
from fem_reference.surface.materials import Section, section_at
from fem_reference.surface.mesh import Elements, Plan, divisions, field_mesh, has_lines, mesh_of, nodes_of
from fem_reference.surface.rubber import limit_notes, require_law
from sheetbench.choices import BRANCHES, STRAIN_LAW
from sheetbench.clock import now
from sheetbench.errors import BadInput, require_choice
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.numerics.continuation.newton import Start
from sheetbench.numerics.continuation.path import Path, Progress
from sheetbench.numerics.continuation.pseudo_transient import relax
from sheetbench.numerics.continuation.trace import trace_path
from sheetbench.numerics.direct import DirectSolver
from sheetbench.scenes import Scene, Solution, Status, require_uniform
from sheetbench.scenes.patches import require_flat_at_rest
from sheetbench.scenes.rigid_motions import require_static

LIMITS = Limits()


def solve(
    scene: Scene,
    elements: Elements = 16,
    graded: bool = True,
    section: Section | None = None,
    law: str = STRAIN_LAW,
    branch: str = "path",
    *,
    near: Shape | None = None,
    progress: Progress | None = None,
) -> Solution:
    """The static equilibrium of a scene; elements along the shorter side (near-square), or (nx, ny).

    graded: finer towards the edges, uniform otherwise (see `mesh.rectangle`); where the sheet bends more than
    stretched elements stand, it is divided evenly after all, and `fallback` says so. section: stiffness per
    width, from material and thickness unless given. law: one of `laws.LAWS`. Past limit points under
    conservative loads the path goes on (see `pseudo_transient`), and `snaps` has the load factors at which
    the sheet snapped. branch: one of `choices.BRANCHES`; "buckled" leaves an unstable equilibrium along its
    lowest mode for a stable one. near: the shape, as `coarse_start.shaped` takes it, of an equilibrium to be
    sought from first; where it leads to no stable one, from flat. progress: called once an iteration.
    Raises scenes.SceneError if the supports leave a rigid motion free, BadInput for an unknown law.
    """
    require_static(scene)
    require_choice("branch", branch, BRANCHES)
    buckled = branch == "buckled"
    counts = divisions(scene.sheet, elements)
    if near is None:
        run, *spent = _runs(scene, counts, section, law, graded, progress, buckled=buckled)
    else:
        run, spent = _run(mesh_of(scene, counts, graded), scene, section, law, graded, progress, near), []
    fallback = ""
    if run.path.fault is STRETCHED:
        fallback, spent, graded = "divided evenly, for it bends much", [run, *spent], False
        run = _run(mesh_of(scene, counts, graded), scene, section, law, graded, progress, buckled=buckled)
    settings: dict[str, Any] = {"elements": list(counts), "graded": graded, "law": law}
    if section is not None:
        settings["section"] = section._asdict()
    if buckled:
        settings["branch"] = branch
    return _solution(scene, run, f"shell {counts[0]} × {counts[1]}", settings, fallback, spent)


def solve_on(mesh: MeshQuad, scene: Scene) -> Solution:
    """Return the equilibrium on any flat mesh of quadrilaterals [m], straight-sided or biquadratic.

    Supports and loads act on the mesh's boundaries of their edges' names ("x0", …), which may lie
    anywhere; of the scene's sheet only the thickness is used, and the lengths of edges with actuators.
    """
    return _solution(scene, _run(mesh, scene), "shell", {"elements": mesh.nelements}, own=True)


class _Run(NamedTuple):
    """A traced path on a mesh, with the seconds that setting up and solving took."""

    mesh: MeshQuad
    structure: ShellStructure
    nodes: np.ndarray
    path: Path[State, Forces]
    setup_seconds: float
    solve_seconds: float


def _runs(
    scene: Scene,
    counts: tuple[int, int],
    section: Section | None,
    law: str,
    graded: bool,
    progress: Progress | None,
    limits: Limits | None = None,
    buckled: bool = False,
) -> list[_Run]:
    """The run on a mesh of so many elements, then those on coarser ones that it has begun with."""
    few = coarse_start.coarse(counts, scene)
    rows = graded and has_lines(borders_of(scene))  # those along an outline are half of a coarse mesh
    begun = [] if few is None else _runs(scene, few, section, law, rows, progress, coarse_start.LIMITS)
    near = begun[0] if begun and coarse_start.plain(begun[0].path) else None
    mesh = mesh_of(scene, counts, graded)
    return [_run(mesh, scene, section, law, graded, progress, near, limits, buckled), *begun]


def _run(
    mesh: MeshQuad,
    scene: Scene,
    section: Section | None = None,
    law: str = STRAIN_LAW,
    graded: bool = False,
    progress: Progress | None = None,
    near: _Run | Shape | None = None,
    limits: Limits | None = None,
    buckled: bool = False,
) -> _Run:
    """graded: give up where stretched elements bend too much (see `validity`); near: where to begin;
    limits and buckled: as `trace_path` has them."""
    begin = now()
    structure, nodes = discretise(mesh, scene, section, law)
    solver = DirectSolver(structure.symmetric, fronts=structure.fronts)
    ready = now()
    begin_at: Start[State] | None = None
    if callable(near):
        begin_at = coarse_start.shaped(near, structure, nodes)
    elif near is not None:
        begin_at = coarse_start.start(near.mesh, near.structure, near.path.state, structure, nodes)
    inspect = inspector(scene, structure, graded)
    slenderness = scene.sheet.thickness / structure.lever
    path = trace_path(
        structure, solver, inspect, relax, progress, begin_at, slenderness, limits or LIMITS, buckled
    )
    path.factor = None  # a run is kept longer than that
    return _Run(mesh, structure, nodes, path, ready - begin, now() - ready)


def trace_on(scene: Scene, structure: ShellStructure) -> tuple[State, Status, list[str]]:
    """The equilibrium of a structure under the full load, how the path to it ended and the notes."""
    solver = DirectSolver(structure.symmetric, fronts=structure.fronts)
    path = trace_path(structure, solver, inspector(scene, structure, False), relax)
    structure.element.grow(path.load_factor)
    return path.state, *judge(scene, structure, path, membrane_strain(structure, path.state))


def _solution(
    scene: Scene,
    run: _Run,
    label: str,
    settings: dict[str, Any],
    fallback: str = "",
    spent: Sequence[_Run] = (),
    own: bool = False,
) -> Solution:
    """The answer of a run; spent: those before it, the last first; own: whether the mesh has an outline of
    its own."""
    structure, path, mesh, on = run.structure, run.path, run.mesh, run.structure.element_nodes
    structure.element.grow(path.load_factor)
    stretched = membrane_strain(structure, path.state)
    status, notes = judge(scene, structure, path, stretched)
    displacement, turn = path.state.change
    forces = structure.forces(path.state, path.load_factor)
    director = turn + UP
    couple = cross(director, forces.residual[1])
    position = structure.rest_positions + displacement
    held = Held(np.concatenate([forces.residual[0], couple], axis=1), position)
    edges = on_edges(structure.rods, forces.rods.pull, held, director)
    wrenches, line_force = exerted(scene, edges, structure.supports.moved, held)
    fields = {"actuator_line_force": line_force} if scene.actuators else {}
    surface = Surface(Plan(mesh, on, run.nodes), position, director, own)
    runs = [*reversed(spent), run]
    of_rods = {"rod": structure.rod_energy(path.state)} if scene.actuators else {}
    return Solution(
        model="shell",
        label=label,
        settings=settings,
        status=status,
        unknowns=structure.unknowns,
        iterations=sum(one.path.factorisations for one in runs),
        setup_seconds=sum(one.setup_seconds for one in runs),
        solve_seconds=sum(one.solve_seconds for one in runs),
        sample=partial(interpolate, mesh, on, displacement),
        reactions=structure.supports.reactions(forces.residual[0]),
        energies=structure.energies(path.state) | of_rods,
        mesh=field_mesh(run.nodes, on, displacement, director, **fields),
        history=tuple(entry for one in runs for entry in one.path.history),
        load_factor=path.load_factor,
        actuators=wrenches,
        balance=balance(scene, structure, path, forces, surface, edges),
        snaps=tuple(path.snaps),
        fallback=fallback,
        remarks=(*notes, *limit_notes(settings.get("law"), scene.material, status)),
        stretch=stretched,
    )


def discretise(
    mesh: MeshQuad, scene: Scene, section: Section | None = None, law: str = STRAIN_LAW
) -> tuple[ShellStructure, np.ndarray]:
    """The discrete shell of a scene on a mesh, and its nodes' plan positions (n, 2) [m]."""
    nodes, element_nodes = nodes_of(mesh)
    plan = Plan(mesh, element_nodes, nodes)
    element = _elements(plan.corners, scene, section, law)
    supports = surface_supports.of_scene(scene, mesh)
    dead, followers = loads.of_scene(scene, plan)
    rods = rod.of_scene(scene, plan)
    supports = rod.hold_bases(supports, rods)
    bound = on_surface(rods, len(nodes))
    return ShellStructure.build(element, element_nodes, supports, dead, followers, bound), nodes


def _elements(nodes: np.ndarray, scene: Scene, section: Section | None, law: str) -> Element:
    material, thickness = scene.material, scene.sheet.thickness
    require_law(law, LAWS, material)
    if law == STRAIN_LAW:
        return NaturalElement.of(nodes, section or section_at(scene, nodes), scene)
    require_flat_at_rest(scene, f"the shell's law '{law}'")
    require_uniform(scene, f"the shell's law '{law}'", f"its law '{STRAIN_LAW}' is for others too")
    if section is not None:
        raise BadInput(f"law = '{law}': a section of its own is linear, '{STRAIN_LAW}'")
    return HyperelasticElement.of(nodes, material, thickness, LAWS[law])
