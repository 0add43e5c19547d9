"""Narrow heavy strip, clamped with its plane turned about its length: it bends and twists.

Kirchhoff's rod (Love 1927, chapter 18) that bends about its width alone, with B = E h³/12 per width, and
twists with G h³/3, 2/(1 + ν) times as much. The equations of directors d (width, normal, tangent), arc s and
moment m, lengths over L and moments per width over B/L, are

    d′ = ω × d,   ω = (m·d₁) d₁ + (1 + ν)/2 (m·d₃) d₃,   m′ = −d₃ × Γ (1 − s) g,   m(1) = 0

integrated from the tip, whose turn follows from the condition at the clamp. Without a turn it is the heavy
elastica; turned by π/2 it buckles at Timoshenko's load.
"""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root
from scipy.spatial.transform import Rotation

CLAMPED = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])  # width, normal, tangent


def weight_direction(turned: float) -> np.ndarray:
    """Return the direction of weight in the frame of a strip that is turned [rad] about its length."""
    return np.array([0.0, -np.sin(turned), -np.cos(turned)])


def tip(load: float, poisson: float, turned: float) -> np.ndarray:
    """Return the displacement (3,) of the tip over the length at Γ = load."""
    down, turn = weight_direction(turned), np.zeros(3)

    def from_tip(turn: np.ndarray, load: float) -> tuple[np.ndarray, np.ndarray]:
        """Return directors (3, 3) and place (3,) at the clamp for a given turn of the tip, at 0."""

        def slopes(s: float, state: np.ndarray) -> np.ndarray:
            directors, moment = state[:9].reshape(3, 3), state[9:12]
            width, _, tangent = directors
            spin = (moment @ width) * width + 0.5 * (1.0 + poisson) * (moment @ tangent) * tangent
            bent = -np.cross(tangent, load * (1.0 - s) * down)
            return np.concatenate([np.cross(spin, directors).ravel(), bent, tangent])

        start = np.concatenate([Rotation.from_rotvec(turn).apply(CLAMPED).ravel(), np.zeros(6)])
        end = solve_ivp(slopes, (1.0, 0.0), start, method="DOP853", rtol=1e-9, atol=1e-11).y[:, -1]
        return end[:9].reshape(3, 3), end[12:]

    def missed(turn: np.ndarray, load: float) -> np.ndarray:
        (width, _, tangent), _ = from_tip(turn, load)
        return np.array([tangent[1], tangent[2], width[2]])

    for part in np.linspace(0.0, load, 4 + int(2.0 * load))[1:]:
        solution = root(missed, turn, (part,), tol=1e-8)
        if not solution.success:
            raise ArithmeticError(f"strip at Γ = {part:g}: {solution.message}")
        turn = solution.x
    return -from_tip(turn, load)[1] - CLAMPED[2]
