"""Free vibration of a clamped silicone block with three loads: one damper or branches, E and loss factor of
each run.

Data: Dubied et al. 2022 (arXiv 2201.12560), srl-ethz/diffPD_sim2real, MIT: C3D files of 100 Hz. The tip is
the mean of the first three markers, the base the mean of the others. A damped cosine through 2.5 s of a run
has its frequency, damping ratio and drop. The shell (2 × 1 elements) has E and loss factor set once, at the
lightest load, or by `identify` from the first PERIODS of each run; the load is a rigid rod on the tip's edge.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, NamedTuple

import numpy as np
from scipy.optimize import curve_fit

import fem_reference
from comparisons.identification.answer import Identification
from comparisons.identification.identification import identify
from comparisons.identification.measurements import Displacements
from comparisons.identification.point_files import read_markers
from sheetbench.answers.solution import Status
from sheetbench.answers.table import Column
from sheetbench.scenes import Chain, Clamped, Gravity, Material, Scene, Sheet


class Load(NamedTuple):
    """Load of the block: its name in the files, mass [kg] and approximate frequency [Hz]."""

    name: str
    mass: float
    frequency: float


RUNS = {
    "no load": Load("gravity", 0.0, 7.7),
    "52 g": Load("load52", 0.052, 4.0),
    "101 g": Load("load101", 0.101, 3.3),
}
RATE, THROUGH, PERIODS = 100.0, 250, 4.0  # 1/s; samples of a cosine, periods of a picture and of identify
YOUNG, LOSS, SET_AT, BAND = 296e3, 0.100, 7.75, (3.0, 8.0)  # Pa, –, Hz, Hz
POISSON, DENSITY, STEPS = 0.49, 1070.0, 60.0  # –, kg/m³, of a period of SET_AT
ELEMENTS, TIP = (2, 1), (0.1, 0.015)
DAMPERS = ("one damper", "branches")


@dataclass(frozen=True)
class Swing:
    """Damped cosine through a tip's motion."""

    load: str
    what: str
    frequency: Annotated[float, Column("frequency", "Hz", "Hz", 1.0, ".2f")]
    damping: Annotated[float, Column("damping ratio", form=".3f")]
    drop: Annotated[float, Column("drop", "m", "mm", 1e3, ".1f")]


@dataclass(frozen=True)
class Fitted:
    """E and loss factor of a run; the tip's residual with both, and with the settings of the lightest
    load."""

    load: str
    run: str
    young: Annotated[float, Column("E", "Pa", "kPa", 1e-3, ".1f")]
    young_from: Annotated[float, Column("from", "Pa", "kPa", 1e-3, ".1f")]
    young_to: Annotated[float, Column("to", "Pa", "kPa", 1e-3, ".1f")]
    loss: Annotated[float, Column("loss factor", form=".3f")]
    loss_from: Annotated[float, Column("from", form=".3f")]
    loss_to: Annotated[float, Column("to", form=".3f")]
    left: Annotated[float, Column("rms: fitted", "m", "mm", 1e3, ".2f")]
    one_damper: Annotated[float, Column("one damper", "m", "mm", 1e3, ".2f")]
    branches: Annotated[float, Column("branches", "m", "mm", 1e3, ".2f")]


@dataclass(frozen=True)
class Curve:
    """Tip over time, (n,) each [s], [m]."""

    load: str
    what: str
    time: np.ndarray
    tip: np.ndarray


@dataclass(frozen=True)
class Block:
    """Measured and computed motions of the block."""

    swings: tuple[Swing, ...]
    fits: tuple[Fitted, ...]
    curves: tuple[Curve, ...]


def cosine(
    time: np.ndarray, end: float, size: float, damping: float, omega: float, phase: float
) -> np.ndarray:
    """Return end + size e^(−ζωt) cos(ωt + phase)."""
    return end + size * np.exp(-damping * omega * time) * np.cos(omega * time + phase)


def measured(file: Path, first: float) -> tuple[Swing, np.ndarray, np.ndarray]:
    """Return the swing of a run, and from the release on its times [s] and tip's displacements [m]. first:
    approximate frequency [Hz]."""
    along = read_markers(file).position[:, :, 0]
    tip = np.nanmean(along[:3], axis=0) - np.nanmean(along[3:], axis=0)
    moves = int(np.argmax(np.abs(tip - tip[:20].mean()) > 4e-3))
    held_tip, end = tip[moves - 12 : moves - 6].mean(), tip[-100:].mean()
    time = np.arange(len(tip)) / RATE
    fitted_part = slice(moves, moves + THROUGH)

    def swinging(at: np.ndarray, size: float, damping: float, omega: float, phase: float) -> np.ndarray:
        return cosine(at, end, size, damping, omega, phase)

    start = (held_tip - end, 0.06, 2 * np.pi * first, 0.3)
    size, damping, omega, phase = curve_fit(
        swinging, time[fitted_part] - time[moves], tip[fitted_part], start, maxfev=20000
    )[0]
    if size * (held_tip - end) < 0.0:
        phase += np.pi
    let_go = time[moves] - ((phase + np.pi) % (2 * np.pi) - np.pi) / omega
    frequency = omega / (2 * np.pi)
    shown = (time > let_go) & (time < let_go + PERIODS / frequency)
    swing = Swing("", "measured", frequency, damping, abs(held_tip - end))
    return swing, time[shown] - let_go, (tip[shown] - held_tip) * np.sign(held_tip - end)


def block(mass: float, material: Material) -> Scene:
    """Return the block under its own weight and the weight of a load [kg]."""
    line = mass / 0.03
    rods = [Chain("x1", segments=1, bending_stiffness=1.0, line_density=line, radius=1e-3)] if mass else []
    return Scene(
        "beam",
        Sheet(0.1, 0.03, 0.03),
        material,
        Gravity((0, 0, -9.81)),
        (Clamped("x0"),),
        actuators=tuple(rods),
        probes={"tip": TIP},
    )


def identified(mass: float, swing: Swing, time: np.ndarray, tip: np.ndarray) -> Identification:
    """Return E and loss factor, of one damper at the run's frequency, of the shell nearest to the run."""
    material = Material(YOUNG, POISSON, DENSITY, loss_factor=2.0 * swing.damping, frequency=swing.frequency)
    moved = np.full((len(time), 3), np.nan)
    moved[:, 2] = tip
    run = Displacements(np.tile(TIP, (len(time), 1)), moved, time)
    answer = identify(block(mass, material), run, ["young", "loss_factor"], model="shell", elements=ELEMENTS)
    assert isinstance(answer, Identification)
    return answer


def computed(mass: float, what: str, end: float) -> tuple[Swing, np.ndarray, np.ndarray]:
    """Return the shell's swing under a load [kg], its times and tip's displacements."""
    material = Material(YOUNG, POISSON, DENSITY, loss_factor=LOSS, frequency=SET_AT)
    if what == "branches":
        branches = Material(YOUNG, POISSON, DENSITY, loss_factor=LOSS, band=BAND).branches
        young = YOUNG / float(branches.storage_and_loss(SET_AT)[0])  # equal stiffness at SET_AT
        material = Material(young, POISSON, DENSITY, loss_factor=LOSS, band=BAND)
    step = 1.0 / (STEPS * SET_AT)
    history = fem_reference.simulate(
        block(mass, material), "shell", end, elements=ELEMENTS, step=step, every=step
    )
    if history.status is not Status.CONVERGED:
        raise ArithmeticError(f"{what}, {mass:g} kg: {history.status}: {history.message}")
    tip = history.probes["tip"][:, 2]
    rest = float(tip[-50:].mean())
    guess = (rest, -rest, 0.05, 2 * np.pi * SET_AT / (1.0 + 12.0 * mass), 0.0)
    fit = curve_fit(cosine, history.time, tip, guess, maxfev=20000)[0]
    return Swing("", what, fit[3] / (2 * np.pi), abs(fit[2]), -fit[0]), history.time, tip


def beam(data: Path, progress: Callable[[str], None]) -> Block:
    """Return all runs, the values fitted to each, and the curves of each load's first run. Raises BadInput
    for a missing file."""
    swings: list[Swing] = []
    fits: list[Fitted] = []
    curves: list[Curve] = []
    for load, (name, mass, first) in RUNS.items():
        runs = {run: measured(data / "silicone-beam" / f"beam_{name}_V2_{run}.c3d", first) for run in "ab"}
        end = max(float(time[-1]) for _, time, _ in runs.values())
        progress(f"{load}: one damper, branches")
        shells = {what: computed(mass, what, end) for what in DAMPERS}
        for run, (swing, time, tip) in runs.items():
            progress(f"{load}: run {run}, E and loss factor")
            swings.append(replace(swing, load=load, what=f"measured {run}"))
            identification = identified(mass, swing, time, tip)
            values = [(u.value, *(u.interval or (np.nan, np.nan))) for u in identification.unknowns.values()]
            off = [
                rms(np.interp(time, shell_time, shell_tip) - tip)
                for _, shell_time, shell_tip in shells.values()
            ]
            residual = identification.residuals[:, 2]
            fits.append(Fitted(load, run, *values[0], *values[1], rms(residual), *off))
            if run == "a":
                curves += [
                    Curve(load, "measured", time, tip),
                    Curve(load, "fitted to it", time, tip + residual),
                ]
        for what, (swing, time, tip) in shells.items():
            swings.append(replace(swing, load=load))
            curves.append(Curve(load, what, time, tip))
    return Block(tuple(swings), tuple(fits), tuple(curves))


def rms(of: np.ndarray) -> float:
    """Return the root of the mean square."""
    return float(np.sqrt(np.mean(of**2)))
