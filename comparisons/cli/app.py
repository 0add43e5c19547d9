"""The `sheetbench` command: its verbs and its exit statuses.

A verb is a module of this package named like the verb, with a function `command`. Slow imports belong inside
that function, to keep `--help` fast.

Exit status: 0 done; 1 a fault of the program, with its traceback; 2 bad input, in one line; 3 a solver
did not converge; 130 interrupted; 141 the output was closed, as by `head`.
"""

from __future__ import annotations

import codecs
import errno
import os
import re
import sys
import traceback
from collections.abc import MutableMapping, Sequence
from contextlib import suppress
from functools import cache
from importlib import import_module
from io import TextIOWrapper
from shutil import get_terminal_size
from typing import Any

import typer
from typer.main import get_command

from comparisons.cli import interruption, messages, startup
from comparisons.cli.output import NOT_CONVERGED
from comparisons.cli.verb import as_verb
from comparisons.sweep import interrupts
from sheetbench.choices import VERBS

FAULT = 1
BAD_INPUT = 2
PIPE_CLOSED = 141  # 128 + SIGPIPE, the status of a program ended by the signal
UsageError: Any = typer.BadParameter.__base__  # click's, or typer's own copy of it
SIZE = re.compile("0*[1-9][0-9]{0,3}")  # of a terminal, in columns or lines
SHOWN = 40  # characters quoted of an overlong name
OUTPUT_FAULTS = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO)
BOXES = 80  # columns: below, the boxes of a help page would cut names off, so it is plain text


@cache
def verb_group(verbs: Sequence[str] = VERBS, boxes: bool = True) -> Any:
    """Return the command with some verbs; boxes: whether help pages have boxes."""
    app = typer.Typer(
        help="How good is your spring lattice? Lumped-mass models of soft sheets beside finite elements.",
        epilog="SCENE is a name that 'sheetbench check' lists, or a path to a TOML file.",
        invoke_without_command=True,
        pretty_exceptions_enable=False,
        rich_markup_mode="rich" if boxes else None,
        context_settings={"help_option_names": ["-h", "--help"]},
        callback=_version_or_help,
    )
    for verb in verbs:
        module = import_module(f"comparisons.cli.{verb}")
        command, short = as_verb(verb, module.command), module.command.__doc__.partition("\n")[0]
        app.command(verb, short_help=short, context_settings=getattr(module, "CONTEXT", None))(command)
    return get_command(app)


def _version_or_help(
    context: typer.Context,
    version: bool = typer.Option(False, "-V", "--version", help="Print the version and stop."),
) -> None:
    if version:
        _print_version()
        raise typer.Exit
    if context.invoked_subcommand is None:
        print(context.get_help(), end="")


def _print_version() -> None:
    from importlib.metadata import version

    print(f"sheetbench {version('sheetbench')}")


def main(arguments: list[str] | None = None) -> None:
    """Run the command line and leave with its exit status."""
    last = arguments is None  # the process ends with the command
    arguments = sys.argv[1:] if arguments is None else arguments
    if arguments[:1] == ["help"]:
        arguments = [*arguments[1:], "--help"]
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors=PLAIN)
    _clean_environment(os.environ)
    for option in arguments:
        if (other := option.replace("--no-", "--")) != option and other in arguments:
            print(f"sheetbench: {other} and {option}: give one of them", file=sys.stderr)
            raise SystemExit(BAD_INPUT)
    if arguments == sys.argv[1:]:
        startup.begin()
    with interruption.end_after_interrupt(last), messages.in_lines():
        try:
            try:
                if arguments in (["--version"], ["-V"]):  # typer would import pydantic to read the flag
                    _print_version()
                    raise SystemExit(0)
                verbs = tuple(arguments[:1]) if {*arguments[:1]} & {*VERBS} else VERBS  # one loads faster
                command = verb_group(verbs, boxes=get_terminal_size().columns >= BOXES)
                status = command(args=arguments, prog_name="sheetbench", standalone_mode=False)
                raise SystemExit(status or 0)
            finally:
                if sys.stdout is not None:  # writing errors are raised here, not at the end of the process
                    sys.stdout.flush()
        except SystemExit as end:
            if end.code == interruption.STATUS:
                interruption.report()
            if isinstance(end.__context__, BrokenPipeError):  # typer's status would be 1
                _drop_output()
                raise SystemExit(PIPE_CLOSED) from None
            raise
        except Exception as error:
            if isinstance(error, typer.Abort) or interrupts.is_behind(error):
                interruption.report()
                raise SystemExit(interruption.STATUS) from None
            raise SystemExit(_report_error(error)) from None


def _plain(error: UnicodeError) -> tuple[str, int]:
    """Return substitutes of characters missing in the output's encoding: - for minus and rules, else ?."""
    assert isinstance(error, UnicodeEncodeError)
    missing = error.object[error.start : error.end]
    return "".join("-" if character in "−─" else "?" for character in missing), error.end


codecs.register_error(PLAIN := "plain", _plain)


def _drop_output() -> None:
    """Redirect the remaining output to the null device."""
    with suppress(OSError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)


def _clean_environment(environment: MutableMapping[str, str]) -> None:
    """Drop impossible sizes of a terminal, and set matplotlib's backend to one without windows."""
    for name in ("COLUMNS", "LINES"):
        if not SIZE.fullmatch(environment.get(name, "")):
            environment.pop(name, None)
    environment["MPLBACKEND"] = "agg"


def _system_message(error: OSError) -> str | None:
    """Return the message for an overlong file name or an output that cannot be written, else None."""
    if error.errno == errno.ENAMETOOLONG:
        return f"{str(error.filename)[:SHOWN]}…: a name that is too long; choose a shorter one"
    if error.filename is None and error.errno in OUTPUT_FAULTS:
        return f"the output cannot be written: {os.strerror(error.errno).lower()}"
    return None


def _report_error(error: Exception) -> int:
    """Print the message of an error, of the user or of the program; return the exit status."""
    if isinstance(error, BrokenPipeError):
        _drop_output()
        return PIPE_CLOSED
    if isinstance(error, OSError) and (message := _system_message(error)) is not None:
        _drop_output()
        print(f"sheetbench: {message}", file=sys.stderr)
        return BAD_INPUT
    from sheetbench.answers.escape import terminal

    if isinstance(error, UsageError):
        path = error.ctx.command_path if error.ctx else "sheetbench"
        message = terminal(" ".join(error.format_message().split()).rstrip("."))
        print(f"sheetbench: {message}; see {path} --help", file=sys.stderr)
        return BAD_INPUT
    from sheetbench.errors import BadInput, NoEquilibrium  # imports numpy and pydantic, slow for help

    if isinstance(error, (BadInput, NoEquilibrium)):
        print(f"sheetbench: {terminal(' '.join(str(error).split()))}", file=sys.stderr)
        return BAD_INPUT if isinstance(error, BadInput) else NOT_CONVERGED
    if isinstance(error, MemoryError):
        message = f"not enough memory: {terminal(str(error))}; take fewer masses or elements"
        print(f"sheetbench: {message}", file=sys.stderr)
        return BAD_INPUT
    traceback.print_exception(error)
    print(
        "sheetbench: this is a fault of the program, not of your input: please report it, with the lines "
        "above and the command",
        file=sys.stderr,
    )
    return FAULT
