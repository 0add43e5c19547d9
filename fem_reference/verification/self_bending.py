"""Sheets that are not flat at rest: a quarter turn, a heated plate's buckling, a stretched plate's frequency.

arc         a cantilever of natural curvature k0, ¼ turn: tip at (sin kL/k, (1 − cos kL)/k), no energy
buckling    a square hinged all round, heated: e0 = π² h²/6 (1 + ν) a² (Kirchhoff)
frequency   the same stretched by N: ω² = (D q² + N q)/ρh, q = 2π²/a²
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fem_reference.linear_buckling import buckling
from fem_reference.shell.statics import solve
from fem_reference.verification.rows import EXACT, Row, relatively
from fem_reference.vibration import modes
from sheetbench.scenes import Clamped, Hinged, Material, Scene, Sheet, Support
from sheetbench.scenes.objects.natural import Natural

YOUNG, POISSON, DENSITY = 1e6, 0.3, 1e3
LENGTH, THICKNESS = 0.2, 0.002
KIRCHHOFF = "Kirchhoff's plate"


def rows() -> Iterator[Row]:
    """The rows of a case."""
    k, mesh = 0.5 * np.pi / LENGTH, "16 × 8"
    curled = _scene(0.5 * LENGTH, THICKNESS, Natural(curvature=(k, 0.0, 0.0)), Clamped(edge="x0"))
    tip = solve(curled, (16, 8)).displacement(np.array([[LENGTH, 0.25 * LENGTH]]))[0]
    yield relatively("ux of the tip of a quarter turn [m]", mesh, 1.0 / k - LENGTH, EXACT, tip[0], 1e-6)
    yield relatively("uz of the tip of a quarter turn [m]", mesh, 1.0 / k, EXACT, tip[2], 1e-6)
    hinges = [Hinged(edge=edge) for edge in ("x0", "x1", "y0", "y1")]
    strain = np.pi**2 * THICKNESS**2 / (6.0 * (1.0 + POISSON) * LENGTH**2)
    heated = _scene(LENGTH, THICKNESS, Natural((strain, strain, 0.0)), *hinges)
    found = float(buckling(heated, "shell", 12).load_factors[0]) * strain
    yield relatively("strain that buckles a heated plate", "12 × 12", strain, KIRCHHOFF, found, 0.012)
    h, tension, q = THICKNESS / 8.0, 0.05, 2.0 * np.pi**2 / LENGTH**2
    stretched = _scene(LENGTH, h, Natural(pretension=(tension, tension)), *hinges)
    rigidity = YOUNG * h**3 / (12.0 * (1.0 - POISSON**2))
    exact = np.sqrt((rigidity * q**2 + tension * q) / (DENSITY * h)) / (2.0 * np.pi)
    lowest = float(modes(stretched, "shell", 8, 1, about="deformed").frequencies[0])
    yield relatively("frequency of a stretched plate [Hz]", "8 × 8", exact, KIRCHHOFF, lowest, 1e-3)


def _scene(width: float, thickness: float, natural: Natural, *supports: Support) -> Scene:
    sheet = Sheet(length_x=LENGTH, length_y=width, thickness=thickness)
    material = Material(young=YOUNG, poisson=POISSON, density=DENSITY)
    return Scene(name="self-bending", sheet=sheet, material=material, supports=supports, natural=natural)
