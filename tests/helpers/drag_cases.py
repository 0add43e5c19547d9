"""Sheets in air with closed forms: one that falls flat, one that swings in a mode.

Falling from rest, m dv/dt = m g − ½ ρ c_d A v² gives v = V tanh(g t/V) with V² = 2 m g/(ρ c_d A), and the
sheet has fallen by V²/g ln cosh(g t/V). In a mode φ of frequency ω and modal mass M = ∫ ρ_s h φ² dA an
amplitude a has the energy ½ M ω² a², and the mean power taken is ½ ρ c_d B (a ω)³ times that of |cos³|, 4/3π:

    d(1/a)/dt = (4/3π) ω ½ ρ c_d B/M,   B = ∫ |φ|³ dA.
"""

import numpy as np

from sheetbench.scenes import Air, Scene, load

G = 9.81
SHEET = load("one-edge-clamped")
PER_AREA = SHEET.material.density * SHEET.sheet.thickness
DENSE = Air(drag=1.2, density=500.0)
TERMINAL = float(np.sqrt(PER_AREA * G / DENSE.coefficient))
FALL = 2.0 * TERMINAL / G  # s, in which it reaches 96 % of that


def falling() -> Scene:
    return SHEET.replace(supports=(), air=DENSE)


def fallen(time: np.ndarray) -> np.ndarray:
    """Displacement of every point [m]."""
    return -(TERMINAL**2) / G * np.log(np.cosh(G * time / TERMINAL))
