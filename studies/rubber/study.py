"""Four silicones and Treloar's rubber: their laws and constants, and the error of a linear lattice.

A lattice whose links are linear in their elongation (`consistent`) has E and ν of small strains alone. It is
compared with the material's own law
    pulled      by the force at which the law is stretched by ε (a strip free to contract)
    hung        under its own weight so heavy that the law is stretched by ε where it is held; the law's
                length is the integral l = ∫ λ(ρ g s) ds
    blown up    clamped all around, by a pressure, against the shell of the material's law

Errors are of the end's displacement, of the top's where it is blown up.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

import numpy as np
from scipy.optimize import brentq

import fem_reference
import lumped
from comparisons.identification.tensile.curves import read
from comparisons.identification.tensile.laws import Fit, stress
from comparisons.identification.tensile.tensile import TensileFit, identify_tensile
from sheetbench.answers.solution import Solution, Status
from sheetbench.answers.table import MILLIMETRES, NUMBER, PERCENT, Column, TableUnit, unit
from sheetbench.errors import BadInput
from sheetbench.scenes import Clamped, EdgeLoad, Gravity, Held, Material, Pressure, Scene, Sheet

SILICONES = ("Ecoflex 00-30", "Ecoflex 00-50", "Dragon Skin 10 MEDIUM", "Dragon Skin 30")
TRELOAR = "Treloar 1944"
UP_TO = 2.5  # largest stretch of soft robots, up to which an elastomer's first law holds
STRETCHES = (0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.6)
PRESSURES = (0.01, 0.05, 0.2, 0.5)  # over E
SHEET, POISSON = Sheet(0.1, 0.05, 0.002), 0.499


@dataclass(frozen=True)
class Constant:
    """Constant of a law, with its 95 % interval."""

    material: str
    covered: Annotated[str, Column("to stretch")]  # a number would take the unit of its row
    law: str
    misfit: Annotated[float, PERCENT(".1f")]
    constant: str
    unit: TableUnit
    value: Annotated[float, NUMBER(".3g")]
    least: Annotated[float, NUMBER(".3g", "from")]
    largest: Annotated[float, NUMBER(".3g", "to")]


@dataclass(frozen=True)
class Strip:
    """Errors of a linear lattice's end, pulled or hung, by stretch."""

    material: str
    way: str
    errors: Annotated[dict[str, float], PERCENT("z.1f")]


@dataclass(frozen=True)
class Square:
    """Heights of an inflated clamped square: of the shell with its law and of a linear lattice."""

    pressure: Annotated[float, NUMBER(".3g", "p a/(E h)")]
    stretch: Annotated[float | None, PERCENT(".1f", "largest stretch")]
    shell: Annotated[float, MILLIMETRES(".3f")]
    lattice: Annotated[float, MILLIMETRES(".3f")]
    error: Annotated[float, PERCENT("z.1f")]


def curves(data: Path) -> dict[str, TensileFit]:
    """Return the fits by name, from files under `data`: to UP_TO, of Treloar's rubber to its end."""
    files = {name: data / "silicone-tensile" / f"{name}.csv" for name in SILICONES}
    treloar = data / "treloar" / "uniaxial.csv"
    for file in (*files.values(), treloar):
        if not file.is_file():
            raise BadInput(f"{file}: not there; its source and licence: docs/rubber.md")
    fits = {name: identify_tensile(read(str(file), up_to=UP_TO)) for name, file in files.items()}
    with TemporaryDirectory() as folder:
        headed = Path(folder) / "treloar.csv"
        text = treloar.read_text(encoding="utf-8").replace(",Stress", ",engineering_stress [MPa]", 1)
        headed.write_text(text, encoding="utf-8")
        return {**fits, TRELOAR: identify_tensile(str(headed))}


def constants(fits: dict[str, TensileFit]) -> Iterator[Constant]:
    """Yield a row per constant of the law that fits the data."""
    for name, fit in fits.items():
        assert fit.law is not None
        for key, value in fit.law.constants.items():
            of = unit("" if key == "limit" else "Pa")
            interval = fit.law.intervals[key]
            covered = f"{fit.covered['uniaxial'][1]:.2f}"
            yield Constant(name, covered, fit.law.law, fit.law.rms, key, of, value, *interval)


def pulled_and_hung(fits: dict[str, TensileFit]) -> Iterator[Strip]:
    """Yield a row per material and way: the error of a `consistent` lattice at each stretch."""
    for name, fit in fits.items():
        for way, error in (("pulled", pulled), ("hung", hung)):
            assert fit.law is not None
            yield Strip(name, way, {f"{100 * at:g} %": error(fit.law, at) for at in STRETCHES})


def _material(fit: Fit) -> Material:
    return Material(2.0 * (1.0 + POISSON) * fit.energy.shear, POISSON, 1000.0)


def _lattice(scene: Scene, grid: tuple[int, int] = (9, 5)) -> Solution:
    return lumped.solve(scene, lumped.calibrate(scene.sheet, scene.material, grid))


def _end(solution: Solution) -> float:
    if solution.status not in (Status.CONVERGED, Status.STRAIN_OUTSIDE_MODEL):
        return float("nan")
    return float(solution.displacement(np.array([[SHEET.length_x, SHEET.length_y / 2.0]]))[0, 0])


def _strip(fit: Fit, **acting: object) -> Scene:
    held = (Held("x0", ("x", "z")), Held("y0", ("y", "z")))
    return Scene("strip", SHEET, _material(fit), supports=held, **acting)  # type: ignore[arg-type]


def pulled(fit: Fit, stretch: float) -> float:
    """Return the lattice's elongation over the law's, less 1, of a pulled strip."""
    pull = float(stress(fit.energy, "uniaxial", np.array([1.0 + stretch]))[0]) * SHEET.thickness
    scene = _strip(fit, loads=(EdgeLoad("x1", force_per_length=(pull, 0.0, 0.0)),))
    return _end(_lattice(scene)) / (stretch * SHEET.length_x) - 1.0


def hung(fit: Fit, stretch: float) -> float:
    """Return the lattice's elongation over the law's, less 1, of a strip under its weight. stretch: of the
    law where the strip is held."""
    top = float(stress(fit.energy, "uniaxial", np.array([1.0 + stretch]))[0])

    def elongation(share: float) -> float:
        def over(at: float) -> float:
            return float(stress(fit.energy, "uniaxial", np.array([1.0 + at]))[0]) - share * top

        return float(brentq(over, 0.0, stretch))

    middles = (np.arange(50) + 0.5) / 50
    long = SHEET.length_x * float(np.mean([elongation(share) for share in middles]))
    weight = top / (1000.0 * SHEET.length_x)
    scene = _strip(fit, gravity=Gravity((weight, 0.0, 0.0)))
    return _end(_lattice(scene)) / long - 1.0


def blown(fit: Fit) -> Iterator[Square]:
    """Yield the height of a clamped square inflated by pressures in both models, and the lattice's error."""
    laws = {"law": fit.law, **fit.constants} if fit.law != "neo-hookean" else {"law": fit.law}
    rubber = Material.model_validate({**_material(fit).model_dump(exclude_none=True), **laws})
    sheet = Sheet(0.1, 0.1, 0.002)
    clamped = tuple(Clamped(edge) for edge in ("x0", "x1", "y0", "y1"))
    for share in PRESSURES:
        load = (Pressure(share * rubber.young * sheet.thickness / sheet.length_x),)
        scene = Scene("blown", sheet, rubber, supports=clamped, loads=load)
        at = np.array([[0.05, 0.05]])
        truth = fem_reference.solve(scene, "shell", elements=6)
        plain = scene.replace(material=_material(fit))
        solutions = (truth, _lattice(plain, (13, 13)))
        tops = [float(s.displacement(at)[0, 2]) if s.comparable else float("nan") for s in solutions]
        yield Square(share, truth.stretch, tops[0], tops[1], tops[1] / tops[0] - 1.0)
