"""Balanced truncation of a lattice for control: the bound foretold holds, slow inputs are exact."""

import numpy as np
import pytest
from cases import with_material
from commands import one_line, run

import lumped
from sheetbench import scenes
from sheetbench.errors import BadInput

BARE = scenes.load("two-edges-clamped")
DAMPED = with_material(BARE, damping_time=2e-3, damping_rate=0.5)


@pytest.fixture(scope="module")
def whole():
    springs = lumped.calibrate(DAMPED.sheet, DAMPED.material, grid=3)
    return lumped.linearise(DAMPED, springs, "flat").state_space(None)


def sampled(space):
    """Frequencies [Hz], the resonances among them."""
    return np.sort(np.r_[0.0, np.geomspace(0.01, 5.0 * space.frequencies[-1], 300), space.frequencies])


def worst(whole, found):
    """Largest gain from the scaled inputs to the outputs' error at the sampled frequencies."""
    at = sampled(whole)
    off = (whole.response(at) - found.space.response(at)) * found.scale
    return float(np.linalg.norm(off, 2, axis=(1, 2)).max())


@pytest.mark.parametrize("order", [1, 4, 9, 20])
def test_no_frequency_is_further_off_than_foretold(whole, order):
    found = whole.balanced(order)
    assert found.order == order and len(found.space.a) == order
    assert found.space.poles.real.max() < 0.0
    assert 0.0 < worst(whole, found) <= found.bound
    assert np.all(np.diff(found.hankel) <= 0.0)
    at_rest = np.zeros(1)
    known = whole.response(at_rest)[0] * found.scale
    np.testing.assert_allclose(found.space.response(at_rest)[0] * found.scale, known, atol=1e-9)
    assert np.linalg.norm(known, axis=0) == pytest.approx(1.0)


def test_one_oscillator_has_the_singular_values_of_the_textbook():
    """ω² y + 2 ζ ω ẏ + ÿ = ω² w has σ = (√(1 + ζ²) ± ζ)/4ζ."""
    omega, zeta = 30.0, 0.02
    a = np.array([[0.0, omega], [-omega, -2.0 * zeta * omega]])
    space = lumped.StateSpace(
        a, np.array([[0.0], [omega]]), np.array([[1.0, 0.0]]), np.zeros((1, 1)), np.array([omega / 2 / np.pi])
    )
    found = space.balanced(2)
    assert found.bound == 0.0
    assert found.hankel == pytest.approx((np.sqrt(1.0 + zeta**2) + np.array([zeta, -zeta])) / (4.0 * zeta))


def test_the_fewest_states_within_a_tolerance(whole):
    found = whole.balanced(tolerance=0.5)
    assert found.bound <= 0.5 < whole.balanced(found.order - 1).bound
    assert whole.balanced(1).order_within(0.5) == found.order
    assert worst(whole, found) <= 0.5 and found.order < len(whole.a)


def test_what_cannot_be_balanced_is_refused(whole):
    springs = lumped.calibrate(BARE.sheet, BARE.material, grid=3)
    undamped = BARE.replace(material={**BARE.material.model_dump(), "damping_time": 0.0, "damping_rate": 0.0})
    with pytest.raises(BadInput, match="not damped"):
        lumped.linearise(undamped, springs, "flat").state_space(4).balanced(2)
    with pytest.raises(BadInput, match="order = 99"):
        whole.balanced(99)
    with pytest.raises(BadInput, match="an order or a tolerance"):
        whole.balanced()


@pytest.mark.parametrize(
    "reduce", ["balanced", "balanced:-1", "balanced:0", "modal:3", "balanced:nan", "balanced:1e400"]
)
def test_what_is_no_order_is_refused_by_the_verb(reduce, capsys):
    assert run("modes", "two-edges-settling", "--lumped", "3", "--state-space", "0", "--reduce", reduce) == 2
    one_line(capsys)
