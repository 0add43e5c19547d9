"""Checks of every answer and every sample of a motion, as compiled loops: inverted cells
(`lumped.statics.faults`), sharpness of bending, rounding of the links' forces (`lumped.statics.validity`)."""

from __future__ import annotations

import math

import numpy as np

from lumped.springs.links import LinkArrays, strains
from sheetbench.numerics.aliasing import empty, zeros
from sheetbench.numerics.options import inner, njit

TINY = float(np.finfo(float).tiny)
TIE_FACTOR = 1.0 + 1e-9  # the first of mirror images is named, which differ by rounding alone


@inner()
def surface(columns: np.ndarray, positions: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the mid-surface (ny, nx, 3) [m] and the unit directors from the bottom layer to the top.

    columns: (ny, nx, layers) masses; positions (n, 3) [m] at rest; u (n, 3) [m].
    """
    ny, nx, layers = columns.shape
    middle, director, share = zeros((ny, nx, 3)), empty((ny, nx, 3)), 1.0 / layers
    for j in range(ny):
        for i in range(nx):
            square = 0.0
            for q in range(3):
                for k in range(layers):
                    mass = columns[j, i, k]
                    middle[j, i, q] += share * (positions[mass, q] + u[mass, q])
                top, bottom = columns[j, i, layers - 1], columns[j, i, 0]
                across = positions[top, q] + u[top, q] - positions[bottom, q] - u[bottom, q]
                director[j, i, q] = across
                square += across * across
            scale = 1.0 / max(math.sqrt(square), TINY)
            for q in range(3):
                director[j, i, q] *= scale
    return middle, director


@njit
def examine(
    states: np.ndarray,
    links: LinkArrays,
    shortest: float,
    columns: np.ndarray,
    positions: np.ndarray,
    areas: np.ndarray,
) -> tuple[np.ndarray, int, int]:
    """Check displacements (k, n, 3) [m]: return `links.strains` of those before the first invalid one, the
    number of its fault, −1 without one, and the mass at the fault. 0: a number is not finite; 1: the shortest
    link; 2: the cell of the mid-surface whose normal, relative to its flat area, points most away from the
    mean director of its corners. shortest: length of a link over its length at rest; areas: (ny − 1, nx − 1)
    [m²], 0 of absent cells; other arguments as in `surface`."""
    ny, nx, _ = columns.shape
    sound, kind, mass = len(states), -1, 0
    for k in range(len(states)):
        for i in range(len(positions)):
            total = states[k, i, 0] + states[k, i, 1] + states[k, i, 2]
            if kind < 0 and not math.isfinite(total):
                sound, kind, mass = k, 0, i
    largest, link = strains(states[:sound], links, shortest)
    if link >= 0:
        kind, mass = 1, links.nodes[link, 0]
    for k in range(len(largest)):
        middle, director = surface(columns, positions, states[k])
        least, which = np.inf, 0
        for j in range(ny - 1):
            for i in range(nx - 1):
                a, b, c, d = middle[j, i], middle[j, i + 1], middle[j + 1, i + 1], middle[j + 1, i]
                facing = 0.0
                for q, r, s in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
                    normal = (c[r] - a[r]) * (d[s] - b[s]) - (c[s] - a[s]) * (d[r] - b[r])
                    mean = director[j, i, q] + director[j, i + 1, q]
                    facing += normal * (mean + director[j + 1, i + 1, q] + director[j + 1, i, q])
                if areas[j, i] > 0.0 and facing < least * areas[j, i]:
                    least, which = facing / areas[j, i], columns[j, i, 0]
        if least <= 0.0:
            return largest[:k], 2, which
    return largest, kind, mass


@njit
def sharpest_bend(
    columns: np.ndarray,
    positions: np.ndarray,
    areas: np.ndarray,
    u: np.ndarray,
    along_x: np.ndarray,
    along_y: np.ndarray,
) -> tuple[float, float, int, int]:
    """Return the largest ℓ² √|κ₁ κ₂| [m] of all cells, its ℓ and its cell (j, i); ℓ is the longer of a cell's
    sides along_x (nx − 1,) and along_y (ny − 1,) [m], κ₁ κ₂ follow from the directors' changes along x and
    y."""
    ny, nx, _ = columns.shape
    middle, director = surface(columns, positions, u)
    largest, row, column = -1.0, 0, 0
    for j in range(ny - 1):
        for i in range(nx - 1):
            if areas[j, i] == 0.0:
                continue
            xx = xy = yx = yy = 0.0
            for q in range(3):
                m, d = middle[j : j + 2, i : i + 2, q], director[j : j + 2, i : i + 2, q]
                m_x, m_y = m[0, 1] - m[0, 0] + m[1, 1] - m[1, 0], m[1, 0] - m[0, 0] + m[1, 1] - m[0, 1]
                d_x, d_y = d[0, 1] - d[0, 0] + d[1, 1] - d[1, 0], d[1, 0] - d[0, 0] + d[1, 1] - d[0, 1]
                xx, xy, yx, yy = xx + m_x * d_x, xy + m_x * d_y, yx + m_y * d_x, yy + m_y * d_y
            gauss = 0.25 * math.sqrt(abs(xx * yy - (0.5 * (xy + yx)) ** 2)) / areas[j, i]
            bent = max(along_x[i], along_y[j]) ** 2 * gauss
            if bent > TIE_FACTOR * largest:
                largest, row, column = bent, j, i
    return largest, max(along_x[column], along_y[row]), row, column


@njit
def link_force_sums(u: np.ndarray, nodes: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """Return k |Δu| of the links at every mass, summed, (k, 1) [N]."""
    carried = zeros(len(u))
    for m in range(len(nodes)):
        a, b = nodes[m, 0], nodes[m, 1]
        square = 0.0
        for q in range(3):
            square += (u[b, q] - u[a, q]) ** 2
        pull = stiffness[m] * math.sqrt(square)
        carried[a] += pull
        carried[b] += pull
    return carried.reshape(-1, 1)
