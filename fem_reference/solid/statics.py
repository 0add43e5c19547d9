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

from skfem import MeshQuad

from fem_reference.discrete.answer import answered, traced
from fem_reference.solid.discrete import DiscreteSolid
from fem_reference.solid.mesh import bricks_through
from fem_reference.surface.borders import borders_of
from fem_reference.surface.mesh import Elements, divisions, has_lines, mesh_of
from sheetbench.answers.solution import Solution
from sheetbench.choices import STRAIN_LAW
from sheetbench.errors import BadInput
from sheetbench.numerics.continuation.path import Progress
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.rigid_motions import require_static

GRADINGS = ("edges", "uniform")


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
    mesh, layers = plan_mesh(scene, (along_x, along_y), grading), bricks_through(scene, layers)
    found = traced(lambda: DiscreteSolid(mesh, scene, layers, law, clamp), progress=progress)
    of_sheet = {"layers": layers, "law": law, "clamp": clamp}
    settings = {"elements": [along_x, along_y], "grading": grading, **of_sheet}
    return answered([found], f"solid {along_x} × {along_y} × {layers}", settings)


def solve_on(mesh: MeshQuad, scene: Scene) -> Solution:
    """Return the equilibrium on columns over any flat mesh of straight-sided quadrilaterals [m]."""
    found = traced(lambda: DiscreteSolid(mesh, scene))
    found.sheet.own = True
    settings = {"elements": mesh.nelements, "layers": 1, "law": STRAIN_LAW, "clamp": "shell-like"}
    return answered([found], "solid", settings)


def plan_mesh(scene: Scene, elements: tuple[int, int], grading: str) -> MeshQuad:
    """The plan mesh; without lines along x and y it has no rows along its rim, for thin curved bricks keep
    corrections from shrinking. Raises BadInput for an unknown grading."""
    if grading not in GRADINGS:
        raise BadInput(f"grading = {grading!r}: known are {', '.join(GRADINGS)}")
    return mesh_of(scene, elements, graded=grading == "edges" and has_lines(borders_of(scene)))
