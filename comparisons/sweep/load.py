"""Conditions of measured times: the machine and its load, the worker of a cluster, the scatter of samples."""

import os
import sys
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from typing import Any

from comparisons.sweep import manifest
from sheetbench import sources

SCATTER = 2.0  # ratio of the largest and smallest sample of one time


def average() -> float | None:
    """Return the system's load average of the last minute, None if unknown."""
    try:
        return os.getloadavg()[0]
    except (OSError, AttributeError):
        return None


def conditions() -> dict[str, Any]:
    """Return the conditions of a measured time: load, machine, versions, this dask worker's address."""
    versions = {"sheetbench": sources.version(), **manifest.versions()}
    out = {"load_average": average(), "machine": manifest.machine(), "versions": versions}
    with suppress(KeyError, ValueError):  # without dask, and outside a worker
        out["worker"] = sys.modules["distributed"].get_worker().address
    return out


def warnings(costs: Iterable[Mapping[str, Any]], samples: Iterable[Sequence[float]] = ()) -> list[str]:
    """Return sentences on times of cluster workers, and on unreliable times.

    Times are unreliable if the load exceeded the number of processors, or if their samples [s] scatter by
    more than SCATTER. costs: the `conditions` of each time, as far as known.
    """
    costs = [cost for cost in costs if cost.get("load_average") is not None]
    cores = [cost.get("machine", {}).get("cpu_count") or os.cpu_count() or 1 for cost in costs]
    loads = [(cost["load_average"], count) for cost, count in zip(costs, cores, strict=True)]
    overloaded = [(load, count) for load, count in loads if load > count]
    sentences = []
    workers = sorted({str(cost.get("worker", "this machine")) for cost in costs})
    machines = {str(cost.get("machine")) for cost in costs if "machine" in cost}
    if len(workers) > 1 or len(machines) > 1:
        sentences.append(f"times are not of one machine ({', '.join(workers)}): compare them with care")
    elif workers and workers != ["this machine"]:
        sentences.append(f"all times are of one worker of the cluster, {workers[0]}")
    if overloaded:
        times = "times are" if len(costs) == 1 else f"{len(overloaded)} of {len(costs)} times are"
        load = "load {:.3g} on {} processors".format(*max(overloaded))
        sentences.append(f"{times} not reliable: other programs were running ({load})")
    ratios = [max(times) / min(times) for times in samples if len(times) > 1 and min(times) > 0.0]
    scattered = [ratio for ratio in ratios if ratio > SCATTER]
    if scattered:
        sentences.append(
            f"{len(scattered)} of {len(ratios)} timings vary by more than a factor of {SCATTER:g}, by up to "
            f"{max(scattered):.3g}: other programs were running"
        )
    return sentences
