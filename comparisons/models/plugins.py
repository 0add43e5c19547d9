"""Models from outside: any simulator that answers a static scene can stand in the tables and on the front.

A plug-in is an object with a name, its default settings, and `solve(scene, settings)`; a package offers it
under the entry-point group `sheetbench.models`:

    [project.entry-points."sheetbench.models"]
    mine = "my_package.my_module:MODEL"

`settings` holds the defaults overridden by what the user asks (plain JSON data), and nothing that the
defaults do not name. What `solve` raises as `sheetbench.scenes.BadInput` is bad input, anything else a fault
of the plug-in; a solve that does not get there says so in its Solution's status. docs/plugin.py is a short
one.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Any, Protocol, runtime_checkable

from sheetbench.scenes import Scene, Solution
from sheetbench.scenes.errors import BadInput

GROUP = "sheetbench.models"


@runtime_checkable
class Model(Protocol):
    """A model of one's own."""

    @property
    def name(self) -> str: ...

    @property
    def settings(self) -> Mapping[str, Any]: ...

    def solve(self, scene: Scene, settings: Mapping[str, Any]) -> Solution:
        """The static answer of a scene: displacement in metres at any plan point, and a status."""
        ...


def names() -> list[str]:
    """Names of the installed plug-ins."""
    return sorted(_found())


def plugin(name: str) -> Model:
    """The plug-in of a name. Raises BadInput if it cannot be loaded or is not a `Model`."""
    try:
        model = _found()[name].load()
    except Exception as error:  # whatever a plug-in does on import, the user is told whose fault it is
        raise BadInput(f"model = '{name}': the plug-in cannot be loaded: {error}") from None
    if not isinstance(model, Model):
        raise BadInput(f"model = '{name}': the plug-in lacks a name, settings or solve(scene, settings)")
    return model


def settings_of(model: Model, asked: Mapping[str, Any]) -> dict[str, Any]:
    """The model's defaults overridden by what is asked. Raises BadInput for a setting it does not have."""
    unknown = [key for key in asked if key not in model.settings]
    if unknown:
        known = ", ".join(model.settings) or "none"
        raise BadInput(f"model = '{model.name}': no setting '{unknown[0]}'; it has {known}")
    return {**model.settings, **asked}


@cache
def _found() -> dict[str, EntryPoint]:
    return {entry.name: entry for entry in entry_points(group=GROUP)}
