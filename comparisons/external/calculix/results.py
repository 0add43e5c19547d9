"""Results of `ccx`: displacements in the .dat file, iterations in the .sta file."""

from __future__ import annotations

import re

import numpy as np

from comparisons.external.process import Failed

_HEADING = re.compile(r"^ *displacements .* and time +(\S+) *$", re.MULTILINE)


def displacements(dat: str, nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the times (s,) of the increments that were printed, of statics the load factors, and their
    displacements (s, nodes, 3) [m], nan of nodes that were not.

    Raises Failed for a file that does not have them.
    """
    headings = list(_HEADING.finditer(dat))
    if not headings:
        raise Failed("its .dat file has no displacements")
    out = np.full((len(headings), nodes, 3), np.nan)
    try:
        for sample, heading in zip(out, headings, strict=True):
            for line in dat[heading.end() :].split("\n\n", 2)[1].splitlines():
                number, *components = line.split()
                sample[int(number) - 1] = [float(c) for c in components]
        times = [float(heading.group(1)) for heading in headings]
    except (ValueError, IndexError):
        raise Failed("its .dat file cannot be read") from None
    return np.array(times), out


def iterations(sta: str) -> int:
    """Equilibrium iterations, each one factorisation; a linear step has one."""
    rows = [line.split() for line in sta.splitlines()]
    counts = [int(row[3]) for row in rows if len(row) >= 7 and all(part.isdigit() for part in row[:4])]
    return max(sum(counts), 1)
