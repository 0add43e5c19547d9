"""NAFEMS LE10: a thick elliptic plate under pressure on its upper face, linear.

A quarter of the plate between the ellipses with half axes 2 and 1 m and 3.25 and 2.75 m, 0.6 m thick,
E 210 GPa, ν 0.3, 1 MPa on the upper face. Held: the outer face in the plane, its mid-line in z too, and the
sides by symmetry. Quantity: σ_yy at D, the inner ellipse's long end, on the upper face: −5.38 MPa.

The displacement gradient at the node gives the stress, so the mesh shrinks towards the inner ellipse.
Plain 27-node bricks on meshes graded to D give −5.41 to −5.42 MPa, 0.6 % from the target, with σ_xx and
σ_zz + 1 MPa below 0.02 MPa there: hence the tolerance.
Source: NAFEMS, The Standard NAFEMS Benchmarks (1990), test LE10.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from skfem import ElementHex2, MeshQuad2

from fem_reference.solid.discrete import DiscreteSolid
from fem_reference.solid.element import shape
from fem_reference.solid.materials import lame
from fem_reference.solid.mesh import Columns
from fem_reference.surface.biquadratic import areas
from fem_reference.surface.loads import area_force
from fem_reference.verification.rows import Row, relatively
from fem_reference.verification.specimens import mapped, specimen
from sheetbench.numerics.direct import DirectSolver
from sheetbench.scenes import Material, Sheet

TOLERANCE = 1e-2
RADIAL, AROUND, LAYERS = 8, 12, 6
GRADING = 1.5
INNER, OUTER = (2.0, 1.0), (3.25, 2.75)
PRESSURE = 1e6
PUBLISHED = -5.38
SOURCE = "NAFEMS 1990, LE10"
STEEL = Material(young=210e9, poisson=0.3, density=7800.0)


def rows() -> Iterator[Row]:
    """σ_yy [MPa] at D."""
    computed = stress_at_d(RADIAL, AROUND, LAYERS)[1, 1] / 1e6
    mesh = f"solid {RADIAL} × {AROUND} × {LAYERS}"
    yield relatively("σ_yy at D [MPa]", mesh, PUBLISHED, SOURCE, computed, TOLERANCE)


def stress_at_d(radial: int, around: int, layers: int) -> np.ndarray:
    """Stress (3, 3) [Pa] at D."""
    scene = specimen(Sheet(3.25, 2.75, 0.6), STEEL, ())
    sheet = DiscreteSolid(_quarter(radial, around), scene, layers=layers)
    columns, rest = sheet.columns, np.zeros(sheet.size)
    free = np.ones(sheet.free.shape, dtype=bool)
    free[columns.edge("x0"), :, 0] = False
    free[columns.edge("y0"), :, 1] = False
    free[columns.edge("outer"), :, :2] = False
    free[columns.edge("outer"), columns.layers, 2] = False
    unknowns = np.flatnonzero(free.ravel())
    matrix = sheet.tangent(sheet.shape(rest, 0.0), rest, 0.0, 0.0)
    force = np.zeros(free.shape)
    plan, upwards = columns.plan, np.array([-PRESSURE])
    force[:, -1, 2:] = area_force(areas(plan.corners), plan.elements, sheet.nodes, upwards)
    displacement = np.zeros(free.shape)
    displacement[free] = DirectSolver().factor(matrix[unknowns][:, unknowns]).solve(force[free])
    at_d = int(np.argmin(np.hypot(plan.nodes[:, 0] - INNER[0], plan.nodes[:, 1])))
    return _stress(columns, displacement.reshape(-1, 3), (at_d + 1) * columns.levels - 1)


def _quarter(radial: int, around: int) -> MeshQuad2:
    """The plan mesh with its sides y0 (y = 0), x0 (x = 0) and outer."""
    share, angles = np.linspace(0.0, 1.0, radial + 1) ** GRADING, np.linspace(0.0, np.pi / 2.0, around + 1)

    def place(outwards: np.ndarray, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        a, b = (inner + (outer - inner) * outwards for inner, outer in zip(INNER, OUTER, strict=True))
        return a * np.cos(angle), b * np.sin(angle)

    return mapped(share, angles, place, {"outer": (0, 1.0), "y0": (1, 0.0), "x0": (1, np.pi / 2.0)})


def _stress(columns: Columns, displacement: np.ndarray, node: int) -> np.ndarray:
    """Stress (3, 3) [Pa] at a node of one brick, from the gradient of displacements (nodes, 3) [m]."""
    bricks = columns.stacks[:, columns.places[-1]]
    brick, place = (int(found[0]) for found in np.nonzero(bricks == node))
    _, slope = shape(ElementHex2.doflocs[place][:, None])
    position = columns.positions.reshape(-1, 3)[bricks[brick]]
    jacobian, gradient = (
        np.einsum("ac,ab->cb", nodal, slope[:, :, 0]) for nodal in (position, displacement[bricks[brick]])
    )
    gradient = gradient @ np.linalg.inv(jacobian)
    strain = 0.5 * (gradient + gradient.T)
    first, second = lame(STEEL)
    return first * np.trace(strain) * np.eye(3) + 2.0 * second * strain
