"""Many equilibria at once: springs, materials or loads that vary on one grid.

What the lattices have in common is found once and kept: links of the grid, pattern, order of the unknowns,
supports. Compiled kernels hold no lock, so that threads share the cores.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from lumped.calibration import Calibration
from lumped.statics.solver import compile_kernels, solve
from sheetbench.errors import BadInput
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import AnyScene, Scene, Solution, scene_of


def solve_many(
    scenes: AnyScene | Sequence[AnyScene],
    calibrations: Calibration | Sequence[Calibration | None] | None = None,
    *,
    workers: int | None = None,
    **options: Any,
) -> list[Solution]:
    """The static equilibria of one scene with each of many springs, of many scenes with one kind of springs,
    or of as many scenes as springs, in pairs and in order.

    scenes, calibrations: one, or a sequence; without calibrations each scene has its own, as in `solve`.
    workers: threads, as many as there are cores unless given. options: of `solve`. Every answer has its own
    status and its own balance: a case that diverges costs no other.

    Raises BadInput for sequences of unequal lengths, and what `solve` raises for a scene or an option.
    """
    requested = [scenes] if isinstance(scenes, Scene | str | Path) else list(scenes)
    given = [calibrations] if isinstance(calibrations, Calibration | None) else list(calibrations)
    count = max(len(requested), len(given)) if requested and given else 0
    if {len(requested), len(given)} - {1, count}:
        raise BadInput(f"{len(requested)} scenes and {len(given)} calibrations: give one, or as many")
    if not count:
        return []
    several = [scene_of(scene) for scene in requested] * (count // len(requested))
    springs = given * (count // len(given))
    compile_kernels()
    with one_blas_thread(), ThreadPoolExecutor(workers or os.cpu_count() or 1) as pool:
        return list(pool.map(lambda case: solve(*case, **options), zip(several, springs, strict=True)))
