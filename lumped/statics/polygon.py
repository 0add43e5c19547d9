"""What a chain of few rigid segments keeps back of the bending of an elastic rod.

The edge is a smooth curve through a chain's joints (`lumped.actuators.binding`), whatever the cells of the
grid, but a free end's half segment has no joint that would bend it, and the curve is no freer than the
joints are. Of the bending of the shell's rod six chains, on sheets of D L = 0.06 to 6 EI, D per width,
lose 23 to 50 % with two segments, 1.1 to 7 with four and 0.2 to 2.8 with eight.
"""

from __future__ import annotations

from sheetbench.scenes import Chain, Scene

FEW = 6  # segments, below which it is said


def polygons(scene: Scene) -> str:
    """A sentence about chains of few segments, else nothing."""
    chains = {str(a.edge): a for a in scene.actuators if isinstance(a, Chain) and a.plane != "inplane"}
    notes = [
        f"the chain on {edge} has {chain.segments} segment{'s' * (chain.segments > 1)}: it bends the edge "
        "less than an elastic rod would, by tens of percent with two, by some with four; take eight or more"
        for edge, chain in sorted(chains.items())
        if chain.segments < FEW
    ]
    return "; ".join(notes)
