"""Equilibria of many designs of one lattice, side by side on all cores."""

from __future__ import annotations

import os
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from lumped.calibration import Calibration
from lumped.gradient import Calibrate
from lumped.sensitivity import Differentiable
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import AnyScene


@dataclass(frozen=True)
class Designs:
    """displacement: (designs, n, 3) [m] of the masses, NaN where a design has no stable equilibrium; status:
    of each; factorisations: of all."""

    displacement: np.ndarray
    status: list[Status]
    factorisations: int


def solve_many(
    scene: AnyScene,
    designs: Mapping[str, np.ndarray],
    calibration: Calibration | None = None,
    *,
    calibrate: Calibrate | None = None,
    workers: int | None = None,
) -> Designs:
    """Return the equilibria of designs, each sought first from the scene's own. designs: values by name, as
    `Differentiable.solve` takes them, with a leading axis. workers: threads, one a core unless given."""
    sheet = Differentiable(scene, calibration, calibrate)
    counts = {len(values) for values in designs.values()}
    if len(counts) != 1:
        raise BadInput(f"designs: {sorted(counts)} values: as many of each are needed")
    start = sheet.solve({})
    out = np.full((counts.pop(), *start.shape), np.nan)

    def solved(number: int) -> tuple[Status, int]:
        _, path = sheet.path({name: values[number] for name, values in designs.items()}, start)
        if path.status is Status.CONVERGED:
            out[number] = path.state.u
        return path.status, path.factorisations

    with one_blas_thread(), ThreadPoolExecutor(workers or os.cpu_count()) as pool:
        found = list(pool.map(solved, range(len(out))))
    return Designs(out, [status for status, _ in found], sum(count for _, count in found))
