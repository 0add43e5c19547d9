"""Where each model of a scene holds, degrades, refuses or fails, as one thing about the sheet is varied.

load         the weight and all loads, times a factor
slenderness  the thickness, times a factor
young        Young's modulus, times a factor
grid         the cells of the lattice, the elements of the references, along the shorter side
damping      the damping time, such that the lowest mode has a share of critical damping: how runs of every
             integrator end, and the largest stable step of the explicit ones
time-step    the steps of every integrator: shares of the largest of explicit ones, else of the lowest period

At rest, an error is the one at the probes against the reference on the same sheet, on the grid study against
its finest mesh; in motion, the largest difference from a run of the midpoint rule with a fine step, over the
largest displacement.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Unpack

import numpy as np

from comparisons.comparison.comparison import error
from comparisons.models.context import large_in_context
from comparisons.models.resolve import resolve
from comparisons.models.spec import Elements, Lattice
from comparisons.motion.run import motion_run
from comparisons.runs.campaign import CampaignKeywords, Run, carry_out
from comparisons.runs.store import Finished, Store
from comparisons.stability.answer import Stability
from comparisons.stability.rows import Row
from comparisons.tradeoff.motion import explicit_limit, shortest_period
from sheetbench.choices import INTEGRATORS, REFERENCE
from sheetbench.errors import BadInput, require_choice
from sheetbench.scenes import Scene, Status
from sheetbench.scenes.layers import Layer
from sheetbench.scenes.orthotropy import MODULI
from sheetbench.scenes.parameters import put
from sheetbench.scenes.patches import Patch
from sheetbench.scenes.tables import FactorTable, Loading

FACTORS = {
    "load": (0.001, 0.01, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 1000.0),
    "slenderness": (0.03, 0.1, 0.3, 1.0, 3.0, 10.0),
    "young": (0.001, 0.01, 0.1, 1.0, 10.0, 100.0, 1000.0),
}
CELLS = {"lumped": (2, 4, 8, 16, 32), "references": (2, 4, 8)}  # along the shorter side
DAMPING = (0.0, 0.01, 0.1, 1.0, 10.0, 100.0)  # of the lowest mode's critical one
SHARES = (0.3, 0.9, 1.1)  # of the largest stable step
DIVISIONS = (200, 50, 20, 8, 4, 2, 1)  # steps a period
FINE, SAMPLES = 400, 40  # steps of the midpoint rule and samples, a period
PERIODS = 3.0  # of a run
PARTS = ("patches", "layers")
VARIED = (*FACTORS, "grid", "damping", "time-step")


@dataclass(frozen=True)
class _Cell:
    """A cell, its run, and the run of its reference; refusal: why there is no run."""

    study: str
    cell: dict[str, Any]
    run: Run | None
    truth: Run | None = None
    refusal: str = ""


@large_in_context
def stability(
    scene: Scene,
    store: Store,
    *,
    varied: Sequence[str] = VARIED,
    lattice: Lattice = Lattice(),  # noqa: B008  # frozen
    reference: str = REFERENCE,
    elements: int = 12,
    large: bool = False,
    **how: Unpack[CampaignKeywords],
) -> Stability:
    """Vary a scene's sheet and solve it by every model, through a campaign's store.

    varied: some of `VARIED`. lattice: with what is not varied. elements: of the references, along the shorter
    side. Raises BadInput for what cannot be varied, for settings that contradict each other, and unless
    `large` for models that take more memory than there is.
    """
    for name in varied:
        require_choice("vary", name, VARIED)
    resolve(scene, lattice, "motion")
    resolve(scene, Elements(reference, elements))
    maker = _Maker(scene, lattice, reference, elements)
    cells = [cell for name in VARIED if name in varied for cell in maker.cells(name)]
    runs = [run for cell in cells for run in (cell.run, cell.truth) if run is not None]
    done = carry_out(runs, store, **how)
    outcomes = {run.key: outcome for run, outcome in zip(runs, done, strict=True)}
    return Stability(scene, reference, maker.period, tuple(_row(cell, outcomes) for cell in cells))


class _Maker:
    """Makes the cells of a scene."""

    def __init__(self, scene: Scene, lattice: Lattice, reference: str, elements: int) -> None:
        self.scene, self.lattice, self.reference, self.elements = scene, lattice, reference, elements
        self.period: float | None = None

    def cells(self, name: str) -> Iterator[_Cell]:
        """Those of a study."""
        if name in FACTORS:
            yield from self._scaled(name)
        elif name == "grid":
            yield from self._grids()
        else:
            springs = resolve(self.scene, self.lattice).springs
            self.period = self.period or shortest_period(self.scene, springs)
            yield from (self._damped if name == "damping" else self._stepped)(self.period)

    def _models(self) -> dict[str, dict[str, Any]]:
        """Return the settings of every model."""
        references = dict.fromkeys(("plate", "shell", self.reference))
        return {"lumped": self.lattice.settings, **{name: {"elements": self.elements} for name in references}}

    def _static(self, scene: Scene, model: str, settings: dict[str, Any], label: str) -> Run:
        arguments = {"scene": scene.document(), "model": model, "settings": settings}
        return Run("crosscheck", arguments, f"{model} {label}")

    def _scaled(self, name: str) -> Iterator[_Cell]:
        if name == "load" and self.scene.gravity is None and not self.scene.loads:
            return
        for factor in FACTORS[name]:
            try:
                scene = scaled(self.scene, name, factor)
            except BadInput as error:
                for model in self._models():
                    yield _Cell(name, {"factor": factor, "model": model}, None, refusal=str(error))
                continue
            label = f"{name} × {factor:g}"
            truth = self._static(scene, self.reference, self._models()[self.reference], label)
            for model, settings in self._models().items():
                cell = {"factor": factor, "model": model}
                yield _Cell(name, cell, self._static(scene, model, settings, label), truth)

    def _grids(self) -> Iterator[_Cell]:
        meshes = sorted({*CELLS["references"], self.elements})
        finest = {**self._models()[self.reference], "elements": meshes[-1]}
        truth = self._static(self.scene, self.reference, finest, f"{meshes[-1]} cells")
        for model, settings in self._models().items():
            size = "grid" if model == "lumped" else "elements"
            for count in CELLS.get(model) or meshes:
                sized = {**settings, size: count + 1 if model == "lumped" else count}
                run = self._static(self.scene, model, sized, f"{count} cells")
                yield _Cell("grid", {"cells": count, "model": model}, run, truth)

    def _damped(self, period: float) -> Iterator[_Cell]:
        for ratio in (None, *DAMPING):
            scene = self.scene
            if ratio is not None:
                damping = {"damping_time": ratio * period / np.pi, "damping_rate": 0.0}
                scene = scene.replace(material=scene.material.replace(**damping))
            for name in INTEGRATORS:
                arguments = {"scene": scene.document(), "lattice": self.lattice.settings, "integrator": name}
                label = f"{name} {'own damping' if ratio is None else f'damping {ratio:g}'}"
                run = Run("stability.run", {**arguments, "period": period}, label)
                yield _Cell("damping", {"damping_ratio": ratio, "integrator": name}, run)

    def _stepped(self, period: float) -> Iterator[_Cell]:
        import lumped

        springs = resolve(self.scene, self.lattice).springs

        def run(integrator: str, step: float, duration: float) -> Run:
            every, label = max(step, period / SAMPLES), f"{integrator} {step:.3g} s"
            of = (self.scene, self.lattice, duration, every, label)
            return motion_run(*of, integrator=integrator, step=step)

        truth = run("midpoint", period / FINE, PERIODS * period)
        for name in INTEGRATORS:
            steps = [period / n for n in DIVISIONS]
            if lumped.INTEGRATORS[name].explicit:
                limit = explicit_limit(name, self.scene, springs)
                steps = [share * limit for share in SHARES]
            for step in steps:
                yield _Cell(
                    "time-step", {"integrator": name, "step": step}, run(name, step, PERIODS * period), truth
                )


def scaled(scene: Scene, name: str, factor: float) -> Scene:
    """Return the scene with its load, thickness or moduli times a factor, those of patches and layers too.
    Raises BadInput where it cannot be."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # extremes are implausible
        if name == "young":
            parts = {key: tuple(_stiffer(each, factor) for each in getattr(scene, key)) for key in PARTS}
            return put(scene, "young", factor * scene.material.young).replace(**parts)
        if name == "slenderness":
            patches = [
                patch.replace(thickness=factor * patch.thickness) if patch.thickness else patch
                for patch in scene.patches
            ]
            return put(scene, "thickness", factor * scene.sheet.thickness).replace(patches=tuple(patches))
        acting = {"loads": tuple(_times(load, factor) for load in scene.loads)}
        return scene.replace(gravity=scene.gravity and _times(scene.gravity, factor), **acting)


def _stiffer(part: Patch | Layer, factor: float) -> Patch | Layer:
    """Return a patch or a layer, its own moduli times a factor."""
    own = {key: factor * part.own[key] for key in ("young", *MODULI) if key in part.own}
    return part.replace(**own) if own else part


def _times(acting: Loading, factor: float) -> Any:
    """Return a load or gravity, times a factor."""
    table = acting.history or FactorTable(time=(0.0,), factor=(1.0,))
    return acting.replace(history=table.replace(factor=tuple(factor * sample for sample in table.factor)))


def _row(cell: _Cell, outcomes: Mapping[str, Finished]) -> Row:
    """Return a cell's row: how it ended, and its error where its reference has an answer too."""
    row: Row = {"study": cell.study, "cell": cell.cell, "error": None, "iterations": None, "seconds": None}
    if cell.run is None:
        return {**row, "status": str(Status.REFUSED), "message": cell.refusal}
    outcome = outcomes[cell.run.key]
    row |= {"status": outcome.status, "message": outcome.message, "seconds": outcome.seconds}
    kept = ("iterations", "computed", "measured", "advised")
    row |= {name: outcome.row[name] for name in kept if name in outcome.row}
    row["iterations"] = row["iterations"] or outcome.row.get("steps")
    truth = outcomes[cell.truth.key] if cell.truth is not None else None
    if truth is None or truth is outcome or any(one.status != Status.CONVERGED for one in (outcome, truth)):
        return row
    if "time" in outcome.row:
        return {**row, "error": _motion_error(outcome.row, truth.row)}
    u, known = (np.array([*one.row["probes"].values()]) for one in (outcome, truth))
    return {**row, "error": error(u, known)}


def _motion_error(row: Mapping[str, Any], truth: Mapping[str, Any]) -> float | None:
    """Return the largest difference of the probes' displacements over the largest displacement, None at
    rest."""
    largest = off = 0.0
    for name, known in truth["probes"].items():
        for axis, values in enumerate(np.array(known).T):
            expected = np.interp(row["time"], truth["time"], values)
            off = max(off, float(np.abs(np.array(row["probes"][name])[:, axis] - expected).max()))
            largest = max(largest, float(np.abs(values).max()))
    return off / largest if largest > 0.0 else None
