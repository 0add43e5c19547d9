"""A manufactured solution of linear elasticity in a block: error in L² and order of the brick.

A unit square of thickness ½, held on all its surface at

    u_i = c_i sin(k_i · x + a_i),    in balance with the body force
    b_j = (λ + μ) Σ_i k_ii k_ij u_i + μ |k_j|² u_j.

Triquadratic displacements: order 3. Near ν = ½ the field is one that keeps the volume (k_ii = 0), as a nearly
incompressible body's must.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fem_reference.solid.discrete import DiscreteSolid
from fem_reference.solid.element import reference, shape
from fem_reference.solid.materials import lame
from fem_reference.surface.mesh import rectangle
from fem_reference.verification.rows import Row, convergence
from sheetbench.numerics.direct import DirectSolver
from sheetbench.scenes import Material, Scene, Sheet

ORDER = 3.0
LARGEST = 1e-3  # error on the finest mesh
ELEMENTS = (4, 8)
SHEET = Sheet(length_x=1.0, length_y=1.0, thickness=0.5)
SIZE = np.array([1.0, -0.7, 0.8])
WAVE = np.array([[2.0, 1.0, -0.5], [0.7, -1.8, 1.2], [1.1, 0.6, 2.1]])
WAVES = {0.3: WAVE, 0.4999: WAVE - np.diag(np.diag(WAVE))}  # by Poisson's ratio
PHASE = np.array([0.3, 1.1, -0.4])


def rows() -> Iterator[Row]:
    """Error on the finest mesh, and the order of the last refinement."""
    mesh = f"solid {ELEMENTS[-1]} × {ELEMENTS[-1]} × {ELEMENTS[-1] // 2}"
    for poisson in WAVES:
        errors = [error(poisson, n) for n in ELEMENTS]
        yield from convergence(f"in L² at ν = {poisson:g}", mesh, errors, LARGEST, ORDER)


def error(poisson: float, elements: int) -> float:
    """Relative error in L² on elements × elements × elements/2 bricks."""
    waves = WAVES[poisson]
    material = Material(young=1.0, poisson=poisson, density=1.0)
    scene = Scene(name="manufactured", sheet=SHEET, material=material)
    sheet = DiscreteSolid(rectangle(SHEET, elements), scene, layers=elements // 2)
    columns, bricks, rest = sheet.columns, sheet.element, np.zeros(sheet.size)
    nodes = np.concatenate([columns.stacks[:, place] for place in columns.places])  # (m, 27) of the bricks
    values, _ = shape(reference().points)
    points = np.einsum("aq,mac->mqc", values, bricks.positions)
    shares = np.einsum("mq,aq,mqc->mac", bricks.volumes, values, _body_force(material, waves, points))
    force = np.zeros((columns.positions.size // 3, 3))
    np.add.at(force, nodes, shares)

    matrix = sheet.tangent(sheet.shape(rest, 0.0), rest, 0.0, 0.0)
    positions = columns.positions.reshape(-1, 3)
    low, high = positions.min(axis=0), positions.max(axis=0)
    inside = np.all((positions > low + 1e-9) & (positions < high - 1e-9), axis=1)
    displacement = np.where(inside[:, None], 0.0, _exact(waves, positions))
    free = np.flatnonzero(np.repeat(inside, 3))
    found, inside = displacement.ravel(), matrix[free]
    found[free] = DirectSolver().factor(inside[:, free]).solve(force.ravel()[free] - inside @ found)
    computed = np.einsum("aq,mac->mqc", values, found.reshape(-1, 3)[nodes])
    exact = _exact(waves, points)
    square = np.einsum("mq,mqc->", bricks.volumes, (computed - exact) ** 2)
    return float(np.sqrt(square / np.einsum("mq,mqc->", bricks.volumes, exact**2)))


def _exact(waves: np.ndarray, points: np.ndarray) -> np.ndarray:
    """u (…, 3) at points (…, 3)."""
    return SIZE * np.sin(points @ waves.T + PHASE)


def _body_force(material: Material, waves: np.ndarray, points: np.ndarray) -> np.ndarray:
    """b (…, 3) [N/m³] at points (…, 3)."""
    first, second = lame(material)
    displacement = _exact(waves, points)
    volumetric = (first + second) * (displacement * np.diag(waves)) @ waves
    return volumetric + second * np.sum(waves**2, axis=1) * displacement
