"""What a linearised lattice shows: its poles, what its commands do at rest, frequency responses."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from comparisons.linearisation.units import unit_of
from sheetbench.answers.report import Picture, Report
from sheetbench.answers.table import Column, Table

if TYPE_CHECKING:
    from comparisons.linearisation.linearisation import Linearisation

ROUNDING = 1e-6  # of what an input moves most


def report(found: Linearisation) -> Report:
    """What `sheetbench linearise` shows."""
    states, size = len(found.space.a), found.matrices.mass.shape[0]
    return Report(
        name="linear",
        title=found.scene.name,
        subtitle=found.scene.title,
        lead=f"{found.label}, about the {'flat sheet' if found.about == 'flat' else 'equilibrium'}: "
        f"{size} unknowns, a state space of {states} states, "
        f"{len(found.matrices.inputs)} inputs, {len(found.matrices.outputs)} outputs",
        document=found.as_dict(),
        tables=(poles(found), jacobian(found)),
        printed=(poles(found), heights(found)),
        notes=(
            *_reduction(found),
            "at rest: displacement of a probe per unit of an input, by the adjoint of K; factor: of a load "
            "or of gravity as the scene has it",
            "files: M, C, K, F, F_rate, G, H and ss_A to ss_D in linear.npz and linear.mat",
        ),
        pictures=(Picture("responses", "comparisons.linearisation.figure:compose", (found,)),),
        attachments={"linear.npz": found.write_npz, "linear.mat": found.write_mat},
        settings={"label": found.label, "about": found.about, "states": states},
    )


def _reduction(found: Linearisation) -> tuple[str, ...]:
    """What a balanced truncation promises."""
    if found.balanced is None:
        return ()
    return (
        f"balanced: {found.balanced.order} of {len(found.modal.a)} states; no input is answered wrong, at "
        f"any frequency, by more than {found.balanced.bound:.2g} of what it does at rest; exactly when slow",
    )


def poles(found: Linearisation) -> Table:
    """A row per pair of poles: the slowest first."""
    rows = tuple(
        (float(abs(pole) / (2.0 * np.pi)), float(ratio), float(pole.real), float(pole.imag))
        for pole, ratio in zip(found.upper, found.damping_ratios, strict=True)
    )
    undamped = not any(found.damping_ratios)
    columns = (
        Column("frequency", "Hz", "Hz", 1.0, ".5g"),
        Column("damping ratio", "", "%", 100.0, "z.3g", detail=undamped),
        Column("real", "1/s", "1/s", 1.0, "z.5g", detail=undamped),
        Column("imaginary", "rad/s", "rad/s", 1.0, ".5g"),
    )
    return Table("Poles (nothing damps them)" if undamped else "Poles", columns, rows, "poles")


def jacobian(found: Linearisation) -> Table:
    """A row per input: what it moves the probes by at rest, in all components."""
    rows = tuple(
        (name, unit_of(name), *column)
        for name, column in zip(found.matrices.inputs, found.matrices.jacobian.T.tolist(), strict=True)
    )
    outputs = (Column(name, "m", "mm", 1e3, "z.4g") for name in found.matrices.outputs)
    columns = (Column("input"), Column("unit"), *outputs)
    return Table("Displacement at rest per unit of input", columns, rows, "jacobian")


def heights(found: Linearisation) -> Table:
    """The same along z alone, of loads, commands and moved edges, these per millimetre; rounding as 0."""
    outputs, inputs = found.matrices.outputs, found.matrices.inputs
    kept = [n for n, name in enumerate(outputs) if name.endswith(" uz")]
    rows = []
    for name, column in zip(inputs, found.matrices.jacobian.T, strict=True):
        unit = unit_of(name)
        scale, shown = (1e-3, "mm") if unit == "m" else (1.0, unit)
        if unit != "N":
            values = np.where(np.abs(column) > ROUNDING * np.abs(column).max(), column, 0.0)
            rows.append((name, shown, *(scale * values[kept]).tolist()))
    columns = (Column("input"), Column("unit"), *(Column(outputs[n], "m", "mm", 1e3, "z.3g") for n in kept))
    return Table("Height at rest per unit of input", columns, tuple(rows))
