"""What a user can get wrong: errors of their own, whose text names the option, the value and what is allowed.

Every package raises BadInput for requests that it cannot fulfil, and for nothing else: an exception of any
other type, a ValueError too, is a fault of the program and shows where it came from.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Mapping
from difflib import get_close_matches

_CONTROL = ("Cc", "Cs", "Zl", "Zp")  # control characters, surrogates, separators of lines and paragraphs
_TURNING = "\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069"  # change the direction of writing
FOREIGN = 160  # characters: what was said first is mostly the reason


class BadInput(ValueError):
    """An option, argument or file that cannot be used as given."""

    def __init__(self, text: str) -> None:
        super().__init__(printable(text))


class SceneError(BadInput):
    """A scene that cannot be read or asks something impossible; the text names file, key and value."""


class WrongArgument(SceneError, TypeError):
    """A keyword that a function or an object does not have, one too many, or one that is missing."""


class Impossible(SceneError):
    """What a scene that reads well does not go with; the text names the scene, and whoever knows its file
    puts that before it."""


class NoMesh(BadInput):
    """Borders of a sheet's shapes between which a reference has no elements, or only folded ones."""


class NoEquilibrium(ArithmeticError):
    """A scene without the stable equilibrium that was to be gone out from; the text says how it ended."""


class Implausible(UserWarning):
    """A scene that can be solved and is hardly meant; the text names file, key, value and unit."""

    def __init__(self, text: str) -> None:
        super().__init__(printable(text))


def printable(text: str, keep: str = "") -> str:
    """Return the text with its control characters spelled out, as `\\x1b`, but for those in `keep`: none of
    a file's reaches a terminal."""
    acting = {c for c in set(text) if c in _TURNING or unicodedata.category(c) in _CONTROL} - set(keep)
    spelled = {ord(c): c.encode("unicode_escape").decode("ascii") for c in acting}
    return text.translate(spelled)


def require_effect(why: str, options: Mapping[str, object]) -> None:
    """Raise BadInput for the first of these options that is given: they have no effect.

    options: values by name, as the user writes it; None, False and what is empty are not given. why: with or
    without what, as "without --out".
    """
    for name, value in options.items():
        empty = isinstance(value, tuple | list) and not value
        if not (value is None or value is False or empty):
            raise BadInput(f"{name}: no effect {why}; leave it out")


def foreign(said: object) -> str:
    """What another program, library or file says, an error too, in one line of FOREIGN characters at most."""
    text = printable(" ".join(str(said).split())) or type(said).__name__
    return text if len(text) <= FOREIGN else f"{text[: FOREIGN - 1]}…"


def require_choice(option: str, value: str, choices: Iterable[str]) -> None:
    """Raise BadInput, listing the choices and the nearest of them, unless `value` is one of them."""
    names = list(choices)
    if value not in names:
        near = "".join(f"; did you mean {name}?" for name in get_close_matches(str(value), names, 1))
        raise BadInput(f"{option} = '{value}': unknown, choose one of {', '.join(names)}{near}")
