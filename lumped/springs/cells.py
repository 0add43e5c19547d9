"""Springs and dampers of cells as compiled loops: measure, stress, force, tangent, rate.

A cell whose four corners, in turn, are the means of p masses each has the mean sides a = (d1 − d2)/2 and
b = (d1 + d2)/2, d1 and d2 its diagonals, and the measure g = (a·a, b·b, a·b); its area is √(det g), exact for
a flat cell, twice the area of the mid-point parallelogram for a warped one. The corners' deviation from mean
sides, by warping or bending in the plane, is q = p₀ − p₁ + p₂ − p₃, 0 at rest, and s = q·q. The springs'
energy is a law of g, for rubber also of s (`lumped.springs.law_table`); rigid motions change neither. The
forces and their change follow from S = dW/dg, D = d²W/dg² and the change δ of g:

    forces      f_a = 2 S₁ a + S₃ b,   f_b = 2 S₂ b + S₃ a,   f_q = 2 S₄ q
    tangent     δf_a = 2 S₁ δa + S₃ δb + 2 a δS₁ + b δS₃,   δS = D δg,   δf_b and δf_q by analogy.

The tangent takes S as an argument: S at u, an extrapolated S (`lumped.springs.links`), its nonnegative part,
or none. Dampers have the stress M ġ (`lumped.springs.laws`) of area and strains for any law of the springs.

Arrays: stress (c, 4) [N/m]; blocks (b, 3, 3) [N/m], added to; u, v, force (n, 3).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lumped.springs.cell_blocks import add_blocks, by_sides, by_warp, to_diagonals
from lumped.springs.law_table import (
    Tag,
    by_constants,
    constants_of,
    count,
    extrapolate,
    mean_stress,
    measures,
    of_extrapolated,
    respond,
    stiffness,
)
from lumped.springs.laws import (
    Branches,
    Four,
    Three,
    Vector,
    dot,
    less,
    plus,
    times,
)
from sheetbench.numerics.aliasing import empty, zeros
from sheetbench.numerics.options import inner, njit


class CellArrays(NamedTuple):
    """Arrays of cells. nodes: (c, 4, p); sides: (c, 2, 3) [m] at rest; rest: (4, c) natural area and δg₀
    [m²]; law: the tag with the constants of the springs' law or, times a second, of the dampers'; slots: (c,
    4p, 4p) block numbers, corner-major."""

    nodes: np.ndarray
    sides: np.ndarray
    rest: np.ndarray
    law: Tag
    slots: np.ndarray


@inner(cache=True, forceinline=True)
def changes(u: np.ndarray, nodes: np.ndarray, c: int) -> tuple[Vector, Vector, Vector]:
    """Return the changes of the mean sides a and b and of q of cell c by u."""
    fx = fy = fz = sx = sy = sz = qx = qy = qz = 0.0
    for s in range(nodes.shape[2]):
        k, m = np.uint64(nodes[c, 0, s]), np.uint64(nodes[c, 1, s])
        n, o = np.uint64(nodes[c, 2, s]), np.uint64(nodes[c, 3, s])
        fx += u[n, 0] - u[k, 0]
        fy += u[n, 1] - u[k, 1]
        fz += u[n, 2] - u[k, 2]
        sx += u[o, 0] - u[m, 0]
        sy += u[o, 1] - u[m, 1]
        sz += u[o, 2] - u[m, 2]
        qx += (u[k, 0] - u[m, 0]) + (u[n, 0] - u[o, 0])
        qy += (u[k, 1] - u[m, 1]) + (u[n, 1] - u[o, 1])
        qz += (u[k, 2] - u[m, 2]) + (u[n, 2] - u[o, 2])
    share = 0.5 / nodes.shape[2]
    twice = share + share
    return (
        (share * (fx - sx), share * (fy - sy), share * (fz - sz)),
        (share * (fx + sx), share * (fy + sy), share * (fz + sz)),
        (twice * qx, twice * qy, twice * qz),
    )


@inner(cache=True, forceinline=True)
def measure(
    u: np.ndarray, cells: CellArrays, c: int
) -> tuple[Four, Three, float, tuple[Vector, Vector, Vector]]:
    """Return δg and s of cell c since the state without stress; g and A of that state; a, b and q at u."""
    sides, natural = cells.sides, cells.rest
    a, b = (sides[c, 0, 0], sides[c, 0, 1], sides[c, 0, 2]), (sides[c, 1, 0], sides[c, 1, 1], sides[c, 1, 2])
    da, db, q = changes(u, cells.nodes, c)
    now_a, now_b = plus(a, da), plus(b, db)
    area, d1, d2, d3 = natural[0, c], natural[1, c], natural[2, c], natural[3, c]
    change = (
        dot(plus(a, now_a), da) - d1,
        dot(plus(b, now_b), db) - d2,
        dot(da, b) + dot(now_a, db) - d3,
        dot(q, q),
    )
    return change, (dot(a, a) + d1, dot(b, b) + d2, dot(a, b) + d3), area, (now_a, now_b, q)


@inner()
def pull(
    cells: CellArrays, c: int, stress: Four, shape: tuple[Vector, Vector, Vector], force: np.ndarray
) -> None:
    """Add the forces of a stress on a, b and q of cell c to its masses."""
    nodes, (a, b, q) = cells.nodes, shape
    share = 0.5 / nodes.shape[2]
    twice1, twice2, s3 = share * (stress[0] + stress[0]), share * (stress[1] + stress[1]), share * stress[2]
    on_a, on_b = plus(times(twice1, a), times(s3, b)), plus(times(twice2, b), times(s3, a))
    along, across = plus(on_a, on_b), less(on_b, on_a)
    warping = times(4.0 * share * stress[3], q)
    for s in range(nodes.shape[2]):
        k, m = np.uint64(nodes[c, 0, s]), np.uint64(nodes[c, 1, s])
        n, o = np.uint64(nodes[c, 2, s]), np.uint64(nodes[c, 3, s])
        for e in range(3):
            if measures(cells.law) == 4:
                force[k, e] += warping[e] - along[e]
                force[m, e] -= warping[e] + across[e]
                force[n, e] += warping[e] + along[e]
                force[o, e] += across[e] - warping[e]
            else:
                force[k, e] -= along[e]
                force[n, e] += along[e]
                force[m, e] -= across[e]
                force[o, e] += across[e]


@njit
def add_forces(
    u: np.ndarray, cells: CellArrays, force: np.ndarray, branches: Branches | None = None
) -> float:
    """Add the internal force to `force` (n, 3) [N]; return the springs' energy [J], branches excluded."""
    energy = 0.0
    for c in range(len(cells.nodes)):
        d, g, area, shape = measure(u, cells, c)
        stored, _, s = respond(cells.law, d, g, area, constants_of(cells.law, c))
        energy += stored
        if branches is not None:
            own, constant, stresses, changes = branches
            k = constant[c]
            for e in range(4):
                stresses[c, e], changes[c, e] = s[e], d[e]
            s = own * s[0] + k[0], own * s[1] + k[1], own * s[2] + k[2], own * s[3] + k[3]
        pull(cells, c, s, shape, force)
    return energy


@njit
def energies(u: np.ndarray, cells: CellArrays) -> np.ndarray:
    """Return the energy of every cell, (c,) [J]; for rubber without the energy of links along its sides."""
    out = empty(len(cells.nodes))
    for c in range(len(cells.nodes)):
        d, g, area, _ = measure(u, cells, c)
        out[c] = respond(cells.law, d, g, area, constants_of(cells.law, c))[0]
    return out


@njit
def extrapolated(u: np.ndarray, step: np.ndarray, cells: CellArrays) -> np.ndarray:
    """Return the law's quantities (c, 4) that the linearisation at u predicts after a step (n, 3) [m]
    (`CellLaw.extrapolate`)."""
    out = empty((len(cells.nodes), 4))
    for c in range(len(cells.nodes)):
        (d, g, area, (a, b, q)), k = measure(u, cells, c), constants_of(cells.law, c)
        _, memory, s = respond(cells.law, d, g, area, k)
        va, vb, vq = changes(step, cells.nodes, c)
        rate = 2.0 * dot(a, va), 2.0 * dot(b, vb), dot(a, vb) + dot(b, va), 2.0 * dot(q, vq)
        moved = extrapolate(cells.law, d, g, area, memory, s, k, rate)
        out[c, 0], out[c, 1], out[c, 2], out[c, 3] = moved
    return out


@njit
def powers_by_constants(u: np.ndarray, v: np.ndarray, cells: CellArrays) -> np.ndarray:
    """Return the derivatives of every cell's power v·f at u by its constants and by its natural δg₀,
    (c, n + 3), f the internal force and v (n, 3)."""
    out = zeros((len(cells.nodes), count(cells.law) + 3))
    for c in range(len(cells.nodes)):
        (d, g, area, (a, b, q)), k = measure(u, cells, c), constants_of(cells.law, c)
        _, memory, _ = respond(cells.law, d, g, area, k)
        va, vb, vq = changes(v, cells.nodes, c)
        rate = 2.0 * dot(a, va), 2.0 * dot(b, vb), dot(a, vb) + dot(b, va), 2.0 * dot(q, vq)
        by_constants(cells.law, d, g, area, memory, k, rate, out[c])
    return out


@njit
def add_average_forces(start: np.ndarray, end: np.ndarray, cells: CellArrays, force: np.ndarray) -> None:
    """Add the force over a step from `start` to `end` (n, 3) [m] whose work is the change of energy: the
    force of the mean stress on the mean sides."""
    for c in range(len(cells.nodes)):
        d0, g, area, (a0, b0, q0) = measure(start, cells, c)
        d1, _, _, (a1, b1, q1) = measure(end, cells, c)
        s = mean_stress(cells.law, d0, d1, g, area, constants_of(cells.law, c))
        pull(
            cells, c, s, (times(0.5, plus(a0, a1)), times(0.5, plus(b0, b1)), times(0.5, plus(q0, q1))), force
        )


@njit
def add_tangent(
    u: np.ndarray,
    cells: CellArrays,
    stress: np.ndarray,
    extrapolated: bool,
    share: float,
    blocks: np.ndarray,
) -> None:
    """Add the tangent of every cell with a stress, or with the share of its stress at u if `stress` is empty,
    and with M + share (D − M), to the 3×3 blocks on and below the diagonal. extrapolated: whether `stress`
    holds quantities of `CellLaw.extrapolate`, which then also give D − M."""
    in_diagonals, of_warp = empty((4, 9)), empty((3, 9))
    stress_at_u = len(stress) == 0
    for c in range(len(cells.nodes)):
        (d, g, area, (a, b, q)), k = measure(u, cells, c), constants_of(cells.law, c)
        _, memory, s = respond(cells.law, d, g, area, k)
        if stress_at_u:
            s = share * s[0], share * s[1], share * s[2], share * s[3]
        else:
            s = stress[c, 0], stress[c, 1], stress[c, 2], stress[c, 3]
        if extrapolated:
            memory, s = of_extrapolated(cells.law, d, g, memory, s)
        six, more = stiffness(cells.law, d, g, area, memory, share, k)
        rows = (
            by_sides((six[0], six[3], six[4]), a, b),
            by_sides((six[3], six[1], six[5]), a, b),
            by_sides((six[4], six[5], six[2]), a, b),
        )
        to_diagonals((s[0], s[1], s[2]), a, b, rows, in_diagonals)
        warps = measures(cells.law) == 4
        if warps:
            by_warp(s[3], more, a, b, q, of_warp)
        add_blocks(in_diagonals, of_warp, warps, cells.nodes.shape[2], cells.slots[c], blocks)
