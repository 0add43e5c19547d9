"""A scene's motion as the lattice and as a finite-element reference have it, side by side.

The reference moves a second time on elements twice as large, and a third time with steps of about twice the
length: how far it goes then is what mesh and step leave uncertain (`uncertainty`), on the safe side, for
both errors are at least halved by the finer run.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, Unpack

import numpy as np

from comparisons.models import sizes
from comparisons.models.context import context, in_context
from comparisons.models.grids import Elements as Count
from comparisons.models.keywords import LatticeKeywords
from comparisons.models.resolve import resolve
from comparisons.models.solve import simulate
from comparisons.models.spec import Elements, Lattice
from comparisons.motion.comparison_answer import MotionComparison
from comparisons.motion.measures import difference
from comparisons.report import amounts
from comparisons.report.work import Pace, Progress, Work, silent
from sheetbench.choices import REFERENCE
from sheetbench.scenes import AnyScene, History, Scene, Status, scene_of

ELEMENTS = 8  # of a moving reference along the shorter side
LONGER = 8.0  # error of a step: steps twice as long
STEPS_PER_PERIOD = 100, 900  # of the lowest mode, with dampers of the springs and without
SOLVES = 0.08  # of a static solve's time that a step takes
EVEN = 0.02  # of the duration, until which steps grow and tell nothing of the pace


@in_context
def compare_motion(
    scene: AnyScene,
    duration: float,
    lattice: Lattice | None = None,
    reference: str | Elements = REFERENCE,
    *,
    elements: Count | None = None,
    law: str | None = None,
    uncertainty: bool = True,
    every: float | None = None,
    frames: int = 0,
    store: Path | None = None,
    large: bool = False,
    progress: Progress = silent,
    **keywords: Unpack[LatticeKeywords],
) -> MotionComparison:
    """Move a scene's sheet for `duration` [s] with the lattice and with a reference, from rest.

    elements: 8 along the shorter side unless given. uncertainty: move the reference twice more, on elements
    twice as large and with steps twice as long. every [s]: distance of samples, 1/100 of the lowest period
    unless given. frames: whole displacements to keep. store: a folder in which every run has one to stream
    to; runs that were stopped go on from there. progress: told what is being done, how large it is and how
    long it may take. Raises BadInput as `compare` and `simulate` do, and for what no reference moves.
    """
    import fem_reference

    asked = scene_of(scene)
    judge = Elements.given(reference, {"elements": elements, "law": law})
    judge = judge.but(count=ELEMENTS) if judge.count is None else judge
    resolve(asked, judge)
    model = resolve(asked, Lattice.given(lattice, keywords), "motion")
    name, along = judge.kind, tuple(sizes.along(asked, judge)[:2])

    def folder(name: str, *of: Any) -> Path | None:
        """Where a run with these settings is kept."""
        if store is None:
            return None
        text = json.dumps([asked.document(), duration, every, frames, of], sort_keys=True, default=str)
        return store / f"{name}-{hashlib.sha256(text.encode()).hexdigest()[:12]}"

    def told(doing: str, begin: Work) -> Callable[[float], None]:
        pace = Pace(duration)
        context().progress(begin)

        def reached(time: float) -> None:
            left = pace.left(time) if time >= EVEN * duration else None
            soon = "" if left is None else f", {amounts.duration(left)} left"
            context().progress(Work(f"{doing}: {time:.3g} of {duration:g} s{soon}"))

        return reached

    def moved(counts: tuple[int, ...], name: str, spacing: float, **settings: Any) -> History:
        doing = f"moving the {name}"
        steps = _expected_steps(asked, duration)
        each = sizes.size(asked, judge.but(count=counts))
        expected = each and replace(each, seconds=steps * SOLVES * each.seconds)
        watch = told(doing, Work(f"{doing}, some {amounts.count(steps)} steps", expected))
        return fem_reference.simulate(
            asked,
            judge.kind,
            duration,
            elements=counts,
            every=spacing,
            store=folder(judge.kind, spacing, counts, judge.options, settings),
            progress=watch,
            **judge.options,
            **settings,
        )

    fem_reference.require_moving(asked, name)
    watch = told("moving the lattice", Work("moving the lattice"))
    kept = folder("lumped", model.settings)
    own = simulate(model, duration, every=every, frames=frames, store=kept, progress=watch)
    spacing = own.settings["every"]
    truth = moved(along, name, spacing, frames=frames)
    bars: dict[str, float | None] = {}
    if uncertainty and truth.status is Status.CONVERGED:
        longer = moved(along, f"{name} in longer steps", spacing, error=LONGER * truth.settings["error"])
        bars = {"mesh": None, "step": _largest(longer, truth)}
        if min(along) > 1:
            half = (along[0] // 2, along[1] // 2)
            coarse = moved(half, f"{name} on larger elements", spacing)
            bars["mesh"] = _largest(coarse, truth)
    return MotionComparison(asked, {model.spec.model: own, name: truth}, bars)


def _largest(one: History, other: History) -> float | None:
    return difference(one, other)["largest"] if one.status is Status.CONVERGED else None


def _expected_steps(scene: Scene, duration: float) -> int:
    """Steps that a reference takes, roughly."""
    import fem_reference

    lowest = float(fem_reference.modes(scene, "plate", 2, count=1).frequencies[0])
    each = STEPS_PER_PERIOD[scene.material.dashpot_time == 0.0]
    return int(np.ceil(each * max(duration * lowest, 0.5)))
