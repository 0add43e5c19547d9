"""Materials of every law of strain."""

from typing import Any

import numpy as np

from sheetbench.scenes import Material

LAWS: dict[str, dict[str, float]] = {
    "neo-hookean": {"young": 1e6},
    "mooney-rivlin": {"c1": 1.5e5, "c2": 2e4},
    "yeoh": {"c1": 1.7e5, "c2": -2e3, "c3": 60.0},
    "gent": {"shear": 3.4e5, "limit": 60.0},
}

CONSTANTS = {
    "mooney-rivlin": {"c1": 0.3, "c2": 0.1},
    "yeoh": {"c1": 0.3, "c2": -0.02, "c3": 0.004},
    "gent": {"shear": 0.6, "limit": 10.0},
}
LEAST = 0.35  # of Poisson's ratio, where laws with these constants begin


def rubber(law: str, poisson: float = 0.45, **other: Any) -> Material:
    """Return a rubber of about 1 MPa at small strains."""
    return Material(law=law, poisson=poisson, density=1000.0, **{**LAWS[law], **other})


def material(law: str, poisson: float = 0.3, young: float = 2.0) -> Material:
    """Return a material with this law, of density 1; ν is raised to the law's least."""
    if law not in CONSTANTS:
        return Material(young=young, poisson=poisson, density=1.0)
    found = Material(law=law, poisson=max(poisson, LEAST), density=1.0, **CONSTANTS[law])
    return found.replace(young=young)


def stored(material: Material, stretches: np.ndarray) -> Any:
    """Return W [Pa] of principal stretches (…, 3), by the formulas of `scenes.objects.material`."""
    squares = stretches**2
    first, third = squares.sum(-1) - 3.0, np.log(stretches).sum(-1)
    second = 0.5 * (squares.sum(-1) ** 2 - (squares**2).sum(-1)) - 3.0
    e, x = material.energy, first
    f = e.c10 * x + e.c20 * x**2 + e.c30 * x**3
    if e.limit:
        f = -e.c10 * e.limit * np.log(1.0 - x / e.limit)
    return f + e.c01 * second - (2 * e.c10 + 4 * e.c01) * third + 0.5 * e.volume(material.poisson) * third**2
