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

from fem_reference.discrete.answer import answered, traced
from fem_reference.solid.discrete import DiscreteSolid
from fem_reference.surface.borders import borders_of
from fem_reference.surface.mesh import Elements, has_lines, mesh_of
from sheetbench.answers.solution import Solution
from sheetbench.choices import STRAIN_LAW
from sheetbench.errors import BadInput
from sheetbench.numerics.continuation.path import Progress
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.rigid_motions import require_static

GRADINGS = ("edges", "uniform")


def solid(
    scene: Scene,
    elements: Elements = 16,
    layers: int = 1,
    law: str = STRAIN_LAW,
    clamp: str = "shell-like",
    grading: str = "edges",
    *,
    moving: bool = False,
    reach: float = 1.0,
) -> DiscreteSolid:
    """Return the discrete solid, whose mesh is the same whatever the reach. Without lines along x and y it
    has no rows along its rim, for thin curved bricks keep corrections from shrinking."""
    if grading not in GRADINGS:
        raise BadInput(f"grading = {grading!r}: known are {', '.join(GRADINGS)}")
    mesh = mesh_of(scene, elements, graded=grading == "edges" and has_lines(borders_of(scene)))
    made = DiscreteSolid(mesh, scene, layers, law, clamp, moving)
    layers = made.columns.layers
    return made.named(elements, f" × {layers}", grading=grading, layers=layers, law=law, clamp=clamp)


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
    return answered(traced(lambda: solid(scene, elements, layers, law, clamp, grading), progress=progress))
