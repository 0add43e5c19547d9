"""The polynomial of fifth degree through a step's ends, with their velocities and accelerations, compiled."""

from __future__ import annotations

import numpy as np

from sheetbench.numerics.typed import njit


@njit(cache=True)
def polynomials(
    displacement: np.ndarray, velocity: np.ndarray, acceleration: np.ndarray, h: float, theta: np.ndarray
) -> np.ndarray:
    """Displacements, velocities and accelerations (3, k, n, 3) at shares θ (k,) of a step of length h [s], by
    the polynomial with those of both its ends, the first and last of (s, n, 3) each."""
    u0, v0, a0 = displacement[0].ravel(), velocity[0].ravel(), acceleration[0].ravel()
    u1, v1, a1 = displacement[-1].ravel(), velocity[-1].ravel(), acceleration[-1].ravel()
    curve, out = np.empty((6, len(u0))), np.empty((3, len(theta), len(u0)))
    for i in range(len(u0)):
        change = u1[i] - u0[i] - h * v0[i] - 0.5 * h * h * a0[i]
        speed = h * (v1[i] - v0[i] - h * a0[i])
        bend = h * h * (a1[i] - a0[i])
        curve[0, i], curve[1, i], curve[2, i] = u0[i], h * v0[i], 0.5 * h * h * a0[i]
        curve[3, i] = 10.0 * change - 4.0 * speed + 0.5 * bend
        curve[4, i] = -15.0 * change + 7.0 * speed - bend
        curve[5, i] = 6.0 * change - 3.0 * speed + 0.5 * bend
    rate = 1.0 / h
    for k in range(len(theta)):
        for i in range(len(u0)):
            u = v = a = 0.0
            for power in range(5, -1, -1):  # Horner's rule, with the derivatives
                a = a * theta[k] + 2.0 * v
                v = v * theta[k] + u
                u = u * theta[k] + curve[power, i]
            out[0, k, i], out[1, k, i], out[2, k, i] = u, v * rate, a * rate * rate
    return out.reshape(3, len(theta), -1, 3)
