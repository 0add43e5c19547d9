"""`sheetbench compare SCENE`: the lattice and a finite-element reference side by side."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from comparisons.cli.options import Grid, Json, Out, Scene, command_line

if TYPE_CHECKING:
    from comparisons.comparison.comparison import Comparison


def command(
    scene: Scene,
    lumped: Grid = None,
    calibration: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="How k is found from E, ν and h: consistent, uniform, …; consistent, with uniform shown "
            "alongside, unless given.",
        ),
    ] = None,
    k: Annotated[
        float | None, typer.Option(metavar="N/M", help="Stiffness of every spring; means uniform.")
    ] = None,
    layer_distance: Annotated[
        float | None, typer.Option(metavar="M", help="Distance of the lattice's layers.")
    ] = None,
    reference: Annotated[str, typer.Option(metavar="MODEL", help="plate, shell or solid.")] = "shell",
    elements: Annotated[
        int, typer.Option(metavar="N", help="The reference's elements along the shorter side.")
    ] = 16,
    uncertainty: Annotated[
        bool | None,
        typer.Option(
            "--uncertainty/--no-uncertainty",
            help="Solve the reference on coarser meshes too, for its error bar; on for plate and shell.",
            show_default=False,
        ),
    ] = None,
    auto: Annotated[
        bool,
        typer.Option("--auto", help="Let the advisor choose the model shown first.", show_default=False),
    ] = False,
    tolerance: Annotated[
        float | None,
        typer.Option(metavar="FRACTION", help="Error that --auto may make; 0.01 unless given."),
    ] = None,
    json: Json = False,
    out: Out = None,
) -> None:
    """Solve a scene with the lattice and with a reference, and show what differs and what it cost."""
    from comparisons.advice.advisor import advise, check_auto
    from comparisons.cli import console
    from comparisons.cli.app import NOT_CONVERGED
    from comparisons.comparison.comparison import compare, load_static
    from comparisons.comparison.output import Output
    from comparisons.comparison.tables import complaints
    from comparisons.report.files import folder, to_json
    from sheetbench.scenes import Solution

    asked = load_static(scene)
    given = {"--lumped": lumped, "--calibration": calibration, "--k": k, "--layer-distance": layer_distance}
    check_auto(auto, tolerance, given)
    output = Output(folder(out), command_line()) if out is not None else None

    with console.progress() as progress:
        advice = None
        if auto:
            progress("asking the advisor …")
            advice = advise(asked, 0.01 if tolerance is None else tolerance)
            if advice.choice is None:
                console.warn(f"--auto: {advice.message}")
                raise typer.Exit(NOT_CONVERGED)

        def finished(solution: Solution) -> None:
            if output is not None:
                output.solution(solution)

        comparison = compare(
            asked,
            grid=lumped,
            calibration=calibration,
            k=k,
            layer_distance=layer_distance,
            reference=reference,
            elements=elements,
            uncertainty=uncertainty,
            choice=advice.choice if advice is not None else None,
            starting=lambda model: progress(f"solving {model} …"),
            finished=finished,
        )
        no_picture = None
        if output is not None:
            progress("writing files …")
            output.comparison(comparison)
            progress("drawing the picture …")
            no_picture = output.picture(comparison)

    if json:
        document = comparison.as_dict()
        print(to_json(document if advice is None else {**document, "advice": advice.as_dict()}), end="")
    else:
        _show(comparison)
        if advice is not None:
            percent = 100 * (advice.tolerance or 0.0)
            console.note(f"The first model was chosen for {percent:g} %: {advice.reason}")
        if output is not None:
            console.note(f"Files in {output.folder}: {', '.join(output.written)}")
    if no_picture:
        console.warn(f"No picture: {no_picture}")
    for complaint in complaints(comparison):
        console.warn(complaint)
    if not comparison.converged:
        raise typer.Exit(NOT_CONVERGED)


def _show(comparison: Comparison) -> None:
    from comparisons.cli import console
    from comparisons.comparison import tables as summary

    scene = comparison.scene
    console.heading(scene.name, scene.title)
    console.note(summary.sheet(scene.sheet, scene.material))
    console.show(summary.displacements(comparison), group_by=0, leave_out=("x", "y"))
    console.show(summary.costs(comparison), leave_out=("what it is",))
    console.note(" · ".join(solution.label for solution in comparison.solutions))
    for said in summary.uncertainty(comparison):
        console.note(said)
    console.note(summary.explanation(comparison))
