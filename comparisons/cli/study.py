"""`sheetbench study NAME`: the reproduction of the published study, and in a checkout the studies there."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import typer

CONTEXT = {"ignore_unknown_options": True, "help_option_names": []}  # options are the study's, help too
CHECKOUT = Path(__file__).parents[2]
LABORATORY = "studies"
INSTALLED = {"reproduction": "Habibi et al. reproduced: errors, tables, settling run, the nearest sheets"}
HELP = ("-h", "--help")


def command(
    context: typer.Context,
    name: str | None = None,
    options: list[str] | None = None,
    no_pictures: bool = False,
) -> None:
    """Run a study: reproduction, and in a checkout the laboratory's.

    Without NAME the installed studies are listed.

    Args:
        name (NAME, argument): Name of the study; without it, all are listed.
        options (ARGUMENTS, argument): Arguments of the study: sheetbench study NAME --help.
        no_pictures: Write all files but the pictures (with --out).
    """
    from comparisons.cli import console
    from sheetbench.answers.table import Column, Table

    studies = _studies()
    if name in HELP:
        print(context.get_help())
    if name in (None, *HELP):
        columns = (Column("study"), Column("about", prose=True))
        console.show(Table("Studies", columns, tuple(studies.items())))
        return
    from typer.main import get_command

    from comparisons.cli.verb import as_verb

    module = module_of(str(name))
    markup = getattr(context.find_root().command, "rich_markup_mode", None)  # None on narrow terminals
    app = typer.Typer(rich_markup_mode=markup, context_settings={"help_option_names": list(HELP)})
    app.command(name)(as_verb(str(name), module.command))
    given = [*(options or ()), *(["--no-pictures"] if no_pictures else ())]
    main: Any = get_command(app)
    status = main(args=given, prog_name=f"sheetbench study {name}", standalone_mode=False)
    if status:
        raise typer.Exit(status)


def module_of(name: str) -> ModuleType:
    """Return the module with the `command` of a study. Raises BadInput for an unknown study."""
    from sheetbench.errors import BadInput, require_choice

    studies = _studies()
    if name not in studies and not _in_checkout():
        raise BadInput(
            f"study {name}: choose from {', '.join(studies)}; others need a clone of the repository: run "
            "'make install' there, then .venv/bin/sheetbench study NAME"
        )
    require_choice("study", name, studies)
    path = f"{LABORATORY}.{name.replace('-', '_')}.command"
    return import_module(f"comparisons.cli.{name}" if name in INSTALLED else path)


def _in_checkout() -> bool:
    """Return whether the packages are in a checkout of the repository."""
    return (CHECKOUT / LABORATORY / "__init__.py").is_file()


def _studies() -> dict[str, str]:
    """Return the available studies with their descriptions."""
    return {**INSTALLED, **(import_module(LABORATORY).STUDIES if _in_checkout() else {})}
