"""Sheets that are not flat at rest: a quarter turn, a heated plate's buckling, a stretched plate's frequency.

arc         a cantilever of natural curvature k0, ¼ turn: tip at (sin kL/k, (1 − cos kL)/k), no energy
buckling    a square hinged all round, heated: e0 = π² h²/6 (1 + ν) a² (Kirchhoff)
frequency   the same stretched by N: ω² = (D q² + N q)/ρh, q = 2π²/a²
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fem_reference.linear_buckling import buckling
from fem_reference.verification.rows import EXACT, Row, relatively
from fem_reference.verification.specimens import around, moved, specimen
from fem_reference.vibration import modes
from sheetbench.scenes import Clamped, Hinged, Material, Sheet
from sheetbench.scenes.objects.natural import Natural

MATERIAL = Material(young=1e6, poisson=0.3, density=1e3)
LENGTH, THICKNESS = 0.2, 0.002
KIRCHHOFF = "Kirchhoff's plate"


def rows() -> Iterator[Row]:
    """The rows of a case."""
    k, mesh, half = 0.5 * np.pi / LENGTH, "16 × 8", 0.5 * LENGTH
    strip, curled = Sheet(LENGTH, half, THICKNESS), Natural(curvature=(k, 0.0, 0.0))
    scene = specimen(strip, MATERIAL, (Clamped(edge="x0"),), natural=curled)
    tip = moved(scene, (LENGTH, 0.5 * half), "shell", (16, 8))
    yield relatively("ux of the tip of a quarter turn [m]", mesh, 1.0 / k - LENGTH, EXACT, tip[0], 1e-6)
    yield relatively("uz of the tip of a quarter turn [m]", mesh, 1.0 / k, EXACT, tip[2], 1e-6)
    young, poisson, hinges = MATERIAL.young, MATERIAL.poisson, around(Hinged)
    strain = np.pi**2 * THICKNESS**2 / (6.0 * (1.0 + poisson) * LENGTH**2)
    hot = Natural(strain=(strain, strain, 0.0))
    heated = specimen(Sheet(LENGTH, LENGTH, THICKNESS), MATERIAL, hinges, natural=hot)
    found = float(buckling(heated, "shell", 12).load_factors[0]) * strain
    yield relatively("strain that buckles a heated plate", "12 × 12", strain, KIRCHHOFF, found, 0.012)
    h, tension, q = THICKNESS / 8.0, 0.05, 2.0 * np.pi**2 / LENGTH**2
    pulled = Natural(pretension=(tension, tension))
    stretched = specimen(Sheet(LENGTH, LENGTH, h), MATERIAL, hinges, natural=pulled)
    rigidity = young * h**3 / (12.0 * (1.0 - poisson**2))
    exact = np.sqrt((rigidity * q**2 + tension * q) / (MATERIAL.density * h)) / (2.0 * np.pi)
    lowest = float(modes(stretched, "shell", 8, 1, about="deformed").frequencies[0])
    yield relatively("frequency of a stretched plate [Hz]", "8 × 8", exact, KIRCHHOFF, lowest, 1e-3)
