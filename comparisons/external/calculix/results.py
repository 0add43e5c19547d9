"""Results of `ccx`: displacements in the .dat file, load factors in the .sta file."""

from __future__ import annotations

import re

import numpy as np

from comparisons.external.process import Failed

_HEADING = re.compile(r"^ *displacements .* and time +(\S+) *$", re.MULTILINE)


def displacements(dat: str, nodes: int) -> tuple[float, np.ndarray]:
    """Return the load factor of the last increment that was kept, and its displacement (nodes, 3) [m].

    Raises Failed for a file that does not have it.
    """
    headings = list(_HEADING.finditer(dat))
    if not headings:
        raise Failed("its .dat file has no displacements")
    last = headings[-1]
    out = np.full((nodes, 3), np.nan)
    try:
        for line in dat[last.end() :].split("\n\n")[1].splitlines():
            number, *components = line.split()
            out[int(number) - 1] = [float(c) for c in components]
        time = float(last.group(1))
    except (ValueError, IndexError):
        raise Failed("its .dat file cannot be read") from None
    return time, out


def iterations(sta: str) -> int:
    """Equilibrium iterations, each one factorisation; a linear step has one."""
    rows = [line.split() for line in sta.splitlines()]
    counts = [int(row[3]) for row in rows if len(row) >= 7 and all(part.isdigit() for part in row[:4])]
    return max(sum(counts), 1)
