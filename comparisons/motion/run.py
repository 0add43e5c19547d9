"""A model's motion as a run of a campaign, plain data in and out, and the history that its row holds.

A row is a history's document, the unknowns, by how much the process grew [bytes], machine and versions.
"""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np

from comparisons.external import plugins
from comparisons.models.context import running
from comparisons.models.resolve import resolve
from comparisons.models.sizes import size
from comparisons.models.solve import simulate
from comparisons.models.spec import Elements, External, Spec, spec_of
from comparisons.runs import load
from comparisons.runs.campaign import Run
from comparisons.runs.peak_memory import with_peak_memory
from comparisons.runs.store import Finished
from sheetbench.errors import BadInput
from sheetbench.scenes import History, Scene, Status, comparable


def motion_run(
    scene: Scene, spec: Spec, duration: float, every: float, label: str = "", timed: bool = False, **run: Any
) -> Run:
    """The run that moves a scene for `duration` [s] with a model, sampled every so often [s]; run: what the
    model's own `simulate` takes, as integrator, step and error."""
    arguments: dict[str, Any] = {
        "scene": scene.document(),
        "model": spec.model,
        "settings": spec.settings,
        "run": run,
    }
    if (digest := plugins.digest(spec.model)) is not None:
        arguments["digest"] = digest
    arguments |= {"duration": duration, "every": every}
    return Run("motion", arguments, label or spec.label, timed)


def require_motion(scene: Scene, spec: Spec) -> None:
    """Raise BadInput for a model that does not move the scene, or takes more memory than there is."""
    import fem_reference

    resolve(scene, spec, "motion")
    if isinstance(spec, Elements):
        fem_reference.require_moving(scene, spec.kind)
    elif isinstance(spec, External):
        plugins.require_moving(spec.model, scene, spec.settings)


def refusal(scene: Scene, spec: Spec) -> str:
    """Return why a model does not move a scene, "" if it does."""
    try:
        require_motion(scene, spec)
    except BadInput as why:
        return str(why)
    return ""


def measure(
    scene: dict[str, Any],
    model: str,
    settings: dict[str, Any],
    run: dict[str, Any],
    duration: float,
    every: float,
    digest: str | None = None,
) -> dict[str, Any]:
    """The row of a run, on warm code; digest: of a plug-in, under which the row is kept."""
    parsed = Scene.model_validate(scene)
    with running(large=True):  # who asks has looked at the size
        meant = resolve(parsed, spec_of(model, settings), "motion")
    if digest is None:
        small = meant
        if isinstance(meant.spec, Elements):
            small = resolve(parsed, meant.spec.but(count=1), "motion")
        simulate(small, 2.0 * every, every=every, **run)
    history, memory = with_peak_memory(lambda: simulate(meant, duration, every=every, **run))
    found = size(parsed, meant.spec)
    return {
        **history.document(),
        "unknowns": history.extra.get("unknowns") if found is None else found.unknowns,
        "peak_memory_bytes": memory if digest is None else None,
        **load.conditions(),
    }


def history_of(outcome: Finished) -> History | None:
    """The history that a run has found, with its status; None where it did not reach its end."""
    if not comparable(outcome.status, 1.0):
        return None
    found: dict[str, Any] = {
        one.name: outcome.row[one.name] for one in fields(History) if one.name in outcome.row
    }
    for name in ("probes", "energies", "reactions", "actuators"):
        found[name] = {key: np.array(values) for key, values in found[name].items()}
    return History(**found | {"status": Status(outcome.status), "time": np.array(found["time"])})
