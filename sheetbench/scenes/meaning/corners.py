"""Supports, motions and chains of edges and their corners, and contradictions between them.

An edge has one support, one motion, or chains that agree. At a common corner of two edges a support holds
components of the corner's displacement, and perhaps its director; bent rods, tilted clamps and motions move
both (`scenes.meaning.kinematics`). Two objects that hold one component must agree at every time, for models
would resolve a contradiction differently. They are compared at the samples of both tables, and between them
at two points that no periodic motion takes for samples. A corner on which a motion agrees belongs to the
motion; a chain follows its corner, unless its base stands there.

A chain does not stretch. Held along its edge at two places it could bend only if it did, and a scene has no
stiffness for that: lattice and references would use different ones, and their answers differ by tens of
percent. A scene with a chain held at two places is refused. A chain is held along itself

- where its base stands;
- at a corner that a support on the neighbouring edge holds along the chain, unless the support moves;
- at a corner where the chain of the neighbouring edge has its base, or where that chain is kept in a plane
  across this one by a base elsewhere: `plane = "normal"`, and not free.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations, pairwise, product

import numpy as np

from sheetbench.scenes.meaning.kinematics import UP, Displaced, MovedEdge, TurnedEdge, bent_or_tilted
from sheetbench.scenes.objects.actuators import Chain, EdgeMotion
from sheetbench.scenes.objects.quantities import PlanPoint
from sheetbench.scenes.objects.sheet import EDGES, Sheet
from sheetbench.scenes.objects.supports import AnySupport, Clamped, Curved, held_axes, named, place, tilt_axes

EXACT = 1e-6  # m per metre of the longer side, and in a director: rounding of numbers written in decimals
BETWEEN = (0.381966, 0.618034)

Holder = AnySupport | EdgeMotion
AnyActuator = Chain | EdgeMotion
Driven = Mapping[str, TurnedEdge]  # by their edges


def conflicts(
    actuators: Sequence[AnyActuator], supports: tuple[AnySupport, ...], sheet: Sheet
) -> Iterator[object]:
    """Yield sentences on contradictions on an edge or at a corner, or false values."""
    on_edges = [support for support in supports if place(support) is None]
    driven = {edge.edge: edge for edge in bent_or_tilted(supports, sheet)}
    for one, other in combinations(on_edges, 2):
        two = f"support: edge {one.edge} has two supports, {one.kind} and {other.kind}"
        yield one.edge == other.edge and two
        yield _corner_conflict("support", one, other, driven, sheet)
    supported = {support.edge for support in on_edges}
    for i, actuator in enumerate(actuators):
        held = "has a support, which holds the masses that the actuator would move"
        yield actuator.edge in supported and f"actuator: edge {actuator.edge} {held}"
        yield from (_edge_conflict(actuator, later) for later in actuators[i + 1 :])
    yield _doubly_held_chain(actuators, supports)
    for motion in actuators:
        if isinstance(motion, EdgeMotion):
            for holder in (*on_edges, *(each for each in actuators if each is not motion)):
                yield _corner_conflict("actuator", motion, holder, driven, sheet)


def _edge_conflict(first: AnyActuator, second: AnyActuator) -> str:
    """Return the reason why two actuators cannot act on one edge, "" if they can or are on two edges."""
    if first.edge != second.edge:
        return ""
    if not isinstance(first, Chain) or not isinstance(second, Chain):
        return f"actuator: edge {first.edge} has a prescribed motion and another actuator"
    for key in ("segments", "plane", "base"):
        mine, theirs = getattr(first, key), getattr(second, key)
        if mine != theirs:
            return (
                f"actuator: two chains on edge {first.edge} have {key} = {mine!r} and {theirs!r}: "
                "chains on one edge must agree in segments, plane and base"
            )
    return ""


def _corner_conflict(key: str, one: Holder, other: Holder | Chain, driven: Driven, sheet: Sheet) -> str:
    """Return a sentence on a contradiction at the common corner of two edges, "" without one."""
    if EDGES[one.edge].normal_axis == EDGES[other.edge].normal_axis:
        return ""
    ends = sheet.edge_ends(other.edge)
    corner = next(end for end in ends if end in sheet.edge_ends(one.edge))
    if isinstance(other, Chain):
        base = f"{key}: the base of the chain on edge {other.edge} stands at the corner that the motion on"
        return f"{base} edge {one.edge} moves" if corner in [ends[end] for end in other.base_ends] else ""
    moving = (holder if isinstance(holder, EdgeMotion) else holder.motion for holder in (one, other))
    tables = [table for table in moving if table is not None]
    if not tables and driven.keys().isdisjoint((one.edge, other.edge)):
        return ""  # both at rest
    axes, turns = ([*(a & b)] for a, b in zip(_held_axes(one), _held_axes(other), strict=True))
    samples = sorted({time for table in tables for time in table.time}) or [0.0]
    between = [a + share * (b - a) for (a, b), share in product(pairwise(samples), BETWEEN)]
    largest, moved, turned = 0.0, "", ""
    for time in sorted([*samples, *between]):
        when = f" at t = {time:.3g} s" if tables else ""
        (u, director), (v, normal) = (_prescribed(h, corner, driven, sheet, time) for h in (one, other))
        for axis in axes:
            if (gap := abs(u[axis] - v[axis])) > max(largest, EXACT * max(sheet.lengths)):
                mover, held = (one, other) if abs(u[axis]) >= abs(v[axis]) else (other, one)
                by = f"{'xyz'[axis]} by {gap:.3g} m{when}"
                moves = f"{_holder_name(mover)} moves the corner that {_holder_name(held)} holds"
                largest, moved = gap, f"{moves}: {by}"
        if np.abs(director - normal)[turns].max(initial=0.0) > EXACT:
            turner, held = (one, other) if director[2] <= normal[2] else (other, one)
            corner_text = f"the corner where {_holder_name(held)} holds it otherwise"
            turned = f"{_holder_name(turner)} turns the director at {corner_text}{when}"
    return (moved and f"{key}: {moved}") or (turned and f"{key}: {turned}")


def _held_axes(holder: Holder) -> tuple[set[int], set[int]]:
    """Return the axes of position and of director that are held at the corners."""
    every = {0, 1, 2}
    if isinstance(holder, EdgeMotion):
        return every, every
    return set(held_axes(holder)), set(tilt_axes(holder))


def _prescribed(
    holder: Holder, corner: PlanPoint, driven: Driven, sheet: Sheet, time: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the displacement [m] and the director (3,) that are prescribed at the corner."""
    point, shift = np.array([corner]), np.zeros(3)
    if isinstance(holder, EdgeMotion):
        displaced = MovedEdge(holder, sheet).displaced(point, time=time)
    else:
        still = Displaced(np.zeros((1, 3)), np.zeros((3, 3)))
        displaced = driven[holder.edge].displaced(point) if holder.edge in driven else still
        if holder.motion is not None:
            shift = holder.motion.course.at(time)
    return displaced.displacement[0] + shift, UP + np.atleast_2d(displaced.director)[0]


def _holder_name(holder: Holder) -> str:
    if isinstance(holder, EdgeMotion):
        return f"the motion on edge {holder.edge}"
    if isinstance(holder, Curved) and holder.curvature:
        return f"the rod on edge {holder.edge} (curvature {holder.curvature:g} 1/m)"
    if isinstance(holder, Clamped) and holder.tilt:
        return f"the clamp on edge {holder.edge} (tilt {holder.tilt:g} rad)"
    return f"the {holder.kind} support on edge {holder.edge}"


def _doubly_held_chain(actuators: Sequence[AnyActuator], supports: Sequence[AnySupport]) -> str:
    """Return a sentence on a chain whose length is fixed at two places along its axis, with a remedy; "" for
    none."""
    chains = {str(chain.edge): chain for chain in actuators if isinstance(chain, Chain)}
    fixed = {name: support for name, support in named(supports).items() if support.motion is None}
    for number, chain in enumerate(actuators, start=1):
        if not isinstance(chain, Chain):
            continue
        places = {end: holder for end in (0, 1) if (holder := _end_holder(chain, end, chains, fixed))}
        if chain.base != "free":
            places[{"start": 0, "middle": -1, "end": 1}[chain.base]] = f'by its own base = "{chain.base}"'
        if len(places) > 1:
            where = {0: "where it starts", 1: "where it ends", -1: "in its middle"}
            held = ", and ".join(f"{where[place]} {by}" for place, by in places.items())
            return (
                f"actuator {number} on edge {chain.edge} is held along itself {held}: a chain does not "
                "stretch, so this one could not bend; let go of all but one, a chain's hold by its "
                'base = "free" or plane = "spatial", a support\'s by one that does not hold the corner along '
                "the edge"
            )
    return ""


def _end_holder(chain: Chain, end: int, chains: Mapping[str, Chain], fixed: Mapping[str, AnySupport]) -> str:
    """Return a clause on the object that holds an end (0 or 1) of a chain along the chain, "" for none. The
    chain's own base is ignored."""
    along = EDGES[chain.edge].along_axis
    edge = f"{'xy'[along]}{end}"
    if edge in fixed and along in held_axes(fixed[edge]):
        return f"by the {fixed[edge].kind} support on edge {edge}"
    other = chains.get(edge)
    if other is None:
        return ""
    if int(chain.edge[1]) in other.base_ends:
        return f'by the base = "{other.base}" of the chain on edge {edge}'
    if other.plane == "normal" and other.base != "free":
        return f'by the chain on edge {edge}, which plane = "normal" and base = "{other.base}" keep straight'
    return ""
