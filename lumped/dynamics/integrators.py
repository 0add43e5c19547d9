"""The integrators by name, with their declared order of accuracy."""

from __future__ import annotations

from lumped.dynamics.esdirk import Esdirk
from lumped.dynamics.generalised_alpha import GeneralisedAlpha
from lumped.dynamics.integrator import Integrator
from lumped.dynamics.midpoint import Midpoint
from lumped.dynamics.projective import Projective
from lumped.dynamics.reduced import Reduced
from lumped.dynamics.verlet import Verlet
from lumped.dynamics.verlet_implicit_damping import VerletImplicitDamping

INTEGRATORS: dict[str, type[Integrator]] = {
    kind.name: kind
    for kind in (GeneralisedAlpha, Esdirk, Verlet, VerletImplicitDamping, Midpoint, Projective, Reduced)
}
