"""What runs of every model say of themselves: strains beyond the model, inversion, energy from nowhere."""

import numpy as np
import pytest
from dynamic_cases import moved

import lumped
from sheetbench.answers.solution import Status
from sheetbench.runs.run import Watch
from sheetbench.scenes import Scene

MODELS = ("lumped", "plate", "shell", pytest.param("solid", marks=pytest.mark.nightly))
SOFT = {
    "name": "soft",
    "sheet": {"length_x": 0.2, "length_y": 0.1, "thickness": 0.003},
    "material": {"young": 2e4, "poisson": 0.3, "density": 1000.0},
    "supports": [{"edge": "x0", "kind": "clamped"}],
    "gravity": {"acceleration": [0.0, 0.0, -9.81]},
}


@pytest.mark.parametrize("model", MODELS)
def test_a_sheet_too_heavy_for_its_law_is_outside_the_model_in_motion_too(model):
    history = moved(Scene.model_validate(SOFT), model, 0.01, 1)
    assert history.status is Status.STRAIN_OUTSIDE_MODEL
    assert "ρ g a/E = 0.0981" in history.message and "from 0 s on" in history.message
    assert history.time[-1] == 0.01


@pytest.mark.sweep(2)
@pytest.mark.parametrize("model", ["lumped", "solid", "shell"])
def test_an_edge_torn_away_is_outside_the_model_from_when_it_is(model):
    """Pulled by three quarters of its length in 0.2 s: by more than half after about two thirds of it."""
    edge = {"edge": "x1", "kind": "clamped"}
    edge["motion"] = {"time": [0.0, 0.2], "displacement": [[0.0, 0.0, 0.0], [0.15, 0.0, 0.0]]}
    supports = [*SOFT["supports"], edge]
    material = SOFT["material"] | {"young": 2e6, "damping_time": 0.02}
    scene = Scene.model_validate(SOFT | {"supports": supports, "material": material, "gravity": None})
    history = moved(scene, model, 0.2, 3)
    assert history.status is Status.STRAIN_OUTSIDE_MODEL
    since = float(history.message.split(" s on")[0].removeprefix("from "))
    assert 0.05 < since < 0.18


@pytest.mark.sweep
@pytest.mark.parametrize("model", ["shell", "lumped", "solid"])
def test_what_turns_inside_out_ends_a_run(model):
    """An edge pushed through the other."""
    edge = {"edge": "x1", "kind": "held", "components": ["x", "z"]}
    edge["motion"] = {"time": [0.0, 0.2], "displacement": [[0.0, 0.0, 0.0], [-0.5, 0.0, 0.0]]}
    scene = Scene.model_validate(SOFT | {"supports": [*SOFT["supports"], edge], "gravity": None})
    history = moved(scene, model, 0.2, 3)
    assert history.status in (Status.INVERTED, Status.DIVERGED)
    assert "inside out" in history.message or model == "solid"
    assert history.time[-1] < 0.2


def test_a_growth_is_told_from_a_hundredth_and_ends_a_run_from_a_tenth():
    """A kinetic energy of 1 J and an elastic one that grows out of nothing, or is lost."""
    time = np.arange(4.0)
    for change, grown in ((0.002, False), (0.05, False), (0.2, True), (-0.2, False)):
        rows = np.column_stack([time, np.ones(4), change * time / 3.0, np.zeros((4, 3))])
        watch = Watch()
        sound, gained = watch.take(rows)
        assert (sound < 4) == (gained > 0.1) == grown
        status, message = watch.ending("")
        assert status is Status.CONVERGED
        assert ("off by" in message) == (abs(change) > 0.01)
        assert Watch.recall(watch.memory()).ending("") == (status, message)


def test_what_the_rule_takes_is_an_energy_of_its_own():
    """With it the account closes; in JSON, CSV and arrays."""
    clamp = {"edge": "x0", "kind": "clamped"}
    clamp["motion"] = {"time": [0.0, 0.05], "displacement": [[0.0, 0.0, 0.0], [0.0, 0.0, 0.03]]}
    material = {"young": 6e6, "poisson": 0.0, "density": 1100.0}
    sheet = {"length_x": 0.15, "length_y": 0.075, "thickness": 0.004}
    changed = {"sheet": sheet, "supports": [clamp], "material": material, "gravity": None}
    scene = Scene.model_validate(SOFT | changed)
    history = lumped.simulate(scene, lumped.calibrate(scene.sheet, scene.material, grid=9), 0.15)
    energies = history.document()["energies"]
    total = sum(energies[name] for name in ("kinetic", "elastic", "potential", "dissipated", "numerical"))
    assert np.allclose(total - energies["work"], history.balance[0], atol=1e-12)
    assert energies["numerical"][-1] > 0.01 * energies["work"].max()
    assert "the energy balance is off by" in history.message and history.status is Status.CONVERGED
    assert history.to_pandas()["numerical [J]"].iloc[-1] == pytest.approx(energies["numerical"][-1])
