"""The curved mid-surface of a cell, from the masses of its own four columns.

A column has a place x, the mean of its masses, and a director d, from its lowest to its highest mass over
their distance. Between the corners i and j of a side the surface is a parabola with the bubble b in its
middle,

    P(r, s) = Σ corners N x + Σ sides 4 r (1 − r) (1 − s) b …,   b = ⅛ (Δx·Δd) t,   t = d̄/|d̄|²,
    Δx = x_j − x_i,   Δd = d_j − d_i,   d̄ = ½ (d_i + d_j)

On a circle of radius R, half an angle α between columns, b = ½ R sin α tan α: it has the circle's tangents at
the columns, so that neighbouring cells join without a kink, and its sagitta but for R α⁴/8. b turns with the
sheet.
"""

from __future__ import annotations

import numpy as np

from sheetbench.scenes.objects.grid import Grid

SIDES = np.array([[0, 1], [1, 2], [3, 2], [0, 3]])


def shapes(r: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Return the shares (p, 8) of corners in turn and of bubbles of sides in places at r, s (p,) of [0,
    1]."""
    corners = [(1.0 - r) * (1.0 - s), r * (1.0 - s), r * s, (1.0 - r) * s]
    along, across = 4.0 * r * (1.0 - r), 4.0 * s * (1.0 - s)
    return np.stack([*corners, along * (1.0 - s), across * r, along * s, across * (1.0 - r)], axis=1)


def outer(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return a bᵀ (…, 3, 3) of vectors (…, 3)."""
    return np.asarray(a[..., :, None] * b[..., None, :])


class CellSurface:
    """Corners and bubbles of cells, of the places (m, q, 3) of their masses. linear: (16, q), the map to x of
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
        """Return corners and bubbles (m, 8, 3) [m], and Δx, Δd, d̄ of sides (3, m, 4, 3)."""
        linear = self.linear @ places
        sides = np.moveaxis(linear[:, 4:].reshape(-1, 4, 3, 3), 2, 0)
        step, turn, mean = sides
        turned = (step * turn).sum(-1) / (mean * mean).sum(-1)
        return np.concatenate([linear[:, :4], 0.125 * turned[..., None] * mean], axis=1), sides

    def slopes(self, sides: np.ndarray) -> np.ndarray:
        """Return derivatives (m, 8, 3, 16, 3) of corners and bubbles by what the linear map gives."""
        (step, turn, mean), side = sides, np.arange(4)
        square, turned = (mean * mean).sum(-1)[..., None], (step * turn).sum(-1)[..., None, None]
        t = mean / square
        by_mean = turned * (np.eye(3) - 2.0 * outer(t, mean)) / square[..., None]
        out = np.zeros((sides.shape[1], 8, 3, 16, 3))
        out[:, side, :, side] = np.eye(3)
        for k, by in enumerate((outer(t, turn), outer(t, step), by_mean)):
            out[:, 4 + side, :, 4 + 3 * side + k] = by.swapaxes(0, 1) / 8.0
        return out

    def second(self, sides: np.ndarray, pull: np.ndarray) -> np.ndarray:
        """Return Σ f·∂²b (m, 16, 3, 16, 3) by what the linear map gives, of f on bubbles (m, 4, 3)."""
        step, turn, mean = sides
        square, along = ((one * mean).sum(-1)[..., None] for one in (mean, pull))
        by_mean = (pull - 2.0 * mean * along / square) / square  # ∂(f·t)/∂d̄
        both, eye = outer(pull, mean), np.eye(3)
        both = both + both.swapaxes(-1, -2) + along[..., None] * eye
        curved = (
            8.0 * along[..., None] * outer(mean, mean) / square[..., None] ** 3
            - 2.0 * both / square[..., None] ** 2
        )
        blocks = np.zeros((3, 3, *pull.shape, 3))
        blocks[0, 1] = blocks[1, 0] = (along / square)[..., None] * eye
        blocks[0, 2], blocks[1, 2] = outer(turn, by_mean), outer(step, by_mean)
        blocks[2, 0], blocks[2, 1] = blocks[0, 2].swapaxes(-1, -2), blocks[1, 2].swapaxes(-1, -2)
        blocks[2, 2] = (step * turn).sum(-1)[..., None, None] * curved
        out = np.zeros((len(pull), 16, 3, 16, 3))
        for side in range(4):
            k = slice(4 + 3 * side, 7 + 3 * side)
            out[:, k, :, k] = blocks[:, :, :, side].transpose(2, 0, 3, 1, 4) / 8.0
        return out
