"""Sheets, materials and shorthands that the tests share; the first sheet is that of Habibi et al.'s
scenes."""

from typing import Any

import numpy as np
from scipy.integrate import solve_bvp
from skfem import MeshQuad

import fem_reference
import lumped
from fem_reference.surface.mesh import rectangle
from sheetbench.answers.solution import Solution, Status
from sheetbench.scenes import Clamped, Gravity, Material, Scene, Sheet
from sheetbench.scenes.objects.grid import grid_of

SHEET = Sheet(length_x=0.188, length_y=0.188, thickness=0.003)
RUBBER = Material(young=54.5e6, poisson=0.48, density=1678.0)
GRAVITY = Gravity(acceleration=(0.0, 0.0, -9.81))
WEIGHT = 1678.0 * 0.003 * 0.188**2 * 9.81  # N, of the sheet
SIDE = np.linspace(0.188 / 8, 0.188, 8)
# Converged values of the sheet of Habibi et al. at E = 54.5 MPa, mm, by probe and axis: this project's own.
# CalculiX (C3D20R, 24 × 24 × 2) has −13.504 at P4 of the first.
CONVERGED = {
    "two-edges-clamped": {
        ("P1", 2): -2.456, ("P2", 2): -6.102, ("P4", 2): -13.504, ("P4", 0): -0.405, ("P4", 1): -0.405
    },
    "one-edge-clamped": {
        ("P1", 2): -17.10, ("P2", 2): -16.51, ("P3", 2): -48.04, ("P4", 2): -47.64, ("P3", 0): -7.19
    },
}  # fmt: skip
POINTS = np.array([[x, y] for x in SIDE for y in SIDE])  # (64, 2) [m], of a 9 × 9 grid but for two edges
OBLONG = Sheet(length_x=0.2, length_y=0.1, thickness=0.005)
SILICONE = Material(young=2.0e7, poisson=0.3, density=1200.0)
CLAMP = Clamped(edge="x0")


def sheet(
    x: float,
    y: float,
    thickness: float,
    young: float = 1e6,
    poisson: float = 0.3,
    density: float = 1000.0,
    *,
    held: str = "x0",
    weight: float = 0.0,
    **more: Any,
) -> Scene:
    """Return a sheet [m] of an isotropic material [Pa, –, kg/m³], clamped along edges, under gravity [m/s²]
    down.

    more: keys of a scene, in place of these or besides.
    """
    given: dict[str, Any] = {"name": "sheet", "material": Material(young, poisson, density)}
    given["supports"] = tuple(Clamped(edge=edge) for edge in held.split())
    if weight:
        given["gravity"] = Gravity(acceleration=(0.0, 0.0, -weight))
    return Scene(sheet=Sheet(x, y, thickness), **given | more)


def equilibrium(
    scene: Scene, model: str, grid: int | tuple[int, int], elements: int | tuple[int, int], **options: Any
) -> Solution:
    """Return the converged answer of a `consistent` lattice of a grid, or of a reference of elements and
    options."""
    if model == "lumped":
        springs = lumped.calibrate(scene.sheet, scene.material, grid, "consistent")
        found = lumped.solve(scene, springs)
    else:
        found = fem_reference.solve(scene, model, elements=elements, **options)
    assert found.status is Status.CONVERGED, found.message
    return found


def with_material(scene: Scene, **changes: float) -> Scene:
    """Return the scene with E, ν or ρ changed."""
    return scene.model_copy(update={"material": scene.material.model_copy(update=changes)})


def relative(u: np.ndarray, reference: np.ndarray) -> float:
    """Return the design's error: largest difference over the largest component."""
    return float(np.abs(u - reference).max() / np.abs(reference).max())


def distorted(sheet: Sheet = SHEET, elements: int = 3, by: float = 0.2) -> MeshQuad:
    """Return the sheet's mesh with its inner vertices moved by up to `by` of an element."""
    mesh = rectangle(sheet, elements)
    places, inner = mesh.p.copy(), mesh.interior_nodes()
    drawn = np.random.default_rng(0).uniform(-1.0, 1.0, (2, len(inner)))
    places[:, inner] += by * sheet.length_x / elements * drawn
    return MeshQuad(places, mesh.t).with_boundaries(mesh.boundaries)


def calibrated(scene: Scene, grid: Any = 3, grading: Any = 0.0, **settings: Any) -> lumped.Calibration:
    """Return the springs of a scene's cells on a grid as for `grid_of`."""
    grid = grid_of(scene.sheet, grid)
    cells = lumped.sections_of(scene, grid, grading)
    return lumped.calibrate(scene.sheet, scene.material, grid, cells=cells, grading=grading, **settings)


def elastica_tip(
    rigidity: float,
    length: float,
    force: tuple[float, float] = (0.0, 0.0),
    weight: float = 0.0,
    curvature: float = 0.0,
    turn: float = 1.0,
) -> np.ndarray:
    """Return the tip (x, z) [m] of an inextensible strip clamped level: B θ'' = (w (L − s) − F_z) cos θ + F_x
    sin θ, θ(0) = 0, θ'(L) = curvature. turn: rough angle of the tip [rad], which selects the branch."""

    def slopes(s: np.ndarray, y: np.ndarray) -> list[np.ndarray]:
        across = weight * (length - s) - force[1]
        bent = (across * np.cos(y[0]) + force[0] * np.sin(y[0])) / rigidity
        return [y[1], bent, np.cos(y[0]), np.sin(y[0])]

    def ends(start: np.ndarray, end: np.ndarray) -> list[float]:
        return [start[0], start[2], start[3], end[1] - curvature]

    s = np.linspace(0.0, length, 101)
    guess = [turn * s / length, np.full_like(s, turn / length), s, 0.5 * turn * s**2 / length]
    found = solve_bvp(slopes, ends, s, guess, tol=1e-10, max_nodes=100_000)
    assert found.success
    return found.y[2:, -1]
