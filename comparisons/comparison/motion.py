"""A scene's motion as the lattice and as a finite-element reference have it, side by side.

The reference moves a second time on elements twice as large, and a third time with steps of about twice the
length: the rows of its error bar (`comparisons.sweep.limits.motion_bar`).
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from comparisons.comparison.motion_answer import MotionComparison
from comparisons.external import plugins
from comparisons.models.grids import Elements as Count
from comparisons.models.resolve import Resolved, resolve
from comparisons.models.solve import simulate
from comparisons.models.spec import Elements, External, Lattice, Spec, parse, unlike
from comparisons.sweep.here import moved_here
from comparisons.sweep.limits import motion_bar
from sheetbench.answers.history import History
from sheetbench.choices import REFERENCE
from sheetbench.scenes import AnyScene, Scene, scene_of

ELEMENTS = 8  # of a moving reference along the shorter side
LONGER = 8.0  # error of a step: steps twice as long


def compare_motion(
    scene: AnyScene,
    duration: float,
    lattice: Lattice = Lattice(),  # noqa: B008  # frozen
    reference: str | Elements = REFERENCE,
    *,
    elements: Count | None = None,
    law: str | None = None,
    uncertainty: bool = True,
    models: Sequence[Spec | str] = (),
    every: float | None = None,
    frames: int = 0,
    store: Path | None = None,
) -> MotionComparison:
    """Move a scene's sheet for `duration` [s] with the lattice and with a reference, from rest.

    uncertainty: move the reference twice more, on elements twice as large and with steps twice as long.
    every [s]: distance of samples. frames: whole displacements to keep. store: a folder in which every run of
    ours has one to stream to and go on from.
    Raises BadInput as `compare` and `simulate` do, and for a model that does not move the scene.
    """
    scene = scene_of(scene)
    finest = Elements.given(reference, {"elements": elements, "law": law})
    finest = finest.but(count=ELEMENTS) if finest.count is None else finest
    beside = [parse(one) for one in models]
    for one in (finest, *beside):
        require_motion(scene, one)
    model = resolve(scene, lattice, "motion")

    def moved(of: Resolved[Any], doing: str, spacing: float | None, **settings: Any) -> History:
        """A run, kept in a folder of its own by its settings where there is a store."""
        if not isinstance(of.spec, External):
            question = [scene.document(), duration, spacing, of.spec.model, of.settings, settings]
            text = json.dumps(question, sort_keys=True, default=str)
            kept = store and store / f"{of.spec.model}-{hashlib.sha256(text.encode()).hexdigest()[:12]}"
            settings |= {"store": kept}
        return simulate(of, duration, doing, every=spacing, **settings)

    own = moved(model, "simulating the lattice", every, frames=frames)
    histories, spacing = {model.spec.model: own}, own.settings["every"]
    for one in beside:
        name = unlike(plugins.shown_name(one.model), (*histories, finest.kind))
        histories[name] = moved(resolve(scene, one, "motion"), f"simulating the {name}", spacing)
    named = f"simulating the {finest.kind}"
    truth = moved(resolve(scene, finest), named, spacing, frames=frames)
    bars: dict[str, float | None] = {}
    if uncertainty and truth.succeeded:
        error = LONGER * truth.settings["error"]
        longer = moved(resolve(scene, finest), f"{named} in longer steps", spacing, error=error)
        rows, along = [moved_here(scene, finest, truth)], finest.counts(scene)
        if min(along[:2]) > 1:
            half = finest.but(count=(along[0] // 2, along[1] // 2))
            run = moved(resolve(scene, half), f"{named} on larger elements", spacing)
            rows.append(moved_here(scene, half, run))
        bars = motion_bar(rows, moved_here(scene, finest, longer))
    return MotionComparison(scene, {**histories, finest.kind: truth}, bars)


def require_motion(scene: Scene, spec: Spec) -> None:
    """Raise BadInput for a model that does not move the scene, or takes more memory than there is."""
    import fem_reference

    resolve(scene, spec, "motion")
    if isinstance(spec, Elements):
        fem_reference.require_moving(scene, spec.kind)
    elif isinstance(spec, External):
        plugins.moving(spec.model)
