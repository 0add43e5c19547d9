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

import numpy as np

from fem_reference import solve
from fem_reference.verification.rows import Row, relatively
from fem_reference.vibration import modes
from sheetbench.scenes import EDGES, Clamped, EdgeLoad, Gravity, Hinged, Layer, Material, Scene, Sheet

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


def _plate(layers: tuple[Layer, ...], load: float) -> Scene:
    weight = Gravity(acceleration=(0.0, 0.0, load / (MATERIAL.density * THIN.thickness)))
    supports = tuple(Hinged.model_validate({"edge": edge}) for edge in EDGES)
    return Scene(
        name="fibres", sheet=THIN, material=MATERIAL, layers=layers, supports=supports, gravity=weight
    )


def _deflections(layers: tuple[Layer, ...], outer: float, source: str) -> Iterator[Row]:
    """w D22/(q a⁴) in the middle, of the plate and of the shell under so small a load that it is linear."""
    terms = (
        sin(m * pi / 2) * sin(n * pi / 2) / (m * n * _delta(outer, m, n))
        for m, n in product(range(1, 80, 2), repeat=2)
    )
    unit = 16.0 / pi**6 * sum(terms)
    load = SMALL * THIN.thickness / unit
    scale = _rigidities(outer)[2]
    for model in ("plate", "shell"):
        hard: dict[str, Any] = {"hard_edges": tuple(EDGES)} if model == "plate" else {}
        found = solve(_plate(layers, load), model, elements=ELEMENTS, **hard)
        middle = float(found.displacement(np.array([[0.5, 0.5]]))[0, 2])
        mesh = f"{model} {ELEMENTS} × {ELEMENTS}"
        yield relatively("w D22/qa⁴", mesh, unit * scale, source, middle / load * scale, STATIC)


def plate() -> Iterator[Row]:
    """A single ply, fibres along x: deflection and the first six frequencies."""
    yield from _deflections((), 1.0, SOURCE)
    yield from _frequencies((), 1.0)


def laminate() -> Iterator[Row]:
    """[0/90]s."""
    yield from _deflections(LAYERS, 0.875, LAMINATE)
    yield from _frequencies(LAYERS, 0.875)


def _frequencies(layers: tuple[Layer, ...], outer: float) -> Iterator[Row]:
    """The first six, in Hz."""
    scene = _plate(layers, 0.0)
    inertia = MATERIAL.density * THIN.thickness
    exact = sorted(
        0.5 * pi * sqrt(_delta(outer, m, n) / inertia) for m, n in product(range(1, 12), range(1, 12))
    )
    for model in ("plate", "shell"):
        found = modes(scene, model, ELEMENTS, count=6).frequencies
        for number, (expected, computed) in enumerate(zip(exact, found, strict=False), start=1):
            mesh, quantity = f"{model} {ELEMENTS} × {ELEMENTS}", f"mode {number} [Hz]"
            yield relatively(quantity, mesh, expected, "Leissa 1969", float(computed), FREQUENCIES)


def off_axis() -> Iterator[Row]:
    """E_x/E₂ of strips with fibres at 15, 30 and 60°, from the stretch of their middle third."""
    sheet = Sheet(length_x=1.0, length_y=0.04, thickness=1e-3)
    stations = np.array([[0.4, 0.02], [0.7, 0.02]])
    pull = 1e-6 * E2 * sheet.thickness
    for model, degrees in product(("plate", "shell"), (15, 30, 60)):
        angle = pi * degrees / 180.0
        c, s = cos(angle), sin(angle)
        exact = 1.0 / (c**4 / E1 + (1.0 / G - 2.0 * NU / E1) * s**2 * c**2 + s**4 / E2)
        scene = Scene(
            name="off-axis",
            sheet=sheet,
            material=MATERIAL.replace(angle=angle),
            supports=(Clamped("x0"),),
            loads=(EdgeLoad("x1", force_per_length=(pull, 0.0, 0.0)),),
        )
        u = solve(scene, model, elements=(60, 4)).displacement(stations)[:, 0]
        found = pull / sheet.thickness * 0.3 / float(u[1] - u[0])
        quantity = f"E_x/E2 at {degrees}°"
        yield relatively(quantity, f"{model} 60 × 4", exact / E2, "exact", found / E2, STATIC)
