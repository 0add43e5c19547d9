"""Motion of a scene by the lattice, a finite-element reference and further models.

The reference is simulated again on two coarser meshes, and with steps of about twice the length, for its
error bar (`comparisons.sweep.limits.motion_bar`).
"""

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
from comparisons.models.spec import Elements, External, Lattice, Spec, parse, unique_name
from comparisons.sweep.in_process import motion_row
from comparisons.sweep.limits import motion_bar
from sheetbench.answers.history import History
from sheetbench.choices import REFERENCE
from sheetbench.scenes import AnyScene, Scene, scene_of

ELEMENTS = 8  # of a reference in motion along the shorter side
LONGER = 8.0  # factor of the step error that doubles the steps


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
    """Simulate a scene for `duration` [s] from rest with the lattice, a reference and further models.

    uncertainty: simulate the reference three times more for its error bar; every [s]: interval of samples;
    frames: number of stored displacement fields; store: a folder from which interrupted runs resume. Raises
    BadInput as `compare` and `simulate`, and for a model without motion of the scene.
    """
    from fem_reference.uncertainty import coarser

    scene = scene_of(scene)
    finest = Elements.given(reference, {"elements": elements, "law": law})
    finest = finest.but(count=ELEMENTS) if finest.count is None else finest
    further = [parse(spec) for spec in models]
    for spec in (finest, *further):
        require_motion(scene, spec)
    lattice_model = resolve(scene, lattice, "motion")

    def run(model: Resolved[Any], doing: str, interval: float | None, **settings: Any) -> History:
        """Simulate a model; with a store in a folder named by the settings."""
        if not isinstance(model.spec, External):
            key = [scene.document(), duration, interval, model.spec.model, model.settings, settings]
            text = json.dumps(key, sort_keys=True, default=str)
            name = f"{model.spec.model}-{hashlib.sha256(text.encode()).hexdigest()[:12]}"
            settings |= {"store": store and store / name}
        return simulate(model, duration, doing, every=interval, **settings)

    first = run(lattice_model, "simulating the lattice", every, frames=frames)
    histories, interval = {lattice_model.spec.model: first}, first.settings["every"]
    for spec in further:
        name = unique_name(plugins.shown_name(spec.model), (*histories, finest.kind))
        histories[name] = run(resolve(scene, spec, "motion"), f"simulating the {name}", interval)
    doing = f"simulating the {finest.kind}"
    truth = run(resolve(scene, finest), doing, interval, frames=frames)
    bars: dict[str, float | None] = {}
    if uncertainty and truth.succeeded:
        error = LONGER * truth.settings["error"]
        longer = run(resolve(scene, finest), f"{doing} in longer steps", interval, error=error)
        rows, (along_x, along_y, *_) = [motion_row(scene, finest, truth)], finest.counts(scene)
        for count in coarser((along_x, along_y))[1:]:
            larger = finest.but(count=count)
            coarse = run(resolve(scene, larger), f"{doing} on larger elements", interval)
            rows.append(motion_row(scene, larger, coarse))
        bars = motion_bar(rows, motion_row(scene, finest, longer))
    return MotionComparison(scene, {**histories, finest.kind: truth}, bars)


def require_motion(scene: Scene, spec: Spec) -> None:
    """Raise BadInput for a model without motion of the scene, or one that needs more memory than is free."""
    import fem_reference

    resolve(scene, spec, "motion")
    if isinstance(spec, Elements):
        fem_reference.require_moving(scene, spec.kind)
    elif isinstance(spec, External):
        plugins.moving(spec.model)
