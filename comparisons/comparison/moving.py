"""Which models move a scene."""

from __future__ import annotations

from comparisons.external import plugins
from comparisons.models.resolve import resolve
from comparisons.models.spec import Elements, External, Spec
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene


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
