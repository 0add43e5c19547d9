"""Tolerances and limits of the path tracer: of finite elements, which are the defaults, and of lattices.

Lengths are in sizes of the structure, residuals relative to the forces that balance. A lattice's factors cost
a hundredth of a shell's and a correction with factors at hand next to nothing: it goes nearer to rounding,
has more factorisations and is looked at for other branches later. Its first reach and the growth of that are
less: with those of elements a sheet softened 54-fold takes 68 factorisations for 17, one that a careful run
from 16 factorisations on looks at 49 (`tests/test_catalogue.py`).
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Limits:
    """tolerance: residual that counts as equilibrium; factorisations: of a path, of its careful second run
    and between snaps; in_all: of a path that snaps."""

    tolerance: float = 5e-9
    refine_below: float = 0.0  # residual from which on factors that are close serve again
    steps_with_last_factors: bool = False  # those of the last correction, where they serve for stability
    idle: float = 1e-9  # correction after which a residual may be all rounding
    careful_tolerance: float = 3e-3  # residual at which a careful load step ends, but for the last
    corrections: int = 24  # of one load step
    back: int = 4  # corrections that are no shorter than so many before,
    shrinking: float = 0.5  # nor than this share of the last one, are given up
    farthest: float = 1e3  # a step beyond has diverged
    first_reach: float = 8.0  # that the first linear step may move the structure
    smallest_step: float = 2.0**-10  # of the load: one that fails and is smaller
    shortest: float = 5e-4  # and one that fails and moves it less is the last: half of `branching`
    lengthen_up_to: int = 6  # factorisations of a load step that is followed by a longer one
    growth: float = 4.0  # of a load step after an easy one
    reach_growth: float = 4.0  # of its reach
    careful_reach: float = 0.1  # that the first careful linear step may move it
    careful_after: int = 16  # factorisations from which on a load step may have jumped over a fold
    careful_budget_factor: int = 4  # times as many may be taken to see whether one has
    continuous: float = 0.5  # of a careful linear step: what its equilibrium may be off it,
    miss: float = 0.05  # and as a length
    safe: float = 0.8  # of what the last miss lets the next careful step go
    branching: float = 1e-3  # linear steps so short may cross a bifurcation
    same_branch: float = 0.25  # of a start's displacement: beyond, an equilibrium may be on another branch
    snaps: int = 12  # of one path
    snap_step: float = 0.01  # in load factor, past the limit point
    factorisations: int = 400
    in_all: int = 1600
