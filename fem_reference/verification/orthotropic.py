"""Sheets with fibres: plates by Navier's series, frequencies, a laminate, and a strip pulled off its axes.

Thin square plates, simply supported, fibres along their sides, deflect by

    w = 16 q/π⁶ Σ sin(mπ/2) sin(nπ/2)/(m n Δ),   Δ = (D₁₁ m⁴ + 2 (D₁₂ + 2 D₆₆) m² n² + D₂₂ n⁴)/a⁴,  m, n odd

in the middle under a uniform load q, and have the frequencies ω = π² √(Δ/ρh), m, n any. With the laminate
[0/90]s D₁₁ and D₂₂ are those of its layers: the outer ones, along x, have 7/8 of the second moment. A long
strip with fibres at θ, pulled, is as stiff as 1/E_x = c⁴/E₁ + (1/G₁₂ − 2 ν₁₂/E₁) s² c² + s⁴/E₂.
Sources: Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells (1959), 85; Leissa, Vibration of
Plates, NASA SP-160 (1969), 9.1; Reddy, Mechanics of Laminated Composite Plates and Shells (2004), 5.2; Jones,
Mechanics of Composite Materials (1999), 2.8.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from math import cos, pi, sin, sqrt
from typing import Any

from fem_reference.verification.natural_frequencies import lowest
from fem_reference.verification.rows import EXACT, Row, relatively
from fem_reference.verification.specimens import around, moved, specimen
from fem_reference.vibration import modes
from sheetbench.scenes import EDGES, Clamped, EdgeLoad, Hinged, Layer, Material, Sheet

STATIC, FREQUENCIES = 5e-3, 1e-2  # tolerances
ELEMENTS = 16
E1, E2, NU, G = 25e9, 1e9, 0.25, 0.5e9  # Reddy's, of unidirectional plies, in one of his sizes
MATERIAL = Material.model_validate(
    {"kind": "orthotropic", "young_1": E1, "young_2": E2, "poisson_12": NU, "shear_12": G, "density": 1500.0}
)
THIN = Sheet(length_x=1.0, length_y=1.0, thickness=1e-3)
SOURCE = "Navier's series, Timoshenko & Woinowsky-Krieger 1959"
LAMINATE = "Navier's series of the laminate, Reddy 2004"
SMALL = 1e-4  # deflection over the thickness
LAYERS = tuple(Layer(2.5e-4, angle=angle) for angle in (0.0, pi / 2, pi / 2, 0.0))


def _rigidities(outer: float) -> tuple[float, float, float]:
    """D11, D12 + 2 D66 and D22 [N·m] of THIN, of which the outer layers, along x, have this share."""
    moment, left = THIN.thickness**3 / 12.0, 1.0 - NU**2 * E2 / E1
    mixed = NU * E2 / left + 2.0 * G
    return tuple(moment * c for c in (  # type: ignore[return-value]
        (outer * E1 + (1.0 - outer) * E2) / left, mixed, (outer * E2 + (1.0 - outer) * E1) / left
    ))  # fmt: skip


def _delta(outer: float, m: int, n: int) -> float:
    d1, d3, d2 = _rigidities(outer)
    return d1 * m**4 + 2.0 * d3 * m**2 * n**2 + d2 * n**4


def _rows(layers: tuple[Layer, ...], outer: float, source: str) -> Iterator[Row]:
    """w D22/(q a⁴) in the middle, of the plate and of the shell under so small a load that it is linear, and
    their first six frequencies [Hz]."""
    terms = (
        sin(m * pi / 2) * sin(n * pi / 2) / (m * n * _delta(outer, m, n))
        for m, n in product(range(1, 80, 2), repeat=2)
    )
    unit = 16.0 / pi**6 * sum(terms)
    load, scale = SMALL * THIN.thickness / unit, _rigidities(outer)[2]
    inertia = MATERIAL.density * THIN.thickness
    exact = sorted(0.5 * pi * sqrt(_delta(outer, *mn) / inertia) for mn in product(range(1, 12), repeat=2))
    for model in ("plate", "shell"):
        hard: dict[str, Any] = {"hard_edges": tuple(EDGES)} if model == "plate" else {}
        mesh = f"{model} {ELEMENTS} × {ELEMENTS}"
        scene = specimen(THIN, MATERIAL, around(Hinged), load, layers=layers)
        middle = moved(scene, (0.5, 0.5), model, ELEMENTS, **hard)[2]
        yield relatively("w D22/qa⁴", mesh, unit * scale, source, middle / load * scale, STATIC)
        found = modes(scene, model, ELEMENTS, count=6).frequencies
        yield from lowest("mode {} [Hz]", mesh, exact[:6], "Leissa 1969", found, FREQUENCIES)


def plate() -> Iterator[Row]:
    """A single ply, fibres along x."""
    yield from _rows((), 1.0, SOURCE)


def laminate() -> Iterator[Row]:
    """[0/90]s."""
    yield from _rows(LAYERS, 0.875, LAMINATE)


def off_axis() -> Iterator[Row]:
    """E_x/E₂ of strips with fibres at 15, 30 and 60°, from the stretch of their middle third."""
    sheet, pull = Sheet(length_x=1.0, length_y=0.04, thickness=1e-3), 1e-6 * E2 * 1e-3
    load = EdgeLoad("x1", force_per_length=(pull, 0.0, 0.0))
    for model, degrees in product(("plate", "shell"), (15, 30, 60)):
        angle = pi * degrees / 180.0
        c, s = cos(angle), sin(angle)
        exact = 1.0 / (c**4 / E1 + (1.0 / G - 2.0 * NU / E1) * s**2 * c**2 + s**4 / E2)
        scene = specimen(sheet, MATERIAL.replace(angle=angle), (Clamped("x0"),), loads=(load,))
        low, high = (moved(scene, (x, 0.02), model, (60, 4))[0] for x in (0.4, 0.7))
        found = pull / sheet.thickness * 0.3 / (high - low)
        yield relatively(f"E_x/E2 at {degrees}°", f"{model} 60 × 4", exact / E2, EXACT, found / E2, STATIC)
