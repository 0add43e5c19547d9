"""Moved edges and held bases: energy, names, what a motion takes; their reactions: test_balance.py."""

import numpy as np
import pytest
from dynamic_cases import make_scene, springs
from numpy.testing import assert_allclose

import fem_reference
import lumped

WEIGHT = 9.81 * 1678.0 * 0.188**2 * 0.003
MOVED = {
    "kind": "motion",
    "edge": "x1",
    "time": [0.0, 1.0],
    "displacement": [[0.0, 0.0, 0.0], [0.0, 0.0, 0.01]],
}
CLAMPED = [{"edge": "x0", "kind": "clamped"}]
CASES = {
    "a moved edge": make_scene(supports=CLAMPED, actuators=[MOVED]),
    "a held base": make_scene(supports=[], actuators=[{"edge": "y1", "base": "start"}]),
    "nothing": make_scene(supports=CLAMPED),
}


@pytest.mark.parametrize("model", ["plate", "shell", "solid"])
def test_a_reference_tells_the_energy_of_rods_wherever_there_are_actuators(model):
    """None of a moved edge, some of a held base's chain; and no word of it where nothing is actuated."""
    energies = {
        name: fem_reference.solve(scene, model=model, elements=2).energies for name, scene in CASES.items()
    }
    assert energies["a moved edge"]["rod"] == 0.0 < energies["a held base"]["rod"]
    assert "rod" not in energies["nothing"]


def test_a_run_writes_down_what_a_motion_takes():
    scene = make_scene(supports=CLAMPED, actuators=[MOVED], damping_rate=50.0)
    history = lumped.simulate(scene, springs(scene), 2.0, step=5e-3, every=0.5)
    total = history.reactions["x0"] + history.reactions["x1"]
    assert_allclose(history.reactions["x1"], history.actuators["x1"][:, 0, :3], atol=1e-12)
    assert np.abs(total[-1] - [0.0, 0.0, WEIGHT]).max() < 1e-3 * WEIGHT


def test_actuators_are_named_by_their_edges_or_numbered():
    two = make_scene(actuators=[{"edge": "x1"}, {"edge": "y1"}])
    assert list(two.named_actuators()) == ["x1", "y1"]
    pair = make_scene(actuators=[{"edge": "x1"}, {"edge": "x1", "face": "top"}, {"edge": "y1"}])
    assert list(pair.named_actuators()) == ["x1.1", "x1.2", "y1.3"]
