"""Springs and dampers of cells as compiled loops: measure, stress, force, tangent, rate.

A cell whose four corners, in turn, are the means of p masses each has the mean sides a = (d1 − d2)/2 and
b = (d1 + d2)/2, d1 and d2 its diagonals, and the measure g = (a·a, b·b, a·b); its area is √(det g), exact for
a flat cell, that of the mid-point parallelogram doubled for a warped one. What its springs store is a law of
g (`lumped.springs.laws`); rigid motions leave g alone. With S = dW/dg, D = d²W/dg² and the change δ of g,

    forces      f_a = 2 S₁ a + S₃ b,   f_b = 2 S₂ b + S₃ a
    tangent     δf_a = 2 S₁ δa + S₃ δb + 2 a δS₁ + b δS₃,   δS = D δg,   δf_b likewise.

The tangent takes S as an argument of its own: that at u, an extrapolated one S + D ġ, its nonnegative part,
none. Dampers have the stress M ġ (`lumped.springs.laws`); of it the derivative by the displacement is
unsymmetric.

Arrays: stress (c, 3) [N/m]; blocks (b, 3, 3) [N/m], added to; u, v, force (n, 3).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from lumped.springs.cell_blocks import add_blocks, both, by_sides, to_diagonals
from lumped.springs.laws import (
    Four,
    Six,
    Three,
    area_and_strains,
    mean_area_and_strains,
    stiffness_of_area_and_strains,
)
from lumped.springs.vectors import Vector, dot, less, plus, times

HALF = 0.5
NO_STRESS = (0.0, 0.0, 0.0)


class CellArrays(NamedTuple):
    """nodes (c, 4, p); sides (c, 2, 3) [m] and area (c,) [m²] at rest; constants (c, n) of the springs' law
    or, times a second, of the dampers'; slots (c, 4p, 4p) block numbers, corner-major."""

    nodes: np.ndarray
    sides: np.ndarray
    area: np.ndarray
    constants: np.ndarray
    slots: np.ndarray


@njit(cache=True, error_model="numpy")
def side_changes(u: np.ndarray, nodes: np.ndarray, c: int) -> tuple[Vector, Vector]:
    """What u changes in the mean sides a and b of cell c."""
    fx = fy = fz = sx = sy = sz = 0.0
    for s in range(nodes.shape[2]):
        k, m = np.uint64(nodes[c, 0, s]), np.uint64(nodes[c, 1, s])
        n, o = np.uint64(nodes[c, 2, s]), np.uint64(nodes[c, 3, s])
        fx += u[n, 0] - u[k, 0]
        fy += u[n, 1] - u[k, 1]
        fz += u[n, 2] - u[k, 2]
        sx += u[o, 0] - u[m, 0]
        sy += u[o, 1] - u[m, 1]
        sz += u[o, 2] - u[m, 2]
    share = 0.5 / nodes.shape[2]
    return (
        (share * (fx - sx), share * (fy - sy), share * (fz - sz)),
        (share * (fx + sx), share * (fy + sy), share * (fz + sz)),
    )


@njit(cache=True, error_model="numpy")
def at_rest(sides: np.ndarray, c: int) -> tuple[Vector, Vector]:
    """The mean sides of cell c at rest."""
    return (
        (sides[c, 0, 0], sides[c, 0, 1], sides[c, 0, 2]),
        (sides[c, 1, 0], sides[c, 1, 1], sides[c, 1, 2]),
    )


@njit(cache=True, error_model="numpy")
def products(a: Vector, b: Vector) -> Three:
    """The measure of sides a and b."""
    return dot(a, a), dot(b, b), dot(a, b)


@njit(cache=True, error_model="numpy")
def measure(
    u: np.ndarray, nodes: np.ndarray, sides: np.ndarray, c: int
) -> tuple[Three, Three, Vector, Vector]:
    """δg, g at rest, and the sides a and b now, of cell c."""
    a, b = at_rest(sides, c)
    da, db = side_changes(u, nodes, c)
    rest = products(a, b)
    now_a, now_b = plus(a, da), plus(b, db)
    change = dot(plus(a, now_a), da), dot(plus(b, now_b), db), dot(da, b) + dot(now_a, db)
    return change, rest, now_a, now_b


@njit(cache=True, error_model="numpy")
def rate(a: Vector, b: Vector, va: Vector, vb: Vector) -> Three:
    """ġ of sides a, b that move with va, vb."""
    return 2.0 * dot(a, va), 2.0 * dot(b, vb), dot(a, vb) + dot(b, va)


@njit(cache=True, error_model="numpy")
def of_cell(constants: np.ndarray, c: int) -> Four:
    """The constants of cell c."""
    return constants[c, 0], constants[c, 1], constants[c, 2], constants[c, 3]


@njit(cache=True, error_model="numpy")
def times_six(d: Six, x: Three) -> Three:
    """A symmetric matrix times a vector."""
    return (
        d[0] * x[0] + d[3] * x[1] + d[4] * x[2],
        d[3] * x[0] + d[1] * x[1] + d[5] * x[2],
        d[4] * x[0] + d[5] * x[1] + d[2] * x[2],
    )


@njit(cache=True, error_model="numpy")
def pull(nodes: np.ndarray, c: int, stress: Three, a: Vector, b: Vector, force: np.ndarray) -> None:
    """Add the forces of a stress on sides a and b of cell c to its masses."""
    share = 0.5 / nodes.shape[2]
    twice1, twice2, s3 = share * (stress[0] + stress[0]), share * (stress[1] + stress[1]), share * stress[2]
    on_a, on_b = plus(times(twice1, a), times(s3, b)), plus(times(twice2, b), times(s3, a))
    along, across = plus(on_a, on_b), less(on_b, on_a)
    for s in range(nodes.shape[2]):
        k, m = np.uint64(nodes[c, 0, s]), np.uint64(nodes[c, 1, s])
        n, o = np.uint64(nodes[c, 2, s]), np.uint64(nodes[c, 3, s])
        for q in range(3):
            force[k, q] -= along[q]
            force[n, q] += along[q]
            force[m, q] -= across[q]
            force[o, q] += across[q]


@njit(cache=True, error_model="numpy")
def add_forces(u: np.ndarray, cells: CellArrays, force: np.ndarray) -> float:
    """Add the internal force to `force` (n, 3) [N]; return the energy [J]."""
    energy = 0.0
    for c in range(len(cells.nodes)):
        d, g, a, b = measure(u, cells.nodes, cells.sides, c)
        stored, _, _, stress = area_and_strains(HALF, d, g, cells.area[c], of_cell(cells.constants, c))
        energy += stored
        pull(cells.nodes, c, stress, a, b, force)
    return energy


@njit(cache=True, error_model="numpy")
def energies(u: np.ndarray, cells: CellArrays) -> np.ndarray:
    """Energy of every cell, (c,) [J]."""
    out = np.empty(len(cells.nodes))
    for c in range(len(cells.nodes)):
        d, g, _, _ = measure(u, cells.nodes, cells.sides, c)
        out[c] = area_and_strains(HALF, d, g, cells.area[c], of_cell(cells.constants, c))[0]
    return out


@njit(cache=True, error_model="numpy")
def extrapolated(u: np.ndarray, step: np.ndarray, cells: CellArrays) -> np.ndarray:
    """Stress S + D ġ that the linearisation at u predicts after a step (n, 3) [m], (c, 3) [N/m]."""
    out = np.empty((len(cells.nodes), 3))
    for c in range(len(cells.nodes)):
        d, g, a, b = measure(u, cells.nodes, cells.sides, c)
        q = of_cell(cells.constants, c)
        _, t, square, stress = area_and_strains(HALF, d, g, cells.area[c], q)
        moved = rate(a, b, *side_changes(step, cells.nodes, c))
        out[c, 0], out[c, 1], out[c, 2] = plus(
            stress, times_six(stiffness_of_area_and_strains(d, g, t, square, 1.0, q), moved)
        )
    return out


@njit(cache=True, error_model="numpy")
def add_average_forces(start: np.ndarray, end: np.ndarray, cells: CellArrays, force: np.ndarray) -> None:
    """Add the force over a step from `start` to `end` (n, 3) [m] whose work is the energy stored in it: that
    of the mean stress on the mean sides."""
    for c in range(len(cells.nodes)):
        d0, g, a0, b0 = measure(start, cells.nodes, cells.sides, c)
        d1, _, a1, b1 = measure(end, cells.nodes, cells.sides, c)
        stress = mean_area_and_strains(d0, d1, g, cells.area[c], of_cell(cells.constants, c))
        pull(cells.nodes, c, stress, times(0.5, plus(a0, a1)), times(0.5, plus(b0, b1)), force)


@njit(cache=True, error_model="numpy")
def add_damping_forces(u: np.ndarray, v: np.ndarray, cells: CellArrays, force: np.ndarray) -> float:
    """Add the damping force of the stress M ġ, signed as an internal one, to `force` (n, 3) [N]; return the
    power taken [W]."""
    power = 0.0
    for c in range(len(cells.nodes)):
        _, _, a, b = measure(u, cells.nodes, cells.sides, c)
        q, now = of_cell(cells.constants, c), products(a, b)
        moving = rate(a, b, *side_changes(v, cells.nodes, c))
        stress = times_six(
            stiffness_of_area_and_strains(NO_STRESS, now, 0.0, now[0] * now[1] - now[2] * now[2], 0.0, q),
            moving,
        )
        power += dot(stress, moving)
        pull(cells.nodes, c, stress, a, b, force)
    return power


@njit(cache=True, error_model="numpy")
def add_tangent(
    u: np.ndarray, cells: CellArrays, stress: np.ndarray, share: float, lower: bool, blocks: np.ndarray
) -> None:
    """Add the tangent of every cell with this stress, or with the share of its own where `stress` is empty,
    and with M + share (D − M), to the 3×3 blocks; lower: to those on and below the diagonal alone."""
    in_diagonals = np.empty((4, 9))
    own = len(stress) == 0
    for c in range(len(cells.nodes)):
        d, g, a, b = measure(u, cells.nodes, cells.sides, c)
        q = of_cell(cells.constants, c)
        _, t, square, s = area_and_strains(HALF, d, g, cells.area[c], q)
        s = times(share, s) if own else (stress[c, 0], stress[c, 1], stress[c, 2])
        k = stiffness_of_area_and_strains(d, g, t, square, share, q)
        rows = (
            by_sides((k[0], k[3], k[4]), a, b),
            by_sides((k[3], k[1], k[5]), a, b),
            by_sides((k[4], k[5], k[2]), a, b),
        )
        to_diagonals(s, a, b, rows, in_diagonals)
        add_blocks(in_diagonals, cells.nodes.shape[2], cells.slots[c], lower, blocks)


@njit(cache=True, error_model="numpy")
def add_damping_tangent(u: np.ndarray, v: np.ndarray, cells: CellArrays, blocks: np.ndarray) -> None:
    """Add the derivative of the damping force by the displacement to the 3×3 blocks, unsymmetric. Of the area

    q₀ [Ȧ ∇²A + ∇A (∇²A ġ)ᵀ],   ∇A = n/2A,   ∇²A = N/2A − n nᵀ/4A³

    is ∂(M ġ)/∂g; with M and the sides' velocities comes ∂ġ.
    """
    in_diagonals = np.empty((4, 9))
    for c in range(len(cells.nodes)):
        _, _, a, b = measure(u, cells.nodes, cells.sides, c)
        q, now = of_cell(cells.constants, c), products(a, b)
        va, vb = side_changes(v, cells.nodes, c)
        moving = rate(a, b, va, vb)
        square = now[0] * now[1] - now[2] * now[2]
        k = stiffness_of_area_and_strains(NO_STRESS, now, 0.0, square, 0.0, q)
        n, turned = (now[1], now[0], -2.0 * now[2]), (moving[1], moving[0], -2.0 * moving[2])
        along = dot(n, moving) / square
        scale = 0.25 * q[0] / square
        h = less(turned, times(0.5 * along, n))  # 2A ∇²A ġ
        h, growing = times(scale, less(h, times(0.5 * along, n))), scale * along * square
        r1 = plus(times(n[0], h), (0.0, growing, 0.0))
        r2 = plus(times(n[1], h), (growing, 0.0, 0.0))
        r3 = plus(times(n[2], h), (0.0, 0.0, -2.0 * growing))
        rows = (
            both(by_sides(r1, a, b), by_sides((k[0], k[3], k[4]), va, vb)),
            both(by_sides(r2, a, b), by_sides((k[3], k[1], k[5]), va, vb)),
            both(by_sides(r3, a, b), by_sides((k[4], k[5], k[2]), va, vb)),
        )
        to_diagonals(times_six(k, moving), a, b, rows, in_diagonals)
        add_blocks(in_diagonals, cells.nodes.shape[2], cells.slots[c], False, blocks)
