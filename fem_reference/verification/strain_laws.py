"""Strip pulled one way, sheared purely and pulled both ways, under each law of strain: closed forms.

    P/E at a stretch ε = λ − 1      one way                        both ways: over 1 − ν, sheared: over 1 − ν²
    Biot                            ε                              ε
    St Venant–Kirchhoff             ½ λ (λ² − 1)                   ½ λ (λ² − 1)

P is the force per area of the unstrained section; a sheared strip keeps its width. A rubber
(`sheetbench.scenes.objects.material`) with the stretches (λ, t, t), (λ, 1, t) or (λ, λ, t) has

    P_i = 2 λ_i (f′ + c₀₁ (I₁ − λ_i²)) + (Λ ln J − m)/λ_i

and P = 0 along t. The strip is loaded by P, and its stretch compared with ε; a rubber strip is held at λ =
0.7, 1.5 and 2, and its force compared with P.
"""

from collections.abc import Iterator, Mapping
from itertools import product
from math import log
from typing import Any

import numpy as np
from scipy.optimize import brentq

from fem_reference.discrete.static import Static, StaticState
from fem_reference.sheets import SHEETS
from fem_reference.shell.laws import LAWS as SHELL_LAWS
from fem_reference.solid.materials import LAWS as SOLID_LAWS
from fem_reference.verification.rows import EXACT, Row, relative_row
from fem_reference.verification.specimens import u_at
from sheetbench.choices import STRAIN_LAWS
from sheetbench.scenes import EdgeLoad, Held, Material, Scene, Sheet

SHEET = Sheet(length_x=0.2, length_y=0.1, thickness=0.01)
MATERIAL = Material(young=1e6, poisson=0.3, density=1000.0)
STRAINS = (0.001, 0.01, 0.1)
WAYS = ("one way", "both ways")
LAWS: dict[str, Mapping[str, Any]] = {"shell": SHELL_LAWS, "solid": SOLID_LAWS}
MODELS = tuple(LAWS)
TOLERANCE = 1e-6
LARGE = (-0.3, 0.5, 1.0)
TO_ROUNDING = 1e-9
RUBBERS = [
    Material.model_validate({"law": law, **constants, "poisson": 0.49, "density": 1000.0})
    for law, constants in {
        "neo-hookean": {"young": 1e6},
        "mooney-rivlin": {"c1": 0.16e6, "c2": 0.04e6},
        "yeoh": {"c1": 0.19e6, "c2": -2e3, "c3": 100.0},
        "gent": {"shear": 0.35e6, "limit": 30.0},
    }.items()
]


def rows() -> Iterator[Row]:
    """Yield the stretch of each model under each law, at the force of the closed form."""
    combinations = [(model, law) for model in MODELS for law in STRAIN_LAWS if law in LAWS[model]]
    for (model, law), way, strain in product(combinations, WAYS, STRAINS):
        pull = stress(law, way, strain)
        force = pull * MATERIAL.young * SHEET.thickness
        scene = pulled((force, force if way == "both ways" else 0.0))
        computed = u_at(scene, SHEET.lengths, model, 2, law=law)[0] / SHEET.length_x
        quantity = f"{law}, {way}: stretch at P/E = {pull:.6f}"
        yield relative_row(quantity, f"{model} 2", strain, EXACT, computed, TOLERANCE)


def rubbers() -> Iterator[Row]:
    """Yield the force that holds each model of each rubber, stretched one way, sheared and both ways."""
    for material, way, strain, model in product(RUBBERS, (*WAYS, "sheared"), LARGE, MODELS):
        law = str(material.law)
        quantity = f"{law}, {way}: P/E at a stretch of {100.0 * strain:g} %"
        computed = _held(model, material, stretches(law, way, strain, material)) / material.young
        expected = stress(law, way, strain, material)
        yield relative_row(quantity, f"{model} 1", expected, EXACT, computed, TO_ROUNDING)


def stress(law: str, way: str, strain: float, material: Material = MATERIAL) -> float:
    """Return P/E of a law at a stretch, pulled in one of the `WAYS` or "sheared"."""
    poisson, stretch = material.poisson, 1.0 + strain
    if law in ("biot", "st-venant-kirchhoff"):
        elongation = strain if law == "biot" else 0.5 * stretch * (stretch**2 - 1.0)
        return elongation / {"one way": 1.0, "both ways": 1.0 - poisson, "sheared": 1.0 - poisson**2}[way]
    stretched = stretches(law, way, strain, material)
    return _pull(material.replace(law=law), stretched, 0) / material.young


def stretches(law: str, way: str, strain: float, material: Material) -> list[float]:
    """Return the stretches of a rubber along x, y and z, the free ones at zero stress."""
    rubber, stretch = material.replace(law=law), 1.0 + strain

    def with_free(free: float) -> list[float]:
        return [stretch, {"one way": free, "both ways": stretch, "sheared": 1.0}[way], free]

    kept = stretch ** {"one way": -0.5, "both ways": -2.0, "sheared": -1.0}[way]  # the volume
    free = brentq(lambda t: _pull(rubber, with_free(t), 2), 0.5 * kept, 1.5 * kept, xtol=1e-15)
    return with_free(float(free))


def _pull(material: Material, stretches: list[float], axis: int) -> float:
    """Return P [Pa] of a rubber along one of its three stretches."""
    energy, along, volume = material.energy, stretches[axis], log(np.prod(stretches))
    first = sum(part**2 for part in stretches)
    x = first - 3.0
    if material.law == "gent":
        slope = 0.5 * energy.shear / (1.0 - x / energy.limit)
    else:
        slope = energy.c10 + 2.0 * energy.c20 * x + 3.0 * energy.c30 * x**2
    at_rest = 2.0 * energy.c10 + 4.0 * energy.c01
    pressure = energy.volume(material.poisson) * volume - at_rest
    return 2.0 * along * (slope + energy.c01 * (first - along**2)) + pressure / along


def pulled(pulls: tuple[float, float], sheet: Sheet = SHEET, material: Material = MATERIAL) -> Scene:
    """Return a strip free to contract, under forces per length [N/m] on x1 along x and on y1 along y."""
    held = (Held(edge="x0", components=("x", "z")), Held(edge="y0", components=("y", "z")))
    along_x = EdgeLoad(edge="x1", force_per_length=(pulls[0], 0.0, 0.0))
    along_y = EdgeLoad(edge="y1", force_per_length=(0.0, pulls[1], 0.0))
    return Scene(name="pulled", sheet=sheet, material=material, supports=held, loads=(along_x, along_y))


def _held(model: str, material: Material, stretches: list[float]) -> float:
    """Return P [Pa] that holds one element of a model of a rubber at its three stretches."""
    sheet = SHEETS[model](pulled((0.0, 0.0), SHEET, material), (1, 1), law=str(material.law))
    by, nodes = np.array(stretches) - 1.0, sheet.plan.nodes
    through = by[2] if model == "solid" else 0.0  # strain of directors; a shell's keep their length
    moved, turned = np.pad(nodes * by[:2], ((0, 0), (0, 1))), np.tile([0.0, 0.0, through], (len(nodes), 1))
    residual = Static(sheet).forces(StaticState(sheet.of_vectors(moved, turned)), 0.0).residual
    return -float(sheet.reactions(residual)["x0"][0]) / (SHEET.length_y * SHEET.thickness)
