"""Moduli of a repeated cell, its coefficients nearest to a material, and the error that stays however fine
the mesh.

Moduli are of the energy under imposed strains and curvatures. Nodes are moved by the field of the strains e,
curvatures κ and transverse shears γ (x, y, xy with the engineering shear; x, y),

    u = e x − z κ x,    w = ½ x·κ x + γ·x,

and by displacements that repeat from cell to cell, for which the energy is least; those neither move the cell
nor turn it through its thickness. The field in another cell differs by a rigid motion, so that all cells have
one energy.

Codes without laws of membranes have sheets of springs of one stiffness: along the sides of triangles, or of
tetrahedra in one layer, whose height is a second coefficient. Squares are cut into five tetrahedra each,
neighbours mirrored, so that they share their faces' diagonals.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import count

import numpy as np
from scipy.linalg import block_diag, null_space
from scipy.optimize import brentq, least_squares, minimize_scalar

import fem_reference
from comparisons.codes.cell import Cell, Place, cell_of, sides_of
from comparisons.models.context import context
from comparisons.sweep.differences import error
from fem_reference.surface.materials import Section, section_of
from sheetbench.errors import BadInput, NoEquilibrium
from sheetbench.scenes import Material, Scene

STABLE = 1e-9  # below zero, of moduli over those on the diagonal: rounding
ROUNDING = 1e-12  # of both moduli beside one off the diagonal


@dataclass(frozen=True)
class Moduli:
    """Forms over (x, y, xy): membrane A [N/m], coupling B [N], bending D [N·m] (3, 3); shear S (2, 2) [N/m],
    None of a cell without thickness, whose normals stay normal."""

    membrane: np.ndarray
    coupling: np.ndarray
    bending: np.ndarray
    shear: np.ndarray | None

    @property
    def stable(self) -> bool:
        """Whether no deformation has a negative energy."""
        plane = np.block([[self.membrane, self.coupling], [self.coupling.T, self.bending]])
        form = plane if self.shear is None else block_diag(plane, self.shear)
        size = np.sqrt(np.maximum(np.abs(np.diag(form)), np.finfo(float).tiny))
        return bool(np.linalg.eigvalsh(form / np.outer(size, size))[0] > -STABLE)

    def named(self) -> dict[str, float]:
        """Return the moduli by name, as A11 or D66."""
        pairs = {"11": (0, 0), "22": (1, 1), "12": (0, 1), "66": (2, 2), "16": (0, 2), "26": (1, 2)}
        forms = {"A": self.membrane, "D": self.bending}
        found = {kind + name: float(form[at]) for kind, form in forms.items() for name, at in pairs.items()}
        if self.shear is not None:
            found |= {"Sx": float(self.shear[0, 0]), "Sy": float(self.shear[1, 1])}
        return found


def moduli_of(cell: Cell, coefficients: Mapping[str, float]) -> Moduli:
    """Return the moduli of a sheet of this cell.

    coefficients: by the names of `cell.units()`, in those units. Raises KeyError where one is missing."""
    count = 3 * len(cell.nodes)
    stiffness, coupled, imposed = np.zeros((count, count)), np.zeros((count, 8)), np.zeros((8, 8))
    for element in cell.elements():
        matrix = sum(coefficients[name] * unit for name, unit in element.stiffness.items())
        field = np.vstack([_evaluate_field(point) for point in cell.at(element.places)])
        rows = np.concatenate([3 * node + np.arange(3) for node, _, _ in element.places])
        np.add.at(stiffness, (rows[:, None], rows), matrix)
        np.add.at(coupled, rows, matrix @ field)
        imposed += field.T @ matrix @ field
    free = null_space(_constrain_motion(cell.nodes))
    relaxed = np.linalg.pinv(free.T @ stiffness @ free, rcond=1e-12, hermitian=True)
    form = (imposed - coupled.T @ free @ relaxed @ free.T @ coupled) / cell.area
    scales = np.sqrt(np.maximum(np.diag(form), 0.0))
    form[np.abs(form) < ROUNDING * np.outer(scales, scales)] = 0.0
    thick = bool(np.ptp(cell.nodes[:, 2]) > 0.0)
    return Moduli(form[:3, :3], form[:3, 3:6], form[3:6, 3:6], form[6:, 6:] if thick else None)


def _evaluate_field(point: np.ndarray) -> np.ndarray:
    """Return the displacement (3,) of a point per unit of each strain, curvature and transverse shear, (3,
    8)."""
    x, y, z = point
    plane = np.array([[x, 0.0, y / 2.0], [0.0, y, x / 2.0]])
    field = np.zeros((3, 8))
    field[:2, :3], field[:2, 3:6] = plane, -z * plane
    field[2] = 0.0, 0.0, 0.0, x * x / 2.0, y * y / 2.0, x * y / 2.0, x, y
    return field


def _constrain_motion(nodes: np.ndarray) -> np.ndarray:
    """Return the constraints on a cell's rigid motion: rows of its mean displacements and, with thickness, of
    the mean turns of its normal."""
    heights = nodes[:, 2] - nodes[:, 2].mean()
    rows = [np.kron(np.ones(len(nodes)), axis) for axis in np.eye(3)]
    if np.any(heights):
        rows += [np.kron(heights, axis) for axis in np.eye(3)[:2]]
    return np.array(rows)


COARSE = 8  # elements of the shells of a search
STIFF = 1e3  # times κGh, of a cell whose normals stay normal
FAILED_ERROR = 1e3  # error of moduli in a search with which the sheet has no stable equilibrium
MANDEL_WEIGHTS = np.array([[1.0, 1.0, 2.0**0.5], [1.0, 1.0, 2.0**0.5], [2.0**0.5, 2.0**0.5, 2.0]])


def nearest(
    cell: Cell, material: Material, thickness: float, fixed: Mapping[str, float] | None = None
) -> dict[str, float]:
    """Return the nonnegative coefficients whose moduli are nearest to the sheet's; coefficients in `fixed`
    keep their values.

    Triangles have the membrane's λh = E ν h/(1 − ν²) and μh = E h/2(1 + ν), bricks Lamé's constants. The
    others are found by least squares over A and D, each over its 11, in a norm that no turn of the axes
    changes (Mandel's)."""
    nu = material.poisson
    stretching = material.young * thickness / (1.0 - nu**2)
    exact = {"lambda_h": nu * stretching, "mu_h": 0.5 * (1.0 - nu) * stretching}
    mu = 0.5 * material.young / (1.0 + nu)
    exact |= {"lambda": 2.0 * mu * nu / (1.0 - 2.0 * nu), "mu": mu, **(fixed or {})}
    units = cell.units()
    fixed_values = {name: value for name, value in exact.items() if name in units}
    names = [name for name in units if name not in fixed_values]
    target = section_of(material, thickness)
    # a value of the right size for each: of springs the membrane's, of hinges the plate's by its length
    sizes = np.array([stretching if units[n] == "N/m" else target.bending[0, 0] for n in names])
    if "hinge" in names and units["hinge"] == "N":
        sizes[names.index("hinge")] /= cell.area**0.5

    def weighted(values: np.ndarray) -> np.ndarray:
        moduli = moduli_of(cell, fixed_values | dict(zip(names, values * sizes, strict=True)))
        pairs = ((moduli.membrane, target.membrane), (moduli.bending, target.bending))
        return np.concatenate([(MANDEL_WEIGHTS * (a - b) / b[0, 0]).ravel() for a, b in pairs])

    if not names:
        return fixed_values
    solution = least_squares(weighted, np.ones(len(names)), bounds=(0.0, np.inf), xtol=1e-14, ftol=1e-14)
    return fixed_values | {n: float(v * s) for n, v, s in zip(names, solution.x, sizes, strict=True)}


def limit_errors(scene: Scene, elements: int = 16) -> Callable[[Moduli], float]:
    """Return a function of a cell's moduli: the error in a scene of the finest mesh of the cell, found by a
    shell with the cell's moduli. The sheet's own shell is solved once, here.

    elements: along the side of a square, as many in all on others. The shell takes large rotations, as the
    meshes do. Both raise NoEquilibrium where the sheet, with its own moduli or the cell's, has no stable
    equilibrium in the scene, the function BadInput where bending and stretching are coupled."""
    lengths = scene.sheet.lengths
    cells = max(2, round(elements * min(lengths) / (lengths[0] * lengths[1]) ** 0.5))
    points, solved = scene.probe_points(), count(1)

    def answer(section: Section | None = None) -> np.ndarray:
        context().progress(f"solving shell, {cells} elements along the shorter side: no. {next(solved)} …")
        solution = fem_reference.solve(scene, model="shell", elements=cells, section=section)
        return solution.require_stable().displacement(points)

    exact = answer()

    def off(moduli: Moduli) -> float:
        share = error(answer(_make_section(scene, moduli)), exact)
        if share is None:
            raise BadInput("the probes do not move: they have no error")
        return share

    return off


def least_error(scene: Scene, moduli: Callable[[float], Moduli], low: float, high: float) -> float:
    """Return the number between low and high whose moduli have the least error in a scene on the finest mesh.
    Raises NoEquilibrium where the sheet is unstable with its own moduli, or with the moduli of every number
    tried."""
    error_of = limit_errors(scene, COARSE)

    def off(logarithm: float) -> float:
        try:
            return error_of(moduli(float(np.exp(logarithm))))
        except NoEquilibrium:
            return FAILED_ERROR

    bounds = (float(np.log(low)), float(np.log(high)))
    minimum = minimize_scalar(off, bounds=bounds, method="bounded", options={"xatol": 5e-3})
    if minimum.fun == FAILED_ERROR:
        raise NoEquilibrium("no coefficients of this mesh have a stable equilibrium in this scene")
    return float(np.exp(minimum.x))


def _make_section(scene: Scene, moduli: Moduli) -> Section:
    material_section = section_of(scene.material, scene.sheet.thickness)
    size = (np.abs(moduli.membrane).max() * np.abs(moduli.bending).max()) ** 0.5
    if np.abs(moduli.coupling).max() > 1e-9 * size:
        raise BadInput("the cell couples bending and stretching: no shell has such a section")
    shear = STIFF * material_section.shear if moduli.shear is None else moduli.shear
    return Section(moduli.membrane, moduli.bending, shear)


def best_hinge(scene: Scene, cell: Cell, coefficients: dict[str, float]) -> float | None:
    """Return the hinges' coefficient with the least error in a scene on the finest mesh, None for a cell
    without hinges. Searched from a twentieth to ten times the coefficient given."""
    if "hinge" not in coefficients:
        return None
    start = coefficients["hinge"]
    bounds = 0.05 * start, 10.0 * start
    return least_error(scene, lambda hinge: moduli_of(cell, coefficients | {"hinge": hinge}), *bounds)


FIVE = (
    ((0, 0, 0), (1, 1, 0), (1, 0, 1), (0, 1, 1)),
    ((1, 0, 0), (0, 0, 0), (1, 1, 0), (1, 0, 1)),
    ((0, 1, 0), (0, 0, 0), (1, 1, 0), (0, 1, 1)),
    ((0, 0, 1), (0, 0, 0), (1, 0, 1), (0, 1, 1)),
    ((1, 1, 1), (1, 1, 0), (1, 0, 1), (0, 1, 1)),
)  # corners of a cube (x, y, layer)
HEIGHTS = (0.2, 5.0)  # of the layers, over the thickness


def square_tetrahedra(i: int, j: int) -> list[list[tuple[int, int, int]]]:
    """Return the five tetrahedra between both layers over square (i, j); corners as (x index, y index,
    layer)."""
    flip = (i + j) % 2
    return [[(i + (x ^ flip), j + y, layer) for x, y, layer in cell] for cell in FIVE]


def tetrahedral_cell(spacing: float, height: float) -> Cell:
    """Return two layers of nodes with springs "k" along every side of the tetrahedra between them."""
    cells = (corners for i in range(2) for j in range(2) for corners in square_tetrahedra(i, j))
    places = [[(i % 2 * 4 + j % 2 * 2 + layer, i // 2, j // 2) for i, j, layer in cell] for cell in cells]
    nodes = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (-0.5, 0.5)])
    periods = 2.0 * spacing * np.eye(2)
    return Cell("tetrahedra", periods, nodes * [spacing, spacing, height], springs=_join_corners(places))


def triangular_cell(name: str, spacing: float) -> Cell:
    """Return a cell of triangles with springs "k" along their sides and hinges by angle, without a
    membrane."""
    cell = cell_of(name, spacing, hinge="angle")
    return replace(cell, springs=_join_corners(cell.triangles))


def _join_corners(elements: Iterable[Sequence[Place]]) -> tuple[tuple[Place, Place, str], ...]:
    """Return springs "k" between every two corners of elements, each once."""
    return tuple((a, b, "k") for a, b in sides_of(elements))


def layered_springs(scene: Scene, spacing: float, best: bool = False) -> dict[str, float]:
    """Return k [N/m] and the layers' distance [m] of tetrahedra.

    k has the membrane nearest to the sheet's, the distance then the bending stiffnesses, or the best fit to
    the scene. Raises NoEquilibrium where the scene's sheet has no stable one."""
    section = section_of(scene.material, scene.sheet.thickness)

    def at(height: float) -> tuple[float, Moduli]:
        unit = moduli_of(tetrahedral_cell(spacing, height), {"k": 1.0})
        k = _fit_factor(unit.membrane, section.membrane)
        assert unit.shear is not None
        return k, Moduli(k * unit.membrane, k * unit.coupling, k * unit.bending, k * unit.shear)

    low, high = (share * scene.sheet.thickness for share in HEIGHTS)
    if best:
        height = least_error(scene, lambda height: at(height)[1], low, high)
    else:

        def miss(height: float) -> float:
            return _fit_factor(at(height)[1].bending, section.bending) - 1.0

        height = float(brentq(miss, low, high))
    return {"k": at(height)[0], "layers": height}


def _fit_factor(form: np.ndarray, target: np.ndarray) -> float:
    """Return the factor on a form that minimises its distance from a target, in Mandel's norm."""
    weighted = MANDEL_WEIGHTS**2 * form
    return float(np.sum(weighted * target) / np.sum(weighted * form))
