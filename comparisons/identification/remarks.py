"""Warnings about a fit: outliers, poor fits, bounds, the law of strain, and the error of the grid."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from comparisons.identification.answer import Estimate
from comparisons.identification.fit import Fit, Nearest
from comparisons.identification.residual_test import POOR, Outlier, Runs, explained
from fem_reference.pulled_strip import curving, laws_of
from sheetbench.answers.table import quantity
from sheetbench.choices import STRAIN_LAW
from sheetbench.scenes import Scene
from sheetbench.scenes.language.summary import few

NOTED = 0.01  # share of the force from which on it is reported
RUBBERS = "neo-hookean"
CELLS = "cells half as large"


def on_outliers(odd: Sequence[Outlier], without: Mapping[str, Estimate]) -> list[str]:
    """Return the rows that do not fit, and the values without them."""
    if not odd:
        return []
    values = "; ".join(
        f"{name} = {quantity(u.value, u.unit)}, 95 % {quantity(u.interval[0], u.unit)} to "
        f"{quantity(u.interval[1], u.unit)}"
        for name, u in without.items()
    )
    rows = "this row" if len(odd) == 1 else "these rows"
    return [f"{'; '.join(map(str, odd))}. Is it a mistake? Without {rows}: {values}"]


def on_residuals(fit: Fit, best: Nearest, left: Runs, starts: int) -> list[str]:
    """Return why residuals are more than noise, and what may be done."""
    names = ", ".join(u.name for u in fit.unknowns)
    tried = f"the best of {starts} starts" if starts > 1 else "the search"
    deviation = quantity(fit.measured.scale * best.noise, "m", ".3g")
    size = f"{tried} leaves residuals of {deviation}, {few(100 * best.noise)} % of the largest measurement"
    if best.noise > POOR:
        turned = " and ".join(fit.turned(best.residuals))
        return [
            f"a poor fit: {size}: no value of {names} explains these data; look at frame, supports and model"
            + (f": the measured {turned} have the opposite sign of the model's" if turned else "")
        ]
    if explained(best.noise, left):
        return []
    return [
        f"not explained: {size}, and are not noise: {left}. Something is missing in the model (supports, "
        "loads, an unknown, finer cells), and the interval, which assumes noise, is too narrow",
    ]


def on_bounds(fit: Fit, best: Nearest) -> list[str]:
    """Return the unknowns that ended at a bound of the search."""
    return [
        f"{u.name} hit its search bound {quantity(u.value(x), u.unit)}: the data do not constrain it"
        for u, x, active in zip(fit.unknowns, best.x, best.against_bounds, strict=True)
        if active
    ]


def on_grid(found: Mapping[str, Estimate], model: str, looked: bool) -> list[str]:
    """Return what the lattice's cells, or the elements of another model, do to the values."""
    lattice = model == "lumped"
    other, error = (CELLS, "grid's") if lattice else ("elements twice as large", "mesh's")
    seen = [u for u in found.values() if u.determined]
    if looked and seen and all(u.interval == u.noise_interval for u in seen):
        return [f"{other} could not be solved: the {error} error is not known, nor in the interval"]
    more = "masses (--lumped), or leave the grid to the fit" if lattice else "--elements"
    finer = {
        name: "" if u.refined is None else f" would be {quantity(u.refined, u.unit)} on {CELLS}"
        for name, u in found.items()
        if u.determined and _wide(u)
    }
    rest = f"most of its interval is the {error} error; take more {more}"
    return [f"{name}{value}: {rest}" for name, value in finer.items()]


def on_law(scene: Scene, law: str | None, stretch: float | None) -> list[str]:
    """Return a sentence where laws of strain differ at the largest stretch of the sheet with the values
    found."""
    material = scene.material
    own = law or material.law or STRAIN_LAW
    differences = {name: abs(curving(own, material) - curving(name, material)) for name in laws_of(material)}
    other = max(differences, key=lambda name: differences[name])
    off = differences[other] * (stretch or 0.0)
    if off <= NOTED:
        return []
    remedy = f"; of soft silicones, which are rubbers, take --law {RUBBERS}"
    remedy = "" if own in (RUBBERS, material.law) else remedy
    return [
        f"values are those of the law {own}: at {few(100.0 * (stretch or 0.0))} % stretch, as here, the "
        f"force of {other} is some {few(100.0 * off)} % another{remedy}"
    ]


def _wide(found: Estimate) -> bool:
    """Return whether the grid widens an interval to more than twice the noise's."""
    whole, noise = np.ptp(found.interval), np.ptp(found.noise_interval)
    return bool(whole > 2.0 * noise and whole > 1e-2 * abs(found.value))
