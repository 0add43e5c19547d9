"""`sheetbench identify SCENE`: material and support parameters from measured displacements."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from comparisons.cli.lattice_options import Lattice, with_lattice
from comparisons.cli.options import Elements, Large, Law, Scene
from comparisons.cli.verb import PictureOptions
from sheetbench.choices import ELEMENTS


@with_lattice
def command(
    scene: Scene,
    lattice: Lattice,
    measured: Annotated[
        Path,
        typer.Option(
            metavar="FILE",
            help="CSV with the columns x,y,ux,uy,uz or x,y,uz (metres; with a column time [s], a motion), or "
            "x,y,z of the deformed surface; or a VTP or PLY point cloud of it.",
        ),
    ],
    unknown: Annotated[
        str,
        typer.Option(
            metavar="NAMES",
            help="young (or E), poisson (nu), density (rho), thickness (h), curvature_EDGE, tilt_EDGE (of a "
            "clamp), damping_time, damping_rate; several with commas.",
        ),
    ] = "young",
    model: Annotated[str, typer.Option(metavar="MODEL", help="lumped, shell or solid.")] = "lumped",
    elements: Elements = str(ELEMENTS),
    law: Law = None,
    offset: Annotated[
        float,
        typer.Option(
            metavar="M",
            help="Where a point cloud was taken, along the surface's normal: half the thickness for its top.",
        ),
    ] = 0.0,
    large: Large = False,
    *,
    output: PictureOptions,
) -> None:
    """Find the values with which a model comes nearest to what was measured, with 95 % intervals.

    The search starts from the scene's own values, and from others where these lead to no fit. Unless --lumped
    is given, the fit makes the lattice's cells smaller until they move the values less than the noise does.
    Lengths are in metres unless a column's header says otherwise (uz [mm]), in the scene's axes.
    """
    from comparisons.comparison.comparison import load_static
    from comparisons.identification.identification import identify
    from comparisons.identification.measurements import read
    from comparisons.identification.prediction import NotReached
    from comparisons.models.candidate import items
    from comparisons.models.grids import parse_elements

    asked = load_static(scene)
    data = read(measured, asked)
    with output.open(scene=asked) as out:
        try:
            found = identify(
                asked,
                data,
                items(unknown),
                model=model,
                **lattice,
                elements=parse_elements(elements),
                law=law,
                offset=offset,
                large=large,
                progress=out.progress,
            )
        except NotReached as error:
            out.stop(f"no answer with the scene's own values: {error}")
        out.show(found.report(str(measured)))
