"""The judges among the installed plug-ins, and whether what they need is here."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from comparisons.judges.answer import Judge
from comparisons.models import plugins
from sheetbench.errors import BadInput, require_choice


@dataclass(frozen=True)
class Found:
    """A judge as it was looked for: how it is asked for, itself, and its version, None where it is absent."""

    asked: str
    judge: Judge
    version: str | None


def look(names: Sequence[str] | None = None) -> list[Found]:
    """The judges of these names, or `FILE.py:OBJECT`; of all installed plug-ins unless given.

    Raises BadInput for a name that is no judge's, and for a judge that was asked for and is not here.
    """
    if names is None:
        return [Found(name, model, model.version()) for name, model in installed().items()]
    found = []
    for name in names:
        if plugins.from_file(name) is None:
            require_choice("--judges", name, installed())
        judge = plugins.plugin(name)
        if not isinstance(judge, Judge):
            raise BadInput(f"--judges = '{name}': a model, but no judge: it has no meshes or no version()")
        if (version := judge.version()) is None:
            raise BadInput(f"--judges = '{name}': needs {judge.needs}")
        found.append(Found(name, judge, version))
    return found


def installed() -> dict[str, Judge]:
    """The judges among the plug-ins; one that cannot be loaded is none."""
    judges = {}
    for name in plugins.names():
        try:
            model = plugins.plugin(name)
        except BadInput:
            continue
        if isinstance(model, Judge):
            judges[name] = model
    return judges
