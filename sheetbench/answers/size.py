"""The size of a solve, computed before it is set up: unknowns, memory and time.

The factors of a matrix whose graph is a grid of N nodes with d unknowns each, s nodes along the shorter side,
ordered by nested dissection, have

    nonzeros   31/4 N log2(s) d²          operations   829/84 N s d³

and a band, which is less on strips, N (s + 1) d² and N (s + 1)² d³. Sources: A. George, SIAM J. Numer. Anal.
10 (1973) 345–363 (square grids); R. J. Lipton, D. J. Rose, R. E. Tarjan, SIAM J. Numer. Anal. 16 (1979)
346–358. Each model adds its own further needs.
"""

from dataclasses import dataclass
from math import log2


@dataclass(frozen=True)
class Size:
    """Size of a static solve. memory: the peak [bytes] above the code's own. seconds: on one core, with the
    usual five factorisations or so."""

    unknowns: int
    memory: float
    seconds: float


def factors(nodes: tuple[int, int], unknowns: int) -> tuple[float, float]:
    """Return the nonzeros of the factors of a grid, and the operations to compute them. unknowns: the number
    of unknowns a node."""
    shorter, count = min(nodes), nodes[0] * nodes[1]
    nonzeros = count * min(31 / 4 * log2(shorter), shorter + 1.0)
    operations = count * min(829 / 84 * shorter, (shorter + 1.0) ** 2)
    return nonzeros * unknowns**2, operations * unknowns**3
