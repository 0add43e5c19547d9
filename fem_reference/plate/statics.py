"""Linear Mindlin plate with its in-plane field: the answer for small deflections.

    ∫ N·δε + M·δκ + Q·δγ dA = δ(loads),   N = h C ε,   M = h³/12 C κ,   Q = 5/6 h G γ

with plane-stress C (see `materials`) and the strains of `element`. Bending and membrane do not know of
each other: no stiffening by stretching, no shortening by bending; where that stops meaning anything says
`fem_reference.plate.validity`. Loads act on the flat sheet: pressure
along +z, an edge moment m as −m on the tilt towards the outward normal. Actuators are linearised about the
flat sheet (`rods`), and their forces' moments taken there. So are bent, tilted and moved edges (the first
orders of `scenes.meaning.kinematics`): the shortening of a bent edge's mid-line is of second order.

Along an edge whose director nothing holds (free, hinged, held) the twisting moment fades within a layer of
width √(D66/κGh) = h/√10, far less than an element. On equal elements the answer then converges like the width
of the elements there: on 16 × 16 of Habibi et al.'s sheet it is 0.06 to 0.4 % off with such edges, and 0.01 %
with all edges clamped. Divided finer towards all edges it is 0.002 to 0.03 % off with such edges, and 0.04 %
with all edges clamped: so it is graded where an edge lets twist go.
Source: Hughes, The Finite Element Method (2000), ch. 5. SI units.
"""

from __future__ import annotations

from functools import partial

from fem_reference.discrete.answer import answered, traced
from fem_reference.plate.discrete import DiscretePlate
from fem_reference.surface.materials import Section
from fem_reference.surface.mesh import Elements, mesh_of
from sheetbench.answers.solution import Solution
from sheetbench.numerics.continuation.path import Progress
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.rigid_motions import require_static


def plate(
    scene: Scene,
    elements: Elements = 16,
    section: Section | None = None,
    graded: bool | None = None,
    hard_edges: tuple[str, ...] = (),
    *,
    moving: bool = False,
    reach: float = 1.0,
) -> DiscretePlate:
    """Return the discrete plate; options: as of `solve`; reach: of the grading (`mesh.mesh_of`)."""
    if graded is None:
        graded = not scene.twisting_edges() <= set(hard_edges)
    made = DiscretePlate(mesh_of(scene, elements, graded, reach), scene, section, hard_edges, moving)
    return made.named(
        elements, graded=graded, hard_edges=list(hard_edges) or None, section=section and section._asdict()
    )


def solve(
    scene: Scene,
    elements: Elements = 16,
    hard_edges: tuple[str, ...] = (),
    section: Section | None = None,
    graded: bool | None = None,
    *,
    progress: Progress | None = None,
) -> Solution:
    """The linear static answer; elements along the shorter side (near-square), or (nx, ny).

    graded: finer towards the edges, or equal elements; unless given, where an edge lets twist go. hard_edges:
    edges on which the tilt along the edge is held as well. A hinged support is soft; with its edge hard it is
    the simple support of the published Mindlin benchmarks. section: stiffness per width, from material and
    thickness unless given; progress: called once an iteration. Raises SceneError if the supports leave a
    rigid motion free.
    """
    require_static(scene, "the plate, which is linear,")
    make = partial(plate, scene, elements, section, graded, hard_edges)
    return answered(traced(make, progress=progress))
