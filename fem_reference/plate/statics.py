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

from typing import Any

import numpy as np
from scipy.sparse import csr_matrix
from skfem import MeshQuad

from fem_reference.discrete.answer import EPSILON, answer
from fem_reference.plate.discrete import DiscretePlate
from fem_reference.plate.validity import judge
from fem_reference.surface.materials import Section
from fem_reference.surface.mesh import Elements, divisions, mesh_of
from sheetbench.answers.solution import Iteration, Solution, Status
from sheetbench.clock import now
from sheetbench.numerics.direct import SingularMatrixError, solve_free
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.rigid_motions import require_static

ROUNDINGS = 4.0  # of a term of K u: K is Bᵀ C B times an area


def solve(
    scene: Scene,
    elements: Elements = 16,
    hard_edges: tuple[str, ...] = (),
    section: Section | None = None,
    graded: bool | None = None,
) -> Solution:
    """The linear static answer; elements along the shorter side (near-square), or (nx, ny).

    graded: finer towards the edges, or equal elements; unless given, where an edge lets twist go. hard_edges:
    edges on which the tilt along the edge is held as well. A hinged support is soft; with its edge hard it is
    the simple support of the published Mindlin benchmarks. section: stiffness per width, from material and
    thickness unless given. Raises SceneError if the supports leave a rigid motion free.
    """
    begin = now()
    require_static(scene, "the plate, which is linear,")
    along_x, along_y = divisions(scene.sheet, elements)
    if graded is None:
        graded = not scene.twisting_edges() <= set(hard_edges)
    settings: dict[str, Any] = {"elements": [along_x, along_y], "graded": graded}
    if hard_edges:
        settings["hard_edges"] = list(hard_edges)
    if section is not None:
        settings["section"] = section._asdict()
    mesh = mesh_of(scene, (along_x, along_y), graded)
    sheet = DiscretePlate(mesh, scene, section, hard_edges)
    return _solved(begin, sheet, f"plate {along_x} × {along_y}", settings)


def solve_on(mesh: MeshQuad, scene: Scene) -> Solution:
    """Return the linear answer on any flat mesh of straight-sided quadrilaterals [m], its edges named."""
    begin, sheet = now(), DiscretePlate(mesh, scene)
    sheet.own = True
    return _solved(begin, sheet, "plate", {"elements": mesh.nelements})


def _solved(begin: float, sheet: DiscretePlate, label: str, settings: dict[str, Any]) -> Solution:
    """The answer of a plate whose making began at that moment. A direct solution, refined once, has no other
    residual than the rounding of K u, which a small rigid motion neither strains nor loads."""
    ready = now()
    q, matrix, force, status, notes = solved(sheet)
    done = now()
    left = matrix @ q - force
    held = np.where(sheet.is_held, left, 0.0)
    size = float(np.linalg.norm(force) + np.linalg.norm(held))
    rounding = ROUNDINGS * EPSILON * (abs(matrix) @ np.abs(q) + np.abs(force))
    singular = status is Status.SINGULAR
    return answer(
        sheet.shape(q, 1.0),
        left,
        size,
        float((rounding / sheet.scale).sum()),
        not singular,
        label=label,
        settings=settings,
        status=status,
        iterations=1,
        setup_seconds=ready - begin,
        solve_seconds=done - ready,
        history=(Iteration(1.0, float(np.linalg.norm(left[sheet.free]) / (size or 1.0)), 1.0),),
        load_factor=0.0 if singular else 1.0,
        remarks=notes,
    )


def solved(
    sheet: DiscretePlate,
) -> tuple[np.ndarray, csr_matrix, np.ndarray, Status, tuple[str, ...]]:
    """Return q (N,) under the full load, K (N, N), the forces (N,) of loads and commands in full on the flat
    sheet, the status and notes."""
    q, flat = sheet.placed(np.zeros(sheet.size), 1.0), sheet.shape(np.zeros(sheet.size), 1.0)
    with one_blas_thread():
        matrix, force = sheet.whole_tangent(sheet.shape(q, 1.0)), sheet.external(flat) - sheet.internal(flat)
        try:
            q = solve_free(matrix, force, q, sheet.free)
        except SingularMatrixError as error:
            return q, matrix, force, Status.SINGULAR, (str(error),)
    own = sheet.at_rest(1.0).strains[0]
    judged = judge(sheet.scene, sheet.elements, sheet.section, q, matrix, sheet.free, own)
    return q, matrix, force, *judged
