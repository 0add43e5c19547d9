"""Tolerances and limits of the path tracer: the defaults for finite elements, and others for lattices.

Lengths are in sizes of the structure, residuals relative to the forces in balance. A lattice's factors cost a
hundredth of a shell's, and a correction with old factors next to nothing: its tolerance is nearer to
rounding, it may use more factorisations, and the search for other branches starts later. Its first reach and
the reach's growth are smaller: with the elements' values a sheet softened 54-fold takes 68 instead of 17
factorisations, and a sheet with a careful run after 16 factorisations takes 49 (`tests/test_catalogue.py`).
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Limits:
    """Limits of a path. tolerance: residual of an equilibrium. factorisations: limit for a path, for its
    careful second run and between snaps. in_all: limit for a path that snaps."""

    tolerance: float = 5e-9
    refine_below: float = 0.0  # residual below which old factors are used again
    steps_with_last_factors: bool = False  # step with the last correction's factors, if valid for stability
    idle: float = 1e-9  # correction after which a residual may be all rounding
    careful_tolerance: float = 3e-3  # residual at which a careful load step ends, except the last
    corrections: int = 24  # of one load step
    back: int = 4  # a load step fails if a correction is no shorter than the one this many before
    shrinking: float = 0.5  # and no shorter than this share of the last one
    farthest: float = 1e3  # a longer step has diverged
    first_reach: float = 8.0  # largest displacement of the first linear step
    smallest_step: float = 2.0**-10  # of the load: the path ends when a smaller step fails
    shortest: float = 5e-4  # and its linear step is shorter: half of `branching`
    lengthen_up_to: int = 6  # factorisations of a load step after which the next one is longer
    growth: float = 4.0  # of a load step after an easy one
    reach_growth: float = 4.0  # of its reach
    careful_reach: float = 0.1  # largest displacement of the first careful linear step
    careful_after: int = 16  # factorisations after which a load step may have jumped over a fold
    careful_budget_factor: int = 4  # factorisations of the careful run over the first run's
    continuous: float = 0.5  # of a careful linear step: largest distance of its equilibrium from it,
    miss: float = 0.05  # and as a length
    safe: float = 0.8  # of the next careful step's length allowed by the last distance
    branching: float = 1e-3  # linear steps this short may cross a bifurcation
    same_branch: float = 0.25  # of a start's displacement: beyond, an equilibrium may be on another branch
    snaps: int = 12  # of one path
    snap_step: float = 0.01  # in load factor, past the limit point
    factorisations: int = 400
    in_all: int = 1600
