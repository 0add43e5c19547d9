"""Neo-Hookean cells as compiled loops: measure, stress, force, tangent (`lumped.springs.laws.neo_hookean`).

As `lumped.springs.cells`, of cells whose four corners are single masses, with one measure more: s = q·q,
q = p₀ − p₁ + p₂ − p₃ what the corners have beside the mean sides, warped or bent in the plane; 0 at rest.

    forces      f_a = 2 S₁ a + S₃ b,   f_b = 2 S₂ b + S₃ a,   f_q = 2 S₄ q

Dampers are those of `lumped.springs.cells`. Arrays: constants (c, 10); stress (c, 4) [N/m].
"""

from __future__ import annotations

import numpy as np
from numba import njit

from lumped.springs import cells as mean
from lumped.springs.cell_blocks import by_sides, to_diagonals
from lumped.springs.cells import CellArrays
from lumped.springs.laws import Four, Ten, Three, mean_neo_hookean, neo_hookean, stiffness_of_neo_hookean
from lumped.springs.vectors import Vector, dot, less, plus, times

HALF = 0.5


@njit(cache=True, error_model="numpy")
def changes(u: np.ndarray, nodes: np.ndarray, c: int) -> tuple[Vector, Vector, Vector]:
    """What u changes in a, b and q of cell c."""
    k, m = np.uint64(nodes[c, 0, 0]), np.uint64(nodes[c, 1, 0])
    n, o = np.uint64(nodes[c, 2, 0]), np.uint64(nodes[c, 3, 0])
    p0, p1, p2, p3 = (
        (u[k, 0], u[k, 1], u[k, 2]),
        (u[m, 0], u[m, 1], u[m, 2]),
        (u[n, 0], u[n, 1], u[n, 2]),
        (u[o, 0], u[o, 1], u[o, 2]),
    )
    d1, d2 = times(0.5, less(p2, p0)), times(0.5, less(p3, p1))
    return less(d1, d2), plus(d1, d2), plus(less(p0, p1), less(p2, p3))


@njit(cache=True, error_model="numpy")
def measure(
    u: np.ndarray, nodes: np.ndarray, sides: np.ndarray, c: int
) -> tuple[Four, Three, Vector, Vector, Vector]:
    """δg and s, g at rest, and a, b and q now, of cell c."""
    a, b = mean.at_rest(sides, c)
    da, db, q = changes(u, nodes, c)
    rest = mean.products(a, b)
    now_a, now_b = plus(a, da), plus(b, db)
    d3 = dot(da, b) + dot(now_a, db)
    return (dot(plus(a, now_a), da), dot(plus(b, now_b), db), d3, dot(q, q)), rest, now_a, now_b, q


@njit(cache=True, error_model="numpy")
def of_cell(k: np.ndarray, c: int) -> Ten:
    """The constants of cell c."""
    return k[c, 0], k[c, 1], k[c, 2], k[c, 3], k[c, 4], k[c, 5], k[c, 6], k[c, 7], k[c, 8], k[c, 9]


@njit(cache=True, error_model="numpy")
def pull(nodes: np.ndarray, c: int, s: Four, a: Vector, b: Vector, q: Vector, force: np.ndarray) -> None:
    """Add the forces of a stress on a, b and q of cell c to its masses."""
    on_a, on_b = plus(times(s[0], a), times(0.5 * s[2], b)), plus(times(s[1], b), times(0.5 * s[2], a))
    along, across = plus(on_a, on_b), less(on_b, on_a)
    k, m = np.uint64(nodes[c, 0, 0]), np.uint64(nodes[c, 1, 0])
    n, o = np.uint64(nodes[c, 2, 0]), np.uint64(nodes[c, 3, 0])
    for e in range(3):
        warping = 2.0 * s[3] * q[e]
        force[k, e] += warping - along[e]
        force[m, e] -= warping + across[e]
        force[n, e] += warping + along[e]
        force[o, e] += across[e] - warping


@njit(cache=True, error_model="numpy")
def add_forces(u: np.ndarray, cells: CellArrays, force: np.ndarray) -> float:
    """Add the internal force to `force` (n, 3) [N]; return the energy [J]."""
    energy = 0.0
    for c in range(len(cells.nodes)):
        d, g, a, b, q = measure(u, cells.nodes, cells.sides, c)
        stored, _, _, _, _, s = neo_hookean(HALF, d, g, cells.area[c], of_cell(cells.constants, c))
        energy += stored
        pull(cells.nodes, c, s, a, b, q, force)
    return energy


@njit(cache=True, error_model="numpy")
def energies(u: np.ndarray, cells: CellArrays) -> np.ndarray:
    """Energy of every cell, (c,) [J]."""
    out = np.empty(len(cells.nodes))
    for c in range(len(cells.nodes)):
        d, g, _, _, _ = measure(u, cells.nodes, cells.sides, c)
        out[c] = neo_hookean(HALF, d, g, cells.area[c], of_cell(cells.constants, c))[0]
    return out


@njit(cache=True, error_model="numpy")
def extrapolated(u: np.ndarray, step: np.ndarray, cells: CellArrays) -> np.ndarray:
    """Stress S + D ġ that the linearisation at u predicts after a step (n, 3) [m], (c, 4) [N/m]."""
    out = np.empty((len(cells.nodes), 4))
    for c in range(len(cells.nodes)):
        d, g, a, b, q = measure(u, cells.nodes, cells.sides, c)
        k = of_cell(cells.constants, c)
        _, t, square, _, _, s = neo_hookean(HALF, d, g, cells.area[c], k)
        six, more = stiffness_of_neo_hookean(d, g, t, square, 1.0, k)
        va, vb, vq = changes(step, cells.nodes, c)
        moved, fourth = mean.rate(a, b, va, vb), 2.0 * dot(q, vq)
        by_g = mean.times_six(six, moved)
        for e in range(3):
            out[c, e] = s[e] + by_g[e] + more[e] * fourth
        out[c, 3] = s[3] + more[0] * moved[0] + more[1] * moved[1] + more[2] * moved[2] + more[3] * fourth
    return out


@njit(cache=True, error_model="numpy")
def add_average_forces(start: np.ndarray, end: np.ndarray, cells: CellArrays, force: np.ndarray) -> None:
    """Add the force over a step from `start` to `end` (n, 3) [m] whose work is the energy stored in it."""
    for c in range(len(cells.nodes)):
        d0, g, a0, b0, q0 = measure(start, cells.nodes, cells.sides, c)
        d1, _, a1, b1, q1 = measure(end, cells.nodes, cells.sides, c)
        s = mean_neo_hookean(d0, d1, g, cells.area[c], of_cell(cells.constants, c))
        a, b, q = times(0.5, plus(a0, a1)), times(0.5, plus(b0, b1)), times(0.5, plus(q0, q1))
        pull(cells.nodes, c, s, a, b, q, force)


@njit(cache=True, error_model="numpy")
def add_tangent(
    u: np.ndarray, cells: CellArrays, stress: np.ndarray, share: float, lower: bool, blocks: np.ndarray
) -> None:
    """Add the tangent of every cell with this stress, or with the share of its own where `stress` is empty,
    and with M + share (D − M), to the 3×3 blocks; lower: to those on and below the diagonal alone."""
    in_diagonals, of_warp = np.empty((4, 9)), np.empty((3, 9))
    own, flat = len(stress) == 0, blocks.reshape(-1, 9)
    for c in range(len(cells.nodes)):
        d, g, a, b, q = measure(u, cells.nodes, cells.sides, c)
        k = of_cell(cells.constants, c)
        _, t, square, _, _, s = neo_hookean(HALF, d, g, cells.area[c], k)
        if own:
            s = share * s[0], share * s[1], share * s[2], share * s[3]
        else:
            s = stress[c, 0], stress[c, 1], stress[c, 2], stress[c, 3]
        six, more = stiffness_of_neo_hookean(d, g, t, square, share, k)
        rows = (
            by_sides((six[0], six[3], six[4]), a, b),
            by_sides((six[3], six[1], six[5]), a, b),
            by_sides((six[4], six[5], six[2]), a, b),
        )
        to_diagonals((s[0], s[1], s[2]), a, b, rows, in_diagonals)
        by_a, by_b = by_sides((more[0], more[1], more[2]), a, b)
        by_d1, by_d2 = plus(by_a, by_b), less(by_b, by_a)
        for x in range(3):
            for y in range(3):
                of_warp[0, 3 * x + y] = q[x] * by_d1[y]
                of_warp[1, 3 * x + y] = q[x] * by_d2[y]
                of_warp[2, 3 * x + y] = 4.0 * more[3] * q[x] * q[y] + (2.0 * s[3] if x == y else 0.0)
        for corner in range(4):
            side, turn = -1.0 if corner < 2 else 1.0, 1.0 if corner % 2 == 0 else -1.0
            for other in range(4):
                if lower and cells.slots[c, corner, other] < cells.slots[c, other, corner]:
                    continue
                side2, turn2 = -1.0 if other < 2 else 1.0, 1.0 if other % 2 == 0 else -1.0
                block = flat[np.uint64(cells.slots[c, corner, other])]
                part, row, column = in_diagonals[2 * (corner % 2) + other % 2], other % 2, corner % 2
                for x in range(3):
                    for y in range(3):
                        at = 3 * x + y
                        block[at] += (
                            side * side2 * part[at]
                            + turn * side2 * of_warp[row, at]
                            + side * turn2 * of_warp[column, 3 * y + x]
                            + turn * turn2 * of_warp[2, at]
                        )
