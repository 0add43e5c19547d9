"""Training of the calibration `central`: the isotropic sheet of Cauchy's moduli with the least error.

A lattice of links alone has C12 = C66 in its layers, so that it bends and stretches as a sheet of

    D11 = a D,   D12 = D66 = b D,        A11 = c A,   A12 = A66 = (b/a) c A.

For every ν the three numbers minimise the largest error over the training scenes, of the plate and
the shell with a, b, c against the sheet's own moduli on one mesh:

    a, b   eight ways of holding a square sheet under little load. Clamped or hinged all round, a deflection
           depends on D11 and D12 + 2 D66 alone and requires b = 1/3 for any ν; free edges and corners require
           the twisting stiffness b = (1 − ν)/2, free strips a − b²/a = 1 − ν². Each is in the set.
    c      five scenes that mostly stretch: a third of the thickness under its weight, and a bent edge.

A thin plate's deflection is proportional to 1/a for a given b/a, and smooth in b/a and c: it is solved at a
few values, interpolated by polynomials, minimised over a fine grid.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import BarycentricInterpolator

import fem_reference
import lumped
from fem_reference.surface.materials import Section, section_of
from sheetbench.answers.files import write_text
from sheetbench.scenes import Clamped, Gravity, Hinged, Load, PointLoad, Scene, load
from sheetbench.scenes.objects.supports import AnySupport

POISSON = (-0.8, -0.4, 0.0, 0.1, 0.2, 0.3, 1.0 / 3.0, 0.4, 0.45, 0.49)
RATIOS = np.linspace(0.22, 0.64, 8)  # b/a
STRETCHES = np.linspace(0.75, 1.2, 6)  # c/a
ELEMENTS = 6
SEED = load("two-edges-clamped")
SIDE = SEED.sheet.length_x
POINTS = np.stack(np.meshgrid(*2 * [np.linspace(0.0, SIDE, 5)]), axis=-1).reshape(-1, 2)
HELD: dict[str, tuple[AnySupport, ...]] = {
    "one edge clamped": (Clamped(edge="x0"),),
    "two adjacent edges clamped": (Clamped(edge="x0"), Clamped(edge="y0")),
    "two opposite edges clamped": (Clamped(edge="x0"), Clamped(edge="x1")),
    "three edges clamped": (Clamped(edge="x0"), Clamped(edge="x1"), Clamped(edge="y0")),
    "clamped all round": tuple(Clamped(edge=edge) for edge in ("x0", "x1", "y0", "y1")),
    "two opposite edges hinged": (Hinged(edge="x0"), Hinged(edge="x1")),
    "hinged all round": tuple(Hinged(edge=edge) for edge in ("x0", "x1", "y0", "y1")),
}
STRETCHED = (*(name for name in HELD if name not in ("one edge clamped", "two opposite edges hinged")),)


@dataclass(frozen=True)
class Trained:
    """Trained a, b, c of a Poisson's ratio, and the worst errors of the bent and of the stretched scenes.
    worst_cauchy: of the isotropic lattice with the sheet's own D11 (`cauchy`), on the bent scenes."""

    poisson: float
    bending: float
    twist: float
    membrane: float
    worst_bent: float
    worst_stretched: float
    worst_cauchy: float

    @property
    def numbers(self) -> tuple[float, ...]:
        """All numbers, rounded to the accuracy of the meshes."""
        return tuple(round(getattr(self, field.name), 4) for field in fields(self))


def bent_scenes() -> dict[str, Scene]:
    """Return the scenes that bend: Habibi et al.'s sheet under 1/1000 of its weight, with seven kinds of
    supports, and with a corner force."""
    feather = Gravity(acceleration=(0.0, 0.0, -9.81e-3))
    bent = {name: _scene(held, feather) for name, held in HELD.items()}
    force = PointLoad(at=(SIDE, SIDE), force=(0.0, 0.0, 1e-4))
    return {
        **bent,
        "a force at the free corner": _scene(HELD["two adjacent edges clamped"], None, (force,)),
    }


def stretched_scenes() -> dict[str, Scene]:
    """Return the scenes that stretch: a sheet of a third of the thickness under its whole weight, and the
    bent edge of the published model."""
    thin = {**SEED.sheet.model_dump(), "thickness": 0.001}
    stretched = {name: _scene(HELD[name], SEED.gravity).replace(sheet=thin) for name in STRETCHED}
    return {**stretched, "a bent edge": load("curved-edge")}


def trained(poisson: float) -> Trained:
    """Return the numbers for a Poisson's ratio."""
    a, b, worst_bent, worst_cauchy = trained_to_bend(poisson)
    c, worst_stretched = trained_to_stretch(poisson, a, b)
    return Trained(poisson, a, b, c, worst_bent, worst_stretched, worst_cauchy)


def trained_to_bend(poisson: float) -> tuple[float, float, float, float]:
    """Return a, b, the worst error with both, and the worst error with a = 1, b = 1/3."""
    scenes = [_with_poisson(scene, poisson) for scene in bent_scenes().values()]
    fields = [_interpolated(scene, "plate", RATIOS, lambda ratio: (1.0, ratio, 1.0)) for scene in scenes]
    truths = [_displacement(scene, "plate") for scene in scenes]
    ratios = np.append(np.linspace(RATIOS[0], RATIOS[-1], 421), 1.0 / 3.0)
    scales = np.linspace(0.6, 1.4, 801)
    worst = np.zeros((len(ratios), len(scales)))
    for field, truth in zip(fields, truths, strict=True):
        shapes = field(ratios)[:, None] / scales[:, None, None]
        worst = np.maximum(worst, np.abs(shapes - truth).max(axis=(2, 3)) / np.abs(truth).max())
    best = np.unravel_index(np.argmin(worst), worst.shape)
    a, ratio = float(scales[best[1]]), float(ratios[best[0]])
    cauchy = max(_error(field(1.0 / 3.0), truth) for field, truth in zip(fields, truths, strict=True))
    return a, a * ratio, float(worst[best]), cauchy


def trained_to_stretch(poisson: float, a: float, b: float) -> tuple[float, float]:
    """Return c for given a and b, and the worst error with it."""
    scenes = [_with_poisson(scene, poisson) for scene in stretched_scenes().values()]
    fields = [_interpolated(scene, "shell", STRETCHES, lambda k: (a, b / a, k * a)) for scene in scenes]
    truths = [_displacement(scene, "shell") for scene in scenes]
    shares = np.append(np.linspace(STRETCHES[0], STRETCHES[-1], 181), 1.0)
    worst = [
        max(_error(field(share), truth) for field, truth in zip(fields, truths, strict=True))
        for share in shares.tolist()
    ]
    return a * float(shares[np.argmin(worst)]), min(worst)


def _scene(held: tuple[AnySupport, ...], gravity: Gravity | None, loads: tuple[Load, ...] = ()) -> Scene:
    return Scene(
        name="training", sheet=SEED.sheet, material=SEED.material, gravity=gravity, supports=held, loads=loads
    )


def _with_poisson(scene: Scene, poisson: float) -> Scene:
    return scene.replace(material={**scene.material.model_dump(), "poisson": poisson})


def _interpolated(
    scene: Scene, model: str, at: np.ndarray, numbers: Callable[[float], tuple[float, float, float]]
) -> Any:
    """Return displacements as a polynomial in a number; numbers: a function from it to a, b/a, c."""
    return BarycentricInterpolator(at, [_displacement(scene, model, *numbers(x)) for x in at.tolist()])


def _displacement(
    scene: Scene, model: str, a: float | None = None, ratio: float = 0.0, c: float = 0.0
) -> np.ndarray:
    """Return displacements [m] at 5 × 5 points, with the sheet's own moduli unless a is given. Else D11 = a
    D, D12 = D66 = a ratio D, A11 = c A, …"""
    section = section_of(scene.material, scene.sheet.thickness)
    if a is not None:
        form = np.array([[1.0, ratio, 0.0], [ratio, 1.0, 0.0], [0.0, 0.0, ratio]])
        section = Section(c * section.membrane[0, 0] * form, a * section.bending[0, 0] * form, section.shear)
    solution = fem_reference.solve(scene, model=model, elements=ELEMENTS, section=section)
    return solution.require_stable().displacement(POINTS)


def _error(displacement: np.ndarray, truth: np.ndarray) -> float:
    return float(np.abs(displacement - truth).max() / np.abs(truth).max())


def write_table() -> Path:
    """Train the calibration `central`, and write the rows of its table; return the table's path."""
    rows = (f"    CentralFactors({', '.join(map(str, trained(poisson).numbers))}),\n" for poisson in POISSON)
    table = Path(lumped.__file__).parent / "calibration" / "central_table.py"
    head = table.read_text(encoding="utf-8").partition("ROWS = (\n")
    write_text(table, "".join([*head[:2], *rows, ")\n"]))
    return table
