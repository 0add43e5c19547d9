"""What a user can get wrong here: one error, whose text names the option, the value and what is allowed."""

from __future__ import annotations

from collections.abc import Iterable


class BadInput(ValueError):
    """An option or argument that cannot be used as given."""


def require_choice(option: str, value: str, choices: Iterable[str]) -> None:
    """Raise BadInput, listing the choices, unless `value` is one of them."""
    names = list(choices)
    if value not in names:
        raise BadInput(f"{option} = '{value}': unknown, choose one of {', '.join(names)}")
