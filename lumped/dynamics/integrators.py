"""The integrators by name, with their declared order of accuracy."""

from __future__ import annotations

from collections.abc import Collection

from lumped.dynamics.explicit.step_limit import step_limit
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
SHORTEST = 0.25  # share of the undamped explicit step, from which on implicit steps take less time


def require_integrator(name: str) -> None:
    """Raise BadInput for a name that is neither an integrator's nor "auto"."""
    if name not in (*INTEGRATORS, AUTO):
        raise BadInput(f"integrator = {name!r}: unknown; choose from {', '.join((*INTEGRATORS, AUTO))}")


def resolve_integrator(name: str, system: System, options: Collection[str] = ()) -> tuple[str, str]:
    """Return the integrator of a run, and why in a sentence where the name is "auto".

    `esdirk` takes a fifth of the time of `generalised-alpha` at like error (docs/development/performance.md);
    it has no chains. Where a sheet touches an obstacle and leaves it, its steps are about two of `verlet`'s
    undamped ones and cost some thirty evaluations of the forces, those of `verlet` four: dampers may make
    these `SHORTEST` as long as the undamped ones (`docs/contact.md`). options: that it has to take.
    Raises BadInput where the integrator does not take one.
    """
    why = ""
    if name == AUTO:
        unlike = [one for one in options if one not in Esdirk.options]
        name, why = Esdirk.name, "least time at equal error"
        if system.coupling is not None:
            name, why = GeneralisedAlpha.name, f"{why}, with chains"
        elif unlike and set(options) <= set(GeneralisedAlpha.options):
            name, why = GeneralisedAlpha.name, f"{why}, that takes {', '.join(unlike)}"
        elif system.items and set(options) <= set(Verlet.options):
            shorter = 1.0 / step_limit(system, system.prescribed.place(0.0)).share
            if shorter * SHORTEST <= 1.0:
                name, why = Verlet.name, f"{why}, with obstacles"
            else:
                why = f"{why}, as dampers make explicit steps {shorter:.2g} times shorter"
    foreign = [one for one in options if one not in INTEGRATORS[name].options]
    if foreign:
        raise BadInput(f"integrator = {name!r}: does not take {', '.join(foreign)}")
    return name, why
