"""What natural strains, curvatures and temperatures are worth, in words: size, radius, stress held flat."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from sheetbench.scenes.meaning.natural_state import Source, expansion_of, plies_of, sources_of
from sheetbench.scenes.objects.fields import SceneFields
from sheetbench.scenes.objects.layers import plane_stress
from sheetbench.scenes.objects.natural import Temperature

NONE = 1e-12  # of the largest, for what is rounding


def natural_in_words(scene: SceneFields) -> Iterator[tuple[str, str]]:
    """Yield name and meaning of each of what makes a sheet other than flat at rest."""
    names = {id(patch.natural): f"patch {n}" for n, patch in enumerate(scene.patches, start=1)}
    for source in sources_of(scene):
        name = "temperature" if isinstance(source.of, Temperature) else names.get(id(source.of), "natural")
        strain, curvature = (
            _without_rounding(part * source.of.last_factor) for part in (source.strain, source.curvature)
        )
        parts = [f"{100.0 * e:.3g} % longer along {axis}" for e, axis in zip(strain, "xy", strict=False) if e]
        parts += [f"sheared by {strain[2]:.3g}"] if strain[2] else []
        for k, axis in zip(curvature, "xy", strict=False):
            way = "+z" if k > 0.0 else "−z"
            parts += [f"an arc of radius {1e3 / abs(k):.4g} mm along {axis}, towards {way}"] if k else []
        parts += [f"twisted by {curvature[2]:.3g} 1/m"] if curvature[2] else []
        low, high = _stresses(scene, source)
        held = f"held flat, stresses from {low:.3g} to {high:.3g} Pa" if parts else "as it is drawn"
        over = "" if source.of.history is None else f", over {source.of.history.time[-1]:g} s"
        yield name, f"{', '.join([*parts, held])}{over}"


def _without_rounding(parts: np.ndarray) -> np.ndarray:
    return np.where(np.abs(parts) > NONE * np.abs(parts).max(initial=0.0), parts, 0.0)


def _stresses(scene: SceneFields, source: Source) -> tuple[float, float]:
    """The least and the largest normal stress [Pa] along x and y in the faces of the layers, held flat."""
    found, h = plies_of(scene), scene.sheet.thickness
    free = [source.strain, source.curvature]
    sums = []
    for number, ply in enumerate(found):
        for at in (ply.low, ply.high):
            if isinstance(source.of, Temperature):
                own = expansion_of(scene, number) * (source.of.change + at * h * source.of.gradient)
            else:
                own = np.append(free[0][:2] - at * h * free[1][:2], 2.0 * (free[0][2] - at * h * free[1][2]))
            sums.append(-source.of.last_factor * (plane_stress(ply) @ own)[:2])
    return float(np.min(sums)), float(np.max(sums))
