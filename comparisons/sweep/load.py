"""What times depend on: the machine and its load, the worker of a cluster, the scatter of samples."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
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
    """Return what a measured time depends on, ready for JSON: load, machine, versions, and the address of the
    dask worker that this runs on."""
    versions = {"sheetbench": sources.version(), **manifest.versions()}
    found = {"load_average": average(), "machine": manifest.machine(), "versions": versions}
    with suppress(KeyError, ValueError):  # without dask, and outside a worker
        found["worker"] = sys.modules["distributed"].get_worker().address
    return found


def warnings(costs: Iterable[Mapping[str, Any]], samples: Iterable[Sequence[float]] = ()) -> list[str]:
    """Return sentences on times that are of a cluster's worker or of several, or doubtful: taken under a load
    above the processors' number, or with samples [s] that scatter by more than SCATTER.

    costs: what `conditions` says of each time, as far as it is known.
    """
    known = [cost for cost in costs if cost.get("load_average") is not None]
    cores = [cost.get("machine", {}).get("cpu_count") or os.cpu_count() or 1 for cost in known]
    busy = [(cost["load_average"], most) for cost, most in zip(known, cores, strict=True)]
    busy = [(load, most) for load, most in busy if load > most]
    sentences, workers = [], sorted({str(cost.get("worker", "this machine")) for cost in known})
    machines = {str(cost.get("machine")) for cost in known if "machine" in cost}
    if len(workers) > 1 or len(machines) > 1:
        sentences.append(f"times are not of one machine ({', '.join(workers)}): compare them with care")
    elif workers and workers != ["this machine"]:
        sentences.append(f"all times are of one worker of the cluster, {workers[0]}")
    if busy:
        times = "times are" if len(known) == 1 else f"{len(busy)} of {len(known)} times are"
        load = "load {:.3g} on {} processors".format(*max(busy))
        sentences.append(f"{times} not reliable: the machine was busy ({load})")
    ratios = [max(times) / min(times) for times in samples if len(times) > 1 and min(times) > 0.0]
    wide = [ratio for ratio in ratios if ratio > SCATTER]
    if wide:
        sentences.append(
            f"{len(wide)} of {len(ratios)} timings vary by more than a factor of {SCATTER:g}, by up to "
            f"{max(wide):.3g}: other programs ran at the same time"
        )
    return sentences
