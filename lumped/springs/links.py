"""Springs and dampers of links as compiled loops: measure, stress, force, tangent, rate.

A link joins two masses; its measure is g = r·r of their relative position r = d₀ + du, d₀ at rest, and its
energy a law of g (`lumped.springs.laws`). Its ends are pulled by ± 2 S r, S = dW/dg; the tangent is
2 S I + 4 D r rᵀ, D = d²W/dg². The change of g, (2 d₀ + du)·du, loses no digits where du is small. The tangent
takes S as an argument: S at u, its positive part, none, or the prediction of the linearisation (Magisano,
Leonetti and Garcea 2017). The strain ε of an energy ½ k ε², here the elongation, is then linear in a step:
with S + D ġ instead a cantilever took one correction more, a chain five, for after a large rotation all links
are stretched for a moment, and D with them. Dampers have the stress M ġ, ġ = 2 r·dv.

A link whose natural length is not |d₀|, g₀ = d₀·d₀ + δg₀ (`lumped.natural`), has δg − δg₀ in place of δg and
√g₀ as its length at rest.

Arrays: stress (m,) [N/m]; blocks (b, 3, 3) [N/m], added to; u, v, force (n, 3).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lumped.springs.laws import Branches, Vector, dot, elongation, times
from sheetbench.numerics.aliasing import empty, zeros
from sheetbench.numerics.options import inner, njit


class LinkArrays(NamedTuple):
    """Arrays of links. nodes: (m, 2); offset: (m, 3) [m], d₀; rest: (2, m), the length [m] and δg₀ [m²];
    constants: (m,), stiffness [N/m] or damping [N·s/m]; slots: (m, 4) block numbers aa, ab, ba, bb."""

    nodes: np.ndarray
    offset: np.ndarray
    rest: np.ndarray
    constants: np.ndarray
    slots: np.ndarray


@inner()
def difference(u: np.ndarray, nodes: np.ndarray, m: int) -> Vector:
    """Return u of the second end of link m less u of the first."""
    a, b = np.uint64(nodes[m, 0]), np.uint64(nodes[m, 1])
    return u[b, 0] - u[a, 0], u[b, 1] - u[a, 1], u[b, 2] - u[a, 2]


@inner()
def measure(u: np.ndarray, links: LinkArrays, m: int) -> tuple[float, float, float, Vector]:
    """Return δg, g, the length at rest [m] and r of link m."""
    d, offset, rest = difference(u, links.nodes, m), links.offset, links.rest
    r = offset[m, 0] + d[0], offset[m, 1] + d[1], offset[m, 2] + d[2]
    change = (offset[m, 0] + r[0]) * d[0] + (offset[m, 1] + r[1]) * d[1] + (offset[m, 2] + r[2]) * d[2]
    return change - rest[1, m], dot(r, r), rest[0, m], r


@inner()
def pull(nodes: np.ndarray, m: int, k: float, r: Vector, force: np.ndarray) -> None:
    """Add ± k r to the forces on the ends of link m."""
    a, b = np.uint64(nodes[m, 0]), np.uint64(nodes[m, 1])
    for q in range(3):
        force[a, q] -= k * r[q]
        force[b, q] += k * r[q]


@njit
def add_forces(
    u: np.ndarray, links: LinkArrays, force: np.ndarray, branches: Branches | None = None
) -> float:
    """Add the internal force to `force` (n, 3) [N]; return the springs' energy [J], branches excluded."""
    energy = 0.0
    for m in range(len(links.nodes)):
        change, square, length, r = measure(u, links, m)
        stored, stress, _, _ = elongation(change, square, length, links.constants[m])
        energy += stored
        if branches is not None:
            own, constant, stresses, changes = branches
            stresses[m, 0], changes[m, 0] = stress, change
            stress = own * stress + constant[m, 0]
        pull(links.nodes, m, stress + stress, r, force)
    return energy


@njit
def survey(
    u: np.ndarray, links: LinkArrays, kind: np.ndarray, kinds: int, layers: int
) -> tuple[np.ndarray, float, float]:
    """Return the links' energies [J] by kind, (kinds,), the part stored by the layers' mean stretch, and the
    largest relative change of length, as `strains`. The links between two columns are consecutive, layer by
    layer."""
    out, stretch, summed, firm, met, least, most = zeros(kinds), 0.0, 0.0, 0.0, 0, 0.0, 0.0
    for m in range(len(links.nodes)):
        change, square, length, _ = measure(u, links, m)
        half, e, rest = 0.5 * links.constants[m], change / (np.sqrt(square) + length), length * length
        out[kind[m]] += half * (e * e)
        if links.offset[m, 2] == 0.0:
            summed, firm, met = summed + e, firm + half, met + 1
            if met % layers == 0:
                stretch, summed, firm = stretch + firm * (summed / layers) ** 2, 0.0, 0.0
            least, most = min(least, change / rest), max(most, change / rest)
    return out, stretch, larger(least, most)


@inner()
def larger(least: float, most: float) -> float:
    """Return the larger relative change of length of the extremes of δg/g₀."""
    return max(most / (1.0 + np.sqrt(1.0 + most)), -least / (1.0 + np.sqrt(1.0 + least)))


@njit
def strains(states: np.ndarray, links: LinkArrays, shortest: float) -> tuple[np.ndarray, int]:
    """Return the largest relative change of length of in-plane links at each of the displacements (k, n, 3)
    [m] before the first with a collapsed link, and the number of that link, −1 without one. A link has
    collapsed at the `shortest` share of its length at rest."""
    out = empty(len(states))
    for k in range(len(states)):
        least, most, collapsed, which = 0.0, 0.0, shortest * shortest, -1
        for m in range(len(links.nodes)):
            change, square, length, _ = measure(states[k], links, m)
            rest = length * length
            if square < collapsed * rest:
                collapsed, which = square / rest, m
            if links.offset[m, 2] == 0.0 and not least * rest <= change <= most * rest:
                least, most = min(least, change / rest), max(most, change / rest)
        if which >= 0:
            return out[:k], which
        out[k] = larger(least, most)
    return out, -1


@njit
def extrapolated(u: np.ndarray, step: np.ndarray, links: LinkArrays, strain: bool) -> np.ndarray:
    """Return the prediction (m,) of the linearisation at u after a step (n, 3) [m]: ½ k e [N] of the
    elongation e if `strain`, else the stress S + D ġ, for lattices of rubber, whose cells subtract the energy
    of links along their sides."""
    out = empty(len(links.nodes))
    for m in range(len(links.nodes)):
        change, square, length, r = measure(u, links, m)
        _, stress, material, rest = elongation(change, square, length, links.constants[m])
        along = 2.0 * dot(r, difference(step, links.nodes, m))
        if strain:
            out[m] = (stress + material * along) * np.sqrt(square)
        else:
            out[m] = stress + (material + rest) * along
    return out


@njit
def powers_by_constants(u: np.ndarray, v: np.ndarray, links: LinkArrays) -> np.ndarray:
    """Return the derivatives of every link's power v·f at u by its stiffness and by its natural δg₀, (m, 2),
    f the internal force and v (n, 3)."""
    out = empty((len(links.nodes), 2))
    for m in range(len(links.nodes)):
        change, square, length, r = measure(u, links, m)
        now, along = np.sqrt(square), dot(r, difference(v, links.nodes, m))
        out[m, 0] = change / ((now + length) * now) * along
        out[m, 1] = -0.5 * links.constants[m] * along / (now * length)
    return out


@njit
def add_average_forces(start: np.ndarray, end: np.ndarray, links: LinkArrays, force: np.ndarray) -> None:
    """Add the force over a step from `start` to `end` (n, 3) [m] whose work is the change of energy: the
    force of the mean stress on the mean r, as δg is 2 r̄·Δr (Simo and Tarnow 1992, Gonzalez 1996)."""
    for m in range(len(links.nodes)):
        change0, square0, length, r0 = measure(start, links, m)
        change1, square1, _, r1 = measure(end, links, m)
        l0, l1 = np.sqrt(square0), np.sqrt(square1)
        e0, e1 = change0 / (l0 + length), change1 / (l1 + length)
        stress = 0.5 * links.constants[m] * (e0 + e1) / (l0 + l1)  # (W₁ − W₀)/(g₁ − g₀)
        pull(links.nodes, m, stress, (r0[0] + r1[0], r0[1] + r1[1], r0[2] + r1[2]), force)


@njit
def add_tangent(
    u: np.ndarray,
    links: LinkArrays,
    stress: np.ndarray,
    extrapolated: bool,
    share: float,
    blocks: np.ndarray,
) -> None:
    """Add the tangent of every link with a stress, or with the share of its stress at u if `stress` is empty,
    and with M + share (D − M), to the 3×3 blocks on and below the diagonal. extrapolated: whether `stress`
    holds predicted ½ k e [N], which then also give D − M."""
    flat = blocks.reshape(-1, 9)
    stress_at_u = len(stress) == 0
    for m in range(len(links.nodes)):
        change, square, length, r = measure(u, links, m)
        _, at_u, material, rest = elongation(change, square, length, links.constants[m])
        s, curved = share * at_u if stress_at_u else stress[m], share * rest
        if extrapolated:
            s /= np.sqrt(square)
            curved = -0.5 * s / square
        across, a = 2.0 * s, times(4.0 * (material + curved), r)
        xx, xy, xz = a[0] * r[0] + across, a[0] * r[1], a[0] * r[2]
        yx, yy, yz = a[1] * r[0], a[1] * r[1] + across, a[1] * r[2]
        zx, zy, zz = a[2] * r[0], a[2] * r[1], a[2] * r[2] + across
        above = 1 if links.slots[m, 1] < links.slots[m, 2] else 2
        for e in range(4):
            if e == above:
                continue
            block = flat[np.uint64(links.slots[m, e])]
            sign = 1.0 if e == 0 or e == 3 else -1.0
            block[0] += sign * xx
            block[1] += sign * xy
            block[2] += sign * xz
            block[3] += sign * yx
            block[4] += sign * yy
            block[5] += sign * yz
            block[6] += sign * zx
            block[7] += sign * zy
            block[8] += sign * zz
