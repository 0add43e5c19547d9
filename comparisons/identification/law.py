"""The effect of the law of strain on values that were found with a shell or solid.

Beyond a percent of stretch laws of strain carry different forces at the same E (docs/strain-laws.md): the E
that explains a measurement is that of the law.
"""

from __future__ import annotations

from fem_reference.pulled_strip import curving, laws_of
from sheetbench.choices import STRAIN_LAW
from sheetbench.scenes import Scene
from sheetbench.scenes.summary import few

NOTED = 0.01  # share of the force from which on it is reported
RUBBERS = "neo-hookean"


def law_note(scene: Scene, law: str | None, stretch: float | None) -> list[str]:
    """Return a sentence where laws of strain differ at the largest stretch of the sheet with the values
    found."""
    material = scene.material
    own = law or material.law or STRAIN_LAW
    differences = {name: abs(curving(own, material) - curving(name, material)) for name in laws_of(material)}
    other = max(differences, key=lambda name: differences[name])
    off = differences[other] * (stretch or 0.0)
    if off <= NOTED:
        return []
    remedy = (
        ""
        if own in (RUBBERS, material.law)
        else f"; of soft silicones, which are rubbers, take --law {RUBBERS}"
    )
    return [
        f"values are those of the law {own}: at {few(100.0 * (stretch or 0.0))} % stretch, as here, the "
        f"force of {other} is some {few(100.0 * off)} % another{remedy}"
    ]
