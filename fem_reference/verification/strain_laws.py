"""A strip pulled one way and two ways, under each law of strain: closed forms.

    P/E at a stretch ε = λ − 1      one way                        the same both ways
    Biot                            ε                              ε/(1 − ν)
    St Venant–Kirchhoff             ½ λ (λ² − 1)                   ½ λ (λ² − 1)/(1 − ν)
    neo-Hooke                       (μ/E) (λ − λ_t²/λ)             (μ/E) (λ − λ_t²/λ)

with P the force per area of the unstrained section and λ_t the stretch across, through the thickness too:
μ (λ_t² − 1) + λ_L ln J = 0, J = λ λ_t² one way and λ² λ_t both ways. The strip is loaded by P, and the
stretch that it shows is held to ε. P = E ε (1 + c ε + …) one way, with c of `pulled_strip.curving`.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import log

import numpy as np
from scipy.optimize import brentq

from fem_reference import solve
from fem_reference.pulled_strip import MATERIAL, SHEET, pulled
from fem_reference.verification.rows import EXACT, Row, relatively
from sheetbench.choices import STRAIN_LAWS

STRAINS = (0.001, 0.01, 0.1)
WAYS = {"one way": 1, "both ways": 2}
MODELS = ("shell", "solid")
TOLERANCE = 1e-6


def rows(case: str) -> Iterator[Row]:
    """The stretch of each model under each law, at the force of the closed form."""
    for model in MODELS:
        for law in STRAIN_LAWS:
            for way in WAYS:
                for strain in STRAINS:
                    quantity = f"{law}, {way}: stretch at P/E = {stress(law, way, strain):.6f}"
                    found = _stretch(model, law, way, strain)
                    yield relatively(case, quantity, f"{model} 2", strain, EXACT, found, TOLERANCE)


def stress(law: str, way: str, strain: float, poisson: float = MATERIAL.poisson) -> float:
    """P/E of a law at a stretch, pulled in one of the `WAYS`."""
    ways, stretch = WAYS[way], 1.0 + strain
    if law == "neo-hookean":
        shear, bulk = 0.5 / (1.0 + poisson), poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
        across = brentq(
            lambda t: shear * (t**2 - 1.0) + bulk * log(stretch**ways * t ** (3 - ways)), 0.1, 4.0, xtol=1e-15
        )
        return shear * (stretch - across**2 / stretch)
    elongation = strain if law == "biot" else 0.5 * stretch * (stretch**2 - 1.0)
    return elongation if ways == 1 else elongation / (1.0 - poisson)


def _stretch(model: str, law: str, way: str, strain: float) -> float:
    pull = stress(law, way, strain) * MATERIAL.young * SHEET.thickness
    scene = pulled((pull, pull if way == "both ways" else 0.0))
    moved = solve(scene, model, elements=2, law=law).displacement(np.array([SHEET.lengths]))
    return float(moved[0, 0]) / SHEET.length_x
