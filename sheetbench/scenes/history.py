"""What a dynamic run answers with: probes, energies and forces over time, and how it ended.

Part of the question's language, as `scenes.Solution` is for statics: it holds no mechanics.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from sheetbench.scenes import summary
from sheetbench.scenes.solution import Status

ENERGIES = ("kinetic", "elastic", "potential", "dissipated", "work")


@dataclass(frozen=True, repr=False)
class History(summary.Summarised):
    """Samples of a run; n of them, of which the first is the start.

    time: (n,) [s]; probes: name → displacement (n, 3) [m]; energies: kinetic, elastic, potential,
    dissipated and work, (n,) [J] each (potential: of constant dead loads; work: done by all other loads,
    and by supports and commands that move); reactions: as those of a `scenes.Solution`, (n, 3) [N]
    each; actuators: name → force and moment about the
    segment's middle that each segment exerts on the sheet, (n, segments, 6) [N, N·m]; steps: taken by the
    integrator; status `converged` means that the run reached its end; resumed_from: what lies
    before is an earlier run's, which this one took up [s].
    """

    label: str
    integrator: str
    settings: dict[str, Any]
    status: Status
    message: str
    time: np.ndarray
    probes: dict[str, np.ndarray]
    energies: dict[str, np.ndarray]
    reactions: dict[str, np.ndarray]
    actuators: dict[str, np.ndarray]
    steps: int
    setup_seconds: float
    solve_seconds: float
    resumed_from: float = 0.0
    extra: dict[str, Any] = field(default_factory=dict)

    @property
    def balance(self) -> np.ndarray:
        """kinetic + elastic + potential + dissipated − work, (n,) [J]: constant in an exact run."""
        e = self.energies
        total: np.ndarray = e["kinetic"] + e["elastic"] + e["potential"] + e["dissipated"] - e["work"]
        return total

    def _summary(self) -> tuple[str, summary.Facts]:
        end = {name: 1e3 * values[-1] for name, values in self.probes.items() if len(values)}
        return f"History of {self.label}, {self.integrator}: {self.status}", [
            (
                "time",
                f"{len(self.time)} samples to {self.time[-1]:.4g} s" if len(self.time) else "no samples",
            ),
            ("steps", f"{self.steps} in {summary.milliseconds(self.solve_seconds)}"),
            ("at the end", ", ".join(f"{name} uz = {u[2]:.4g} mm" for name, u in end.items())),
            ("reactions", summary.forces({name: force[-1] for name, force in self.reactions.items()})),
            (
                "energies",
                summary.energies({name: float(e[-1]) for name, e in self.energies.items() if len(e)}),
            ),
            ("message", self.message),
        ]
