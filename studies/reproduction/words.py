"""Fits in words, as the findings say them."""

from __future__ import annotations

from math import degrees

from comparisons.reproduction.published import COMPONENTS
from comparisons.reproduction.words import millimetres
from sheetbench.answers.table import number, quantity
from sheetbench.scenes.seed import PROBES, seed_inputs
from studies.reproduction.nearest import LAYERS, YOUNG, Fit

ROD = {0: "", 1: " with the rod's ends up", -1: " with the rod's ends down"}
KINDS = {
    "sheet": "plate of the published thickness and Poisson's ratio",
    "lattice": "lattice of equal springs",
}
SYMBOLS = {"young": ("E", "Pa"), "k": ("k", "N/m"), "layer_distance": ("lz", "m"), "curvature": ("κ", "1/m")}


def tests(of: tuple[int, ...]) -> str:
    """Which tests, to start a sentence with."""
    return f"Test {of[0]}" if len(of) == 1 else "Both tests together"


def values(fit: Fit) -> str:
    """What was found for what was sought."""
    texts = []
    for name, value in fit.sought.items():
        if name == "tilt":
            texts.append(f"supports turned by {number(degrees(value), '.2g')}°")
        else:
            symbol, unit = SYMBOLS[name]
            texts.append(f"{symbol} = {quantity(value, unit, '.3g')}")
    return ", ".join(texts)


def missed(fit: Fit) -> str:
    """The published entries that a sheet has not, by test."""
    missing = fit.missed
    texts = []
    for i, test in enumerate(fit.tests):
        rows = range(i * len(PROBES), (i + 1) * len(PROBES))
        names = [
            f"{component}({probe})"
            for row, probe in zip(rows, PROBES, strict=True)
            for axis, component in enumerate(COMPONENTS)
            if missing[row, axis]
        ]
        if names:
            texts.append(", ".join(names) + (f" of test {test}" if len(fit.tests) > 1 else ""))
    return " and ".join(texts)


def scanned(kind: str) -> str:
    """The sheets of a scan."""
    given = seed_inputs()
    if kind == "sheet":
        low, high = (quantity(given["young"] * factor, "Pa", ".3g") for factor in (YOUNG[0], YOUNG[-1]))
        return f"plates of {low} to {high}"
    low, high = (millimetres(given["thickness"] * factor, ".3g") for factor in (LAYERS[0], LAYERS[-1]))
    return f"lattices of the published k with layers {low} to {high} apart"
