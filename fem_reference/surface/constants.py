"""Constants of a sheet at the Gauss points as values by name; sections and laws of them, derivatives by them.

Derivatives are complex steps, ∂f/∂c = Im f(c + iε)/ε, which have no difference to cancel and are exact to
rounding: section and laws take complex constants like real ones, so that a law brings its derivatives
with its stress. Source: Squire and Trapp, SIAM Review 40 (1998) 110.
"""

from collections.abc import Callable, Iterable
from types import SimpleNamespace
from typing import Any

import numpy as np

from fem_reference.surface.biquadratic import AT_GAUSS
from fem_reference.surface.materials import Section, constants_of, grown, section_of, stretched
from sheetbench.scenes import Constants, Scene
from sheetbench.scenes.meaning.natural_state import natural_at
from sheetbench.scenes.objects.cells import NUMBERS
from sheetbench.scenes.objects.material import WORDS
from sheetbench.scenes.objects.orthotropy import Ply

Values = dict[str, Any]  # numbers, or (m, 9)
STRAIN, LAW = ("exx", "eyy", "exy"), "law"
TINY = 1e-30


def values_of(scene: Scene, corners: np.ndarray, natural: bool) -> Values:
    """Return the constants of a scene's sheet at the Gauss points of elements with nodes (m, 9, 2) [m].
    Constants of plies have the ply's number in front, a rubber's the keys of its law; natural: with the
    natural strain."""
    constants = constants_of(scene, corners)
    values: Values = {"thickness": constants.thickness}
    if not constants.plies:
        values |= {name: getattr(constants, name) for name in NUMBERS}
    for number, ply in enumerate(constants.plies):
        values |= {f"{number}.{name}": value for name, value in ply._asdict().items()}
    if law := WORDS.get(scene.material.law or ""):
        values |= {LAW: scene.material.law} | scene.material.given(law.keys)
    state = natural_at(stretched(scene), AT_GAUSS[0] @ corners) if natural else None
    if state is not None and (strain := state.at()[0]).any():
        values |= dict(zip(STRAIN, (strain[..., 0, 0], strain[..., 1, 1], strain[..., 0, 1]), strict=True))
    return values


def constants_with(values: Values) -> Constants:
    """Return `Constants` with the given values."""
    count = sum(name.endswith(".low") for name in values)
    plies = tuple(Ply(*(values[f"{number}.{name}"] for name in Ply._fields)) for number in range(count))
    return Constants(plies=plies, **{name: values.get(name) for name in NUMBERS})


def section_with(values: Values) -> Section:
    """Return the section of a sheet with the given values, per area and strain of the drawn sheet."""
    constants = constants_with(values)
    section = section_of(constants, constants.thickness)
    if STRAIN[0] not in values:
        return section
    xx, yy, xy = (values[name] for name in STRAIN)
    return grown(section, np.moveaxis(np.array([[xx, xy], [xy, yy]]), (0, 1), (-2, -1)))


def material_with(values: Values) -> Any:
    """Return an object with the young, poisson and energy of the given values, as argument of a law."""
    material = SimpleNamespace(young=values["young"], poisson=values["poisson"])
    if LAW in values:
        keys, energy = WORDS[values[LAW]]
        material.energy = energy(*(values[key] for key in keys))
    return material


def by_values(
    function: Callable[[Values], np.ndarray], values: Values, names: Iterable[str] = ()
) -> dict[str, np.ndarray]:
    """Return the derivatives of a function of constants by the constants, by all or by the given names."""

    def derivative(name: str) -> np.ndarray:
        return np.asarray(function({**values, name: values[name] + 1j * TINY}).imag / TINY)

    return {name: derivative(name) for name in names or values if name != LAW}
