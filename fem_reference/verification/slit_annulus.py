"""Annular plate slit along a radius, one side of the slit clamped and the other lifted.

E 21e6, ν 0, radii 6 and 10, thickness 0.03, force 0.8 per length of the lifted side, which rises nearly as
high as the plate is wide. A and B are the inner and the outer end of the lifted side.
Source: Sze, Liu & Lo, Finite Elements in Analysis and Design 40 (2004) 1551–1569, section 3.3.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from skfem import MeshQuad2

from fem_reference.discrete.answer import solve_on
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.verification.rows import Row, curve
from fem_reference.verification.specimens import mapped, specimen
from sheetbench.answers.solution import Status
from sheetbench.scenes import Clamped, EdgeLoad, Material, Sheet

TOLERANCE = 5e-3
RADIAL, AROUND = 6, 48
FORCE = 0.8
SOURCE = "Sze, Liu & Lo 2004, 3.3"
PUBLISHED = {
    0.1: (4.277, 5.876),
    0.25: (7.602, 10.288),
    0.5: (10.468, 13.768),
    0.75: (12.310, 15.842),
    1.0: (13.891, 17.528),
}


def rows() -> Iterator[Row]:
    """Rise of both ends of the lifted side at each share of the force."""
    names, mesh = ("w_A at P = {:g} P_max", "w_B at P = {:g} P_max"), f"shell {RADIAL} × {AROUND}"
    yield from curve(names, mesh, PUBLISHED, SOURCE, TOLERANCE, rise, RADIAL, half_at=min(PUBLISHED))


def rise(share: float, radial: int) -> np.ndarray:
    """w (2,) [m] of the inner and the outer end of the lifted side."""
    sheet, material = Sheet(20.0, 20.0, 0.03), Material(young=21e6, poisson=0.0, density=1.0)
    lift = EdgeLoad(edge="y0", force_per_length=(0.0, 0.0, FORCE * share))
    scene = specimen(sheet, material, (Clamped(edge="y1"),), loads=(lift,))
    mesh = annulus(radial, radial * AROUND // RADIAL)
    solution = solve_on(DiscreteShell, mesh, scene)
    if solution.status is not Status.CONVERGED:
        return np.full(2, np.nan)
    lifted = np.unique(mesh.facets[:, mesh.boundaries["y0"]])
    ends = lifted[np.argsort(np.hypot(*mesh.p[:, lifted]))[[0, -1]]]
    return solution.mesh.point_data["displacement"][ends, 2]


def annulus(radial: int, around: int) -> MeshQuad2:
    """Radii 6 to 10, the sides of the slit along θ = 0 named y0 (θ = 0) and y1 (θ = 2π)."""
    radii, angles = np.linspace(6.0, 10.0, radial + 1), np.linspace(0.0, 2.0 * np.pi, around + 1)
    sides = {"y0": (1, 0.0), "y1": (1, 2.0 * np.pi)}
    return mapped(radii, angles, lambda r, turn: (r * np.cos(turn), r * np.sin(turn)), sides)
