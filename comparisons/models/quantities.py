"""A sheet and its material from options; refusals name the options."""

from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from sheetbench.errors import BadInput
from sheetbench.scenes.language.refusals import in_one_line
from sheetbench.scenes.language.units import amount, quantity

Quantities = TypeVar("Quantities", bound=BaseModel)
SIDES = "sides are written 0.188, 0.188x0.3 or 120x80mm"


def sides(text: Any) -> dict[str, float]:
    """Return the sides along x and y [m] of `0.188`, `0.188x0.3`, `120x80 mm` (one unit for both), or one or
    two numbers; an empty dict for None."""
    if text is None:
        return {}
    if not isinstance(text, str):
        both = text if isinstance(text, list | tuple) else [text]
        return {
            f"length_{axis}": amount("--side", length, "m")
            for axis, length in zip("xy", (both[0], both[-1]), strict=True)
        }
    parts = text.replace("×", "x").replace("X", "x").split("x")
    unit = parts[-1].strip().lstrip("0123456789.eE+-")
    if unit and len(parts) == 2 and parts[0].strip()[-1:].isdigit():
        parts[0] += unit
    try:
        lengths = [quantity(part, "m") for part in parts]
    except BadInput as error:
        raise BadInput(f"--side = '{text}': {error}; {SIDES}") from None
    if len(lengths) > 2:
        raise BadInput(f"--side = '{text}': {SIDES}")
    return {"length_x": lengths[0], "length_y": lengths[-1]}


def checked(kind: type[Quantities], data: dict[str, Any], option: str = "--") -> Quantities:
    """Return the validated object. Raises BadInput naming the first option out of bounds; option: the prefix
    of its name."""
    try:
        return kind.model_validate(data)
    except ValidationError as error:
        reason = in_one_line(error, kind)
        if error.errors()[0]["loc"]:
            key = str(error.errors()[0]["loc"][0])
            reason = f"{option}{'side' if key.startswith('length') else key}{reason.removeprefix(key)}"
        raise BadInput(reason) from None
