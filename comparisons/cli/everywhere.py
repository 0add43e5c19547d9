"""What every verb and study has, added in one place: --quiet, --no-pictures, and what an interrupt says."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from inspect import Parameter, signature
from typing import Any

from comparisons.cli import interruption, options


def with_everywhere(command: Callable[..., None]) -> Callable[..., None]:
    """The command with --quiet, and with a --no-pictures that does nothing where it draws none."""
    own = signature(command, eval_str=True)
    anyway = "no_pictures" not in own.parameters

    @wraps(command)
    def run(*, quiet: bool, **given: Any) -> None:
        if anyway:
            given.pop("no_pictures")
        if not quiet:
            command(**given)
            return
        from comparisons.cli import console  # with rich: help must not wait for it

        with console.quietly():
            command(**given)

    parameters = [p.replace(kind=Parameter.KEYWORD_ONLY) for p in own.parameters.values()]
    added = {"no_pictures": options.NoPicturesAnyway} if anyway else {}
    for name, option in {**added, "quiet": options.Quiet}.items():
        parameters.append(Parameter(name, Parameter.KEYWORD_ONLY, default=False, annotation=option))
    run.__signature__ = own.replace(parameters=parameters)  # type: ignore[attr-defined]
    run.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return run


def with_promise(verb: str, command: Callable[..., None]) -> Callable[..., None]:
    """The command, which notes first what an interrupt of it leaves behind, and names its scene's file where
    a refusal does not."""

    @wraps(command)
    def run(**given: Any) -> None:
        interruption.promise(verb, given.get("out"))
        try:
            command(**given)
        except ValueError as error:
            from sheetbench.errors import Impossible, SceneError

            if isinstance(error, Impossible) and given.get("scene"):
                raise SceneError(f"{given['scene']}: {error}") from None
            raise

    return run
