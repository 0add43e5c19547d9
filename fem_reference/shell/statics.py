"""Geometrically nonlinear Reissner–Mindlin shell of the flat sheet: large displacements and rotations.

Position φ + ζ d with a unit director d at every node; membrane, bending and transverse-shear energies of
a plane-stress St Venant–Kirchhoff sheet, ½ h E:C:E + h³/24 κ:C:κ + ½ k h G γ·γ with k = 5/6, on nine-node
elements with assumed strains (`element`), or of another law of strain (`laws`, `hyperelastic`), under dead
and follower loads. Rotations may be large; the weight has no couple on the director.
"""

from __future__ import annotations

from functools import partial
from typing import Any, cast

from fem_reference.discrete.answer import Traced, answered, inspected, traced
from fem_reference.shell import coarse_start
from fem_reference.shell.coarse_start import Shape
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.shell.validity import STRETCHED, stretched
from fem_reference.surface.borders import borders_of
from fem_reference.surface.materials import Section
from fem_reference.surface.mesh import Elements, divisions, has_lines, mesh_of
from sheetbench.answers.solution import Solution
from sheetbench.choices import BRANCHES, STRAIN_LAW
from sheetbench.errors import require_choice
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.numerics.continuation.path import Progress
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.rigid_motions import require_static

LIMITS = Limits()


def shell(
    scene: Scene,
    elements: Elements = 16,
    section: Section | None = None,
    graded: bool = True,
    law: str = STRAIN_LAW,
    *,
    moving: bool = False,
    reach: float = 1.0,
) -> DiscreteShell:
    """Return the discrete shell; options: as of `solve`; reach: of the grading (`mesh.mesh_of`)."""
    made = DiscreteShell(mesh_of(scene, elements, graded, reach), scene, section, law, moving)
    return made.named(elements, graded=graded, law=law, section=section and section._asdict())


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
    counts, of_sheet = divisions(scene.sheet, elements), {"section": section, "law": law}
    options = {"progress": progress, "buckled": branch == "buckled"}
    if near is None:
        runs = _runs(scene, counts, graded, of_sheet, **options)
    else:
        begin = partial(coarse_start.shaped, near)
        runs = [_run(scene, counts, graded, of_sheet, near=begin, progress=progress)]
    fallback = ""
    if runs[0].path.fault is STRETCHED:
        fallback = "divided evenly, for it bends much"
        runs = [_run(scene, counts, False, of_sheet, **options), *runs]
    return answered(*runs, fallback=fallback, **({"branch": branch} if branch == "buckled" else {}))


def _runs(
    scene: Scene, counts: tuple[int, int], graded: bool, of_sheet: dict[str, Any], **options: Any
) -> list[Traced]:
    """The run on a mesh of so many elements, then those on coarser ones that it has begun with."""
    few = None if scene.obstacles else coarse_start.coarse(counts, scene)
    rows = graded and has_lines(borders_of(scene))  # those along an outline are half of a coarse mesh
    on_coarse = {"progress": options["progress"], "limits": coarse_start.LIMITS}
    begun = [] if few is None else _runs(scene, few, rows, of_sheet, **on_coarse)
    near = None
    if begun and coarse_start.plain(begun[0].path):
        near = partial(coarse_start.start, cast(DiscreteShell, begun[0].sheet), begun[0].path.state.q)
    return [_run(scene, counts, graded, of_sheet, near=near, **options), *begun]


def _run(
    scene: Scene, counts: tuple[int, int], graded: bool, of_sheet: dict[str, Any], **options: Any
) -> Traced:
    """The run on one mesh; options: as of `discrete.answer.traced`."""
    inspect = stretched if graded else inspected
    make = partial(shell, scene, counts, graded=graded, **of_sheet)
    return traced(make, inspect, **{"limits": LIMITS, **options})
