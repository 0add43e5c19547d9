"""What natural strains, curvatures and temperatures are worth, in words: size, radius, stress held flat."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from sheetbench.scenes.meaning.natural_state import TENSOR, Source, expansion_of, plies_of, sources_of
from sheetbench.scenes.objects.fields import SceneFields
from sheetbench.scenes.objects.layers import plane_stress
from sheetbench.scenes.objects.natural import Temperature

NONE = 1e-12  # of the largest, for what is rounding


def natural_in_words(scene: SceneFields) -> Iterator[tuple[str, str]]:
    """Yield name and meaning of each of what makes a sheet other than flat at rest."""
    for source in sources_of(scene):
        strain, curvature = (
            source.of.last_factor * np.where(np.abs(part) > NONE * np.abs(part).max(), part, 0.0)
            for part in (source.strain, source.curvature)
        )
        parts = list[str]()
        for e, k, axis in zip(strain, curvature, "xy", strict=False):
            way, towards = "longer" if e > 0.0 else "shorter", "+z" if k > 0.0 else "−z"
            parts += [f"{100.0 * abs(e):.3g} % {way} along {axis}"] if e else []
            parts += [f"an arc of radius {1e3 / abs(k):.4g} mm along {axis}, towards {towards}"] if k else []
        parts += [f"sheared by {strain[2]:.3g}"] if strain[2] else []
        parts += [f"twisted by {curvature[2]:.3g} 1/m"] if curvature[2] else []
        parts += ["held flat, stresses from {:.3g} to {:.3g} Pa".format(*_stresses(scene, source))]
        over = "" if source.of.history is None else f", over {source.of.history.time[-1]:g} s"
        yield source.name, (", ".join(parts) if len(parts) > 1 else "as it is drawn") + over


def _stresses(scene: SceneFields, source: Source) -> tuple[float, float]:
    """The least and the largest normal stress [Pa] along x and y in the faces of the layers, held flat."""
    sums = []
    for number, ply in enumerate(plies_of(scene)):
        for z in scene.sheet.thickness * np.array([ply.low, ply.high]):
            own = (source.strain - z * source.curvature) / TENSOR
            if isinstance(source.of, Temperature):
                own = expansion_of(scene, number) * (source.of.change + z * source.of.gradient)
            sums.append(-source.of.last_factor * (plane_stress(ply) @ own)[:2])
    return float(np.min(sums)), float(np.max(sums))
