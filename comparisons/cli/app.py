"""The `sheetbench` command: its verbs and its exit statuses.

A verb is a module of this package named like the verb, with a function `command`. Importing it must stay
quick, so a verb imports what it works with inside that function.

Exit status: 0 done; 1 a fault of the program, with its traceback; 2 bad input, said in one line; 3 a solver
did not converge.
"""

from __future__ import annotations

import sys
import traceback
from importlib import import_module

import typer

from comparisons.cli import warned

VERBS = (
    "new",
    "check",
    "scenes",
    "compare",
    "calibrate",
    "identify",
    "simulate",
    "tradeoff",
    "transfer",
    "advise",
    "stability",
    "verify",
    "modes",
    "schema",
)
FAULT = 1
BAD_INPUT = 2
NOT_CONVERGED = 3

app = typer.Typer(
    help="How good is your spring lattice? Lumped-mass models of soft sheets beside finite elements.",
    epilog="SCENE is a name that 'sheetbench scenes' lists, or a path to a TOML file.",
    invoke_without_command=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
for _verb in VERBS:
    app.command(_verb)(import_module(f"comparisons.cli.{_verb}").command)


def _print_version(asked: bool) -> None:
    if asked:
        from importlib.metadata import version

        print(f"sheetbench {version('sheetbench')}")
        raise typer.Exit


@app.callback()
def _help_where_nothing_is_asked(
    context: typer.Context,
    _version: bool = typer.Option(
        False, "--version", help="Print the version and stop.", is_eager=True, callback=_print_version
    ),
) -> None:
    if context.invoked_subcommand is None:
        print(context.get_help(), end="")


def main(arguments: list[str] | None = None) -> None:
    """Run the command line and leave with its exit status."""
    try:
        with warned.in_a_line():
            app(args=arguments, prog_name="sheetbench")
    except Exception as error:
        from sheetbench.scenes.errors import BadInput  # with numpy and pydantic: help must not wait for them

        if isinstance(error, BadInput):
            from comparisons.report.escape import terminal

            print(f"sheetbench: {terminal(' '.join(str(error).split()))}", file=sys.stderr)
            raise SystemExit(BAD_INPUT) from None
        traceback.print_exc()
        print(
            "sheetbench: this is a fault of the program, not of your input: please report it, with the lines "
            "above and the command",
            file=sys.stderr,
        )
        raise SystemExit(FAULT) from None
