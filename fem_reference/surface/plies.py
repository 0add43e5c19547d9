"""Stiffness of sheets with fibres: orthotropic plies at angles, one or several through the thickness.

The stiffness in a ply's own axes, in plane stress (`sheetbench.scenes.objects.orthotropy`), with ν₂₁ = ν₁₂
E₂/E₁ is

    Q = 1/(1 − ν₁₂ ν₂₁) [[E₁, ν₁₂ E₂, 0], [ν₁₂ E₂, E₂, 0], [0, 0, (1 − ν₁₂ ν₂₁) G₁₂]],    C = Tᵀ Q T,

T(θ) the matrix from strains [xx, yy, 2xy] to [11, 22, 2·12]. Classical lamination theory of plies from z₀ to
z₁ has

    A = Σ C (z₁ − z₀),    B = Σ C (z₁² − z₀²)/2,    D = Σ C (z₁³ − z₀³)/3,

and the transverse shear has the energy of the shear stresses in balance with cylindrical bending along x and
along y, τ_xz = g_x Q_x with g_x = −∫ C₁₁ (z − B₁₁/A₁₁) dz/(D₁₁ − B₁₁²/A₁₁) from the lower face up, and g_y
with C₂₂, A₂₂, B₂₂, D₂₂:

    S⁻¹ = ∫ diag(g) G⁻¹ diag(g) dz,

which is 5/6 h G of a single ply.
Sources: Jones, Mechanics of Composite Materials (1999), 2.6 and 4.2; Whitney, J. Appl. Mech. 40 (1973) 302.
"""

from collections.abc import Sequence

import numpy as np

from fem_reference.surface.biquadratic import IN_PLANE, IN_SPACE, pulled_back
from sheetbench.scenes.objects.orthotropy import Ply

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(3)  # exact for g², of the fourth power


def _turned(stiffness: np.ndarray, angle: np.ndarray, pairs: Sequence[tuple[int, int]]) -> np.ndarray:
    """Return the stiffness by x, y, z from the stiffness in a ply's axes, of strains by pairs of axes."""
    c, s = np.cos(angle), np.sin(angle)
    axes = np.zeros((*c.shape, 3, 3), c.dtype)
    axes[..., 0, 0] = axes[..., 1, 1] = c
    axes[..., 1, 0], axes[..., 0, 1], axes[..., 2, 2] = s, -s, 1.0
    turn = pulled_back(axes, pairs)  # from strains in x, y, z to strains in the ply's axes
    return np.asarray(turn.swapaxes(-1, -2) @ stiffness @ turn)


def plane_stress(ply: Ply) -> np.ndarray:
    """Return C (…, 3, 3) [Pa]: stress [xx, yy, xy] of strain [xx, yy, 2xy]."""
    constants = ply.young_1, ply.young_2, ply.poisson_12, ply.shear_12, ply.angle
    e1, e2, nu, g, angle = np.broadcast_arrays(*constants)
    stiffness = np.zeros((*e1.shape, 3, 3), np.result_type(float, *constants))
    determinant = 1.0 - nu**2 * e2 / e1
    stiffness[..., 0, 0], stiffness[..., 1, 1], stiffness[..., 2, 2] = e1 / determinant, e2 / determinant, g
    stiffness[..., 0, 1] = stiffness[..., 1, 0] = nu * e2 / determinant
    return _turned(stiffness, angle, IN_PLANE)


def shear_moduli(ply: Ply) -> np.ndarray:
    """Return G (…, 2, 2) [Pa]: stress [xz, yz] of strain [2xz, 2yz]."""
    g13, g23, angle = np.broadcast_arrays(ply.shear_13, ply.shear_23, ply.angle)
    return _turned(np.stack([g13, g23], axis=-1)[..., None] * np.eye(2), angle, ((0, 2), (1, 2)))


def section(plies: Sequence[Ply], thickness: float | np.ndarray) -> tuple[np.ndarray, ...]:
    """Return A (…, 3, 3) [N/m], D (…, 3, 3) [N·m], S (…, 2, 2) [N/m] and B (…, 3, 3) [N] of a sheet's plies.
    thickness: of the sheet (…) [m]."""
    moduli = [plane_stress(ply) for ply in plies]
    forms = stretching, mixed, bending = [
        sum(c * (ply.high**n - ply.low**n) / n for c, ply in zip(moduli, plies, strict=True))
        for n in (1, 2, 3)
    ]
    stretched, pulled, rigidity = (np.diagonal(one, axis1=-2, axis2=-1)[..., :2] for one in forms)
    neutral = pulled / stretched
    rigidity = rigidity - neutral * pulled
    compliance = np.zeros((*rigidity.shape, 2), rigidity.dtype)
    shear_flow = np.zeros_like(rigidity)  # g at the ply's lower face
    for c, ply in zip(moduli, plies, strict=True):
        moduli_xy = np.diagonal(c, axis1=-2, axis2=-1)[..., :2]
        soft, half = np.linalg.inv(shear_moduli(ply)), 0.5 * (ply.high - ply.low)
        for point, weight in zip(_POINTS, _WEIGHTS, strict=True):
            at = ply.low + half * (1.0 + point)
            g = shear_flow - moduli_xy * (0.5 * (at + ply.low) - neutral) * (at - ply.low) / rigidity
            compliance = compliance + weight * half * g[..., :, None] * soft * g[..., None, :]
        middle, depth = 0.5 * (ply.high + ply.low), ply.high - ply.low
        shear_flow = shear_flow - moduli_xy * (middle - neutral) * depth / rigidity
    h = np.asarray(thickness)[..., None, None]
    return h * stretching, h**3 * bending, h * np.linalg.inv(compliance), h**2 * mixed


def in_space(ply: Ply) -> np.ndarray:
    """Return the stiffness (…, 6, 6) [Pa] of stress [xx, yy, zz, xy, yz, xz], shears of strain
    engineering."""
    e1, e2, e3, n12, n13, n23, g12, g13, g23, angle = np.broadcast_arrays(*map(np.float64, ply[2:-1]))
    soft = np.zeros((*e1.shape, 6, 6))
    for place, modulus in enumerate((e1, e2, e3, g12, g23, g13)):
        soft[..., place, place] = 1.0 / modulus
    for (a, b), mixed in (((0, 1), n12 / e1), ((0, 2), n13 / e1), ((1, 2), n23 / e2)):
        soft[..., a, b] = soft[..., b, a] = -mixed
    return _turned(np.linalg.inv(soft), angle, IN_SPACE)
