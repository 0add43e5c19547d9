"""`sheetbench study NAME`: a study of the laboratory, the package `studies`, which only a checkout has."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Annotated, Any

import typer

from comparisons.cli.options import NoPictures

CONTEXT = {"ignore_unknown_options": True, "help_option_names": []}  # options are the study's, help too
CHECKOUT = Path(__file__).parents[2]
LABORATORY = "studies"
HELP = ("-h", "--help")


def command(
    context: typer.Context,
    name: Annotated[
        str | None, typer.Argument(metavar="NAME", help="Name of the study; without it, all are listed.")
    ] = None,
    options: Annotated[
        list[str] | None,
        typer.Argument(metavar="ARGUMENTS", help="Arguments of the study: sheetbench study NAME --help."),
    ] = None,
    no_pictures: NoPictures = False,
) -> None:
    """Run a study of the models from a checkout of the repository; without NAME, list them."""
    from comparisons.cli import console
    from sheetbench.answers.table import Column, Table

    studies = _studies()
    if name in (None, *HELP):
        print(context.get_help())
        if not studies:
            console.note(_no_checkout())
            return
        columns = (Column("study"), Column("about", prose=True))
        console.show(Table("Studies", columns, tuple(studies.items())))
        return
    from typer.main import get_command

    from comparisons.cli.verb import as_verb
    from sheetbench.errors import BadInput, require_choice

    if not studies:
        raise BadInput(f"study {name}: {_no_checkout()}")
    require_choice("study", str(name), studies)
    module = import_module(f"{LABORATORY}.{str(name).replace('-', '_')}.command")
    markup = getattr(context.find_root().command, "rich_markup_mode", None)  # as wide as the terminal is
    app = typer.Typer(rich_markup_mode=markup, context_settings={"help_option_names": list(HELP)})
    app.command(name)(as_verb(str(name), module.command))
    given = [*(options or ()), *(["--no-pictures"] if no_pictures else ())]
    main: Any = get_command(app)
    status = main(args=given, prog_name=f"sheetbench study {name}", standalone_mode=False)
    if status:
        raise typer.Exit(status)


def _studies() -> dict[str, str]:
    """Return every study with what it is about; none where these packages do not stand in a checkout."""
    if not (CHECKOUT / LABORATORY / "__init__.py").is_file():
        return {}
    studies: dict[str, str] = import_module(LABORATORY).STUDIES
    return studies


def _no_checkout() -> str:
    return (
        "studies are not installed with the package; clone the repository, run 'make install' there, then "
        ".venv/bin/sheetbench study NAME"
    )
