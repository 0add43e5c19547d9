"""`sheetbench modes SCENE`: the natural frequencies of the lattice and of a reference."""

from __future__ import annotations

from typing import Annotated

from comparisons.cli.options import Elements, Large, LatticeOptions, Scene, option
from comparisons.cli.output import PictureOptions
from sheetbench.choices import ELEMENTS, MASSES, REFERENCE, REFERENCES, listed


def command(
    scene: Scene,
    lattice: LatticeOptions,
    count: Annotated[int, option("How many modes, lowest first.", "N")] = 10,
    masses: Annotated[
        str | None,
        option(
            f"How the lattice's mass is lumped: {listed(MASSES)}. Default: higher-order, or the masses "
            "that springs were fitted with.",
            "NAME",
        ),
    ] = None,
    reference: Annotated[
        list[str] | None, option(f"{listed(REFERENCES)}; may be repeated. Default: {REFERENCE}.", "MODEL")
    ] = None,
    elements: Elements = str(ELEMENTS),
    about: Annotated[
        str,
        option(
            "About the flat, stress-free sheet, or its equilibrium under its loads (lattice and shell).",
            "flat|deformed",
        ),
    ] = "flat",
    buckling: Annotated[
        bool, option("Also at how many times its loads the flat sheet buckles, with the shapes paired.")
    ] = False,
    large: Large = False,
    *,
    output: PictureOptions,
) -> None:
    """List the natural frequencies of lattice and reference, of the flat sheet or about its equilibrium."""
    from comparisons.models.grids import parse_elements
    from comparisons.modes.spectra import spectra
    from sheetbench.errors import NoEquilibrium
    from sheetbench.scenes import load

    loaded = load(scene)
    with output.open(scene=loaded) as out:
        try:
            modes = spectra(
                loaded,
                lattice.spec,
                count=count,
                masses=masses,
                reference=reference or REFERENCE,
                elements=parse_elements(elements),
                about=about,
                buckling=buckling,
            )
        except NoEquilibrium as error:
            out.stop(f"no modes about the deformed sheet: {error}")
        out.show(modes)
