"""Geometrically nonlinear three-dimensional solid: the sheet without a plate theory's assumptions.

    ∫ S(E) : δE dV = δ(loads),    E = ½ (Fᵀ F − 1)

total Lagrangian, St Venant–Kirchhoff (default), Biot or a rubber's (`materials`), on 27-node bricks that lock
neither in a thin sheet nor as ν → ½ (`element`), in one layer or more. Displacements are the
mid-surface's.

At every edge the solid has a layer as wide as the sheet is thick: at a free one the twisting stress turns
round, at a clamp the Poisson contraction is stopped. On a uniform mesh much coarser than that, answers
converge like 1/n (a full clamp's stress is singular besides): the mesh is graded towards the edges. The
default clamp is a shell's (`supports`). Actuators are the shell's rods and motions (`rods`). SI
units.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from skfem import MeshQuad

from fem_reference.discrete.answer import answered, judge, shape_of
from fem_reference.discrete.static import Forces, Static, StaticState
from fem_reference.solid.discrete import DiscreteSolid
from fem_reference.solid.materials import LAWS
from fem_reference.solid.mesh import Columns
from fem_reference.surface.borders import borders_of
from fem_reference.surface.mesh import Elements, divisions, has_lines, mesh_of, require_upright
from fem_reference.surface.rubber import limit_notes, require_law
from sheetbench.answers.solution import Solution, Status
from sheetbench.choices import STRAIN_LAW
from sheetbench.clock import now
from sheetbench.errors import BadInput
from sheetbench.numerics.continuation.path import Fault, Path, Progress
from sheetbench.numerics.continuation.trace import trace_path
from sheetbench.scenes import Constants, EdgeLoad, Material, Pressure, Scene, require_uniform
from sheetbench.scenes.meaning.composition import constants_at, of_sheet
from sheetbench.scenes.meaning.rigid_motions import require_static
from sheetbench.scenes.objects.orthotropy import Ply, impossible_in_space

GRADINGS = ("edges", "uniform")
MOST_BRICKS = 12  # through the thickness of a laminate


def solve(
    scene: Scene,
    elements: Elements = 16,
    layers: int = 1,
    law: str = STRAIN_LAW,
    clamp: str = "shell-like",
    grading: str = "edges",
    *,
    progress: Progress | None = None,
) -> Solution:
    """The static equilibrium of a scene; elements along the shorter side (near-square), or (nx, ny).

    layers: bricks through the thickness; law: a key of `LAWS`; clamp: one of `supports.CLAMPS`; grading: one
    of `GRADINGS`; progress: called once an iteration.
    Raises scenes.SceneError if the supports leave a rigid motion free, BadInput for an unknown option.
    """
    require_static(scene)
    along_x, along_y = divisions(scene.sheet, elements)
    mesh = plan_mesh(scene, (along_x, along_y), grading)
    requested = {"elements": [along_x, along_y], "grading": grading}
    layers = bricks_through(scene, layers)
    label = f"solid {along_x} × {along_y} × {layers}"
    return _solved(mesh, scene, label, requested, layers, law, clamp, progress=progress)


def solve_on(mesh: MeshQuad, scene: Scene) -> Solution:
    """Return the equilibrium on columns over any flat mesh of straight-sided quadrilaterals [m]."""
    return _solved(mesh, scene, "solid", {"elements": mesh.nelements}, own=True)


def _solved(
    mesh: MeshQuad,
    scene: Scene,
    label: str,
    requested: dict[str, Any],
    layers: int = 1,
    law: str = STRAIN_LAW,
    clamp: str = "shell-like",
    own: bool = False,
    progress: Progress | None = None,
) -> Solution:
    """own: whether the mesh has an outline of its own, in place of the scene's sheet."""
    begin = now()
    sheet = discretise(mesh, scene, layers, law, clamp)
    sheet.own = own
    ready = now()
    path = trace_path(Static(sheet), sheet.solver(), inspected, None, progress=progress)
    done = now()
    status, notes = judge(path)
    return answered(
        path,
        label=label,
        settings={**requested, "layers": layers, "law": law, "clamp": clamp},
        status=status,
        setup_seconds=ready - begin,
        solve_seconds=done - ready,
        history=tuple(path.history),
        remarks=(*notes, *limit_notes(law, scene.material, status)),
    )


def trace_on(sheet: DiscreteSolid) -> tuple[np.ndarray, Status, list[str]]:
    """Return q (N,) under the full load of a sheet at rest, how the path to it ended, and notes."""
    path = trace_path(Static(sheet), sheet.solver(), inspected, None)
    return path.state.q, *judge(path)


def inspected(path: Path[StaticState, Forces]) -> Fault | None:
    """Return why a step of the path is given up: a brick that has turned inside out."""
    found = shape_of(path).sheet.inside_out(path.state.q)
    return Fault(Status.INVERTED, found) if found else None


def _require_meshable(scene: Scene, law: str) -> None:
    """Raise BadInput for a sheet with a step in its thickness, or one that is not the same all over and has
    another law, or loads that follow it."""
    if scene.uniform:
        return
    for ply in of_sheet(scene).plies:
        if wrong := impossible_in_space(ply):
            raise BadInput(f"{'layer' if scene.layers else 'material'}.{wrong}")
    taper = scene.sheet.taper_x or scene.sheet.taper_y
    for number, patch in enumerate(scene.patches, start=1):
        if patch.thickness is not None and (taper or patch.thickness != scene.sheet.thickness):
            raise BadInput(
                f"patch {number}.thickness = {patch.thickness:g} m: the solid has no steps in its thickness; "
                "the shell and the plate have"
            )
    if law != STRAIN_LAW:
        require_uniform(scene, f"the solid's law '{law}'", f"its law '{STRAIN_LAW}' is for others too")
    if taper and (scene.actuators or any(isinstance(load, Pressure | EdgeLoad) for load in scene.loads)):
        raise BadInput(
            "sheet.taper_x, sheet.taper_y: the solid has tapered sheets under weight and point loads alone; "
            "the shell has others too"
        )


def bricks_through(scene: Scene, layers: int) -> int:
    """Return how many bricks there are through the thickness: as many as requested, of a laminate at least so
    many, with faces between all plies. Raises BadInput where those are too many."""
    if not scene.layers:
        return layers
    plies = of_sheet(scene).plies
    between = np.array([ply.low - plies[0].low for ply in plies])
    for count in range(layers, MOST_BRICKS + 1):
        if np.allclose(count * between, np.rint(count * between), rtol=0.0, atol=1e-6):
            return count
    raise BadInput(
        f"layer: the solid has {MOST_BRICKS} bricks of one height at most through its thickness, and no such "
        "number has a face between all layers; plate, shell and lattice have them"
    )


def _constants_of_bricks(scene: Scene, middles: np.ndarray, layers: int) -> Constants:
    """Return the constants of bricks, of a laminate each those of its ply; middles (layers · m, 1, 2) [m]: of
    their plan elements, layer by layer."""
    found = constants_at(scene, middles)
    if not scene.layers:
        return found
    heights = (np.arange(layers) + 0.5) / layers + found.plies[0].low
    own = [next(ply for ply in found.plies if ply.low <= at <= ply.high) for at in heights]
    values: list[Any] = [np.repeat(each, len(middles) // layers)[:, None] for each in zip(*own, strict=True)]
    ply = Ply(*values)
    return found.replace(plies=(ply._replace(low=-0.5, high=0.5),), density=ply.density)


def plan_mesh(scene: Scene, elements: tuple[int, int], grading: str) -> MeshQuad:
    """The plan mesh; without lines along x and y it has no rows along its rim, for thin curved bricks keep
    corrections from shrinking. Raises BadInput for an unknown grading."""
    if grading not in GRADINGS:
        raise BadInput(f"grading = {grading!r}: known are {', '.join(GRADINGS)}")
    return mesh_of(scene, elements, graded=grading == "edges" and has_lines(borders_of(scene)))


def discretise(
    mesh: MeshQuad,
    scene: Scene,
    layers: int = 1,
    law: str = STRAIN_LAW,
    clamp: str = "shell-like",
    moving: bool = False,
) -> DiscreteSolid:
    """The discrete solid of a scene, at rest unless it is moving, on a plan mesh of straight-sided
    quadrilaterals.

    Supports and loads act on the mesh's boundaries of their edges' names; of the scene's sheet only the
    thickness is used. Raises BadInput for an unknown law or clamp, no layers or a folded element.
    """
    columns, material = _columns_of(mesh, scene, layers, law)
    return DiscreteSolid(columns, scene, law, material, clamp, moving)


def _columns_of(mesh: MeshQuad, scene: Scene, layers: int, law: str) -> tuple[Columns, Material | Constants]:
    """The columns of a scene's solid over a mesh, and what its bricks are made of."""
    require_upright(mesh)
    require_law(law, LAWS, scene)
    if layers < 1:
        raise BadInput(f"layers = {layers}: at least one through the thickness")
    _require_meshable(scene, law)
    layers = bricks_through(scene, layers)
    columns = Columns.on(mesh, scene.sheet, layers)
    if scene.uniform:
        return columns, scene.material
    middles = np.tile(columns.plan.corners.mean(axis=1), (layers, 1))[:, None]
    return columns, _constants_of_bricks(scene, middles, layers)
