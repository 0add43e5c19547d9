"""A command's arguments before its verb reads them: options that a folder adds to them, and opposite ones.

`sheetbench-defaults.toml` in a folder gives options to the commands run in it, a table a verb:

    [compare]
    elements = 24
    large = true

A flag that is false is left out, as on the command line. They stand before the options of the command line,
which therefore win, and are kept with the command beside its results.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Collection, Iterator, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import Any

FILE = "sheetbench-defaults.toml"


class Refused(Exception):
    """Why a command is refused before its verb is called, in a line."""


def with_defaults(
    arguments: Sequence[str], verbs: Collection[str], options_of: Callable[[str], Collection[str]]
) -> list[str]:
    """Return a command's arguments with the options of its verb's table behind the verb, and say so.

    options_of: a verb's options, as "--large". Raises Refused for a file that cannot be read, tables of no
    verb, keys that are no option and values that no option takes.
    """
    verb, *others = arguments or [""]
    asks = {"-h", "--help"} & set(others)
    if verb not in verbs or asks or not Path(FILE).is_file():
        return list(arguments)
    import tomllib

    try:
        tables = tomllib.loads(Path(FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        from sheetbench.errors import foreign

        raise Refused(f"{FILE}: cannot be read: {foreign(error)}") from None
    for name, table in tables.items():
        if name not in verbs or not isinstance(table, dict):
            raise Refused(f"{FILE}: {name}: a table of a verb is needed, as [compare]")
    known = options_of(verb) if verb in tables else ()
    written = [
        one for key, value in tables.get(verb, {}).items() for one in _written(verb, key, value, known)
    ]
    options = [one for one in written if _opposite(one) not in others]
    if options and "--quiet" not in (*others, *options):
        print(f"{FILE}: {verb} {' '.join(options)}", file=sys.stderr)
    return [verb, *options, *others]


def _opposite(flag: str) -> str:
    return f"--{flag.removeprefix('--no-')}" if flag.startswith("--no-") else f"--no-{flag[2:]}"


def _written(verb: str, key: str, value: Any, known: Collection[str]) -> Iterator[str]:
    option = key.replace("_", "-")
    if f"--{option}" not in known:
        near = get_close_matches(f"--{option}", known, 1)
        raise Refused(f"{FILE}: {verb}.{key}: no option{f'; did you mean {near[0][2:]}?' if near else ''}")
    if isinstance(value, bool):
        if value or f"--no-{option}" in known:
            yield f"--{option}" if value else f"--no-{option}"
        return
    for one in value if isinstance(value, list) else [value]:
        if not isinstance(one, str | int | float):
            raise Refused(f"{FILE}: {verb}.{key}: a number, a text, true, false or a list of these is needed")
        yield f"--{option}={one}"


def refuse_opposites(arguments: Sequence[str]) -> None:
    """Raise Refused for an option beside its opposite."""
    for option in arguments:
        if option.startswith("--no-") and _opposite(option) in arguments:
            raise Refused(f"{_opposite(option)} and {option}: give one of them")
