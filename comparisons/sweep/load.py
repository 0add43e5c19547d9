"""Signs of a busy machine while times were taken: its load, and the scatter of samples."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import Any

from comparisons.sweep import manifest
from sheetbench import sources

SCATTER = 2.0  # largest over smallest sample of one time


def average() -> float | None:
    """Return how many processes wanted a processor in the last minute, on average; None where unknown."""
    try:
        return os.getloadavg()[0]
    except (OSError, AttributeError):
        return None


def conditions() -> dict[str, Any]:
    """Return what a measured time depends on, ready for JSON: load, machine, versions."""
    versions = {"sheetbench": sources.version(), **manifest.versions()}
    return {"load_average": average(), "machine": manifest.machine(), "versions": versions}


def warnings(loads: Iterable[float | None], samples: Iterable[Sequence[float]] = ()) -> list[str]:
    """Return sentences on times that are doubtful: taken under a load above the processors' number, or with
    samples [s] that scatter by more than SCATTER."""
    cores = os.cpu_count() or 1
    known = [load for load in loads if load is not None]
    busy = [load for load in known if load > cores]
    sentences = []
    if busy:
        times = "times are" if len(known) == 1 else f"{len(busy)} of {len(known)} times are"
        load = f"load {max(busy):.3g} on {cores} processors"
        sentences.append(f"{times} too long: the machine was busy ({load})")
    ratios = [max(times) / min(times) for times in samples if len(times) > 1 and min(times) > 0.0]
    wide = [ratio for ratio in ratios if ratio > SCATTER]
    if wide:
        sentences.append(
            f"{len(wide)} of {len(ratios)} timings vary by more than a factor of {SCATTER:g}, by up to "
            f"{max(wide):.3g}: other programs ran at the same time"
        )
    return sentences
