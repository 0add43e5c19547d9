"""Natural frequencies of square plates, ν 0.3: NAFEMS FV16 and FV12, and Leissa's thin plates.

NAFEMS' targets and Leissa's coefficients are upper bounds, above what plates converge to by up to 1.3 %. They
are held to 1.5 %. The converged values are this project's own, of the plate on 36 × 36 elements and more, the
thin plates' at h/a = 1e-4; where there are any, models are held to 0.3 % of them.
Sources: NAFEMS, Selected Benchmarks for Natural Frequency Analysis (1987), tests FV12 and FV16; Leissa,
The free vibration of rectangular plates, J. Sound Vib. 31 (1973) 257–293.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from fem_reference.surface.materials import bending_stiffness
from fem_reference.verification.rows import OURS, Row, mesh_change, relatively
from fem_reference.verification.specimens import around, specimen
from fem_reference.vibration import modes
from sheetbench.scenes import Clamped, Material, Scene, Sheet

CONVERGED, BOUND = 3e-3, 1.5e-2  # tolerances
ELEMENTS = 16
FINER = f"{OURS}, finer mesh"
STEEL = Material(young=200e9, poisson=0.3, density=8000.0)
NAFEMS = Sheet(length_x=10.0, length_y=10.0, thickness=0.05)
THIN = Sheet(length_x=1.0, length_y=1.0, thickness=1e-3)

COEFFICIENT = "ω a² √(ρh/D)"

Values = Sequence[float | None]


class Benchmark(NamedTuple):
    """A sheet clamped along edges and its first six frequencies; unit: "Hz" or COEFFICIENT."""

    title: str
    sheet: Sheet
    edges: tuple[str, ...]
    source: str
    unit: str
    converged: Values
    bounds: Values
    models: tuple[str, ...] = ("plate", "shell")


BENCHMARKS = {
    "nafems-fv16": Benchmark(
        "cantilevered square plate", NAFEMS, ("x0",), "NAFEMS 1987, FV16", "Hz",
        (0.4179, 1.0227, 2.5618, 3.272, 3.7214, 6.5105), (0.421, 1.029, 2.582, 3.306, 3.753, 6.555),
        ("plate", "shell", "solid"),
    ),
    "nafems-fv12": Benchmark(
        "free square plate", NAFEMS, (), "NAFEMS 1987, FV12", "Hz",
        (None, None, None, 4.182, 4.182, None), (1.622, 2.360, 2.922, 4.233, 4.233, 7.416),
    ),
    "leissa-one-edge": Benchmark(
        "thin square plate, one edge clamped", THIN, ("x0",), "Leissa 1973", COEFFICIENT,
        (3.471, 8.506, 21.28, 27.20, 30.95, 54.18), (3.492, 8.525, 21.43, 27.33, 31.11, 54.44),
    ),
    "leissa-two-edges": Benchmark(
        "thin square plate, two edges clamped", THIN, ("x0", "y0"), "Leissa 1973", COEFFICIENT,
        (6.919, 23.90, 26.58, 47.65, 62.71, 65.53), (6.942, 24.03, 26.68, 47.79, 63.04, 65.83),
    ),
}  # fmt: skip


def rows(case: str) -> Iterator[Row]:
    """Six modes of every model of a case of `BENCHMARKS`."""
    _, sheet, edges, source, unit, converged, bounds, models = BENCHMARKS[case]
    scene = specimen(sheet, STEEL, around(Clamped, edges))
    scale = 1.0 if unit == "Hz" else _coefficient(scene)
    for model in models:
        coarse, found = (scale * modes(scene, model, n, 6).frequencies for n in (ELEMENTS // 2, ELEMENTS))
        mesh = f"{model} {ELEMENTS} × {ELEMENTS}"
        yield from lowest(f"mode {{}} [{unit}], converged", mesh, converged, FINER, found, CONVERGED)
        yield from lowest(f"mode {{}} [{unit}], bound", mesh, bounds, source, found, BOUND)
        yield mesh_change(mesh, coarse, found, CONVERGED)


def lowest(
    quantity: str, mesh: str, published: Values, source: str, found: np.ndarray, tolerance: float
) -> Iterator[Row]:
    """Rows of the lowest frequencies, but for those that are not published; quantity: with a place for their
    number."""
    for number, (expected, computed) in enumerate(zip(published, found, strict=True), 1):
        if expected is not None:
            yield relatively(quantity.format(number), mesh, expected, source, computed, tolerance)


def _coefficient(scene: Scene) -> float:
    """ω a² √(ρh/D) of 1 Hz."""
    sheet, material = scene.sheet, scene.material
    rigidity = bending_stiffness(material, sheet.thickness)[0, 0]
    return 2.0 * np.pi * sheet.length_x**2 * np.sqrt(material.density * sheet.thickness / rigidity)
