"""The natural strain that gives a sheet its pretension by a lattice's springs.

Held at its drawn size, a lattice of equally stretched cells does the work Σ f·δx = N : δε A in a small strain
of its plan, f the springs' forces on the masses at x, so that its tension N is Σ f xᵀ/A. The distance of its
layers is free: Σ f_z z = 0. The area of a cell that is stiffer, or partly covered by the sheet, counts by the
factor of its stiffness. Derived for this project.
"""

from collections.abc import Callable
from copy import copy

import numpy as np

from lumped.assembly import Assembly
from lumped.calibration import Calibration
from lumped.sections import CellSection
from sheetbench.scenes import Scene, Sheet
from sheetbench.scenes.meaning.composition import of_sheet
from sheetbench.scenes.meaning.natural_state import NaturalState, Source, held_at_drawn_size, sheet_at_rest
from sheetbench.scenes.objects.natural import Natural


def with_pretension_strain(scene: Scene, assembly: Assembly) -> Scene:
    """Return the scene with the natural strain that gives its pretension in a lattice without a natural
    state."""

    def tension(strain: np.ndarray) -> np.ndarray:
        from scipy.optimize import newton

        lattice, areas = assembly.lattice, assembly.lattice.cell_areas
        if assembly.cells is not None:
            of_cells, whole = assembly.cells.bending, CellSection.of(of_sheet(scene)).bending
            areas = areas * of_cells[..., 0, 0] / whole[..., 0, 0]
        area, plan, size = areas.sum(), lattice.positions[:, :2], len(lattice.positions)
        thicker = np.zeros((size if assembly.coupling is None else assembly.coupling.size, 3))
        thicker[:size, 2] = height = lattice.positions[:, 2]
        shape = tuple(len(line.widths) for line in reversed(lattice.lines))
        source, grown = Source("natural", Natural(), strain, np.zeros(3)), copy(assembly)
        grown.grow(NaturalState([source], shape, lambda _: np.ones(shape)))

        def push(by: float) -> float:
            return float(grown.force(by * thicker)[1][:size, 2] @ height)

        by = newton(push, 0.0, x1=1e-3 * np.abs(strain).max(), tol=1e-13)
        work = grown.force(by * thicker)[1][:size, :2].T @ plan
        return np.array([work[0, 0], work[1, 1], 0.5 * (work[0, 1] + work[1, 0])]) / area

    return held_at_drawn_size(scene, tension)


def calibrated_at_rest(scene: Scene, calibrate: Callable[[Sheet], Calibration]) -> Calibration:
    """Return the springs of a scene's sheet at its size at rest.

    Parameters
    ----------
    scene : Scene
        Scene with or without a natural strain or pretension.
    calibrate : callable
        Function ``Sheet -> Calibration`` that calibrates a sheet of given length and width.

    Returns
    -------
    Calibration
        Springs of the sheet at rest. The size at rest under a pretension follows from springs that are
        calibrated with the linear law's size first.
    """
    return calibrate(size_at_rest(scene, calibrate))


def size_at_rest(scene: Scene, calibrate: Callable[[Sheet], Calibration]) -> Sheet:
    """Return the sheet of a scene at its size at rest; `calibrate` is called under a pretension alone."""
    sheet = sheet_at_rest(scene)
    if scene.natural is None or scene.natural.pretension is None:
        return sheet
    return sheet_at_rest(with_pretension_strain(scene, Assembly(scene.sheet, calibrate(sheet))))
