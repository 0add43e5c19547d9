"""The coefficients of a cell nearest to a material, and the error that stays however fine the mesh."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from scipy.optimize import least_squares, minimize_scalar

import fem_reference
from comparisons.codes.cell import Cell
from comparisons.codes.homogenise import Moduli, moduli_of
from comparisons.sweep.differences import error
from fem_reference.surface.materials import Section, section_of
from sheetbench.errors import BadInput, NoEquilibrium
from sheetbench.scenes import Material, Scene

COARSE = 8  # elements of the shells of a search
STIFF = 1e3  # times κGh, of a cell whose normals stay normal
LOST = 1e3  # error of moduli in a search with which the sheet has no stable equilibrium
TURNED = np.array([[1.0, 1.0, 2.0**0.5], [1.0, 1.0, 2.0**0.5], [2.0**0.5, 2.0**0.5, 2.0]])


def nearest(
    cell: Cell, material: Material, thickness: float, fixed: Mapping[str, float] | None = None
) -> dict[str, float]:
    """Coefficients, none negative, whose moduli come nearest to the sheet's; those of `fixed` as they are.

    Triangles have the membrane's λh = E ν h/(1 − ν²) and μh = E h/2(1 + ν), bricks Lamé's constants. The
    others are found by least squares over A and D, each over its 11, in a norm that no turn of the axes
    changes (Mandel's).
    """
    nu = material.poisson
    stretching = material.young * thickness / (1.0 - nu**2)
    exact = {"lambda_h": nu * stretching, "mu_h": 0.5 * (1.0 - nu) * stretching}
    mu = 0.5 * material.young / (1.0 + nu)
    exact |= {"lambda": 2.0 * mu * nu / (1.0 - 2.0 * nu), "mu": mu, **(fixed or {})}
    units = cell.units()
    known = {name: value for name, value in exact.items() if name in units}
    names = [name for name in units if name not in known]
    target = section_of(material, thickness)
    # a value of the right size for each: of springs the membrane's, of hinges the plate's by its length
    sizes = np.array([stretching if units[n] == "N/m" else target.bending[0, 0] for n in names])
    if "hinge" in names and units["hinge"] == "N":
        sizes[names.index("hinge")] /= cell.area**0.5

    def weighted(values: np.ndarray) -> np.ndarray:
        got = moduli_of(cell, known | dict(zip(names, values * sizes, strict=True)))
        pairs = ((got.membrane, target.membrane), (got.bending, target.bending))
        return np.concatenate([(TURNED * (a - b) / b[0, 0]).ravel() for a, b in pairs])

    if not names:
        return known
    found = least_squares(weighted, np.ones(len(names)), bounds=(0.0, np.inf), xtol=1e-14, ftol=1e-14)
    return known | {n: float(v * s) for n, v, s in zip(names, found.x, sizes, strict=True)}


def limit_error(scene: Scene, moduli: Moduli, elements: int = 16) -> float:
    """The error in a scene of a mesh of this cell, however fine: that of a shell with the cell's moduli.

    elements: along the side of a square, as many in all on others. The shell takes large rotations, as such
    meshes do. Raises BadInput where bending and stretching are coupled, NoEquilibrium where the sheet, or one
    of these moduli, has no stable equilibrium in the scene.
    """
    return limit_errors(scene, elements)(moduli)


def limit_errors(scene: Scene, elements: int) -> Callable[[Moduli], float]:
    """`limit_error` of any moduli in a scene, whose own answer is found once."""
    lengths = scene.sheet.lengths
    across = max(2, round(elements * min(lengths) / (lengths[0] * lengths[1]) ** 0.5))
    points = scene.probe_points()
    sheet = fem_reference.solve(scene, model="shell", elements=across)
    true = sheet.require_stable().displacement(points)

    def off(moduli: Moduli) -> float:
        found = fem_reference.solve(scene, model="shell", elements=across, section=_section(scene, moduli))
        share = error(found.require_stable().displacement(points), true)
        if share is None:
            raise BadInput("the probes do not move: there is no error to tell")
        return share

    return off


def least_error(
    scene: Scene, moduli: Callable[[float], Moduli], low: float, high: float
) -> tuple[float, float]:
    """The number between low and high whose moduli leave the least error in the limit in this scene, and that
    error. Raises NoEquilibrium where the sheet, or every one of these moduli, is unstable there."""
    error_of = limit_errors(scene, COARSE)

    def off(logarithm: float) -> float:
        try:
            return error_of(moduli(float(np.exp(logarithm))))
        except NoEquilibrium:
            return LOST

    bounds = (float(np.log(low)), float(np.log(high)))
    found = minimize_scalar(off, bounds=bounds, method="bounded", options={"xatol": 5e-3})
    if found.fun == LOST:
        raise NoEquilibrium("no coefficients of this mesh have a stable equilibrium in this scene")
    return float(np.exp(found.x)), float(found.fun)


def _section(scene: Scene, moduli: Moduli) -> Section:
    own = section_of(scene.material, scene.sheet.thickness)
    size = (np.abs(moduli.membrane).max() * np.abs(moduli.bending).max()) ** 0.5
    if np.abs(moduli.coupling).max() > 1e-9 * size:
        raise BadInput("the cell couples bending and stretching: no shell here has such a section")
    shear = STIFF * own.shear if moduli.shear is None else moduli.shear
    return Section(moduli.membrane, moduli.bending, shear)


def best_hinge(scene: Scene, cell: Cell, coefficients: dict[str, float]) -> tuple[float, float] | None:
    """The hinges' coefficient that leaves the least error in the limit in this scene, and that error; None
    of a cell without hinges. Searched from a twentieth to ten times the coefficient given."""
    if "hinge" not in coefficients:
        return None
    start = coefficients["hinge"]

    def moduli(hinge: float) -> Moduli:
        return moduli_of(cell, coefficients | {"hinge": hinge})

    return least_error(scene, moduli, 0.05 * start, 10.0 * start)
