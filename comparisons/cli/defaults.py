"""Options that a folder gives to the commands run in it: `sheetbench-defaults.toml`, a table a verb.

    [compare]
    elements = 24
    uncertainty = false

They stand before the options of the command line, which therefore win, and are kept with the command beside
its results.
"""

from __future__ import annotations

import sys
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import Any

FILE = "sheetbench-defaults.toml"


class Refused(Exception):
    """Why a file of defaults is refused, in a line."""


def with_defaults(arguments: Sequence[str], verbs: Collection[str]) -> list[str]:
    """Return a command's arguments with the options of its verb's table behind the verb, and say so.

    Raises Refused for a file that cannot be read, tables of no verb and values that no option takes.
    """
    verb, *others = arguments or [""]
    asks = {"-h", "--help"} & set(others)
    if verb not in verbs or asks or not Path(FILE).is_file():
        return list(arguments)
    import tomllib

    try:
        tables = tomllib.loads(Path(FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise Refused(f"{FILE}: cannot be read: {' '.join(str(error).split())}") from None
    for name, table in tables.items():
        if name not in verbs or not isinstance(table, dict):
            raise Refused(f"{FILE}: {name}: a table of a verb is needed, as [compare]")
    options = [one for key, value in tables.get(verb, {}).items() for one in _written(verb, key, value)]
    if options and "--quiet" not in (*others, *options):
        print(f"{FILE}: {verb} {' '.join(options)}", file=sys.stderr)
    return [verb, *options, *others]


def _written(verb: str, key: str, value: Any) -> Iterator[str]:
    option = key.replace("_", "-")
    if isinstance(value, bool):
        yield f"--{option}" if value else f"--no-{option}"
        return
    for one in value if isinstance(value, list) else [value]:
        if not isinstance(one, str | int | float):
            raise Refused(f"{FILE}: {verb}.{key}: a number, a text, true, false or a list of these is needed")
        yield f"--{option}={one}"
