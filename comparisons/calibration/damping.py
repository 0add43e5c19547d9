"""Damping of a material from a loss factor or measured moduli.

    η = 2ζ = tan δ = 1/Q,    ζ = δ/√(4π² + δ²)

with ζ the fraction of critical damping, tan δ of a dynamic test, Q of a resonance, and δ the logarithmic
decrement of a decay. Measured moduli are fitted by a Prony series with two branches per decade of the
measured range; stiffnesses and E∞ are the nonnegative least squares of the relative misfit. Source: Koruk and
Rajagopal 2024, Sensors 24, 6137.
"""

from itertools import pairwise
from math import ceil, log10, pi
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.identification.columns import Columns, read_columns
from sheetbench.answers.table import MILLISECONDS, NUMBER, Table
from sheetbench.errors import BadInput
from sheetbench.scenes import Material, Relaxation
from sheetbench.scenes.objects.relaxation import A_DECADE

LEAST_SHARE = 1e-4  # branches with smaller shares are dropped
FEWEST = 4  # least number of rows of measured moduli
DAMPED = "sheetbench modes lists the damping ratio of each mode"
RELATION = "loss factor η = 2ζ = tan δ = 1/Q; a decay's logarithmic decrement is πη where η is small"


def branches(material: Material) -> list[tuple[float, float]]:
    """Return share and time [s] of each Maxwell branch of a material."""
    own = material.branches
    return [*zip(map(float, own.shares), map(float, own.times), strict=True)]


def keys(
    loss_factor: float | None = None,
    at: float | None = None,
    band: tuple[float, float] | None = None,
    prony: Path | None = None,
    option: str = "--",
) -> dict[str, Any]:
    """Return the keys of [material] for damping options. Raises BadInput naming the options."""
    limits = " and ".join(option + name for name, value in (("at", at), ("band", band)) if value is not None)
    factor = f"{option}loss-factor"
    if prony is not None:
        if others := " and ".join(filter(None, [factor if loss_factor is not None else "", limits])):
            raise BadInput(f"{option}prony and {others}: measured moduli have their own damping and band")
        return _series(prony)
    if loss_factor is None:
        if limits:
            raise BadInput(f"{limits}: needs {factor}")
        return {}
    if not loss_factor > 0.0:
        raise BadInput(f"{factor} = {loss_factor:g}: must be greater than 0")
    if (at is None) == (band is None):
        raise BadInput(f"{factor}: give {option}at HZ, for one damper a spring, or {option}band LOW HIGH")
    return {"loss_factor": loss_factor, "frequency": at, "band": band}


SERIES = {"frequency": "Hz", "storage": "Pa", "loss": "Pa", "tan_delta": "", "time": "s", "modulus": "Pa"}


def tables(material: Material) -> tuple[Table, ...]:
    """Return a table of a material's branches and their effect on its modulus, nothing without branches."""
    rows = branches(material)
    if not rows:
        return ()
    ends = material.band or tuple(1.0 / (2.0 * pi * time) for _, time in (rows[-1], rows[0]))
    storage, _ = material.branches.storage_and_loss(np.array(ends))
    text = (
        f"{RELATION}. Motion stiffens these branches: the modulus is {storage[0]:.3g} times the long-time "
        f"one, which statics take, at {ends[0]:.3g} Hz, and {storage[1]:.3g} times at {ends[1]:.3g} Hz"
    )
    columns = (NUMBER(".5g", "share"), MILLISECONDS(".5g", "time"))
    caption = "Maxwell branches, as [[material.relaxation]]"
    return (Table.listed(caption, columns, rows, "branches", text=text),)


def notes(material: Material) -> list[str]:
    """Return notes on the damping of a material, none without damping."""
    if material.branches.times:
        return [DAMPED]
    if not material.dashpot_time:
        return []
    return [
        f"One damper per spring, {1e3 * material.dashpot_time:.4g} ms · k, gives η in proportion to the "
        f"frequency: it is right at one frequency only. {RELATION}",
        DAMPED,
    ]


def document(material: Material) -> dict[str, Any]:
    """Return the key `damping` of the JSON document, nothing without damping."""
    if not (material.dashpot_time or material.branches.times):
        return {}
    return {
        "damping": {
            "loss_factor": material.loss_factor,
            "damping_time": material.dashpot_time,
            "relaxation": [{"share": share, "time": time} for share, time in branches(material)],
        }
    }


def to_toml(material: Material) -> str:
    """Return the branches of a material as TOML for a scene, or a comment with its single damper."""
    text = "".join(
        f"\n[[material.relaxation]]\nshare = {share!r}\ntime = {time!r}\n"
        for share, time in branches(material)
    )
    if text:
        return f"\n# in [material]: young = {material.young!r}{text}"
    return f"\n# in [material]: damping_time = {material.dashpot_time!r}\n" if material.dashpot_time else ""


def _series(path: Path) -> dict[str, Any]:
    """Return young and relaxation from a file of frequency, storage, loss or of time, modulus."""
    columns = read_columns(path, SERIES)
    names = set(columns.names)
    if {"frequency", "storage"} <= names and names & {"loss", "tan_delta"}:
        at, storage = _column(path, columns, "frequency"), columns.numbers("storage")
        loss = columns.numbers("loss") if "loss" in names else storage * columns.numbers("tan_delta")
        decades = log10(at[-1] / at[0])
        times = 1.0 / (2.0 * pi * np.geomspace(at[-1], at[0], max(2, ceil(A_DECADE * decades) + 1)))
        x = 2.0 * pi * at[:, None] * times
        one = np.ones((len(at), 1))
        rows = np.vstack([np.hstack([one, x * x / (1.0 + x * x)]), np.hstack([0.0 * one, x / (1.0 + x * x)])])
        measured = np.concatenate([storage, loss])
    elif {"time", "modulus"} <= names:
        at, measured = _column(path, columns, "time"), columns.numbers("modulus")
        times = np.geomspace(at[0], at[-1], max(2, ceil(A_DECADE * log10(at[-1] / at[0])) + 1))
        rows = np.hstack([np.ones((len(at), 1)), np.exp(-at[:, None] / times)])
    else:
        raise BadInput(
            f"{path}: columns {', '.join(columns.names) or 'missing'}; needed are frequency, storage and "
            "loss (or tan_delta) of a dynamic test, or time and modulus of a relaxation"
        )
    if not (measured > 0.0).all():
        raise BadInput(f"{path}: moduli must be greater than 0")
    from scipy.optimize import nnls

    stiffness, _ = nnls(rows / measured[:, None], np.ones(len(measured)))
    if not stiffness[0] > 0.0:
        raise BadInput(
            f"{path}: no long-time modulus is left: the sheet would flow; measure slower or longer"
        )
    instant = float(stiffness.sum())
    shares = [(float(e) / instant, float(t)) for e, t in zip(stiffness[1:], times, strict=True)]
    branches = [(share, time) for share, time in shares if share > LEAST_SHARE]
    misfit = float(np.sqrt(np.mean((rows @ stiffness / measured - 1.0) ** 2)))
    if misfit > 0.1 or not branches:
        raise BadInput(
            f"{path}: {len(branches)} branches miss the moduli by {100 * misfit:.0f} % (root mean square)"
        )
    long_time = 1.0 - sum(share for share, _ in branches)
    return {"young": instant * long_time, "relaxation": tuple(Relaxation(*branch) for branch in branches)}


def _column(path: Path, columns: Columns, name: str) -> np.ndarray:
    values = columns.numbers(name)
    if len(values) < FEWEST:
        raise BadInput(f"{path}: {len(values)} rows; at least {FEWEST}")
    for row, (previous, value) in zip(columns.rows[1:], pairwise(values), strict=True):
        if not 0.0 < previous < value:
            raise row.refused(name, "must be greater than 0 and increase")
    return values
