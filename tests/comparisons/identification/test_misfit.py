"""Measured deflections that point the other way than the model's."""

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


def test_a_deflection_of_the_other_sign_is_refused_with_its_correlation():
    misfit(0.3 * MODEL).require_same_way(Prediction(MODEL, []))
    misfit(-MODEL).require_same_way(Prediction(0.0 * MODEL, []))
    with pytest.raises(BadInput, match=r"uz have the opposite sign of the model's \(correlation −1\.00"):
        misfit(-2.0 * MODEL).require_same_way(Prediction(MODEL, []))
