"""The curved mid-surface of a cell, from the masses of its own four columns.

A column has a place x, the mean of its masses, and a director d, from its lowest to its highest mass over
their distance. Between the corners i and j of a side the surface has the tangents across the directors there,

    P(r, s) = Σ corners N x + Σ sides 4 r (1 − r) H(s) b + g(r) (1 − s) e …, b = ⅛ (Δx·Δd) t,   e = −(Δx·d̄)
    t,   Δx = x_j − x_i,   Δd = d_j − d_i,   d̄ = ½ (d_i + d_j),   t = d̄/|d̄|²

with g = r (1 − 2r) on the first half of a side and (1 − r)(1 − 2r) on the second, of slope 1 at both ends,
H = 1 − 2s² and 2 (1 − s)², of slope 0; e fades as the chords that it turns. So neighbouring cells join
without a kink, also at a line of contact, where a shear force V jumps: the director of a column is the slope
of a beam there, and a chord differs from the mean of the slopes at its ends by V l²/12B. On a circle e = 0
and b is its sagitta but for R α⁴/8, α half the angle between columns. Both turn with the sheet.
"""

from __future__ import annotations

import numpy as np

from sheetbench.scenes.objects.grid import Grid

SIDES = np.array([[0, 1], [1, 2], [3, 2], [0, 3]])
KINDS = np.array([[0.125, 0.0], [0.0, -1.0]])  # of Δd, d̄ in b and e


def shapes(r: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Return the shares (p, 12) of corners in turn, and of b and e of each side, in places at r, s (p,) of
    [0, 1]."""
    corners = [(1.0 - r) * (1.0 - s), r * (1.0 - s), r * s, (1.0 - r) * s]
    curves: list[np.ndarray] = []
    for x, y in ((r, s), (s, 1.0 - r), (r, 1.0 - s), (s, r)):
        fades = np.where(y < 0.5, 1.0 - 2.0 * y * y, 2.0 * (1.0 - y) ** 2)
        curves += [4.0 * x * (1.0 - x) * fades, np.minimum(x, 1.0 - x) * (1.0 - 2.0 * x) * (1.0 - y)]
    return np.stack([*corners, *curves], axis=1)


def outer(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return a bᵀ (…, 3, 3) of vectors (…, 3)."""
    return np.asarray(a[..., :, None] * b[..., None, :])


class CellSurface:
    """Corners and curves of cells, of the places (m, q, 3) of their masses. linear: (16, q), the map to x of
    corners and to Δx, Δd, d̄ of each side."""

    def __init__(self, grid: Grid, layer_distance: float):
        layers = grid[2]
        director = np.zeros(layers)
        director[[0, -1]] = np.array([-1.0, 1.0]) / ((layers - 1) * layer_distance)
        x, d = np.kron(np.eye(4), np.full(layers, 1.0 / layers)), np.kron(np.eye(4), director)
        i, j = SIDES.T
        of_sides = np.stack([x[j] - x[i], d[j] - d[i], 0.5 * (d[i] + d[j])], axis=1)
        self.linear = np.concatenate([x, of_sides.reshape(12, -1)])

    def vectors(self, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return corners, b and e (m, 12, 3) [m], and Δx, Δd, d̄ of sides (3, m, 4, 3)."""
        linear = self.linear @ places
        sides = np.moveaxis(linear[:, 4:].reshape(-1, 4, 3, 3), 2, 0)
        step, turn, mean = sides
        dots = np.stack([(step * turn).sum(-1), (step * mean).sum(-1)], axis=-1) @ KINDS.T
        curves = (dots / (mean * mean).sum(-1)[..., None])[..., None] * mean[:, :, None]
        return np.concatenate([linear[:, :4], curves.reshape(-1, 8, 3)], axis=1), sides

    def slopes(self, sides: np.ndarray) -> np.ndarray:
        """Return derivatives (m, 12, 3, 16, 3) of corners, b and e by what the linear map gives."""
        (step, turn, mean), side = sides, np.arange(4)
        square = (mean * mean).sum(-1)[..., None]
        t = mean / square
        by_mean = (np.eye(3) - 2.0 * outer(t, mean)) / square[..., None]
        out = np.zeros((sides.shape[1], 12, 3, 16, 3))
        out[:, side, :, side] = np.eye(3)
        for kind, (of_turn, of_mean) in enumerate(KINDS):
            along = of_turn * turn + of_mean * mean
            dot = (step * along).sum(-1)[..., None, None]
            parts = outer(t, along), of_turn * outer(t, step), dot * by_mean + of_mean * outer(t, step)
            for k, by in enumerate(parts):
                out[:, 4 + 2 * side + kind, :, 4 + 3 * side + k] = by.swapaxes(0, 1)
        return out

    def second(self, sides: np.ndarray, pull: np.ndarray) -> np.ndarray:
        """Return Σ f·∂²(b, e) (m, 16, 3, 16, 3) by what the linear map gives, of f on them (m, 8, 3)."""
        step, turn, mean = sides
        square, eye = (mean * mean).sum(-1)[..., None], np.eye(3)
        out = np.zeros((len(pull), 16, 3, 16, 3))
        for (of_turn, of_mean), f in zip(KINDS, (pull[:, ::2], pull[:, 1::2]), strict=True):
            along, q = (f * mean).sum(-1)[..., None], of_turn * turn + of_mean * mean
            by_mean = (f - 2.0 * mean * along / square) / square  # ∂(f·t)/∂d̄
            both = outer(f, mean)
            both = both + both.swapaxes(-1, -2) + along[..., None] * eye
            curved = (
                8.0 * along[..., None] * outer(mean, mean) / square[..., None] ** 3
                - 2.0 * both / square[..., None] ** 2
            )
            even, crossed = (along / square)[..., None] * eye, outer(step, by_mean)
            blocks = np.zeros((3, 3, *f.shape, 3))
            blocks[0, 1] = blocks[1, 0] = of_turn * even
            blocks[0, 2] = of_mean * even + outer(q, by_mean)
            blocks[1, 2] = of_turn * crossed
            blocks[2, 0], blocks[2, 1] = blocks[0, 2].swapaxes(-1, -2), blocks[1, 2].swapaxes(-1, -2)
            blocks[2, 2] = (step * q).sum(-1)[..., None, None] * curved
            blocks[2, 2] += of_mean * (crossed + crossed.swapaxes(-1, -2))
            for side in range(4):
                k = slice(4 + 3 * side, 7 + 3 * side)
                out[:, k, :, k] += blocks[:, :, :, side].transpose(2, 0, 3, 1, 4)
        return out
