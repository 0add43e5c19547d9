"""Model − measurement, as shares of the largest measurement: residuals, slopes, and which way they point.

Residuals are u_model − u_measured at every measured component, or the distances of a cloud's points from the
model's surface, along its normals (`comparisons.identification.surface`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from comparisons.identification import surface
from comparisons.identification.measurements import MOVED, Displacements, Measured, Surface
from comparisons.identification.prediction import Prediction
from sheetbench.answers.table import number
from sheetbench.errors import BadInput

OPPOSITE = -0.5  # correlation with the model's displacement below which the measured one is turned round
TELLING = 0.1  # of the largest measurement: what a component must reach for its sign to say something


@dataclass(frozen=True)
class Misfit:
    """Of measurements, with the plan grid on which a model gives its whole surface, and the distance [m] from
    the mid-surface at which a cloud was taken."""

    measured: Measured
    axes: tuple[np.ndarray, np.ndarray]
    offset: float = 0.0

    @property
    def requested(self) -> np.ndarray:
        """Plan points (n, 2) [m] at which the model is to answer."""
        return surface.plan_points(self.axes) if isinstance(self.measured, Surface) else self.measured.points

    def of(self, predicted: Prediction) -> tuple[np.ndarray, np.ndarray]:
        """Residuals (m,) and their slopes (m, n) by the unknowns' x."""
        measured, scale = self.measured, self.measured.scale
        if isinstance(measured, Displacements):
            given = measured.measured
            slopes = [slope[given] for slope in predicted.slopes]
            residuals = (predicted.displacement - measured.displacement)[given]
        else:
            found = surface.feet(self.axes, surface.Field(self.axes, predicted.displacement), measured.points)
            slopes = [
                np.einsum("nc,nc->n", found.normals, surface.Field(self.axes, slope).at(found.points))
                for slope in predicted.slopes
            ]
            residuals = self.offset - found.distances
        return residuals / scale, np.stack(slopes, axis=1) / scale

    def per_point(self, residuals: np.ndarray) -> np.ndarray:
        """Residuals [m] in the shape of the measurements, nan where nothing was measured."""
        if isinstance(self.measured, Surface):
            return residuals * self.measured.scale
        out = np.full(self.measured.displacement.shape, np.nan)
        out[self.measured.measured] = residuals * self.measured.scale
        return out

    def turned(self, residuals: np.ndarray) -> list[str]:
        """Return the measured components that point the other way than the model's."""
        if isinstance(self.measured, Surface):
            return []
        predicted = self.measured.displacement + self.per_point(residuals)
        return [
            name
            for name, model, measured in zip(MOVED, predicted.T, self.measured.displacement.T, strict=True)
            if _correlation(model, measured, self.measured.scale) < OPPOSITE
        ]


def require_same_way(measured: Measured, predicted: Prediction, axes: tuple[np.ndarray, np.ndarray]) -> None:
    """Raise BadInput where the measured deflection points the other way than the predicted one."""
    if isinstance(measured, Displacements):
        name, deflection, model = "uz", measured.displacement[:, 2], predicted.displacement[:, 2]
    else:
        name, deflection = "heights", measured.points[:, 2]
        model = surface.Field(axes, predicted.displacement).at(measured.points[:, :2])[:, 2]
    correlation = _correlation(model, deflection, measured.scale)
    if correlation < OPPOSITE:
        raise BadInput(
            f"{measured.source}: the measured {name} have the opposite sign of the model's (correlation "
            f"{number(correlation, '.2f')} at the scene's own values); z points up"
        )


def _correlation(model: np.ndarray, measured: np.ndarray, scale: float) -> float:
    """Σ model · measured over both norms, of what was measured; 0 where that is small or nothing moves."""
    given = np.isfinite(measured)
    model, measured = model[given], measured[given]
    norms = float(np.linalg.norm(model) * np.linalg.norm(measured))
    if norms == 0.0 or np.abs(measured).max() < TELLING * scale:
        return 0.0
    return float(model @ measured) / norms
