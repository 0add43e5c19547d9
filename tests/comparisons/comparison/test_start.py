"""Where motions start, in every model: from a stable equilibrium or not at all; a plucked beam."""

import numpy as np
import pytest
import scipy.optimize
from dynamic_cases import moved

from sheetbench.errors import NoEquilibrium
from sheetbench.face import solve
from sheetbench.scenes import Scene

SHEET = {"length_x": 0.15, "length_y": 0.03, "thickness": 0.003}
MATERIAL = {"young": 6e6, "poisson": 0.0, "density": 1100.0}
CLAMP = {"edge": "x0", "kind": "clamped"}
BETA = 1.8751040687  # cosh β cos β = −1
TIP, MESH = (0.15, 0.015), (8, 2)
PULL = {"kind": "edge", "edge": "x1", "force_per_length": [0.0, 0.0, 0.02], "hold": True}
MODELS = ("lumped", "plate", "shell", "solid")
DAILY = ("lumped", "plate", "shell", pytest.param("solid", marks=pytest.mark.nightly))


def strip(**more):
    scene = {"name": "plucked", "sheet": SHEET, "material": MATERIAL, "supports": [CLAMP], "loads": [PULL]}
    scene |= {"initial": {"shape": "static"}, "probes": {"tip": TIP}}
    return Scene.model_validate(scene | more)


def at_rest(scene, model):
    return solve(scene, model, **({"grid": 5} if model == "lumped" else {"elements": MESH}))


@pytest.mark.parametrize("model", DAILY)
def test_a_rod_bent_out_of_reach_is_no_start(model):
    """At κ = 200 1/m statics end inverted, or beyond the linear theory; motions began with 638 J for 10."""
    sheet = {"length_x": 0.188, "length_y": 0.188, "thickness": 0.003}
    rod = {"edge": "x0", "kind": "curved", "curvature": 200.0}
    scene = Scene.model_validate({"name": "rod", "sheet": sheet, "material": MATERIAL, "supports": [rod]})
    with pytest.raises(NoEquilibrium, match=f"start from no stable equilibrium: {model}: .*:"):
        moved(scene, model, 0.01, 1)


@pytest.mark.sweep(2)
@pytest.mark.parametrize("model", MODELS)
def test_a_motion_starts_from_the_equilibrium_that_statics_find(model):
    """The held load is in the statics; let go, the energy at the start is the elastic one, and is kept."""
    scene = strip()
    history, still = moved(scene, model, 0.01, MESH), at_rest(scene, model)
    assert np.allclose(history.probes["tip"][0], still.displacement([TIP])[0], atol=1e-9)
    assert history.energies["kinetic"][0] == 0.0
    assert history.energies["elastic"][0] == pytest.approx(sum(still.energies.values()), rel=1e-6)
    assert np.abs(history.balance - history.balance[0]).max() < 2e-3 * history.energies["elastic"][0]


@pytest.mark.sweep(2)
@pytest.mark.parametrize("model", ["lumped", "shell"])
def test_a_plucked_strip_swings_and_decays_as_a_beam(model):
    """f₁ = β²/2π √(EI/ρA L⁴), 12/β⁴ of the deflection in the first mode, e^(−αt/2)."""
    alpha = 0.5
    scene = strip(material=MATERIAL | {"damping_rate": alpha})
    omega = BETA**2 * np.sqrt(6e6 * 0.003**2 / 12.0 / 1100.0) / 0.15**2
    period = 2.0 * np.pi / omega
    history = moved(scene, model, 3.25 * period, MESH, every=period / 80.0)
    t, z = history.time, history.probes["tip"][:, 2]
    assert z[0] == pytest.approx(0.02 * 0.15**3 / (3.0 * 6e6 * 0.003**3 / 12.0), rel=0.01)

    def swing(amplitude, rate, decay):
        turn = rate * omega * t
        damped = np.cos(turn) + decay / (rate * omega) * np.sin(turn)
        return amplitude * z[0] * damped * np.exp(-decay * t)

    start = [0.9, 1.0, 0.4 * alpha]
    fitted = scipy.optimize.least_squares(lambda p: (swing(*p) - z) / z[0], start).x
    assert fitted == pytest.approx([12.0 / BETA**4, 1.0, 0.5 * alpha], rel=0.01)


def test_a_held_load_wants_a_start_and_no_history():
    with pytest.raises(ValueError, match=r"load 1.hold = true: has no effect without \[initial\]"):
        strip(initial=None)
    history = {"time": [0.0, 1.0], "factor": [0.0, 1.0]}
    with pytest.raises(ValueError, match="hold = true: it acts in full until t = 0"):
        strip(loads=[PULL | {"history": history}])


def test_a_start_under_loads_takes_histories_and_supports_as_they_are_then():
    """A factor of ½ at t = 0, and a support already 1 mm up."""
    half = PULL | {"hold": False, "history": {"time": [0.0, 1.0], "factor": [0.5, 1.0]}}
    lifted = CLAMP | {"motion": {"time": [0.0, 1.0], "displacement": [[0.0, 0.0, 1e-3], [0.0, 0.0, 2e-3]]}}
    scene = strip(loads=[half], supports=[lifted])
    for model in MODELS:
        full = at_rest(strip(), model).displacement([TIP])[0, 2]
        assert moved(scene, model, 0.001, MESH).probes["tip"][0, 2] == pytest.approx(
            1e-3 + 0.5 * full, rel=2e-3
        )
