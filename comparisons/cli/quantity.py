"""Numbers of the command line that may have a unit: `--thickness "2 mm"`."""

from __future__ import annotations

from collections.abc import Callable

import typer


def quantity_in(unit: str) -> Callable[[str], float]:
    """A parser of an option's text, a number in the SI unit `unit` or a quantity with a unit of its own."""

    def parse(text: str) -> float:
        from sheetbench.errors import BadInput  # with numpy and pydantic: help must not wait for them
        from sheetbench.scenes.units import quantity

        try:
            return quantity(str(text), unit)
        except BadInput as error:
            raise typer.BadParameter(str(error)) from None

    return parse
