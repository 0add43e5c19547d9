"""A verb from its command: groups of options in place of one parameter, --quiet, what an interrupt leaves."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from inspect import Parameter, isclass, signature
from typing import Annotated, Any

import typer

from comparisons.cli import interruption
from comparisons.cli.options import CampaignOptions, Group, option
from comparisons.cli.output import OutputOptions

Quiet = Annotated[
    bool, option("No progress and no notes on standard error; results, warnings and errors stay.")
]
NoPicturesAnyway = Annotated[bool, typer.Option(hidden=True)]  # of verbs that draw none, for scripts


def as_verb(name: str, command: Callable[..., None]) -> Callable[..., None]:
    """Return the command as typer reads it, with the options of its groups and those of every verb.

    A flag is `--name` alone, unless it says more. An Impossible scene is refused with the name of its file.
    """
    own = signature(command, eval_str=True)
    groups: dict[str, type[Group]] = {}
    parameters: list[Parameter] = []
    for parameter in own.parameters.values():
        if isclass(parameter.annotation) and issubclass(parameter.annotation, Group):
            groups[parameter.name] = parameter.annotation
            parameters += parameter.annotation.parameters()
        else:
            parameters.append(parameter.replace(kind=Parameter.KEYWORD_ONLY))
    of_campaign = any(issubclass(kind, CampaignOptions) for kind in groups.values())
    draws = any(parameter.name == "no_pictures" for parameter in parameters)
    added = {"quiet": Quiet} if draws else {"no_pictures": NoPicturesAnyway, "quiet": Quiet}
    for flag, annotation in added.items():
        parameters.append(Parameter(flag, Parameter.KEYWORD_ONLY, default=False, annotation=annotation))
    for parameter in parameters:
        _name_flag(parameter)

    @wraps(command)
    def run(*, quiet: bool, **values: Any) -> None:
        resumed = of_campaign or values.get("duration") is not None
        interruption.promise(name, values.get("out"), resumed)
        plain = {} if draws else {"no_pictures": values.pop("no_pictures")}
        for group, kind in groups.items():
            verb = {"verb": name, **plain} if issubclass(kind, OutputOptions) else {}
            values[group] = kind(**verb, **{one.name: values.pop(one.name) for one in kind.parameters()})
        try:
            if not quiet:
                command(**values)
                return
            from comparisons.cli import console  # with rich: help must not wait for it

            with console.quietly():
                command(**values)
        except ValueError as error:
            from sheetbench.errors import Impossible, SceneError

            if isinstance(error, Impossible) and values.get("scene"):
                raise SceneError(f"{values['scene']}: {error}") from None
            raise

    paragraphs = (command.__doc__ or "").split("\n\n")  # whose lines a help page breaks itself
    run.__doc__ = "\n\n".join(" ".join(one.split()) for one in paragraphs)
    run.__signature__ = own.replace(parameters=parameters)  # type: ignore[attr-defined]
    run.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return run


def _name_flag(parameter: Parameter) -> None:
    """Name a flag without a name of its own, to which typer would add `--no-name`."""
    for one in getattr(parameter.annotation, "__metadata__", ()):
        if parameter.annotation.__origin__ is bool and one.default is ...:
            one.param_decls = (f"--{parameter.name.replace('_', '-')}",)
