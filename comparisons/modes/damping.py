"""Damping of natural modes by the material.

Dampers and branches of all springs and moduli are proportional to their stiffness, so a mode of K about the
flat sheet at ω follows one equation,

    s² + α s + ω² (E(s)/E∞ + τ s) = 0,    E(s)/E∞ = 1 + Σ a_i s τ_i/(1 + s τ_i),    ζ = −Re s/|s|,

with α the damping_rate, τ the damping_time and the branches a_i, τ_i.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from math import inf, pi
from typing import Annotated

from sheetbench.answers.table import HERTZ, NUMBER, PERCENT, Table
from sheetbench.scenes import Material


@dataclass(frozen=True)
class ModeDamping:
    """Damping of a mode: its damped frequency [Hz], requested (if any) and obtained damping ratio."""

    number: Annotated[int, NUMBER("d", "mode")]
    frequency_hz: Annotated[float, HERTZ(".4g", "frequency")]
    asked: Annotated[float | None, PERCENT(".2f", "ζ requested")]
    got: Annotated[float, PERCENT(".2f", "ζ obtained")]

    @property
    def miss(self) -> Annotated[float | None, PERCENT("z.1f", "difference")]:
        """Relative difference of the obtained from the requested damping ratio."""
        return self.got / self.asked - 1.0 if self.asked else None


def mode_damping(material: Material, frequencies: Iterable[float]) -> tuple[ModeDamping, ...]:
    """Return the damping of modes; frequencies: undamped [Hz], at the long-time modulus."""
    tau, alpha, (low, high) = material.dashpot_time, material.damping_rate, material.band or (0.0, inf)
    modes = []
    for number, frequency in enumerate(frequencies, start=1):
        s = material.branches.pole(2.0 * pi * float(frequency), tau, alpha)
        damped_frequency = s.imag / (2.0 * pi)
        in_band = low <= damped_frequency <= high
        requested = 0.5 * material.loss_factor if material.loss_factor and in_band else None
        modes.append(ModeDamping(number, damped_frequency, requested, -s.real / abs(s)))
    return tuple(modes)


def damping_table(modes: Iterable[ModeDamping], caption: str, name: str) -> Table:
    """Return a table of modes with their requested and obtained damping ratios."""
    fields = ("number", "frequency_hz", "asked", "got", "miss")
    return Table.of(ModeDamping, modes, caption, name, fields=fields)
