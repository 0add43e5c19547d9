"""Moduli of a repeated cell, from its energy under imposed strains and curvatures.

Nodes are moved by the field of the strains e, curvatures κ and transverse shears γ (x, y, xy with the
engineering shear; x, y),

    u = e x − z κ x,    w = ½ x·κ x + γ·x,

and by displacements that repeat from cell to cell, for which the energy is least; those neither move the
cell nor turn it through its thickness. The field in another cell differs by a rigid motion, so that the
energy of one cell is that of all.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.linalg import null_space

from comparisons.codes.cell import Cell

ROUNDING = 1e-12  # of both moduli beside one off the diagonal


@dataclass(frozen=True)
class Moduli:
    """Forms over (x, y, xy): membrane A [N/m], coupling B [N], bending D [N·m] (3, 3); shear S (2, 2) [N/m],
    None of a cell without thickness, whose normals stay normal."""

    membrane: np.ndarray
    coupling: np.ndarray
    bending: np.ndarray
    shear: np.ndarray | None

    def named(self) -> dict[str, float]:
        """The moduli by name, as A11 or D66."""
        pairs = {"11": (0, 0), "22": (1, 1), "12": (0, 1), "66": (2, 2), "16": (0, 2), "26": (1, 2)}
        forms = {"A": self.membrane, "D": self.bending}
        found = {kind + name: float(form[at]) for kind, form in forms.items() for name, at in pairs.items()}
        if self.shear is not None:
            found |= {"Sx": float(self.shear[0, 0]), "Sy": float(self.shear[1, 1])}
        return found


def moduli_of(cell: Cell, coefficients: Mapping[str, float]) -> Moduli:
    """Moduli of a sheet of this cell.

    coefficients: by the names of `cell.units()`, in those units. Raises KeyError where one is missing.
    """
    count = 3 * len(cell.nodes)
    stiffness, coupled, imposed = np.zeros((count, count)), np.zeros((count, 8)), np.zeros((8, 8))
    for element in cell.elements():
        matrix = sum(coefficients[name] * unit for name, unit in element.stiffness.items())
        field = np.vstack([_field(point) for point in cell.at(element.places)])
        rows = np.concatenate([3 * node + np.arange(3) for node, _, _ in element.places])
        np.add.at(stiffness, (rows[:, None], rows), matrix)
        np.add.at(coupled, rows, matrix @ field)
        imposed += field.T @ matrix @ field
    free = null_space(_rigid(cell.nodes))
    relaxed = np.linalg.pinv(free.T @ stiffness @ free, rcond=1e-12, hermitian=True)
    form = (imposed - coupled.T @ free @ relaxed @ free.T @ coupled) / cell.area
    scales = np.sqrt(np.maximum(np.diag(form), 0.0))
    form[np.abs(form) < ROUNDING * np.outer(scales, scales)] = 0.0
    thick = bool(np.ptp(cell.nodes[:, 2]) > 0.0)
    return Moduli(form[:3, :3], form[:3, 3:6], form[3:6, 3:6], form[6:, 6:] if thick else None)


def _field(point: np.ndarray) -> np.ndarray:
    """Displacement (3,) of a point per unit of each strain, curvature and transverse shear (3, 8)."""
    x, y, z = point
    plane = np.array([[x, 0.0, y / 2.0], [0.0, y, x / 2.0]])
    field = np.zeros((3, 8))
    field[:2, :3], field[:2, 3:6] = plane, -z * plane
    field[2] = 0.0, 0.0, 0.0, x * x / 2.0, y * y / 2.0, x * y / 2.0, x, y
    return field


def _rigid(nodes: np.ndarray) -> np.ndarray:
    """Rows: mean displacements and, of a cell that has thickness, mean turns of its normal."""
    heights = nodes[:, 2] - nodes[:, 2].mean()
    rows = [np.kron(np.ones(len(nodes)), axis) for axis in np.eye(3)]
    if np.any(heights):
        rows += [np.kron(heights, axis) for axis in np.eye(3)[:2]]
    return np.array(rows)
