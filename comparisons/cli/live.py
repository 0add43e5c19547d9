"""`sheetbench live SCENE`: a page on this machine with sliders, where lattice and shell answer."""

from __future__ import annotations

from typing import Annotated

import typer

from comparisons.cli.options import Calibration, Grading, Scene

ELEMENTS = 8


def command(
    scene: Scene,
    lumped: Annotated[
        int | None,
        typer.Option(
            "--lumped",
            "--grid",
            metavar="N",
            help="Masses along the shorter side to start with; 9 unless given.",
            show_default=False,
        ),
    ] = None,
    grading: Grading = None,
    calibration: Calibration = None,
    elements: Annotated[
        int, typer.Option(metavar="N", help="Elements of the shell along the shorter side to start with.")
    ] = ELEMENTS,
    port: Annotated[int, typer.Option(metavar="PORT", help="Port to listen on; 0: any that is free.")] = 0,
    browser: Annotated[
        bool, typer.Option("--browser/--no-browser", help="Open the page, or only tell its address.")
    ] = True,
) -> None:
    """Open a page where one drags E, ν, h, load and grid, and lattice and shell answer beside their error.

    The page is served on localhost only, at a secret URL. Ctrl-C ends it.
    """
    from comparisons.cli.console import note
    from comparisons.comparison.comparison import load_static
    from comparisons.live import redirection, server
    from comparisons.live.panel import Panel
    from comparisons.models.resolve import resolve
    from comparisons.models.spec import Lattice
    from sheetbench.errors import BadInput

    if not 0 <= port <= 65535:
        raise BadInput(f"--port = {port}: from 0 to 65535")
    loaded = load_static(scene)
    meant = resolve(loaded, Lattice(lumped, calibration, grading=grading)).spec
    if not isinstance(meant.grading, float | None):
        raise BadInput(f"grading = {meant.grading}: this page grades towards all edges; give a number")
    panel = Panel(loaded, elements, grid=lumped, grading=meant.grading, calibration=meant.calibration)

    with redirection.kept() as leads_to:

        def opened(address: str) -> None:
            note(f"{address}\nCtrl-C ends it.")
            if browser:
                import webbrowser

                webbrowser.open(leads_to(address))

        server.run(panel, port, opened)
