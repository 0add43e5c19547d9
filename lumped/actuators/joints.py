"""Joint angles between neighbouring segments from scalar products of their frames, and the joints' energy.

A segment has the frame (t, n, b), the next one the tangent t'. For s = (n·t', b·t'), c = t·t' and S = |s|,
the joint's rotation vector has the components

    φ_i = s_i g,    g = θ/S,   θ = atan2(S, c),

φ_1 in the plane of t and n, φ_2 in the plane of t and b. A joint stores ½ k |φ − φ0|² [J], k [N·m/rad].
Derivatives follow from ∂g/∂c = −1/ρ² and ∂g/∂w = (c/ρ² − g)/2w, w = S², ρ² = w + c²; as w → 0 by series.
Arrays over the joints: measures (j, 3) = (s_1, s_2, c); angles (j, 2).
"""

import numpy as np

SERIES = 1e-6  # w below which the series is used; it leaves out terms of order w²


def angles(measures: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return φ (j, 2), its derivatives (j, 2, 3) and second derivatives (j, 2, 3, 3) by the measures."""
    s, c = measures[:, :2], measures[:, 2]
    w = (s**2).sum(axis=1)
    square = w + c**2
    small = (w < SERIES) & (c > 0.0)
    safe = np.where(small, 1.0, w)
    root = np.sqrt(safe)
    g = np.where(small, 1.0 / c - w / (3.0 * c**3), np.arctan2(root, c) / root)
    g_w = np.where(small, -1.0 / (3.0 * c**3) + 0.4 * w / c**5, (c / square - g) / (2.0 * safe))
    g_ww = np.where(small, 0.4 / c**5, (-c / square**2 - 3.0 * g_w) / (2.0 * safe))
    g_c, g_cc, g_wc = -1.0 / square, 2.0 * c / square**2, 1.0 / square**2

    slope = np.concatenate([2.0 * g_w[:, None] * s, g_c[:, None]], axis=1)  # of g by the measures
    bend = np.empty((len(c), 3, 3))
    bend[:, :2, :2] = 4.0 * g_ww[:, None, None] * s[:, :, None] * s[:, None, :]
    bend[:, :2, :2] += 2.0 * g_w[:, None, None] * np.eye(2)
    bend[:, :2, 2] = bend[:, 2, :2] = 2.0 * g_wc[:, None] * s
    bend[:, 2, 2] = g_cc
    unit = np.eye(3)[:2]  # ∂s_i/∂measures
    first = unit * g[:, None, None] + s[:, :, None] * slope[:, None, :]
    mixed = unit[None, :, :, None] * slope[:, None, None, :]
    second = mixed + mixed.swapaxes(2, 3) + s[:, :, None, None] * bend[:, None, :, :]
    return s * g[:, None], first, second


def derivatives(
    measures: np.ndarray, stiffness: np.ndarray, rest: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return every joint's energy (j,) [J], its gradient (j, 3) and Hessian (j, 3, 3) by the measures."""
    phi, first, second = angles(measures)
    torque = stiffness[:, None] * (phi - rest)
    gradient = np.einsum("ji,jia->ja", torque, first)
    hessian = np.einsum("j,jia,jib->jab", stiffness, first, first)
    stored = 0.5 * (torque * (phi - rest)).sum(axis=1)
    return stored, gradient, hessian + np.einsum("ji,jiab->jab", torque, second)


def average_gradient(
    start: np.ndarray, end: np.ndarray, stiffness: np.ndarray, rest: np.ndarray
) -> np.ndarray:
    """Return Gonzalez' discrete gradient (j, 3); times (end − start) it is the difference of the energies."""
    change = end - start
    _, middle, _ = derivatives(0.5 * (start + end), stiffness, rest)
    size = (change**2).sum(axis=1)
    moving = size > 1e-20  # below, the correction is of third order in a change that rounding hides
    before, after = (derivatives(at, stiffness, rest)[0] for at in (start, end))
    stored = after - before
    miss = np.where(moving, stored - (middle * change).sum(axis=1), 0.0)
    return middle + (miss / np.where(moving, size, 1.0))[:, None] * change
