"""`sheetbench study NAME`: studies of the models, from a checkout of the repository."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import typer

CONTEXT = {"ignore_unknown_options": True, "help_option_names": []}  # options are the study's, help too
CHECKOUT = Path(__file__).parents[2]
LABORATORY = "studies"
HELP = ("-h", "--help")


def command(
    context: typer.Context,
    name: str | None = None,
    options: list[str] | None = None,
    no_pictures: bool = False,
) -> None:
    """Run a study of the models, from a clone of the repository.

    Without NAME the studies are listed.

    Args:
        name (NAME, argument): Name of the study; without it, all are listed.
        options (ARGUMENTS, argument): Arguments of the study: sheetbench study NAME --help.
        no_pictures: Write all files but the pictures (with --out).
    """
    from comparisons.cli import console
    from sheetbench.answers.table import Column, Table

    if name in HELP:
        print(context.get_help())
        return
    if name is None:
        columns = (Column("study"), Column("about", prose=True))
        console.show(Table("Studies", columns, tuple(_studies().items())))
        return
    from typer.main import get_command

    from comparisons.cli.verb import as_verb

    module = module_of(name)
    markup = getattr(context.find_root().command, "rich_markup_mode", None)  # None on narrow terminals
    app = typer.Typer(rich_markup_mode=markup, context_settings={"help_option_names": list(HELP)})
    app.command(name)(as_verb(name, module.command))
    given = [*(options or ()), *(["--no-pictures"] if no_pictures else ())]
    main: Any = get_command(app)
    status = main(args=given, prog_name=f"sheetbench study {name}", standalone_mode=False)
    if status:
        raise typer.Exit(status)


def module_of(name: str) -> ModuleType:
    """Return the module with the `command` of a study. Raises BadInput for an unknown study."""
    from sheetbench.errors import require_choice

    require_choice("study", name, _studies())
    return import_module(f"{LABORATORY}.{name.replace('-', '_')}.command")


def _studies() -> dict[str, str]:
    """Return the studies with their descriptions. Raises BadInput outside a checkout of the repository."""
    from sheetbench.errors import BadInput

    if not (CHECKOUT / LABORATORY / "__init__.py").is_file():
        raise BadInput(
            "study: studies are not installed; in a clone of the repository run 'make install', then "
            ".venv/bin/sheetbench study NAME"
        )
    studies: dict[str, str] = import_module(LABORATORY).STUDIES
    return studies
