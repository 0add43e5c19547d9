"""The law of the pressure over the depth, and where a cell's points are (`lumped.contact.contact`)."""

from __future__ import annotations

import numpy as np


def rounded_law(depth: np.ndarray, rounded: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return ψ, p and p' over k at depths (m, p) [m] of a law that is rounded over δ (m, p) [m]."""
    d = np.maximum(depth, 0.0)
    over = np.where(rounded > 0.0, rounded, 1.0)
    near = d < rounded
    energy = np.where(near, d**3 / (6.0 * over), 0.5 * d * (d - rounded) + rounded**2 / 6.0)
    pressure = np.where(near, 0.5 * d * d / over, d - 0.5 * rounded)
    return energy, np.where(depth > 0.0, pressure, 0.0), np.where(near, d / over, depth > 0.0)


def side_rule(parts: int, ends: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return linear weights (n, 2) of a side's ends, and the weights (n,) of a rule, at the middles of its
    parts or at their ends."""
    at = np.arange(parts + 1) / parts if ends else (np.arange(parts) + 0.5) / parts
    rule = np.full(len(at), 1.0 / parts)
    if ends:
        rule[[0, -1]] *= 0.5
    return np.stack([1.0 - at, at], axis=1), rule
