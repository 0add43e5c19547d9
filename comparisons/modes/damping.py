"""Damping of modes by what the material has of it.

All springs and moduli have their dampers and branches in proportion to their stiffness, so that a mode of K
about the flat sheet at ω is one equation,

    s² + α s + ω² (E(s)/E∞ + τ s) = 0,    E(s)/E∞ = 1 + Σ a_i s τ_i/(1 + s τ_i),    ζ = −Re s/|s|,

with α the damping_rate, τ the damping_time and the branches a_i, τ_i.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import inf, pi
from typing import Annotated

from sheetbench.answers.table import HERTZ, NUMBER, PERCENT, Table
from sheetbench.scenes import Material


@dataclass(frozen=True)
class ModeDamping:
    """A mode's frequency [Hz] as it swings, damping ratio requested (None: nothing) and got."""

    number: Annotated[int, NUMBER("d", "mode")]
    frequency_hz: Annotated[float, HERTZ(".4g", "frequency")]
    asked: Annotated[float | None, PERCENT(".2f", "ζ requested")]
    got: Annotated[float, PERCENT(".2f", "ζ obtained")]

    @property
    def miss(self) -> Annotated[float | None, PERCENT("z.1f", "difference")]:
        """Relative difference of what is got."""
        return self.got / self.asked - 1.0 if self.asked else None


def mode_damping(material: Material, frequencies: Iterable[float]) -> tuple[ModeDamping, ...]:
    """Return the damping of modes of these undamped frequencies [Hz] at the long-time modulus."""
    tau, alpha, (low, high) = material.dashpot_time, material.damping_rate, material.band or (0.0, inf)
    found = []
    for number, frequency in enumerate(frequencies, start=1):
        s = material.branches.pole(2.0 * pi * float(frequency), tau, alpha)
        swings = s.imag / (2.0 * pi)
        within = material.loss_factor and low <= swings <= high
        wanted = 0.5 * material.loss_factor if material.loss_factor and within else None
        found.append(ModeDamping(number, swings, wanted, -s.real / abs(s)))
    return tuple(found)


def damping_table(modes: Iterable[ModeDamping], caption: str, name: str) -> Table:
    """Return a row per mode: what was requested, what is got."""
    fields = ("number", "frequency_hz", "asked", "got", "miss")
    return Table.of(ModeDamping, modes, caption, name, fields=fields)
