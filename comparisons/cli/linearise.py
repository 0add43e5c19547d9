"""`sheetbench linearise SCENE`: M, C, K and a state space about an equilibrium."""

from __future__ import annotations

from typing import Annotated

from comparisons.cli.options import Large, LatticeOptions, Scene, option
from comparisons.cli.output import PictureOptions

MODES = 20


def command(
    scene: Scene,
    lattice: LatticeOptions,
    modes: Annotated[int, option("Modes of the state space; 0 for all.", "N", min=0)] = MODES,
    reduce: Annotated[
        str | None,
        option(
            "balanced:8 keeps the 8 most important states; balanced:0.01 as few as keep the error of "
            "every response below that share of its static value.",
            "HOW",
        ),
    ] = None,
    about: Annotated[
        str, option("deformed: under the scene's loads; flat: without them.", "WHAT")
    ] = "deformed",
    large: Large = False,
    *,
    output: PictureOptions,
) -> None:
    """Linearise the lattice about its equilibrium: poles, static gains, matrices for control.

    Inputs are the loads, forces at the probes, commands of chains and positions of held edges; outputs
    the probes' displacements. --out writes M, C, K and the state space for NumPy and MATLAB.
    """
    from comparisons.linearisation.linearisation import linearise
    from sheetbench import scenes
    from sheetbench.errors import NoEquilibrium

    loaded = scenes.load(scene)
    with output.open(scene=loaded) as out:
        try:
            linearisation = linearise(loaded, lattice.spec, modes=modes or None, reduce=reduce, about=about)
        except NoEquilibrium as error:
            out.stop(f"no linear form about the equilibrium: {error}; --about flat has one")
        out.show(linearisation)
