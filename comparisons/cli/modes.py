"""`sheetbench modes SCENE`: natural frequencies, buckling, matrices for control."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, cast

from comparisons.cli.options import Kind, LatticeOptions
from comparisons.cli.output import PictureOptions
from comparisons.cli.verb import no_effect
from sheetbench.choices import ELEMENTS, REFERENCE

if TYPE_CHECKING:
    from comparisons.modes.answer import Spectra
    from comparisons.modes.state_space import Linearisation
    from sheetbench.answers.solution import About


@no_effect(with_state_space="count masses reference elements buckling", without_state_space="reduce")
def command(
    scene: str,
    lattice: LatticeOptions,
    *,
    count: int = 10,
    masses: str | None = None,
    reference: list[str] | None = None,
    elements: str = str(ELEMENTS),
    about: Annotated[str | None, Kind(choices=("flat", "deformed"))] = None,
    buckling: bool = False,
    state_space: Annotated[int | None, Kind(least=0)] = None,
    reduce: str | None = None,
    large: bool = False,
    output: PictureOptions,
) -> Annotated[Spectra | Linearisation, "state_space: Linearisation"]:
    """List natural frequencies; buckling loads; control matrices.

    Frequencies of lattice and reference, of the flat sheet or about its equilibrium. --state-space linearises
    the lattice for control: inputs are the loads, forces at the probes, commands of chains and positions of
    held edges; outputs are the probes' displacements.

    Args:
        count (N): Number of modes, lowest first.
        masses (NAME): Lumping of the lattice's mass: {MASS_DISTRIBUTIONS}. Default: higher-order, or the
            masses that springs were fitted with.
        reference (MODELS): {REFERENCES}. Default: {REFERENCE}.
        about (flat|deformed): About the flat, stress-free sheet, or its equilibrium under its loads (lattice
            and shell). Default: flat; deformed with --state-space.
        buckling: List the load factors at which the flat sheet buckles too, paired by shape.
        state_space (N): Linearise the lattice instead, with N modes, 0 for all: poles, static gains; --out
            writes M, C, K and the state space for NumPy and MATLAB.
        reduce (HOW): Reduction of the states (with --state-space): balanced:8 keeps the 8 most important
            ones; balanced:0.01 the fewest with a guaranteed error of 1 % of each static response.
    """
    from comparisons.models.grids import parse_elements
    from comparisons.modes.spectra import spectra
    from comparisons.modes.state_space import linearise
    from sheetbench.errors import NoEquilibrium
    from sheetbench.scenes import scene_of

    loaded = scene_of(scene)
    with output.open(scene=loaded, variant={"--state-space": state_space is not None}) as out:
        try:
            if state_space is not None:
                size, around = state_space or None, cast("About", about or "deformed")
                return out.show(linearise(loaded, lattice.spec, modes=size, reduce=reduce, about=around))
            return out.show(
                spectra(
                    loaded,
                    lattice.spec.but(masses=masses),
                    count=count,
                    reference=REFERENCE if reference is None else reference,
                    elements=parse_elements(elements),
                    about=cast("About", about or "flat"),
                    buckling=buckling,
                )
            )
        except NoEquilibrium as error:
            deformed = "modes about the deformed sheet"
            answer = deformed if state_space is None else "linear form about the equilibrium"
            out.stop(f"no {answer}: {error}; use --about flat")
