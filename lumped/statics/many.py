"""Many equilibria at once, over all cores: springs, materials or loads that vary on one grid.

Each case is solved as `lumped.solve` does, on a thread of its own: the compiled corrections hold no lock
(`lumped.statics.fused`), and what the lattices have in common (links of the grid, pattern, order of the
unknowns) is found once and kept.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from lumped.calibration import Calibration
from lumped.linear.threads import one_blas_thread
from lumped.statics.solver import compile_kernels, solve
from sheetbench.scenes import AnyScene, Scene, Solution, scene_of
from sheetbench.scenes.errors import BadInput


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
    asked = [scenes] if isinstance(scenes, Scene | str | Path) else list(scenes)
    given = [calibrations] if isinstance(calibrations, Calibration | None) else list(calibrations)
    count = max(len(asked), len(given)) if asked and given else 0
    if {len(asked), len(given)} - {1, count}:
        raise BadInput(f"{len(asked)} scenes and {len(given)} calibrations: give one, or as many")
    posed = [scene_of(scene) for scene in asked]
    pairs = zip(posed * (count // len(posed)), given * (count // len(given)), strict=True) if count else ()
    compile_kernels()
    with one_blas_thread(), ThreadPoolExecutor(workers or os.cpu_count()) as pool:
        return list(pool.map(lambda pair: solve(*pair, **options), pairs))
