"""Estimated memory and time of a reference, from its mesh alone.

Elements are biquadratic in the plan, (2 nx + 1) (2 ny + 1) nodes; plate and shell have five unknowns a node,
a solid of L layers of bricks 3 (2 L + 1). Memory and work are proportional to the number of elements, except
for the factors of the tangent.

The constants were fitted to static solves on an AMD EPYC with Python 3.11, 2026-11-22: bytes to the peaks of
the resident set, for plates of 32² to 96² elements, solids of 8² to 24² and of two layers, strips of 4 × 256,
all of them within 21 %. Shells of 16² to 64² reach 1/1.5 of their bytes, within 4 %, while their tangent is
positive definite; where it is not, it is factored another way, which takes about twice as much. Seconds to
0.24 and 1.7 s for shells of 16² and 32² on a quiet core and, where there was none, to half the processor time
on a busy one.
"""

from typing import NamedTuple

from sheetbench.answers.size import Size, factors


class Cost(NamedTuple):
    """Cost model. Bytes: constant, per element and per nonzero of the factors; seconds per element and per
    operation of factorising."""

    constant: float
    element: float
    nonzero: float
    element_seconds: float
    operation_seconds: float


COSTS = {
    "plate": Cost(10e6, 0.21e6, 8.0, 0.5e-3, 2e-10),
    "shell": Cost(8e6, 0.075e6, 24.0, 1.35e-3, 1e-9),
    "solid": Cost(20e6, 1.2e6, 14.0, 6e-3, 1.2e-9),
}


def footprint(model: str, elements: tuple[int, int], layers: int = 1) -> Size:
    """Return the size of a static solve; frequencies of a shell take 1.7 times the memory."""
    nodes = (2 * elements[0] + 1, 2 * elements[1] + 1)
    unknowns = 3 * (2 * layers + 1) if model == "solid" else 5
    count = elements[0] * elements[1] * layers
    nonzeros, operations = factors(nodes, unknowns)
    cost = COSTS[model]
    return Size(
        unknowns=nodes[0] * nodes[1] * unknowns,
        memory=cost.constant + cost.element * count + cost.nonzero * nonzeros,
        seconds=cost.element_seconds * count + cost.operation_seconds * operations,
    )
