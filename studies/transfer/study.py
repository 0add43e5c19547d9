"""Errors of calibrations on scenes that they were not made for: methods × scenes, as the grid is refined.

    error         largest |component of (u − u_shell)| over 5 × 5 points of the sheet, divided by the largest
                  |component of u_shell| there
    extrapolated  the error of Richardson's limit u + (u − u')/3 of the two finest grids, the coarser with
                  cells twice as large (u')
    predicted     the error of the shell with the membrane, bending and shear stiffness of the moduli report,
                  for the finest grid and for cells → 0
    miss          of a natural frequency: f/f_shell − 1

Cross-layer links stiffen the membrane the less, the smaller the cells are beside the layer distance, so that
a lattice that is not calibrated for its grid is another plate on every grid. A prediction from its
moduli on a grid is compared with the error on that grid; 33 masses a side may be far from cells → 0.
"""

from collections.abc import Iterator, Sequence
from typing import Any, Unpack

import numpy as np

from comparisons.models.resolve import resolve, resolve_each
from comparisons.models.sizes import require_room
from comparisons.models.spec import Elements, GradingLike, Lattice, Spec, lattices
from comparisons.sweep.campaign import CampaignKeywords, Run, carry_out
from comparisons.sweep.differences import error
from comparisons.sweep.solved import Request
from comparisons.sweep.store import Finished, Store
from sheetbench.answers.solution import comparable
from sheetbench.choices import AUTO, CALIBRATIONS
from sheetbench.scenes import Scene
from studies.transfer.answer import Transfer
from studies.transfer.drawn_scenes import drawn_sheets
from studies.transfer.scenes import HELD_OUT, LINEAR, MODAL, TRAINING, transfer_scenes
from studies.transfer.tasks import FINEST, points

# not run: `consistent` has their moduli
OTHERS = (
    *(f"consistent-{name}" for name in ("interior", "membrane", "oblique")),
    "neo-hookean",
    "hyperelastic",
)
METHODS = tuple(name for name in CALIBRATIONS if name not in OTHERS)
FITTED = tuple(name for name in METHODS if CALIBRATIONS[name].fitted)
PARTS = ("static", "limits", "modal", "aspect", "left-out", "drawn")
GRIDS = (9, 17, 33)
DISTRIBUTIONS = ("tributary", "gregory", "higher-order")
LONG = ((9, 9), (9, 13), (9, 17), (9, 25), (25, 9))  # grids of `moduli` on the training scenes
LONG_EVERYWHERE = ((17, 17), (17, 25), (17, 33), (17, 49), (49, 17))  # grids of `moduli` on every scene
LIMITS = (*TRAINING, *LINEAR)


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
    """Carry out the requested parts through a campaign's store, and return their rows. methods: names of
    calibrations; grids: masses a side, 4 n + 1, coarsest first; grading: in the part "static", of the methods
    that take one, a number or "auto"; scenes: names of `transfer_scenes`, by default all; elements: of the
    shell, along a side. Raises BadInput, before the first run, for a grid or mesh that takes more memory than
    there is, unless `large`."""
    scenes_by_name = {
        name: scene for name, scene in transfer_scenes().items() if scenes is None or name in scenes
    }
    for scene in () if large else scenes_by_name.values():
        require_room(scene, Lattice((max(grids), max(grids))), "--grids")
        require_room(scene, Elements("shell", elements))
    study = _Study(scenes_by_name, tuple(methods), tuple(grids), elements, grading)
    study.rows(parts)
    done = carry_out(study.runs, store, **how)
    study.outcomes = dict(zip((run.key for run in study.runs), done, strict=True))
    failed = [
        f"{run.label}: {end.status}: {end.message}"
        for run, end in zip(study.runs, done, strict=True)
        if not _answered(end)
    ]
    return Transfer(study.methods, study.grids, elements, **study.rows(parts), failed=failed)


class _Study:
    """Runs that the parts need, and rows from their outcomes."""

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
        self.probed = {name: scene.replace(probes=_probes(scene)) for name, scene in scenes.items()}
        self.planned: dict[str, Run] = {}
        self.outcomes: dict[str, Finished] | None = None

    @property
    def runs(self) -> list[Run]:
        return list(self.planned.values())

    def rows(self, parts: Sequence[str]) -> dict[str, list[dict[str, Any]]]:
        """Return the rows by part; before there are outcomes, note every run that they need."""
        names = [part.replace("-", "_") for part in parts]
        return {name: list(getattr(self, name)()) for name in names}

    def static(self) -> Iterator[dict[str, Any]]:
        for name in self.scenes:
            truth = self._reference(name)
            gradings, reasons = self.gradings(name)
            for method in self.methods:
                grids = list(zip(self.grids, gradings[method], strict=True))
                fields = [self._lattice(name, method, (n, n), grading=g) for n, g in grids]
                grading_fields = {"gradings": gradings[method], "reasons": list(reasons)}
                resolved = {"calibration": self._method(name, method)} if method == AUTO else {}
                yield {
                    "scene": name,
                    "method": method,
                    **({} if self.grading is None else grading_fields),
                    **resolved,
                    "trained_on": method in FITTED and name in TRAINING,
                    "errors": [_error(u, truth) for u in fields],
                    "extrapolated": _error(_richardson(fields), truth),
                }

    def gradings(self, name: str) -> tuple[dict[str, list[float | str]], tuple[str, ...]]:
        """Return the gradings of the scene's lattices by method, one a grid, and the reasons."""
        specs = lattices(self.scenes[name], [(n, n) for n in self.grids], self.methods)
        chosen, reasons = resolve_each(self.scenes[name], specs, self.grading)
        values = [candidate.settings.get("grading", 0.0) for candidate in chosen]
        count = len(self.grids)
        return {m: values[i * count : (i + 1) * count] for i, m in enumerate(self.methods)}, reasons

    def limits(self) -> Iterator[dict[str, Any]]:
        n = self.grids[-1]
        for name in (name for name in self.scenes if name in LIMITS):
            truth = self._reference(name)
            for method in (m for m in self.methods if m not in FITTED):
                fields = [self._lattice(name, method, (n, n)) for n in self.grids]
                finest = self._lattice(name, method, (n, n), "homogenised", elements=self.elements)
                limit = self._lattice(name, method, (FINEST, FINEST), "homogenised", elements=self.elements)
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
            truth = self._reference(name, "reference_frequencies")
            for method in self.methods:
                for masses in DISTRIBUTIONS:
                    frequencies = [
                        self._lattice(name, method, (n, n), "lattice_frequencies", masses=masses)
                        for n in self.grids
                    ]
                    yield {
                        "scene": name,
                        "method": method,
                        "masses": masses,
                        "misses": [_misses(f, truth) for f in frequencies],
                    }

    def aspect(self) -> Iterator[dict[str, Any]]:
        for name in self.scenes:
            for grid in (*(LONG if name in TRAINING else ()), *LONG_EVERYWHERE):
                error = _error(self._lattice(name, "moduli", grid), self._reference(name))
                ratio = (max(grid) - 1) / (min(grid) - 1)
                yield {"scene": name, "grid": list(grid), "aspect": ratio, "error": error}

    def left_out(self) -> Iterator[dict[str, Any]]:
        n = self.grids[0]
        held_out = [name for name in self.scenes if name in HELD_OUT]
        for method in (m for m in self.methods if m in FITTED):
            masses = "gregory" if method == "fit-modal" else "tributary"
            for name in held_out:
                if not (training := [other for other in held_out if other != name]):
                    continue
                u = self._lattice(name, method, (n, n), "fitted", training=training)
                f = self._lattice(
                    name, method, (n, n), "lattice_frequencies", training=training, masses=masses
                )
                truth = self._reference(name, "reference_frequencies")
                yield {
                    "method": method,
                    "left_out": name,
                    "grid": n,
                    "error": _error(u, self._reference(name)),
                    "misses": _misses(f, truth),
                }

    def drawn(self) -> Iterator[dict[str, Any]]:
        for scene in drawn_sheets():
            run = Run("studies.transfer.drawn:measure", {"scene": scene.document()}, f"{scene.name} drawn")
            if (done := self._done(run)) is not None:
                yield {key: done.row[key] for key in ("scene", "errors", "bar")}

    def _method(self, name: str, method: str) -> str:
        """Return the calibration of a scene's lattices; "auto" is resolved."""
        return resolve(self.scenes[name], Lattice(calibration=method)).spec.calibration or method

    def _lattice(
        self,
        name: str,
        method: str,
        grid: tuple[int, int],
        task: str = "",
        *,
        training: Sequence[str] = (),
        grading: float | str = 0.0,
        **more: Any,
    ) -> np.ndarray | None:
        """Return a task's result for a lattice; without a task, its displacement at the points. training:
        scenes of a fitted method in place of its own."""
        method = self._method(name, method)
        if not task:
            return self._field(name, Lattice((*grid, 2), method, grading=grading))
        if training:
            more["training"] = [self.texts[other] for other in training]
        label = f"{method} {grid[0]}×{grid[1]} {task}"
        return self._result_of(task, name, label, method=method, grid=[*grid, 2], **more)

    def _reference(self, name: str, task: str = "") -> np.ndarray | None:
        if not task:
            return self._field(name, Elements("shell", self.elements))
        return self._result_of(task, name, task, elements=self.elements)

    def _field(self, name: str, spec: Spec) -> np.ndarray | None:
        """Return the displacement at the points, by the table of solves."""
        done = self._done(Request(self.probed[name], spec, label=f"{name} {spec.label}").task)
        return None if done is None else np.array([*done.row["probes"].values()])

    def _result_of(self, task: str, name: str, label: str, **arguments: Any) -> np.ndarray | None:
        """Return a run's result, or None where it has no answer to the whole load or is not done yet."""
        arguments["scene"] = self.texts[name]
        done = self._done(Run(f"studies.transfer.tasks:{task}", arguments, f"{name} {label}"))
        return None if done is None else np.array(done.row["found"], dtype=float)

    def _done(self, run: Run) -> Finished | None:
        """Note a run and return its outcome, None without an answer to the whole load, or before it."""
        self.planned.setdefault(run.key, run)
        done = None if self.outcomes is None else self.outcomes[run.key]
        return done if done is not None and _answered(done) else None


def _probes(scene: Scene) -> dict[str, list[float]]:
    return {f"p{i}": place for i, place in enumerate(points(scene.sheet).tolist())}


def _answered(done: Finished) -> bool:
    """Return whether a run ended with a usable result: a task done, or an answer to compare."""
    return done.status == "done" or comparable(done.status, done.row.get("load_factor", 1.0))


def _error(u: np.ndarray | None, truth: np.ndarray | None) -> float | None:
    return None if u is None or truth is None else error(u, truth)


def _misses(f: np.ndarray | None, truth: np.ndarray | None) -> np.ndarray | None:
    return None if f is None or truth is None else f / truth - 1.0


def _richardson(fields: Sequence[np.ndarray | None]) -> np.ndarray | None:
    """Return the limit of the two finest fields, one on cells twice as large, for errors like h²."""
    if len(fields) < 2 or fields[-1] is None or fields[-2] is None:
        return None
    limit: np.ndarray = fields[-1] + (fields[-1] - fields[-2]) / 3.0
    return limit
