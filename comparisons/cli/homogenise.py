"""`sheetbench homogenise CELL [SCENE]`: what a mesh of triangles, hinges, springs or bricks is as a sheet."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli.options import option
from comparisons.cli.output import OutputOptions

SPACINGS = 8  # cells along the shorter side, unless a spacing is given


def command(
    cell: Annotated[
        str,
        typer.Argument(
            metavar="CELL",
            help="one-diagonal, alternate-diagonals, equilateral, unstructured: triangles with hinges; "
            "bricks: one through the thickness; or a TOML file with periods, nodes and elements.",
        ),
    ],
    scene: Annotated[str, typer.Argument(metavar="[SCENE]", help="Scene with the sheet and its load.")] = (
        "two-edges-clamped"
    ),
    spacing: Annotated[
        float | None,
        option(
            "Distance of nodes, in m or as 5mm. Default: an eighth of the shorter side.", "LENGTH", unit="m"
        ),
    ] = None,
    hinge: Annotated[
        str,
        option(
            "Energy of a hinge, ½ k w θ²: length, w the edge's; angle, w = 1; height, w = 3 length² "
            "over the area of both triangles.",
            "WEIGHT",
        ),
    ] = "length",
    coefficient: Annotated[
        list[str] | None,
        option("Use this coefficient in place of the nearest one. May be repeated.", "NAME=VALUE"),
    ] = None,
    *,
    output: OutputOptions,
) -> None:
    """Compute the moduli of a discrete sheet, its best coefficients for a material and the error left.

    That error is the limit of the mesh: a finer mesh of the same cell does not reduce it.
    """
    from comparisons.cells.answer import homogenise
    from comparisons.cells.meshes import cell_of
    from sheetbench import scenes
    from sheetbench.errors import BadInput

    of = scenes.load(scene)
    length = min(of.sheet.length_x, of.sheet.length_y) / SPACINGS if spacing is None else spacing
    given = {}
    for text in coefficient or ():
        name, _, value = text.partition("=")
        try:
            given[name] = float(value)
        except ValueError:
            raise BadInput(f"--coefficient {text}: NAME=VALUE, the value a number") from None
    named = cell_of(cell, length, of.sheet.thickness, hinge)
    with output.open(scene=of, variant={"CELL": cell, "--spacing": length, "--hinge": hinge}) as out:
        out.show(homogenise(of, named, given))
