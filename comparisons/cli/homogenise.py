"""`sheetbench homogenise CELL [SCENE]`: what a mesh of triangles, hinges, springs or bricks is as a sheet."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli.options import option
from comparisons.cli.output import OutputOptions


def command(
    cell: Annotated[
        str,
        typer.Argument(
            metavar="CELL",
            help="one-diagonal, alternate-diagonals, equilateral, unstructured: triangles with hinges; "
            "bricks: one through the thickness; or a TOML file with periods, nodes and elements.",
        ),
    ],
    scene: Annotated[str, typer.Argument(metavar="SCENE", help="Scene with the sheet and its load.")],
    spacing: Annotated[
        float | None,
        option(
            "Distance of nodes, in m or as 5mm. Default: an eighth of the shorter side.", "LENGTH", unit="m"
        ),
    ] = None,
    hinge: Annotated[
        str | None,
        option(
            "Energy of a hinge, ½ k w θ²: length, w the edge's; angle, w = 1; height, w = 3 length² "
            "over the area of both triangles. Default: length.",
            "WEIGHT",
        ),
    ] = None,
    coefficient: Annotated[
        list[str] | None,
        option("Use this coefficient in place of the one found. May be repeated.", "NAME=VALUE"),
    ] = None,
    *,
    output: OutputOptions,
) -> None:
    """Compute the moduli of a discrete sheet, its best coefficients for a material and the error left.

    That error is the limit of the mesh: a finer mesh of the same cell does not reduce it.
    """
    from comparisons.cells.answer import homogenise
    from comparisons.cells.meshes import cell_on
    from comparisons.comparison.comparison import load_static
    from sheetbench.errors import BadInput

    of = load_static(scene)
    given = {}
    for text in coefficient or ():
        name, _, value = text.partition("=")
        try:
            given[name] = float(value)
        except ValueError:
            raise BadInput(f"--coefficient {text}: NAME=VALUE, the value a number") from None
    named = cell_on(of.sheet, cell, spacing, hinge)
    variant = {"CELL": cell, "--spacing": spacing, "--hinge": hinge}
    with output.open(scene=of, variant=variant) as out:
        out.show(homogenise(of, named, coefficients=given))
