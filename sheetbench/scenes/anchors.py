"""Chains that are held along themselves at two places.

A chain does not stretch. Held along its edge at two places it could bend only if it did, and how stiff it is
against that no scene says: lattice and references would each answer for a stiffness of their own, tens of
percent apart. Such scenes are refused. A chain is held along itself

- where its base stands;
- at a corner that a support on the neighbouring edge holds along the chain, unless the support moves;
- at a corner where the chain of the neighbouring edge has its base, or where that chain is kept in a plane
  across this one by a base elsewhere: `plane = "normal"`, and not free.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from sheetbench.scenes.actuators import Chain, EdgeMotion
from sheetbench.scenes.sheet import EDGES
from sheetbench.scenes.supports import AnySupport, held_axes, named


def held_twice(actuators: Sequence[Chain | EdgeMotion], supports: Sequence[AnySupport]) -> str | None:
    """A sentence saying which chain is held along itself at two places, and what to change; or None."""
    chains = {str(chain.edge): chain for chain in actuators if isinstance(chain, Chain)}
    fixed = {name: support for name, support in named(supports).items() if support.motion is None}
    for number, chain in enumerate(actuators, start=1):
        if not isinstance(chain, Chain):
            continue
        places = {end: holder for end in (0, 1) if (holder := _holder(chain, end, chains, fixed))}
        if chain.base != "free":
            places[{"start": 0, "middle": -1, "end": 1}[chain.base]] = f'by its own base = "{chain.base}"'
        if len(places) > 1:
            where = {0: "where it starts", 1: "where it ends", -1: "in its middle"}
            held = ", and ".join(f"{where[place]} {by}" for place, by in places.items())
            return (
                f"{number} on edge {chain.edge} is held along itself {held}: a chain does not stretch, so "
                "this one could not bend; let go of all but one, a chain's hold by its "
                'base = "free" or plane = "spatial", a support\'s by one that does not hold the corner along '
                "the edge"
            )
    return None


def _holder(
    chain: Chain, end: int, chains: Mapping[str, Chain], fixed: Mapping[str, AnySupport]
) -> str | None:
    """What holds an end (0 or 1) of a chain along the chain, other than its own base; None where nothing."""
    along = EDGES[chain.edge].along_axis
    edge = f"{'xy'[along]}{end}"
    if edge in fixed and along in held_axes(fixed[edge]):
        return f"by the {fixed[edge].kind} support on edge {edge}"
    other = chains.get(edge)
    if other is None:
        return None
    if int(chain.edge[1]) in other.base_ends:
        return f'by the base = "{other.base}" of the chain on edge {edge}'
    if other.plane == "normal" and other.base != "free":
        return f'by the chain on edge {edge}, which plane = "normal" and base = "{other.base}" keep straight'
    return None
