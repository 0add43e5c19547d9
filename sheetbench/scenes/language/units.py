"""Quantities written with their units, `2 mm`, `0.6 MPa`, `1.2 g/cm³`, `5 ms`, as numbers in SI units.

A unit is a product of powers of the units in `UNITS`, some of which take an SI prefix; `*`, `·` or a space
multiply and `/` divides. A unit of another dimension than the requested one is refused by name.
"""

import re
from collections.abc import Mapping
from fractions import Fraction
from functools import cache
from math import pi
from numbers import Real
from typing import Any

from sheetbench.errors import BadInput

Dimension = tuple[int, ...]  # powers of m, kg, s, rad and K

# exact, so that 1.2 g/cm³ is 1200 kg/m³ to the last digit
UNITS: dict[str, tuple[Fraction, Dimension]] = {
    "m": (Fraction(1), (1, 0, 0, 0, 0)),
    "g": (Fraction(1, 1000), (0, 1, 0, 0, 0)),
    "s": (Fraction(1), (0, 0, 1, 0, 0)),
    "N": (Fraction(1), (1, 1, -2, 0, 0)),
    "Pa": (Fraction(1), (-1, 1, -2, 0, 0)),
    "J": (Fraction(1), (2, 1, -2, 0, 0)),
    "Hz": (Fraction(1), (0, 0, -1, 0, 0)),
    "rad": (Fraction(1), (0, 0, 0, 1, 0)),
    "bar": (Fraction(100_000), (-1, 1, -2, 0, 0)),
    "deg": (Fraction(pi) / 180, (0, 0, 0, 1, 0)),
    "°": (Fraction(pi) / 180, (0, 0, 0, 1, 0)),
    "min": (Fraction(60), (0, 0, 1, 0, 0)),
    "in": (Fraction(254, 10_000), (1, 0, 0, 0, 0)),
    "K": (Fraction(1), (0, 0, 0, 0, 1)),
    "%": (Fraction(1, 100), (0, 0, 0, 0, 0)),
    "1": (Fraction(1), (0, 0, 0, 0, 0)),
}
PREFIXED = {"m", "g", "s", "N", "Pa", "J", "Hz", "rad", "bar"}
PREFIXES = {"G": 9, "M": 6, "k": 3, "d": -1, "c": -2, "m": -3, "µ": -6, "μ": -6, "u": -6}  # powers of ten
SPELLED = {**UNITS} | {
    prefix + unit: (Fraction(10) ** power * UNITS[unit][0], UNITS[unit][1])
    for prefix, power in PREFIXES.items()
    for unit in sorted(PREFIXED)
    if prefix + unit not in UNITS
}
NAMES: dict[str, tuple[str, str]] = {  # by the SI unit: the quantity, and how one is written
    "m": ("length", "2 mm"),
    "s": ("time", "5 ms"),
    "Pa": ("stress or modulus", "0.6 MPa"),
    "kg/m³": ("density", "1.2 g/cm³"),
    "m/s²": ("acceleration", "9.81 m/s²"),
    "N": ("force", "20 mN"),
    "N/m": ("stiffness or force per length", "5 N/m"),
    "N/m²": ("force per area", "20 N/m²"),
    "N·m/m": ("moment per length", "2 mN·m/m"),
    "N·m²": ("bending stiffness", "20 N·cm²"),
    "N·s/m": ("damping", "3 mN·s/m"),
    "N·m": ("bending stiffness of a sheet", "2 µN·m"),
    "kg/m²": ("mass per area", "150 g/m²"),
    "kg/m": ("mass per length", "50 g/m"),
    "kg": ("mass", "20 g"),
    "kg·m²": ("moment of inertia", "20 g·cm²"),
    "1/m": ("curvature", "0.4 1/cm"),
    "1/s": ("rate", "0.5 1/s"),
    "s/m": ("inverse speed", "0.2 s/m"),
    "Hz": ("frequency", "5 Hz"),
    "rad": ("angle", "2 deg"),
    "K": ("temperature difference", "20 K"),
    "K/m": ("temperature gradient", "5 K/mm"),
    "1/K": ("expansion", "70e-6 1/K"),
    "": ("pure number", "0.45"),
}
LARGEST = Fraction(10) ** 300
LONGEST = 40  # characters
NUMBER = re.compile(r"\s*([-+−]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d{1,3})?)\s*(.*?)\s*")
FACTOR = re.compile(r"([^\d^⁰¹²³⁴⁻-]+|1)\^?(-?\d|⁻?[¹²³⁴])?")
POWERS = str.maketrans("¹²³⁴⁻", "1234-")


def quantity(text: str, unit: str) -> float:
    """Return a text as `2 mm` as a number in the SI unit `unit`, which a number without a unit has already.

    Raises BadInput, in a sentence, if the text is no number, its unit unknown or of another dimension.
    """
    example = NAMES.get(unit, ("", f"1 {unit}"))[1]
    match = NUMBER.fullmatch(text)
    if len(text) > LONGEST:
        match, text = None, f"{text[:LONGEST]}…"
    if match is None or "," in text:
        why = "with a decimal point" if match else f"[{unit}], or with a unit: {example}"
        raise BadInput(f"'{text}' is no quantity; write a number {why}")
    value = Fraction(match[1].replace("−", "-"))
    if match[2]:
        size, dimension = _unit(match[2])
        if dimension != _unit(unit)[1]:
            needed = f"{_with_article(unit)} is needed: {example}"
            raise BadInput(f"'{text}' is {_dimension_name(dimension, match[2])}; {needed}")
        value *= size / _unit(unit)[0]
    if abs(value) > LARGEST:
        raise BadInput(f"'{text}' is too large")
    return float(value)


def converted(value: object, unit: str) -> object:
    """Convert texts with a unit, also within lists and tables, to numbers in SI units; keep other values.

    A text that is no quantity of this unit is kept: the check of the number refuses it and names its key.
    """
    if isinstance(value, str):
        match = NUMBER.fullmatch(value)
        try:
            return value if match and not match[2] else quantity(value, unit)  # a bare number needs no quotes
        except BadInput:
            return value
    if isinstance(value, list | tuple):
        return [converted(entry, unit) for entry in value]
    if isinstance(value, dict):
        return {key: converted(entry, unit) for key, entry in value.items()}
    return value


def numbers(data: Mapping[str, Any], units: Mapping[str, str]) -> dict[str, float]:
    """Return the numbers of the keys in `units`, in SI units; an empty dict if one is missing or no number.
    The check of the key itself reports the fault."""
    try:
        texts: dict[str, Any] = {key: converted(data[key], unit) for key, unit in units.items()}
        return {key: float(text) for key, text in texts.items()}
    except (KeyError, TypeError, ValueError):
        return {}


@cache
def _unit(text: str) -> tuple[Fraction, Dimension]:
    """Return the size in SI units and the dimension of a unit. Raises BadInput if a part of it is unknown."""
    size, dimension, sign = Fraction(1), [0, 0, 0, 0, 0], 1
    for part in re.split(r"([*·⋅ /]+)", text):
        if not part.strip(" ·*⋅"):
            continue
        if part.strip() == "/":
            sign = -1
            continue
        match = FACTOR.fullmatch(part)
        if match is None or match[1] not in SPELLED:
            candidates = [unit for unit in SPELLED if unit.casefold() == part.casefold()]
            meant = f" ({' or '.join(candidates)}?)" if candidates else ""
            known = ", ".join(list(UNITS)[:-1])
            raise BadInput(f"'{part}' is no known unit{meant}; known: {known}, with prefixes G to µ")
        power = sign * int((match[2] or "1").translate(POWERS))
        one, of = SPELLED[match[1]]
        size *= one**power
        dimension = [have + power * more for have, more in zip(dimension, of, strict=True)]
        sign = 1
    if sign < 0:
        raise BadInput(f"'{text}' is no unit: nothing follows the last /")
    return size, tuple(dimension)


def _dimension_name(dimension: Dimension, unit: str) -> str:
    """Return the quantity that a unit measures, with its article."""
    for known in NAMES:
        if _unit(known)[1] == dimension:
            return _with_article(known)
    return f"in {unit}"


def _with_article(unit: str) -> str:
    name = NAMES.get(unit, (f"quantity in {unit}", ""))[0]
    return f"{'an' if name[0] in 'aeiou' else 'a'} {name}"


def amount(name: str, value: float | str, unit: str) -> float:
    """Convert an argument, a number in an SI unit or a text with a unit, to a number in the SI unit. Raises
    BadInput, with the argument's name, for other values."""
    if isinstance(value, str):
        try:
            return quantity(value, unit)
        except BadInput as error:
            raise BadInput(f"{name} = {value!r}: {error}") from None
    if isinstance(value, bool) or not isinstance(value, Real):
        raise BadInput(f"{name} = {value!r}: a number{f' [{unit}]' if unit else ''} is needed")
    return float(value)
