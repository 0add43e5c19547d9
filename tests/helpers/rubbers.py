"""Materials of every law of strain."""

from sheetbench.scenes import Material

CONSTANTS = {
    "mooney-rivlin": {"c1": 0.3, "c2": 0.1},
    "yeoh": {"c1": 0.3, "c2": -0.02, "c3": 0.004},
    "gent": {"shear": 0.6, "limit": 10.0},
}
LEAST = 0.35  # of Poisson's ratio, where laws with these constants begin


def material(law: str, poisson: float = 0.3, young: float = 2.0) -> Material:
    """A material with this law, of density 1; ν is raised to where its law begins."""
    if law not in CONSTANTS:
        return Material(young=young, poisson=poisson, density=1.0)
    found = Material(law=law, poisson=max(poisson, LEAST), density=1.0, **CONSTANTS[law])
    return found.replace(young=young)
