"""`sheetbench compare SCENE`: the lattice and a finite-element reference side by side."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli.lattice_options import Lattice, given, with_lattice
from comparisons.cli.options import (
    Elements,
    Export,
    Figure,
    Json,
    Large,
    Law,
    Models,
    NoPictures,
    Out,
    Overwrite,
    Scene,
    Symmetry,
)
from sheetbench.choices import BRANCHES, ELEMENTS, REFERENCE, REFERENCES, listed


@with_lattice
def command(
    scene: Scene,
    lattice: Lattice,
    reference: Annotated[str, typer.Option(metavar="MODEL", help=f"{listed(REFERENCES)}.")] = REFERENCE,
    elements: Elements = str(ELEMENTS),
    law: Law = None,
    symmetry: Symmetry = False,
    model: Models = None,
    uncertainty: Annotated[
        bool | None,
        typer.Option(
            "--uncertainty/--no-uncertainty",
            help="Solve the reference on coarser meshes too, for its error bar; on for plate and shell.",
            show_default=False,
        ),
    ] = None,
    branch: Annotated[
        str,
        typer.Option(metavar="NAME", help=f"{listed(BRANCHES)}: leave unstable equilibria or not."),
    ] = "path",
    auto: Annotated[
        bool,
        typer.Option("--auto", help="Let the advisor choose the model shown first.", show_default=False),
    ] = False,
    tolerance: Annotated[
        float | None,
        typer.Option(metavar="FRACTION", help="Error that --auto may make; 0.01 unless given."),
    ] = None,
    export: Export = None,
    large: Large = False,
    json: Json = False,
    out: Out = None,
    figure: Figure = None,
    no_pictures: NoPictures = False,
    overwrite: Overwrite = False,
) -> None:
    """Solve a scene with the lattice and with a reference, and show what differs and what it cost.

    Where no calibration is named, uniform springs are shown alongside.
    """
    from comparisons.advice.advisor import advise, check_auto
    from comparisons.cli.finish import finish
    from comparisons.comparison.comparison import compare, load_static
    from comparisons.models.candidate import parse_model
    from comparisons.models.grids import parse_elements
    from comparisons.models.springs import LatticeSpec
    from comparisons.report.vtk import write_solution
    from sheetbench.scenes.errors import BadInput

    asked = load_static(scene)
    size, others = parse_elements(elements), [parse_model(text) for text in model or ()]
    check_auto(auto, tolerance, given(lattice))
    if auto and export is not None:
        raise BadInput("--export: the advisor may choose a model without springs; leave --auto out")
    named = lattice["calibration"] is not None or lattice["k"] is not None
    models = {"--reference": reference, "--calibration": "named" if named else "open", "--auto": auto}
    models |= {"--model": " ".join(model)} if model else {}
    with finish(
        "compare", json, out, overwrite, scene=asked, apart=models, figure=figure, pictures=not no_pictures
    ) as end:
        advice = None
        if auto:
            allowed = 0.01 if tolerance is None else tolerance
            advice = advise(asked, allowed, large=large, progress=end.progress)
            if advice.choice is None:
                end.stop(f"--auto: {advice.message}")
        found = compare(
            asked,
            **lattice,
            reference=reference,
            elements=size,
            law=law,
            uncertainty=uncertainty,
            symmetry=symmetry,
            branch=branch,
            choice=advice.choice if advice is not None else None,
            others=others,
            large=large,
            progress=end.progress,
            finished=lambda s: end.keep(f"{s.model}.vtu", lambda path: write_solution(path, s)),
        )
        report = found.report(advice)
        if export is not None:
            springs, _ = LatticeSpec(**lattice).springs(asked)
            report = end.export(export, asked, springs, report, overwrite)
        end(report)
