"""The integrators by name, with their declared order of accuracy."""

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

KINDS: tuple[type[Integrator], ...] = (GeneralisedAlpha, Esdirk, Verlet, Midpoint)
INTEGRATORS = {kind.name: kind for kind in KINDS}
SHORTEST = 0.25  # share of the undamped explicit step below which implicit steps take less time


def require_integrator(name: str) -> None:
    """Raise BadInput for the name of an unknown integrator.

    Parameters
    ----------
    name : str
        A key of `INTEGRATORS`, or "auto".

    Raises
    ------
    BadInput
        If the name is neither an integrator's nor "auto".

    Examples
    --------
    >>> import lumped
    >>> lumped.require_integrator("verlet")
    """
    if name not in (*INTEGRATORS, AUTO):
        raise BadInput(f"integrator = {name!r}: unknown; choose from {', '.join((*INTEGRATORS, AUTO))}")


def resolve_integrator(name: str, system: System, options: Collection[str] = ()) -> tuple[str, str]:
    """Return the integrator of a run, and the reason in a sentence if the name is "auto".

    `esdirk` takes a fifth of the time of `generalised-alpha` at equal error
    (docs/development/performance.md); it has no chains. For a sheet that touches an obstacle and leaves it,
    an `esdirk` step is about two undamped `verlet` steps long and costs some thirty evaluations of the
    forces, a `verlet` step four: dampers may shorten `verlet` steps to `SHORTEST` of the undamped ones
    (`docs/contact.md`). options: options of the run. Raises BadInput for an option that the integrator does
    not take.
    """
    reason = ""
    if name == AUTO:
        unsupported = [option for option in options if option not in Esdirk.options]
        name, reason = Esdirk.name, "least time at equal error"
        if system.coupling is not None:
            name, reason = GeneralisedAlpha.name, f"{reason}, with chains"
        elif unsupported and set(options) <= set(GeneralisedAlpha.options):
            name, reason = GeneralisedAlpha.name, f"{reason}, that takes {', '.join(unsupported)}"
        elif system.contacts and set(options) <= set(Verlet.options):
            shorter = 1.0 / step_limit(system, system.prescribed.place(0.0)).share
            if shorter * SHORTEST <= 1.0:
                name, reason = Verlet.name, f"{reason}, with obstacles"
            else:
                reason = f"{reason}, as dampers make explicit steps {shorter:.2g} times shorter"
    foreign = [option for option in options if option not in INTEGRATORS[name].options]
    if foreign:
        raise BadInput(f"integrator = {name!r}: does not take {', '.join(foreign)}")
    return name, reason
