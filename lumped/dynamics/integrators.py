"""The integrators by name, with their declared order of accuracy."""

from __future__ import annotations

from collections.abc import Collection

from lumped.dynamics.explicit.verlet import Verlet
from lumped.dynamics.implicit.esdirk import Esdirk
from lumped.dynamics.implicit.generalised_alpha import GeneralisedAlpha
from lumped.dynamics.implicit.midpoint import Midpoint
from lumped.dynamics.integrator import Integrator
from lumped.dynamics.system import System
from sheetbench.choices import AUTO
from sheetbench.errors import BadInput

INTEGRATORS: dict[str, type[Integrator]] = {
    kind.name: kind for kind in (GeneralisedAlpha, Esdirk, Verlet, Midpoint)
}


def require_integrator(name: str) -> None:
    """Raise BadInput for a name that is neither an integrator's nor "auto"."""
    if name not in (*INTEGRATORS, AUTO):
        raise BadInput(f"integrator = {name!r}: unknown; choose from {', '.join((*INTEGRATORS, AUTO))}")


def resolve_integrator(name: str, system: System, options: Collection[str] = ()) -> tuple[str, str]:
    """The integrator of a run, and why in a sentence where the name is "auto".

    Of those that adapt their steps `esdirk` takes a fifth of the time of `generalised-alpha` at like error
    (docs/development/performance.md), and explicit ones take more, but for sheets that touch and leave an
    obstacle; it has no chains. options: that it has to take.
    Raises BadInput where the integrator does not take one.
    """
    chains = system.coupling is not None
    why = ""
    if name == AUTO:
        unlike = [one for one in options if one not in Esdirk.options]
        takes_unlike = bool(unlike) and set(options) <= set(GeneralisedAlpha.options)
        name = GeneralisedAlpha.name if chains or takes_unlike else Esdirk.name
        if system.items and set(options) <= set(Verlet.options):
            return Verlet.name, "least time at equal error, with obstacles"
        why = "least time at equal error"
        why += ", with chains" if chains else f", that takes {', '.join(unlike)}" if takes_unlike else ""
    foreign = [one for one in options if one not in INTEGRATORS[name].options]
    if foreign:
        raise BadInput(f"integrator = {name!r}: does not take {', '.join(foreign)}")
    return name, why
