"""Stiffness of sheets with fibres: orthotropic plies, by the invariants of their stiffness under rotation.

The invariants of the stiffness Q of a ply in its axes give C at the angle t (Tsai and Pagano):

    U₁ = (3 Q₁₁ + 3 Q₂₂ + 2 Q₁₂ + 4 Q₆₆)/8      C₁₁ = U₁ + U₂ cos 2t + U₃ cos 4t
    U₂ = (Q₁₁ − Q₂₂)/2                          C₂₂ = U₁ − U₂ cos 2t + U₃ cos 4t
    U₃ = (Q₁₁ + Q₂₂ − 2 Q₁₂ − 4 Q₆₆)/8          C₁₂ = U₄ − U₃ cos 4t
    U₄ = (Q₁₁ + Q₂₂ + 6 Q₁₂ − 4 Q₆₆)/8          C₁₆ = ½ U₂ sin 2t + U₃ sin 4t
    U₅ = (U₁ − U₄)/2                            C₂₆ = ½ U₂ sin 2t − U₃ sin 4t,   C₆₆ = U₅ − U₃ cos 4t.

Plies from z₀ to z₁ have A = Σ C (z₁ − z₀), B = Σ C (z₁² − z₀²)/2, D = Σ C (z₁³ − z₀³)/3. Transverse forces
Q_x, Q_y have the stresses of cylindrical bending without tension, in each ply (a + 2 b n z − b z²) Q with
n = B₁₁/A₁₁ and b = C₁₁/2(D₁₁ − n B₁₁); the shear compliance is their energy's. A single ply has S = κ G h,
κ = 5/6.
Source: Jones, Mechanics of Composite Materials (1999), 2.7, 4.2; Whitney, J. Appl. Mech. 40 (1973) 302.
"""

from collections.abc import Sequence

import numpy as np

from sheetbench.scenes.objects.orthotropy import Ply

ROUNDING = 1e-12  # of A times the thickness: a smaller B is 0
Parts = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def in_plane(ply: Ply) -> np.ndarray:
    """Return C (…, 3, 3) [Pa] of a ply over (x, y, xy)."""
    q11 = np.asarray(ply.young_1**2 / (ply.young_1 - ply.poisson_12**2 * ply.young_2))
    q22 = q11 * ply.young_2 / ply.young_1
    q12, q66, both = ply.poisson_12 * q22, ply.shear_12, q11 + q22
    u1, u4 = (3.0 * both + 2.0 * q12 + 4.0 * q66) / 8.0, (both + 6.0 * q12 - 4.0 * q66) / 8.0
    u2, u3 = 0.5 * (q11 - q22), (both - 2.0 * q12 - 4.0 * q66) / 8.0
    once, twice = u2 * np.cos(2.0 * ply.angle), u3 * np.cos(4.0 * ply.angle)
    half, skew = 0.5 * u2 * np.sin(2.0 * ply.angle), u3 * np.sin(4.0 * ply.angle)
    c11, c22, c12, c66 = u1 + once + twice, u1 - once + twice, u4 - twice, 0.5 * (u1 - u4) - twice
    return _matrix(((c11, c12, half + skew), (c12, c22, half - skew), (half + skew, half - skew, c66)))


def section(plies: Sequence[Ply], thickness: np.ndarray) -> Parts:
    """Return A (…, 3, 3) [N/m], D (…, 3, 3) [N·m], S (…, 2, 2) [N/m] and B (…, 3, 3) [N] of plies."""
    moduli = [in_plane(ply) for ply in plies]
    layers = list(zip(moduli, plies, strict=True))
    stretching, mixed, bending = (
        np.sum([c * (ply.high**n - ply.low**n) / n for c, ply in layers], axis=0) for n in (1, 2, 3)
    )
    mixed = np.where(np.abs(mixed) > ROUNDING * np.abs(stretching).max(), mixed, 0.0)
    stretched, pulled, bent = (_along(part) for part in (stretching, mixed, bending))
    neutral = pulled / stretched
    compliance, below = np.zeros((2, 2)), np.zeros(2)
    for c, ply in layers:
        b = _along(c) / (2.0 * (bent - neutral * pulled))
        a = below + b * (ply.low - 2.0 * neutral) * ply.low
        stress = np.stack([a, 2.0 * b * neutral, -b], axis=-1)
        powers = np.array([[(ply.high**n - ply.low**n) / n for n in range(m, m + 3)] for m in (1, 2, 3)])
        compliance = compliance + stress @ powers @ stress.swapaxes(-1, -2) * _shear_compliance(ply)
        below = stress @ [1.0, ply.high, ply.high**2]
    h = np.asarray(thickness)[..., None, None]
    return h * stretching, h**3 * bending, h * np.linalg.inv(compliance), h**2 * mixed


def _along(form: np.ndarray) -> np.ndarray:
    """Return the entries 11 and 22 (…, 2) of forms (…, 3, 3)."""
    return np.diagonal(form, axis1=-2, axis2=-1)[..., :2]


def _shear_compliance(ply: Ply) -> np.ndarray:
    """Return the compliance of transverse shear along x and y (…, 2, 2) [1/Pa]."""
    mean = 0.5 * (1.0 / ply.shear_13 + 1.0 / ply.shear_23)
    half_difference = 0.5 * (1.0 / ply.shear_13 - 1.0 / ply.shear_23)
    once, mixed = half_difference * np.cos(2.0 * ply.angle), half_difference * np.sin(2.0 * ply.angle)
    return _matrix(((mean + once, mixed), (mixed, mean - once)))


def _matrix(rows: Sequence[Sequence[np.ndarray]]) -> np.ndarray:
    """Return the matrices (…, k, k) of entries (…)."""
    return np.stack([np.stack(np.broadcast_arrays(*row), axis=-1) for row in rows], axis=-2)
