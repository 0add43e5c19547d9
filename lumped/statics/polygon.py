"""What a chain's rigid segments do to the sheet between its joints.

Where a segment spans several cells it holds the edge, position and director, straight from joint to joint,
and the sheet bends about the joints alone: the chain, of stiffness EI, has to give it its kinks, and bends
the edge less than an elastic rod would. By the share x/(1 + x), for n segments of r cells each (one cell has
nothing to hold straight) on an edge of length L of a sheet of bending stiffness D,

    x = n^(−1.84) (ln r)^1.28 (0.12 + 3.4 z/(1 + 0.21 z)),    z = D L/EI

The form is of its causes: harmonics of the parabolas between the joints as r cells can show them, and the
sheet's own resistance beside the chain's. Its five numbers were fitted to 85 chains, n = 2 to 16, r = 2 to 8,
z = 0.015 to 6, sheets of ½ to 2 L across the edge, commands of 0.1 to 12 1/m, against the same grid with a
segment a cell: they are within a factor of 1.51 of all that lose more than 0.5 % (test_polygon.py). How
much less the probes move is not detected so well: it depends on where they are, and on what else moves the
sheet.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from sheetbench.scenes import EDGES, Chain, Scene
from sheetbench.scenes.summary import few

REPORTED = 0.01  # share of the bending from which on it is reported
SEGMENTS, CELLS, CHAIN, SHEET, RESISTANCE = -1.84, 1.28, 0.12, 3.4, 0.21


def lost_bending(scene: Scene, grid: Sequence[int]) -> dict[str, float]:
    """Of every edge with chains that bend it upwards or down: the share of their bending that segments
    longer than the cells of a grid of masses (nx, ny, …) take, 0 where they are not longer."""
    sheet, material = scene.sheet, scene.material
    rigidity = material.young * sheet.thickness**3 / 12.0 / (1.0 - material.poisson**2)
    found: dict[str, float] = {}
    for edge in {actuator.edge for actuator in scene.actuators}:
        chains = [
            a for a in scene.actuators if isinstance(a, Chain) and a.edge == edge and a.plane != "inplane"
        ]
        if not chains:
            continue
        along = EDGES[edge].along_axis
        segments = chains[0].segments
        cells = max((grid[along] - 1) / segments, 1.0)
        ratio = rigidity * sheet.lengths[along] / sum(chain.bending_stiffness for chain in chains)
        kinks = CHAIN + SHEET * ratio / (1.0 + RESISTANCE * ratio)
        lost = segments**SEGMENTS * math.log(cells) ** CELLS * kinks
        found[edge] = lost / (1.0 + lost)
    return found


def polygons(scene: Scene, grid: Sequence[int]) -> str:
    """A sentence about chains whose segments keep a noticeable part of the bending back, else nothing."""
    if not scene.actuators:
        return ""
    notes = [
        f"the chain on {edge} bends it some {few(100.0 * share)} % less than an elastic rod would: each "
        "rigid segment holds several cells straight; take one segment a cell"
        for edge, share in sorted(lost_bending(scene, grid).items())
        if share > REPORTED
    ]
    return "; ".join(notes)
