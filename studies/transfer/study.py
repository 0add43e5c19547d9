"""Do springs calibrated on some scenes serve others? Methods × scenes → error, as the grid is refined.

    error         largest |component of (u − u_shell)| over 5 × 5 points of the sheet, divided by the largest
                  |component of u_shell| there
    extrapolated  the error of Richardson's limit u + (u − u')/3 of the two finest grids, the coarser with
                  cells twice as large (u')
    predicted     the error of the shell whose membrane, bending and shear stiffness are those
                  the moduli report gives: of the finest grid, and of cells → 0
    miss          of a natural frequency: f/f_shell − 1

Cross-layer links stiffen the membrane the less, the smaller the cells are beside the layer distance, so that
a lattice which is not calibrated for its grid is another plate on every grid. What is predicted from its
moduli on a grid is to be held against the error there; 33 masses a side may be far from cells → 0.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Unpack

import numpy as np

from comparisons.comparison.comparison import error
from comparisons.models.resolve import resolve, resolve_each
from comparisons.models.sizes import require_room
from comparisons.models.spec import Elements, GradingLike, Lattice, lattices
from comparisons.runs.campaign import CampaignKeywords, Run, carry_out
from comparisons.runs.store import Finished, Store
from sheetbench.answers.answer import Answer
from sheetbench.answers.table import Table
from sheetbench.choices import AUTO, CALIBRATIONS
from sheetbench.scenes import Scene, comparable
from studies.transfer import tables
from studies.transfer.scenes import HELD_OUT, LINEAR, MODAL, TRAINING, transfer_scenes
from studies.transfer.tasks import FINE

# `consistent` has their moduli
OTHERS = (
    *(f"consistent-{name}" for name in ("interior", "membrane", "oblique")),
    "neo-hookean",
    "hyperelastic",
)
METHODS = tuple(name for name in CALIBRATIONS if name not in OTHERS)
FITTED = tuple(name for name in METHODS if CALIBRATIONS[name].fitted)
PARTS = ("static", "limits", "modal", "aspect", "left-out")
GRIDS = (9, 17, 33)
MASSES = ("tributary", "gregory", "higher-order")
LONG = ((9, 9), (9, 13), (9, 17), (9, 25), (25, 9))  # of `moduli` on the training scenes
LONG_EVERYWHERE = ((17, 17), (17, 25), (17, 33), (17, 49), (49, 17))  # on every scene
LIMITS = (*TRAINING, *LINEAR)


@dataclass(frozen=True, repr=False)
class Transfer(Answer):
    """The study's rows by part; `failed`: a sentence for every run without an answer."""

    file_name = "transfer"

    methods: tuple[str, ...]
    grids: tuple[int, ...]
    elements: int
    static: list[dict[str, Any]] = field(default_factory=list)
    limits: list[dict[str, Any]] = field(default_factory=list)
    modal: list[dict[str, Any]] = field(default_factory=list)
    aspect: list[dict[str, Any]] = field(default_factory=list)
    left_out: list[dict[str, Any]] = field(default_factory=list)
    failed: list[str] = field(default_factory=list)

    def heading(self) -> tuple[str, str, str]:
        return "transfer", "calibrations judged on scenes that they were not made on", ""

    def document(self) -> dict[str, Any]:
        return dict(vars(self))  # errors and misses are fractions

    def tables(self) -> list[Table]:
        return tables.tables(self)

    def notes(self) -> tuple[str, ...]:
        return (tables.explanation(self),)

    def complaints(self) -> list[str]:
        return self.failed

    def choices(self) -> dict[str, Any]:
        return {"methods": self.methods, "grids": self.grids, "elements": self.elements}

    @property
    def succeeded(self) -> bool:
        return not self.failed


def transfer(
    store: Store,
    *,
    methods: Sequence[str] = METHODS,
    grids: Sequence[int] = GRIDS,
    grading: GradingLike = None,
    scenes: Sequence[str] | None = None,
    parts: Sequence[str] = PARTS,
    elements: int = 24,
    large: bool = False,
    **how: Unpack[CampaignKeywords],
) -> Transfer:
    """Carry out the parts asked for, through a campaign's store, and put their rows together.

    methods: names of calibrations; grids: masses a side, 4 n + 1, coarsest first; grading: in
    the part "static", of the methods that take one, a number or "auto"; scenes: names of
    `transfer_scenes`, all of them unless given; elements: of the shell, along a side.
    Raises BadInput, before the first run, unless `large` for what takes more memory than there is.
    """
    chosen = {name: scene for name, scene in transfer_scenes().items() if scenes is None or name in scenes}
    for scene in () if large else chosen.values():
        require_room(scene, Lattice((max(grids), max(grids))), "--grids")
        require_room(scene, Elements("shell", elements))
    study = _Study(chosen, tuple(methods), tuple(grids), elements, grading)
    study.plan(parts)
    done = carry_out(study.runs, store, **how)
    study.outcomes = dict(zip((run.key for run in study.runs), done, strict=True))
    result = Transfer(study.methods, study.grids, elements)
    for part in parts:
        getattr(result, part.replace("-", "_")).extend(getattr(study, part.replace("-", "_"))())
    result.failed.extend(study.failures())
    return result


class _Study:
    """The runs asked for, and rows from their outcomes. What is asked before there are any is planned."""

    def __init__(
        self,
        scenes: dict[str, Scene],
        methods: tuple[str, ...],
        grids: tuple[int, ...],
        elements: int,
        grading: GradingLike = None,
    ) -> None:
        self.grading = grading
        self.scenes, self.methods, self.grids, self.elements = scenes, methods, grids, elements
        self.texts = {name: scene.document() for name, scene in scenes.items()}
        self.planned: dict[str, Run] = {}
        self.outcomes: dict[str, Finished] | None = None

    @property
    def runs(self) -> list[Run]:
        return list(self.planned.values())

    def plan(self, parts: Sequence[str]) -> None:
        """Note every run that the parts ask for."""
        for part in parts:
            list(getattr(self, part.replace("-", "_"))())

    def static(self) -> Iterator[dict[str, Any]]:
        for name in self.scenes:
            truth = self._reference(name)
            gradings, reasons = self.gradings(name)
            for method in self.methods:
                grids = list(zip(self.grids, gradings[method], strict=True))
                fields = [self._lattice(name, method, (n, n), grading=g) for n, g in grids]
                chosen = {"gradings": gradings[method], "reasons": list(reasons)}
                taken = {"calibration": self._method(name, method)} if method == AUTO else {}
                yield {
                    "scene": name,
                    "method": method,
                    **({} if self.grading is None else chosen),
                    **taken,
                    "trained_on": method in FITTED and name in TRAINING,
                    "errors": [_error(u, truth) for u in fields],
                    "extrapolated": _error(_richardson(fields), truth),
                }

    def gradings(self, name: str) -> tuple[dict[str, list[float | str]], tuple[str, ...]]:
        """Of the scene's lattices by method, one a grid, and the reasons where they were chosen."""
        every = lattices(self.scenes[name], [(n, n) for n in self.grids], self.methods)
        chosen, reasons = resolve_each(self.scenes[name], every, self.grading)
        values = [candidate.settings.get("grading", 0.0) for candidate in chosen]
        count = len(self.grids)
        return {m: values[i * count : (i + 1) * count] for i, m in enumerate(self.methods)}, reasons

    def limits(self) -> Iterator[dict[str, Any]]:
        for name in (name for name in self.scenes if name in LIMITS):
            truth = self._reference(name)
            for method in (m for m in self.methods if m not in FITTED):
                fields = [self._lattice(name, method, (n, n)) for n in self.grids]
                finest = self._homogenised(name, method, self.grids[-1])
                limit = self._homogenised(name, method, FINE)
                yield {
                    "scene": name,
                    "method": method,
                    "finest": _error(fields[-1], truth),
                    "predicted_finest": _error(finest, truth),
                    "extrapolated": _error(_richardson(fields), truth),
                    "predicted_limit": _error(limit, truth),
                    "lattice_less_plate": _error(fields[-1], finest),
                }

    def modal(self) -> Iterator[dict[str, Any]]:
        for name in (name for name in self.scenes if name in MODAL):
            truth = self._reference_frequencies(name)
            for method in self.methods:
                for masses in MASSES:
                    frequencies = [self._frequencies(name, method, (n, n), masses) for n in self.grids]
                    yield {
                        "scene": name,
                        "method": method,
                        "masses": masses,
                        "misses": [_misses(f, truth) for f in frequencies],
                    }

    def aspect(self) -> Iterator[dict[str, Any]]:
        for name in self.scenes:
            for grid in (*(LONG if name in TRAINING else ()), *LONG_EVERYWHERE):
                u = self._lattice(name, "moduli", grid)
                ratio = (max(grid) - 1) / (min(grid) - 1)
                yield {
                    "scene": name,
                    "grid": list(grid),
                    "aspect": ratio,
                    "error": _error(u, self._reference(name)),
                }

    def left_out(self) -> Iterator[dict[str, Any]]:
        n = self.grids[0]
        held_out = [name for name in self.scenes if name in HELD_OUT]
        for method in (m for m in self.methods if m in FITTED):
            for name in held_out:
                if not (training := [other for other in held_out if other != name]):
                    continue
                u = self._lattice(name, method, (n, n), training)
                f = self._frequencies(name, method, (n, n), _own_masses(method), training)
                truth = self._reference_frequencies(name)
                yield {
                    "method": method,
                    "left_out": name,
                    "grid": n,
                    "error": _error(u, self._reference(name)),
                    "misses": _misses(f, truth),
                }

    def failures(self) -> list[str]:
        """Runs that ended without an answer."""
        assert self.outcomes is not None
        return [
            f"{run.label}: {done.status}: {done.message}"
            for run in self.runs
            if not _answered(done := self.outcomes[run.key])
        ]

    def _method(self, name: str, method: str) -> str:
        """The calibration of a scene's lattices, "auto" as it has it."""
        return resolve(self.scenes[name], Lattice(calibration=method)).spec.calibration or method

    def _lattice(
        self,
        name: str,
        method: str,
        grid: tuple[int, int],
        training: list[str] | None = None,
        grading: float | str = 0.0,
    ) -> np.ndarray | None:
        method = self._method(name, method)
        arguments: dict[str, Any] = {"scene": self.texts[name], "method": method, "grid": [*grid, 2]}
        arguments |= {"grading": grading} if grading else {}
        if training is not None:
            arguments["training"] = [self.texts[other] for other in training]
        return self._ask("lattice", arguments, f"{name} {method} {grid[0]}×{grid[1]}", "displacement")

    def _reference(self, name: str) -> np.ndarray | None:
        arguments = {"scene": self.texts[name], "model": "shell", "elements": self.elements}
        return self._ask("reference", arguments, f"{name} shell", "displacement")

    def _homogenised(self, name: str, method: str, n: int) -> np.ndarray | None:
        arguments = {
            "scene": self.texts[name],
            "model": "shell",
            "elements": self.elements,
            "method": self._method(name, method),
            "grid": [n, n, 2],
        }
        return self._ask("homogenised", arguments, f"{name} {method} homogenised {n}", "displacement")

    def _frequencies(
        self, name: str, method: str, grid: tuple[int, int], masses: str, training: list[str] | None = None
    ) -> np.ndarray | None:
        arguments: dict[str, Any] = {
            "scene": self.texts[name],
            "method": self._method(name, method),
            "grid": [*grid, 2],
            "masses": masses,
        }
        if training is not None:
            arguments["training"] = [self.texts[other] for other in training]
        label = f"{name} {method} {grid[0]}×{grid[1]} {masses} frequencies"
        return self._ask("lattice_frequencies", arguments, label, "frequencies")

    def _reference_frequencies(self, name: str) -> np.ndarray | None:
        arguments = {"scene": self.texts[name], "elements": self.elements}
        return self._ask("reference_frequencies", arguments, f"{name} shell frequencies", "frequencies")

    def _ask(self, task: str, arguments: dict[str, Any], label: str, key: str) -> np.ndarray | None:
        """What a run found, or None where it has no answer to the whole load; planned if not yet done."""
        run = Run(f"studies.transfer.tasks:{task}", arguments, label)
        self.planned.setdefault(run.key, run)
        if self.outcomes is None:
            return None
        done = self.outcomes[run.key]
        return np.array(done.row[key], dtype=float) if _answered(done) else None


def _answered(done: Finished) -> bool:
    """Whether a run ended with what may be used: what it was to do done, or an answer to compare."""
    return done.status == "done" or comparable(done.status, done.row.get("load_factor", 1.0))


def _own_masses(method: str) -> str:
    return "gregory" if method == "fit-modal" else "tributary"


def _error(u: np.ndarray | None, truth: np.ndarray | None) -> float | None:
    return None if u is None or truth is None else error(u, truth)


def _misses(f: np.ndarray | None, truth: np.ndarray | None) -> np.ndarray | None:
    return None if f is None or truth is None else f / truth - 1.0


def _richardson(fields: Sequence[np.ndarray | None]) -> np.ndarray | None:
    """The limit of the two finest fields, the coarser on cells twice as large, if the error falls as h²."""
    if len(fields) < 2 or fields[-1] is None or fields[-2] is None:
        return None
    limit: np.ndarray = fields[-1] + (fields[-1] - fields[-2]) / 3.0
    return limit
