"""Errors of a user's input, whose text names the option, its value and the allowed values.

Every package raises BadInput for requests that it cannot fulfil, and for nothing else: an exception of any
other type, a ValueError too, is a fault of the program and shows its traceback.
"""

import unicodedata
from collections.abc import Iterable, Mapping
from difflib import get_close_matches

_CONTROL = ("Cc", "Cs", "Zl", "Zp")  # control characters, surrogates, separators of lines and paragraphs
_TURNING = "\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069"  # change the direction of writing
FOREIGN = 160  # characters: the reason is mostly in the first ones


class BadInput(ValueError):
    """An option, argument or file that cannot be used as given.

    Parameters
    ----------
    text : str
        The reason in one line; control characters are spelled out.
    """

    def __init__(self, text: str) -> None:
        super().__init__(printable(text))


class SceneError(BadInput):
    """A scene that cannot be read, or an impossible value in it.

    Parameters
    ----------
    text : str
        The reason in one line, with file, key and value.
    """


class WrongArgument(SceneError, TypeError):
    """An unknown, superfluous or missing keyword of a function or an object."""


class Impossible(SceneError):
    """A valid scene that a model or a verb does not support. The text names the scene; a reader of the
    scene's file puts the file's name before it."""


class NoMesh(BadInput):
    """A sheet's shapes between whose borders a reference has no elements, or only folded ones."""


class NoEquilibrium(ArithmeticError):
    """A scene without the stable equilibrium that a computation starts from; the text has the status."""


class Implausible(UserWarning):
    """A warning of a scene that can be solved but is probably a slip.

    Parameters
    ----------
    text : str
        The slip in one line, with file, key, value and unit.
    """

    def __init__(self, text: str) -> None:
        super().__init__(printable(text))


def printable(text: str, keep: str = "") -> str:
    """Return a text with its control characters spelled out, as `\\x1b`, except the ones in `keep`.

    No control character of a file reaches a terminal.
    """
    acting = {c for c in set(text) if c in _TURNING or unicodedata.category(c) in _CONTROL} - set(keep)
    spelled = {ord(c): c.encode("unicode_escape").decode("ascii") for c in acting}
    return text.translate(spelled)


def require_effect(why: str, options: Mapping[str, object]) -> None:
    """Raise BadInput for the first option that is given although it has no effect.

    options: values by name, in the user's spelling, where None, False and empty values stand for absent
    options. why: the circumstance, as "without --out".
    """
    for name, value in options.items():
        empty = isinstance(value, tuple | list) and not value
        if not (value is None or value is False or empty):
            raise BadInput(f"{name}: no effect {why}; leave it out")


def foreign(message: object) -> str:
    """Return a message or an error of another program or library in a line of at most FOREIGN characters."""
    text = printable(" ".join(str(message).split())) or type(message).__name__
    return text if len(text) <= FOREIGN else f"{text[: FOREIGN - 1]}…"


def require_choice(option: str, value: str, choices: Iterable[str]) -> None:
    """Raise BadInput, listing the choices and the nearest of them, unless `value` is one of them."""
    names = list(choices)
    if value not in names:
        near = "".join(f"; did you mean {name}?" for name in get_close_matches(str(value), names, 1))
        raise BadInput(f"{option} = '{value}': unknown, choose one of {', '.join(names)}{near}")
