"""Geometrically nonlinear Reissner–Mindlin shell of the flat sheet: large displacements and rotations.

Position φ + ζ d with a unit director d at every node; membrane, bending and transverse-shear energies of
a plane-stress St Venant–Kirchhoff sheet, ½ h E:C:E + h³/24 κ:C:κ + ½ k h G γ·γ with k = 5/6, on nine-node
elements with assumed strains (`element`), or of another law of strain (`laws`, `hyperelastic`), under dead
and follower loads. Rotations may be large; the weight has no couple on the director.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from skfem import MeshQuad

from fem_reference.discrete.answer import answered, judge
from fem_reference.discrete.static import Forces, Static, StaticState
from fem_reference.shell import coarse_start
from fem_reference.shell.coarse_start import Shape
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.shell.element import Element
from fem_reference.shell.hyperelastic import HyperelasticElement
from fem_reference.shell.laws import LAWS
from fem_reference.shell.natural import grown
from fem_reference.shell.validity import STRETCHED, inspector
from fem_reference.surface.borders import borders_of
from fem_reference.surface.materials import Section, section_at
from fem_reference.surface.mesh import Elements, Plan, divisions, has_lines, mesh_of, plan_of
from fem_reference.surface.rubber import limit_notes, require_law
from sheetbench.answers.solution import Solution, Status
from sheetbench.choices import BRANCHES, STRAIN_LAW
from sheetbench.clock import now
from sheetbench.errors import BadInput, require_choice
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.numerics.continuation.newton import Start
from sheetbench.numerics.continuation.path import Path, Progress
from sheetbench.numerics.continuation.pseudo_transient import relax
from sheetbench.numerics.continuation.trace import trace_path
from sheetbench.scenes import Scene, require_uniform
from sheetbench.scenes.meaning.rigid_motions import require_static

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
    run = _run(mesh, scene)
    run.sheet.own = True
    return _solution(scene, run, "shell", {"elements": mesh.nelements})


class _Run(NamedTuple):
    """A traced path on a mesh, with the seconds that setting up and solving took."""

    sheet: DiscreteShell
    path: Path[StaticState, Forces]
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
    few = None if scene.obstacles else coarse_start.coarse(counts, scene)
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
    sheet = discretise(mesh, scene, section, law)
    ready = now()
    begin_at: Start[StaticState] | None = None
    if callable(near):
        begin_at = coarse_start.shaped(near, sheet)
    elif near is not None:
        begin_at = coarse_start.start(near.sheet, near.path.state.q, sheet)
    slenderness = scene.sheet.thickness / sheet.lever
    options = progress, begin_at, slenderness, limits or LIMITS, buckled
    path = trace_path(Static(sheet), sheet.solver(), inspector(graded), relax, *options)
    path.factor = None  # a run is kept longer than that
    return _Run(sheet, path, ready - begin, now() - ready)


def trace_on(sheet: DiscreteShell) -> tuple[np.ndarray, Status, list[str]]:
    """Return q (N,) under the full load of a sheet at rest, how the path to it ended, and notes."""
    path = trace_path(Static(sheet), sheet.solver(), inspector(False), relax)
    return path.state.q, *judge(path)


def _solution(
    scene: Scene,
    run: _Run,
    label: str,
    settings: dict[str, Any],
    fallback: str = "",
    spent: Sequence[_Run] = (),
) -> Solution:
    """The answer of a run; spent: those before it, the last first."""
    status, notes = judge(run.path)
    runs = [*reversed(spent), run]
    return answered(
        run.path,
        label=label,
        settings=settings,
        status=status,
        iterations=sum(one.path.factorisations for one in runs),
        setup_seconds=sum(one.setup_seconds for one in runs),
        solve_seconds=sum(one.solve_seconds for one in runs),
        history=tuple(entry for one in runs for entry in one.path.history),
        snaps=tuple(run.path.snaps),
        fallback=fallback,
        remarks=(*notes, *limit_notes(settings.get("law"), scene.material, status)),
    )


def discretise(
    mesh: MeshQuad,
    scene: Scene,
    section: Section | None = None,
    law: str = STRAIN_LAW,
    moving: bool = False,
) -> DiscreteShell:
    """The discrete shell of a scene, at rest unless it is moving, on a mesh."""
    plan = plan_of(mesh)
    return DiscreteShell(plan, scene, _elements_of(plan, scene, section, law), moving)


def _elements_of(plan: Plan, scene: Scene, section: Section | None, law: str) -> Element:
    """The elements of a scene's shell on a plan, of a law of strain and, unless that is another than the
    default, of a section."""
    nodes = plan.corners
    material, thickness = scene.material, scene.sheet.thickness
    require_law(law, LAWS, scene)
    if law == STRAIN_LAW:
        own = section or section_at(scene, nodes)
        return Element.build(nodes, grown(own, scene, nodes))
    require_uniform(scene, f"the shell's law '{law}'", f"its law '{STRAIN_LAW}' is for others too")
    if section is not None:
        raise BadInput(f"law = '{law}': a section of its own is linear, '{STRAIN_LAW}'")
    return HyperelasticElement.of(nodes, material, thickness, LAWS[law])
