"""A verb from its command: groups of options in place of one parameter, --quiet, what an interrupt leaves.

A command whose keyword `output` is of the type `OutputOptions` has --json, --out and --overwrite, and with
`PictureOptions` --figure and --no-pictures besides; `CampaignOptions` are those of many runs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, fields
from functools import wraps
from inspect import Parameter, isclass, signature
from typing import TYPE_CHECKING, Any, get_type_hints

from comparisons.cli import interruption, options
from comparisons.cli.options import Figure, Json, NoPictures, Out, Overwrite, Retry, Scheduler, Wait, Workers

if TYPE_CHECKING:
    from comparisons.cli.output import Output
    from sheetbench.scenes import Scene


class Group:
    """A dataclass whose fields with typer's annotations are options."""

    @classmethod
    def parameters(cls) -> list[Parameter]:
        """Return the options as keyword parameters of a command."""
        hints = get_type_hints(cls, include_extras=True)
        return [
            Parameter(one.name, Parameter.KEYWORD_ONLY, default=one.default, annotation=hints[one.name])
            for one in fields(cls)  # type: ignore[arg-type]
            if hasattr(hints[one.name], "__metadata__")
        ]


@dataclass(frozen=True)
class OutputOptions(Group):
    """Where the answer of a verb goes."""

    verb: str
    json: Json = False
    out: Out = None
    overwrite: Overwrite = False
    figure: str | None = None
    no_pictures: bool = False

    def open(
        self,
        *,
        scene: Scene | None = None,
        about: Mapping[str, Any] | None = None,
        variant: Mapping[str, Any] | None = None,
        alone: bool = False,
    ) -> AbstractContextManager[Output]:
        """Return the context in which a verb works and shows its report (`comparisons.cli.output.opened`)."""
        from comparisons.cli.output import opened  # with rich: help must not wait for it

        return opened(self, scene=scene, about=about, variant=variant, alone=alone)


@dataclass(frozen=True)
class PictureOptions(OutputOptions):
    """The output of a verb that draws pictures."""

    figure: Figure = None
    no_pictures: NoPictures = False


@dataclass(frozen=True)
class CampaignOptions(Group):
    """How a campaign's runs are carried out."""

    workers: Workers = None
    scheduler: str | None = None
    wait: bool = False
    retry: Retry = False


@dataclass(frozen=True)
class ClusterOptions(CampaignOptions):
    """The options of a campaign whose runs may go to a cluster."""

    scheduler: Scheduler = None
    wait: Wait = False


def as_verb(name: str, command: Callable[..., None]) -> Callable[..., None]:
    """Return the command as typer reads it, with the options of its groups and those of every verb.

    An Impossible scene is refused with the name of its file.
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
    for added, option in {"no_pictures": options.NoPicturesAnyway, "quiet": options.Quiet}.items():
        if added != "no_pictures" or not draws:
            parameters.append(Parameter(added, Parameter.KEYWORD_ONLY, default=False, annotation=option))

    @wraps(command)
    def run(*, quiet: bool, **values: Any) -> None:
        resumed = of_campaign or values.get("duration") is not None
        interruption.promise(name, values.get("out"), resumed)
        if not draws:
            values.pop("no_pictures")
        for group, kind in groups.items():
            verb = {"verb": name} if issubclass(kind, OutputOptions) else {}
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
