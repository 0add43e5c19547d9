"""`sheetbench view SCENE|DIR`: deformed sheets to be turned and played, in a window or in the browser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from comparisons.cli.lattice_options import Lattice, with_lattice
from comparisons.cli.options import Elements, Json
from sheetbench.choices import ELEMENTS, REFERENCE, REFERENCES, listed


@with_lattice
def command(
    scene: Annotated[
        str,
        typer.Argument(
            metavar="SCENE|DIR",
            help="Catalogue name, path to a TOML file, or a folder that verbs wrote to with --out.",
            show_default=False,
        ),
    ],
    lattice: Lattice,
    reference: Annotated[str, typer.Option(metavar="MODEL", help=f"{listed(REFERENCES)}.")] = REFERENCE,
    elements: Elements = str(ELEMENTS),
    window: Annotated[
        bool | None,
        typer.Option(
            "--window/--browser",
            help="Where to show it; a window where there is a display, else the browser.",
            show_default=False,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="FILE",
            help="Write the page into this HTML file, and open nothing.",
            show_default=False,
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Show the deformed sheets of both models and their difference, or what a folder holds; play a motion.

    The page for the browser is one file that needs no network. --lumped to --elements are for a SCENE.
    """
    from comparisons.cli import console
    from comparisons.comparison.comparison import compare, load_static
    from comparisons.models.grids import parse_elements
    from comparisons.report.files import write_text
    from comparisons.view import staged
    from sheetbench.files import require_file
    from sheetbench.scenes.errors import BadInput

    if window and out is not None:
        raise BadInput("--window and --out: a window leaves no page; choose one")
    if out is not None:
        require_file(out)
    size, troubles = parse_elements(elements), list[str]()
    if Path(scene).is_dir():
        shown, troubles = staged.of_folder(Path(scene))
    else:
        asked = load_static(scene)
        with console.progress() as say:
            both = compare(
                asked,
                **lattice,
                companion=False,
                reference=reference,
                elements=size,
                uncertainty=False,
                progress=say,
            )
            shown = [staged.of_comparison(both)]
    for said in troubles:
        console.warn(said)
    if out is None and window is not False:
        from comparisons.view.window import Window, display_there

        if window or display_there():
            Window(shown).show()
            return
    from tempfile import mkdtemp
    from webbrowser import open as browse

    from comparisons.view.page import page

    target = Path(mkdtemp(prefix="sheetbench-")) / "view.html" if out is None else out
    write_text(target, page(shown))
    if json:
        views = [view.get("label") or view["name"] for one in shown for view in one.options["views"]]
        console.document({"file": str(target), "views": views, "troubles": troubles})
    else:
        console.note(f"The sheets are in {target}")
    if out is None and not browse(target.resolve().as_uri()) and not json:
        console.note("There is no browser here: open it where there is one.")
