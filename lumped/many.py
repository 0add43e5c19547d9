"""Equilibria of many designs of one lattice, in parallel on all cores.

Designs of moduli and forces on springs of the linear laws start at the scene's own equilibrium, and go on in
one compiled loop that holds no lock: steps with its factors, near the end with the factors of their own
tangent, which has to be positive definite, made again where a step takes less than nine tenths off. Designs
that do not end so, and others, follow the load path (`Differentiable.path`).
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from lumped.calibration import Calibration
from lumped.cell_fields import YOUNG
from lumped.gradient import FORCES
from lumped.sensitivity import Differentiable
from lumped.springs import all_families
from lumped.springs.all_families import SpringArrays, Stresses
from lumped.springs.cells import CellArrays
from lumped.springs.law_table import AreaAndStrains
from lumped.springs.links import LinkArrays
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.numerics import banded
from sheetbench.numerics.aliasing import empty
from sheetbench.numerics.banded import Band
from sheetbench.numerics.options import Pointer, njit, pointer
from sheetbench.numerics.sparse_products import Rows, product, transposed_product
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import AnyScene

TOLERANCE = 1e-11  # of a residual, relative to the loads
STEPS = 30
PART = 64  # designs that a thread takes at a time
NEAR = 1e-3  # of the loads, the residual from which on a design has a tangent of its own


@dataclass(frozen=True)
class Designs:
    """Equilibria of many designs.

    Parameters
    ----------
    displacement : ndarray of shape (designs, n, 3)
        Displacement [m] of the masses, NaN where a design has no stable equilibrium.
    status : list of Status
        Status of each design.
    """

    displacement: np.ndarray
    status: list[Status]


def solve_many(
    scene: AnyScene,
    designs: Mapping[str, np.ndarray],
    calibration: Calibration | None = None,
    *,
    workers: int | None = None,
) -> Designs:
    """Return the equilibria of many designs of one scene, each sought first from the scene's own.

    Parameters
    ----------
    scene : Scene, str or Path
        Scene with a static answer, the name of one in the catalogue, or the path of its file.
    designs : dict of str to ndarray
        Values by name as in `Differentiable.solve`, with a leading axis over the designs.
    calibration : Calibration, optional
        Springs; by default the scene's, or consistent ones on nine masses along the shorter side.
    workers : int, optional
        Number of threads, by default one a core.

    Returns
    -------
    Designs
        Displacements [m] and status.

    Raises
    ------
    BadInput
        For numbers of designs that differ between names, unknown fields and fields of another shape.
    """
    sheet = Differentiable(scene, calibration)
    counts = {len(values) for values in designs.values()}
    if len(counts) != 1:
        raise BadInput(f"designs: {sorted(counts)} values: equal numbers of values are needed")
    start, count = sheet.solve({}), counts.pop()
    sheet.checked({name: values[0] for name, values in designs.items() if count})
    out, done = np.full((count, *start.shape), np.nan), np.zeros(count, dtype=bool)

    def solved(number: int) -> Status:
        _, path = sheet.path({name: values[number] for name, values in designs.items()}, start)
        out[number] = path.state.u if path.status is Status.CONVERGED else np.nan
        return path.status

    with one_blas_thread(), ThreadPoolExecutor(workers or os.cpu_count() or 1) as pool:
        if designs.keys() <= {YOUNG, FORCES} and _qualifies(sheet):
            solve = _compiled_solver(sheet, start, designs, out, done)
            list(pool.map(solve, [slice(at, at + PART) for at in range(0, count, PART)]))
        others = np.flatnonzero(~done).tolist()
        status = dict(zip(others, pool.map(solved, others), strict=True))
    return Designs(out, [status.get(number, Status.CONVERGED) for number in range(count)])


def _qualifies(sheet: Differentiable) -> bool:
    """Return whether a lattice qualifies for the compiled loop: springs of linear laws, dead loads, a small
    matrix."""
    problem = sheet.problem
    others = problem.contacts or problem.assembly.coupling is not None or problem.loads.follow
    linear = problem.assembly.conservative and not problem.assembly.any_strain
    flat = problem.assembly.natural is None and not len(problem.assembly.springs[3])
    return bool(not others and linear and flat and problem.system.band is not None)


def _compiled_solver(
    sheet: Differentiable,
    start: np.ndarray,
    designs: Mapping[str, np.ndarray],
    out: np.ndarray,
    done: np.ndarray,
) -> Callable[[slice], None]:
    """Return the function that solves a part of the designs in compiled code and marks converged designs."""
    problem, assembly, band = sheet.problem, sheet.problem.assembly, sheet.problem.system.band
    base, forces = sheet.base[YOUNG].ravel(), np.broadcast_to(designs.get(FORCES, 0.0), out.shape)
    young = np.broadcast_to(np.reshape(designs.get(YOUNG, base), (-1, base.size)), (len(out), base.size))
    of_cells = sheet.cells.by_cells(sheet.calibration.constants, assembly, {})
    assert band is not None
    start_factors, _ = banded.factored(problem.tangent(start, 1.0), band)
    free, none = problem.constraints.transform_arrays, all_families.NO_STRESSES
    given = start, start_factors, assembly.all_families.springs

    def solve(part: slice) -> None:
        factor = young[part] / np.where(base > 0.0, base, 1.0)
        links, *arrays = (np.einsum("qmn,bqm->bmn", each, factor[:, cells]) for cells, each in of_cells[:3])
        arrays = [links[..., 0], *arrays, forces[part] + problem.loads.last_dead]
        rounding = assembly.rounding * assembly.all_families.link_stiffness_norm * factor.max(initial=1.0)
        ends = free, band, float(rounding), none, out[part], done[part]
        correct(*given, *map(np.ascontiguousarray, arrays), *ends)

    return solve


@njit
def correct(
    start: np.ndarray,
    start_factors: np.ndarray,
    springs: Pointer[SpringArrays],
    k: np.ndarray,
    layers: np.ndarray,
    middle: np.ndarray,
    loads: np.ndarray,
    free: Rows,
    band: Band,
    rounding: float,
    none: Stresses,
    out: np.ndarray,
    done: np.ndarray,
) -> None:
    """Set displacements (designs, n, 3) [m] in equilibrium under loads (designs, n, 3) [N] with links of
    stiffness k (designs, m) and cells of the constants `layers` and `middle` (designs, c, 7), corrected with
    the factors of `start`, then with factors of each design; `done` marks convergence; rounding [N/m]:
    rounding error of the forces over the displacement."""
    n = len(band.order)
    of = springs.value
    a, b, c = of.links, of.layers, of.middle
    for d in range(len(k)):
        arrays = SpringArrays(
            LinkArrays(a.nodes, a.offset, a.rest, k[d], a.slots),
            CellArrays(b.nodes, b.sides, b.rest, AreaAndStrains(layers[d]), b.slots),
            CellArrays(c.nodes, c.sides, c.rest, AreaAndStrains(middle[d]), c.slots),
            of.faces,
            of.blocks,
            of.mirror,
            of.diagonal,
        )
        own = pointer(arrays)
        u, last, size = start.copy(), np.inf, np.sqrt(np.sum(loads[d] ** 2))
        factors, own_factors, fresh = start_factors, False, False
        for _ in range(STEPS):
            rows = transposed_product(free, (loads[d] - all_families.force(u, own)[1]).ravel(), n)
            imbalance = np.sqrt(np.sum(rows * rows))
            converged = imbalance <= max(TOLERANCE * size, rounding * np.abs(u).max())
            slow = not fresh and not imbalance <= (0.1 if own_factors else 0.5) * last
            if slow or (not own_factors and imbalance <= NEAR * size) or (converged and not own_factors):
                blocks = all_families.tangent(u, none, False, 1.0, 1.0, empty(0), own)
                factors = banded.stored(blocks, band)
                if not banded.factor(factors, n, band.width):
                    break
                own_factors = fresh = True
            else:
                fresh = False
            if converged:  # stable, as the tangent nearest to it says
                out[d], done[d] = u, True
                break
            last = imbalance
            u += product(free, banded.solve_unrefined(factors, band.width, band.order, rows)).reshape(u.shape)
