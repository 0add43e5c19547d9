"""`sheetbench identify SCENE`: material and support parameters from measured displacements."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from comparisons.cli.options import Elements, Large, LatticeOptions, Law, option
from comparisons.cli.output import PictureOptions
from sheetbench.choices import ELEMENTS
from sheetbench.errors import BadInput


def command(
    scene: Annotated[
        str | None,
        typer.Argument(metavar="[SCENE]", help="Catalogue name or path; not needed for --tensile."),
    ] = None,
    *,
    lattice: LatticeOptions,
    measured: Annotated[
        Path | None,
        option(
            "CSV with the columns x,y,ux,uy,uz or x,y,uz (metres; with a column time \\[s], a motion), "
            "or x,y,z of the deformed surface; or a VTP or PLY point cloud of it.",
            "FILE",
        ),
    ] = None,
    tensile: Annotated[
        list[str] | None,
        option(
            "A tensile test instead: CSV with stretch (or strain) and engineering_stress, true_stress "
            "or force; pure-shear=FILE or equibiaxial=FILE of other tests. May be repeated.",
            "FILE",
        ),
    ] = None,
    up_to: Annotated[
        float | None, option("With --tensile: ignore data beyond this stretch.", "STRETCH")
    ] = None,
    area: Annotated[
        float | None,
        option("With --tensile and a force: undeformed cross-section, 1.8e-5 or 18mm².", "M2", unit="m²"),
    ] = None,
    unknown: Annotated[
        str,
        option(
            "young (or E), poisson (nu), density (rho), thickness (h), young_1 and the other constants of "
            "fibres, patch1.young (or its poisson, density, thickness, angle), curvature_EDGE, tilt_EDGE "
            "(of a clamp), damping_time, damping_rate, loss_factor, share_N and time_N of a branch, drag "
            "(of the air); several with commas.",
            "NAMES",
        ),
    ] = "young",
    model: Annotated[str, option("lumped, shell or solid.", "MODEL")] = "lumped",
    elements: Elements = str(ELEMENTS),
    law: Law = None,
    offset: Annotated[
        float,
        option(
            "Distance of a point cloud from the mid-surface: half the thickness for the sheet's top.", "M"
        ),
    ] = 0.0,
    large: Large = False,
    output: PictureOptions,
) -> None:
    """Fit material and support values to measurements of a sheet, with 95 % intervals.

    The search starts from the scene's own values, else from others. Without --lumped
    the lattice is refined until the error of its grid is below the noise.
    Lengths are in metres unless a column's header says otherwise (uz \\[mm]), in the scene's axes.
    --tensile fits a rubber's law and its constants instead.
    """
    if tensile:
        if measured is not None or scene is not None:
            raise BadInput("--tensile: needs no SCENE and no --measured; ask for one or the other")
        from comparisons.identification.tensile.tensile import identify_tensile

        curves = identify_tensile(tensile, area=area, up_to=up_to)
        with output.open(about={"tensile": tensile}) as out:
            out.show(curves)
        return
    if scene is None or measured is None:
        raise BadInput("identify: give a SCENE and --measured FILE, or --tensile FILE")
    from comparisons.comparison.comparison import load_static
    from comparisons.identification.identification import identify
    from comparisons.identification.measurements import read
    from comparisons.identification.prediction import NotReached
    from comparisons.models.grids import parse_elements
    from comparisons.models.spec import items

    loaded = load_static(scene)
    data = read(measured, loaded)
    with output.open(scene=loaded) as out:
        try:
            fit = identify(
                loaded,
                data,
                items(unknown),
                lattice.spec,
                model=model,
                elements=parse_elements(elements),
                law=law,
                offset=offset,
            )
        except NotReached as error:
            out.stop(f"no answer with the scene's own values: {error}")
        out.show(fit)
