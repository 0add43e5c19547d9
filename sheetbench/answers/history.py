"""The answer of a dynamic run: probes, energies and forces over time, and the status at its end.

It holds no mechanics, as `Solution` for statics.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from sheetbench.answers.answer import Answer
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Picture, Write
from sheetbench.answers.solution import COMPONENTS, Status
from sheetbench.answers.table import MILLIMETRES, Column, Table, number
from sheetbench.errors import BadInput

if TYPE_CHECKING:
    import pandas
    import xarray

UNDAMPED = (
    "this sheet has no damping and does not settle; to damp it, give [material] loss_factor, "
    "damping_time or damping_rate, or [air] its drag"
)
ENERGIES = ("kinetic", "elastic", "potential", "dissipated", "work")
Displacement = Annotated[float, MILLIMETRES("z.3f")]


@dataclass(frozen=True)
class ExcursionRow:
    """A probe's last displacement, and its largest component during the motion [m]."""

    probe: str
    ux: Displacement
    uy: Displacement
    uz: Displacement
    largest: Displacement


@dataclass(frozen=True, repr=False)
class History(Answer):
    """The n samples of a run in motion, of which the first is the start.

    Parameters
    ----------
    label : str
        The model in words.
    integrator : str
        The method of integration.
    settings : dict
        The model's and the integrator's settings.
    status : Status
        The end of the run; `converged`: it reached its end.
    message : str
        Remarks on the run, "" without any.
    time : ndarray, (n,) [s]
        Times of the samples.
    probes : dict of str to ndarray, (n, 3) [m]
        Displacement of each probe by name.
    energies : dict of str to ndarray, (n,) [J]
        Kinetic, elastic, potential (of constant dead loads) and dissipated energy, and the work of all other
        loads, of moving supports and of commands; empty if a program does not report them.
    reactions : dict of str to ndarray, (n, 3) [N]
        Forces of the supports on the sheet, by the names of a `Solution`.
    actuators : dict of str to ndarray, (n, segments, 6) [N, N·m]
        Force of each segment on the sheet, and its moment about the segment's middle.
    steps : int
        Number of steps of the integrator.
    setup_seconds, solve_seconds : float [s]
        Time for the set-up and for the run.
    resumed_from : float [s], optional
        Time at which the run resumed an earlier one.
    extra : dict, optional
        Frames and other data that a caller requested.
    """

    file_name = "history"
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
        """Return kinetic + elastic + potential + dissipated − work, (n,) [J]: constant in an exact run. It is
        nan if the program does not report energies."""
        e = self.energies or dict.fromkeys(ENERGIES, np.full(len(self.time), np.nan))
        return np.asarray(e["kinetic"] + e["elastic"] + e["potential"] + e["dissipated"] - e["work"])

    @property
    def numerical(self) -> np.ndarray:
        """Return the energy (n,) [J] that the integrator has dissipated: the fall of the balance."""
        return self.balance[:1].sum() - self.balance

    @property
    def accounts(self) -> dict[str, np.ndarray]:
        """Return the energies by name, with the integrator's numerical dissipation; empty if none were
        recorded."""
        return {**self.energies, "numerical": self.numerical} if self.energies else {}

    def gradient(self, *_: Any, **__: Any) -> None:
        """Raise BadInput: a motion has no adjoint derivatives."""
        raise BadInput(
            "gradient: a motion has no adjoint in time; lumped.simulate(..., sensitivities=['young']) has "
            "derivatives by up to 20 parameters"
        )

    def heading(self) -> tuple[str, str, str]:
        return f"History of {self.label}, {self.integrator}", f"{self.status}", f"{self.steps} steps"

    def document(self) -> dict[str, Any]:
        own = {one.name: getattr(self, one.name) for one in fields(History) if one.name != "extra"}
        return {**own, "energy": self.balance, "status": str(self.status), "energies": self.accounts}

    def tables(self) -> tuple[Table, ...]:
        """Return a table with a row per probe: its last displacement and its largest component."""
        moved = [(name, u) for name, u in self.probes.items() if len(u)]
        rows = [ExcursionRow(name, *u[-1].tolist(), *[np.abs(u).max()]) for name, u in moved]
        end = self.time[-1] if len(self.time) else 0.0
        caption = f"Displacement at {end:g} s, and its largest component during the motion"
        return (Table.of(ExcursionRow, rows, caption, "probes"),)

    def figures(self) -> tuple[Picture, ...]:
        return (Picture("history", "sheetbench.answers.history_figure:compose", (self, self.label)),)

    def files(self) -> dict[str, Write]:
        """Return writers of CSV files: all samples, and the probes' in rows for `identify --measured`."""
        columns = (Column("time", "s"), Column("probe"), *(Column(name, "m") for name in COMPONENTS))
        rows = tuple(
            (time, name, *u)
            for name, of in self.probes.items()
            for time, u in zip(self.time.tolist(), of.tolist(), strict=True)
        )
        tables = {"history.csv": self.series(), "displacements.csv": Table("Displacements", columns, rows)}
        return {name: partial(write_text, text=table.to_csv()) for name, table in tables.items()}

    def notes(self) -> list[str]:
        """Return sentences on a resumed run, the choice of integrator, the stable step and the energy."""
        notes = []
        if self.resumed_from:
            notes.append(f"went on from {self.resumed_from:.4g} s, which an earlier run had reached")
        if why := self.settings.get("integrator_reason"):
            notes.append(f"integrator {self.integrator}: {why}")
        if limit := self.settings.get("largest_step"):
            taken = number(1e3 * self.settings["step"], ".4g")
            notes.append(f"steps of {taken} ms; the largest stable one is {number(1e3 * limit, '.4g')} ms")
        if not self.energies or not len(self.time):
            return notes
        if self.energies["kinetic"].any() and not self.energies["dissipated"].any():
            notes.append(UNDAMPED)
        spread = float(abs(self.numerical).max())
        scale = max(float(abs(energy).max()) for energy in self.energies.values())
        held = number(spread / scale if scale else spread, ".1e")
        return [*notes, f"energy balance closes to {held} of the largest energy"]

    def choices(self) -> dict[str, Any]:
        return {"integrator": self.integrator, **self.settings}

    def complaints(self) -> list[str]:
        return [] if self.succeeded else [f"{self.status}: {self.message}"]

    @property
    def succeeded(self) -> bool:
        """Return whether the run reached its end."""
        return self.status is Status.CONVERGED

    def series(self) -> Table:
        """Return a row per sample: time, probes, energies, reactions, forces and moments of every segment."""
        energies = {**self.accounts, "balance": self.balance} if self.energies else {}
        series = [("time", "s", self.time)]
        for name, u in self.probes.items():
            series += _parts(name, "u", "m", u)
        series += [(name, "J", energy) for name, energy in energies.items()]
        for name, force in self.reactions.items():
            series += _parts(name, "F", "N", force)
        for name, wrench in self.actuators.items():
            for i, values in enumerate(wrench.swapaxes(0, 1)):
                segment = f"{name}.{i}"
                series += [*_parts(segment, "F", "N", values[:, :3])]
                series += [*_parts(segment, "M", "N·m", values[:, 3:])]
        columns = tuple(Column(name, unit) for name, unit, _ in series)
        rows = zip(*(values.tolist() for *_, values in series), strict=True)
        return Table("History", columns, tuple(rows))

    def to_pandas(self, table: str = "") -> pandas.DataFrame:
        """Return all samples in SI units, or the table of a name. Raises BadInput for an unknown name."""
        return super().to_pandas(table) if table else self.series().to_pandas()

    def to_xarray(self) -> xarray.Dataset:
        """Return displacement [m] by probe, time and axis, energies [J] and reactions [N] by time. Raises
        BadInput if xarray is not installed."""
        try:
            import xarray
        except ModuleNotFoundError:
            raise BadInput("to_xarray needs xarray: pip install xarray") from None
        moved = np.stack([*self.probes.values()]) if self.probes else np.empty((0, len(self.time), 3))
        axes = ("time", "axis")
        forces = {f"reaction {name}": (axes, f, {"units": "N"}) for name, f in self.reactions.items()}
        energies = {name: ("time", energy, {"units": "J"}) for name, energy in self.accounts.items()}
        return xarray.Dataset(
            {"displacement": (("probe", *axes), moved, {"units": "m"}), **energies, **forces},
            {"time": ("time", self.time, {"units": "s"}), "probe": [*self.probes], "axis": [*"xyz"]},
            {"label": self.label, "integrator": self.integrator, "status": str(self.status)},
        )


def _parts(name: str, letter: str, unit: str, values: np.ndarray) -> list[tuple[str, str, np.ndarray]]:
    """Return name, unit and samples (n,) of each component of vectors (n, 3)."""
    return [(f"{name}.{letter}{axis}", unit, of) for axis, of in zip("xyz", values.T, strict=True)]
