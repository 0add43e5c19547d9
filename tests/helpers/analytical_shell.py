"""Published and closed-form values that only the tests of the shell read."""

import numpy as np

# Converged values of the seed's sheet at E = 54.5 MPa, mm: this project's own. CalculiX (C3D20R, 24 × 24 × 2)
# has −13.504 at P4 of the first.
SEED = {
    "two-edges-clamped": {
        ("P1", 2): -2.456, ("P2", 2): -6.102, ("P4", 2): -13.504, ("P4", 0): -0.405, ("P4", 1): -0.405
    },
    "one-edge-clamped": {
        ("P1", 2): -17.10, ("P2", 2): -16.51, ("P3", 2): -48.04, ("P4", 2): -47.64, ("P3", 0): -7.19
    },
}  # fmt: skip

# Sze, Liu & Lo (2004), 3.1: P/P_max → −u, w at the tip.
END_SHEAR = {0.25: (0.563, 3.015), 0.5: (1.604, 4.933), 0.75: (2.541, 6.031), 1.0: (3.286, 6.698)}

# Sze, Liu & Lo (2004), 3.3: share of the line load → w at the inner and the outer end of the lifted side.
SLIT_ANNULUS = {
    0.1: (4.277, 5.876), 0.25: (7.602, 10.288), 0.5: (10.468, 13.768),
    0.75: (12.310, 15.842), 1.0: (13.891, 17.528),
}  # fmt: skip

# Heavy elastica: qL³/EI → w/L, u/L.
HEAVY_ELASTICA = {
    0.5: (0.06231, 0.00222), 1: (0.12347, 0.00875), 2: (0.23851, 0.03311),
    5: (0.49591, 0.15334), 10: (0.70020, 0.34365), 20: (0.82988, 0.55477),
}  # fmt: skip

# Mindlin square plate clamped all round, uniform load, ν 0.3: h/L → w_centre D/(q L⁴).
CLAMPED_PLATE = {1e-5: 0.0012653, 0.001: 0.0012653, 0.1: 0.001505, 0.2: 0.002172}


def rolled_up(length: float, rigidity: float, moment: float) -> tuple[float, float]:
    """u, w of the tip of an inextensible strip under an end moment: a circle of curvature M/EI."""
    angle = moment * length / rigidity
    return rigidity / moment * np.sin(angle) - length, rigidity / moment * (1 - np.cos(angle))
