"""Solutions and motions without a solver: a closed-form field on a small lattice, probes of one's own."""

from typing import Any

import numpy as np

from sheetbench.answers.history import ENERGIES, History
from sheetbench.answers.solution import FieldMesh, Solution, Status
from sheetbench.scenes import Scene


def solution(scene: Scene, model: str = "lumped", size: float = -0.01, **changes: Any) -> Solution:
    """Return a sheet whose far corner moves by `size` [m], any other point by x y / (length_x length_y) of
    it."""
    lx, ly = scene.sheet.lengths

    def sample(points: np.ndarray) -> np.ndarray:
        share = points[:, 0] * points[:, 1] / (lx * ly)
        return np.column_stack([0.05 * size * share, 0.05 * size * share, size * share])

    x, y = (grid.ravel() for grid in np.meshgrid(np.linspace(0, lx, 5), np.linspace(0, ly, 5), indexing="ij"))
    number = np.arange(25).reshape(5, 5)
    links = np.vstack(
        [
            np.column_stack([number[:-1].ravel(), number[1:].ravel()]),
            np.column_stack([number[:, :-1].ravel(), number[:, 1:].ravel()]),
        ]
    )
    mesh = FieldMesh(
        np.column_stack([x, y, np.zeros(25)]),
        [("line", links)],
        {"displacement": sample(np.column_stack([x, y]))},
        {"tension": [np.zeros(len(links))]},
    )
    values: dict[str, Any] = {
        "model": model,
        "label": f"{model} without a solver",
        "settings": {"grid": [5, 5, 2]} if model == "lumped" else {"elements": 16},
        "status": Status.CONVERGED,
        "unknowns": 75,
        "iterations": 3,
        "setup_seconds": 0.1,
        "solve_seconds": 0.004,
        "sample": sample,
        "reactions": {support.edge: np.array([0.0, 0.0, 0.8]) for support in scene.supports},
        "energies": {"strain": 1e-3},
        "mesh": mesh,
    }
    return Solution(**{**values, **changes})


def history(time: np.ndarray, probes: dict[str, np.ndarray]) -> History:
    """Return a motion (n,) [s] of probes (n, 3) [m] whose energies all equal the time."""
    energies = dict.fromkeys(ENERGIES, time)
    return History("lumped", "verlet", {}, Status.CONVERGED, "", time, probes, energies, {}, {}, 4, 0.0, 0.0)
