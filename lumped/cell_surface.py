"""The curved mid-surface of a cell, from the masses of its own four columns.

A column has a place x, the mean of its masses, and a director d, from its lowest to its highest mass over
their distance. At both ends of a side the surface leaves a column across its director: with Δx the side's
chord, and a = −(Δx·d) d/|d|² at its ends i and j,

    P(r, s) = Σ corners N x + Σ sides ½ r (1 − r) H(s) (a_i − a_j) + ½ g(r) (1 − s) (a_i + a_j) …

with g = r (1 − 2r) on the first half of a side and (1 − r)(1 − 2r) on the second, of slope 1 at both ends,
H = 1 − 2s² and 2 (1 − s)², of slope 0; the second part fades as the chords that it turns. So neighbouring
cells join without a kink, also at a line of contact, where a shear force V jumps: the director of a column is
the slope of a beam there, and a chord differs from the mean of the slopes at its ends by V l²/12B. On a
circle the second part is 0, the first its sagitta but for 3/8 R α⁴, α half the angle between columns.
Derivatives of a are written in n = d/|d|² and J = ∂n/∂d: a = −(Δx·d) n = −(Δx·n) d.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from lumped.lattice import Lattice
from lumped.mid_surface import MidSurface
from sheetbench.scenes.objects.grid import Grid

SIDES, EYE = np.array([[0, 1], [1, 2], [3, 2], [0, 3]]), np.eye(3)


def outer(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return a ⊗ b (…, k, l) of vectors (…, k) and (…, l)."""
    return np.asarray(a[..., :, None] * b[..., None, :])


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return a·b (…, 1, 1) of vectors (…, 3)."""
    return np.asarray((a * b).sum(-1)[..., None, None])


def shapes(r: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Return the shape functions (p, 12) at points r, s (p,) of [0, 1]: of the corners in turn, then of a at
    the ends of each side."""
    found = [(1.0 - r) * (1.0 - s), r * (1.0 - s), r * s, (1.0 - r) * s]
    for x, y in ((r, s), (s, 1.0 - r), (r, 1.0 - s), (s, r)):
        even = 0.5 * x * (1.0 - x) * np.where(y < 0.5, 1.0 - 2.0 * y * y, 2.0 * (1.0 - y) ** 2)
        odd = 0.5 * np.minimum(x, 1.0 - x) * (1.0 - 2.0 * x) * (1.0 - y)
        found += [odd + even, odd - even]
    return np.stack(found, axis=1)


class CellSurface:
    """Curved mid-surfaces of cells, from the positions (m, q, 3) of their masses. corners: (4, q), the map to
    x of corners; ends: (2, 8, q), the maps to Δx and d at both ends of four sides."""

    def __init__(self, grid: Grid, layer_distance: float):
        layers = grid[2]
        director = np.zeros(layers)
        director[[0, -1]] = np.array([-1.0, 1.0]) / ((layers - 1) * layer_distance)
        self.corners, d = np.kron(np.eye(4), np.full(layers, 1.0 / layers)), np.kron(np.eye(4), director)
        chords = np.repeat(self.corners[SIDES[:, 1]] - self.corners[SIDES[:, 0]], 2, axis=0)
        self.ends = np.stack([chords, d[SIDES.ravel()]])

    def vectors(self, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return corners and a (m, 12, 3) [m], and Δx and n at the ends of sides (2, m, 8, 3)."""
        v, d = self.ends[:, None] @ places
        n = d / dot(d, d)[..., 0]
        return np.concatenate([self.corners @ places, -dot(v, d)[..., 0] * n], axis=1), np.stack([v, n])

    def first(self, ends: np.ndarray) -> np.ndarray:
        """Return the derivatives (m, 12, 3, q, 3) of corners and a by the masses' positions."""
        v, n = ends
        d = n / dot(n, n)[..., 0]
        by = -outer(d, n), -outer(n, v) - dot(v, n) * (EYE - 2.0 * outer(d, n))
        corners = np.einsum("kq,cd->kcqd", self.corners, EYE)
        curves = np.einsum("vmkcd,vkq->mkcqd", np.stack(by), self.ends, optimize=True)
        return np.concatenate([np.broadcast_to(corners, (len(curves), *corners.shape)), curves], axis=1)

    def second(self, ends: np.ndarray, f: np.ndarray) -> np.ndarray:
        """Return Σ f·∂²a (m, q, 3, q, 3) by the places, of f on a (m, 8, 3)."""
        v, n = ends
        d = n / dot(n, n)[..., 0]
        turned = dot(n, n)[..., 0] * f - 2.0 * dot(f, n)[..., 0] * n  # J f
        half = 2.0 * dot(v, n) * outer(f, n) - outer(v, turned)
        both = half + half.swapaxes(-1, -2) + 2.0 * dot(v, n) * dot(f, n) * (EYE - 4.0 * outer(n, d))
        mixed = -dot(f, n) * EYE - outer(d, turned)
        by = np.stack([[np.zeros_like(both), mixed], [mixed.swapaxes(-1, -2), both]])
        return np.einsum("vkq,vwmkcd,wkr->mqcrd", self.ends, by, self.ends, optimize=True)


class CurvedSurface(MidSurface):
    """Linear map of changes of a lattice's displacement u (n, 3) [m] to changes of the curved surface at plan
    points (k, 2). displacement: (k, 3) [m], that surface's there. Raises BadInput for points off the sheet.
    """

    def __init__(self, lattice: Lattice, points: np.ndarray, u: np.ndarray):
        super().__init__(lattice, points, order=1)
        (nx, ny, layers), cells = lattice.grid, CellSurface(lattice.grid, lattice.layer_distance)
        (column, r), (row, s) = (line.index(at) for line, at in zip(lattice.lines, points.T, strict=True))
        number = np.full((ny - 1) * (nx - 1), -1)
        number[lattice.present_cells] = np.arange(len(lattice.mid_cells))
        cell = number[row * (nx - 1) + column]
        share, nodes = shapes(r, s)[:, 4:] * (cell >= 0)[:, None], lattice.mid_cells[cell]
        nodes = nodes.reshape(-1, 4 * layers)
        vectors, ends = cells.vectors(lattice.positions[nodes] + u[nodes])
        self.displacement = super().of(u) + np.einsum("kq,kqi->ki", share, vectors[:, 4:])
        by = np.einsum("kq,kqiaj->kiaj", share, cells.first(ends)[:, 4:])
        rows = np.arange(3 * len(nodes)).reshape(-1, 3, 1, 1)
        both = np.broadcast_arrays(rows, 3 * nodes[:, None, :, None] + np.arange(3))
        self._curves = by.ravel(), tuple(each.ravel() for each in both)

    def matrix(self, size: int) -> sp.csr_array:
        straight = super().matrix(size)
        return straight + sp.csr_array(self._curves, shape=straight.shape)

    def of(self, field: np.ndarray) -> np.ndarray:
        return np.asarray(self.matrix(len(field)) @ field.ravel()).reshape(-1, 3)

    def shared(self, values: np.ndarray, size: int) -> np.ndarray:
        return np.asarray(self.matrix(size).T @ values.ravel()).reshape(-1, 3)


def middle(
    lattice: Lattice, points: np.ndarray, u: np.ndarray, curved: bool
) -> tuple[np.ndarray, MidSurface]:
    """Return displacements (p, 3) [m] at plan points (p, 2) of the curved surface, or of cubics through
    masses, and the map of their changes. Raises BadInput for points off the sheet."""
    if curved:
        surface = CurvedSurface(lattice, points, u)
        return surface.displacement, surface
    cubics = MidSurface(lattice, points)
    return cubics.of(u), cubics
