"""Residuals of measurements, and components that point the other way than the model's."""

import numpy as np
import pytest

from comparisons.identification.fit import Fit
from comparisons.identification.measurements import Displacements
from comparisons.identification.model import Model, Prediction
from sheetbench.errors import BadInput

POINTS = np.array([[0.1, 0.0], [0.1, 0.05], [0.1, 0.1]])
MODEL = np.array([[-2e-3, 1e-5, -9e-3], [-2.2e-3, 0.0, -1e-2], [-2.4e-3, -1e-5, -1.1e-2]])
AXES = (np.linspace(0.0, 0.1, 3), np.linspace(0.0, 0.1, 3))


def misfit(displacement):
    """Of no unknown, for what does not ask the model."""
    return Fit(Displacements(POINTS, np.asarray(displacement)), (), Model({}, AXES, lambda *_: None))


def test_residuals_are_shares_of_the_largest_measurement_and_come_back_in_metres():
    measured = MODEL * [1.0, 1.0, 1.25]
    measured[1, 2] = np.nan
    slope = np.arange(9.0).reshape(3, 3)
    one = misfit(measured)
    residuals, slopes = one.residuals(Prediction(MODEL, [slope, 2.0 * slope]))
    scale = 1.25 * 1.1e-2
    given = np.isfinite(measured)
    np.testing.assert_allclose(residuals, (MODEL - measured)[given] / scale)
    np.testing.assert_allclose(slopes, np.stack([slope[given], 2.0 * slope[given]], axis=1) / scale)
    back = one.per_point(residuals)
    np.testing.assert_allclose(back[given], (MODEL - measured)[given], atol=1e-18)
    np.testing.assert_array_equal(np.isnan(back), ~given)


@pytest.mark.parametrize(
    ("factors", "opposite"),
    [
        ((1.0, 1.0, 1.0), []),
        ((-1.0, 1.0, 1.0), ["ux"]),
        ((1.0, 1.0, -1.0), ["uz"]),
        ((1.0, -1.0, 1.0), []),  # of a hundredth of the largest: its sign says nothing
        ((1.0, 0.0, 1.0), []),
    ],
)
def test_a_component_is_opposite_where_it_is_large_and_its_correlation_negative(factors, opposite):
    one = misfit(MODEL * factors)
    residuals, _ = one.residuals(Prediction(MODEL, [np.zeros((3, 3))]))
    assert one.turned(residuals) == opposite


def test_a_deflection_of_the_other_sign_is_refused_with_its_correlation():
    misfit(0.3 * MODEL).require_same_way(Prediction(MODEL, []))
    misfit(-MODEL).require_same_way(Prediction(0.0 * MODEL, []))
    with pytest.raises(BadInput, match=r"uz have the opposite sign of the model's \(correlation −1\.00"):
        misfit(-2.0 * MODEL).require_same_way(Prediction(MODEL, []))
