"""What a chain's rigid segments do to the sheet between its joints.

Where a segment spans several cells it holds the edge, position and director, straight from joint to joint,
and the sheet bends about the joints alone. Against the arc of curvature κ the edge is a polygon, off by the
parabola ½ κ s² of every segment of length d, whose m-th harmonic κ d²/(2π²m²) of wave number 2πm/d costs the
sheet ½ D k³ a² per length (a half plane whose edge keeps its slope); the slopes across the edge, held in
steps too, cost as much again. Summed over the harmonics that a segment's r cells can show, Σ 1/m ≈ ln r, it
is as if the chain's bending stiffness were larger by

    ΔEI = (4/π) D d ln r,

and the chain, asked for a curvature, bends less by ΔEI/(EI + D b/3 + ΔEI), with b the sheet's length across
the edge, whose own resistance D b/3 (deflections linear in the distance) it has to overcome anyhow. With one
cell a segment, masses at the joints, there is nothing to hold straight. Derived for this project; within a
factor of 1.8 of what grids of 9 to 33 masses and 4 to 16 segments do, too small for four segments and too
large for sixteen (tests/test_polygon.py).
"""

from __future__ import annotations

import math

from lumped.lattice import Lattice
from sheetbench.scenes import EDGES, Chain, Scene

SAID = 0.01  # share of the bending from which on it is said


def lost_bending(scene: Scene, lattice: Lattice) -> dict[str, float]:
    """Of every edge with chains that bend it upwards or down: the share of their bending that segments longer
    than cells take, 0 where they are not longer."""
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
        segment = sheet.lengths[along] / chains[0].segments
        cells = max(segment / lattice.spacing[along], 1.0)
        stiffer = 4.0 / math.pi * rigidity * segment * math.log(cells)
        own = sum(chain.bending_stiffness for chain in chains) + rigidity * sheet.lengths[1 - along] / 3.0
        found[edge] = stiffer / (own + stiffer)
    return found


def polygons(scene: Scene, lattice: Lattice) -> str:
    """A sentence about chains whose segments keep a noticeable part of the bending back, else nothing."""
    said = [
        f"the chain on {edge} bends it some {100.0 * share:.2g} % less than an elastic rod would: each rigid "
        "segment holds several cells straight; take one segment a cell"
        for edge, share in sorted(lost_bending(scene, lattice).items())
        if share > SAID
    ]
    return "; ".join(said)
