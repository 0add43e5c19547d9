"""The five options of a lattice, declared once for every verb that builds one.

A command that has a parameter `lattice: Lattice` gets --grid, --calibration, --k, --layer-distance and
--grading, and their values as the keywords that `compare`, `simulate`, `modes` and the others take.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from inspect import Parameter, signature
from typing import Any

from comparisons.cli import options

Lattice = dict[str, Any]
OPTIONS = {
    "grid": options.Grid,
    "calibration": options.Calibration,
    "k": options.K,
    "layer_distance": options.LayerDistance,
    "grading": options.Grading,
}


def with_lattice(command: Callable[..., None]) -> Callable[..., None]:
    """The command with the five options in the place of its parameter `lattice`."""

    @wraps(command)
    def run(**given: Any) -> None:
        lattice = {name: given.pop(name) for name in OPTIONS}
        command(**given, lattice=lattice)

    parameters: list[Parameter] = []
    for parameter in signature(command, eval_str=True).parameters.values():
        if parameter.name != "lattice":
            parameters.append(parameter.replace(kind=Parameter.KEYWORD_ONLY))
            continue
        parameters += [
            Parameter(name, Parameter.KEYWORD_ONLY, default=None, annotation=option)
            for name, option in OPTIONS.items()
        ]
    run.__signature__ = signature(command).replace(parameters=parameters)  # type: ignore[attr-defined]
    run.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return run


def given(lattice: Lattice) -> dict[str, Any]:
    """The values by the options' names."""
    return {"--lumped" if name == "grid" else f"--{name.replace('_', '-')}": v for name, v in lattice.items()}
