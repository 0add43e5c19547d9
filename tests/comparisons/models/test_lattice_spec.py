"""A lattice is resolved in one place: every verb that has one takes the same options and means the same."""

import numpy as np
import pytest
from commands import run

import lumped
import sheetbench as sb
from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene, SpringTable

OPTIONS = {"k": 550.0, "layer_distance": 0.004}
FLAGS = ("--grid", "3", "--k", "550", "--layer-distance", "0.004")


@pytest.fixture(scope="module")
def scene() -> Scene:
    return sb.load("two-edges-clamped")


@pytest.fixture(scope="module")
def springy(scene: Scene) -> Scene:
    """The scene with springs of its own, of no calibration."""
    springs = lumped.calibrate(scene.sheet, scene.material, grid=3, method="uniform", k=400.0)
    table = {**springs.document()["springs"], "layer_distance": springs.layer_distance, "grid": [3, 3, 2]}
    return scene.replace(springs=SpringTable.model_validate(table))


def test_every_verb_in_python_takes_k_and_layer_distance(scene: Scene) -> None:
    springs = lumped.calibrate(scene.sheet, scene.material, 3, "uniform", **OPTIONS)
    modes = sb.modes(scene, count=2, grid=3, elements=2, **OPTIONS)[0]
    expected = lumped.modes(scene, springs, 2, lumped.usual_masses(springs)).frequencies
    assert modes.frequencies == pytest.approx(expected, rel=1e-9)
    history = sb.simulate(scene, 0.01, grid=3, **OPTIONS)
    assert np.allclose(history.probes["P4"], lumped.simulate(scene, springs, 0.01).probes["P4"], atol=1e-12)
    answer = sb.solve(scene, grid=3, **OPTIONS).displacement(scene.probe_points())
    assert np.allclose(answer, lumped.solve(scene, springs).displacement(scene.probe_points()), atol=1e-12)


@pytest.mark.parametrize(
    "verb", [("modes", "--elements", "2"), ("linearise",), ("simulate", "--duration", "0.01")]
)
def test_every_verb_of_the_command_line_takes_them(
    verb: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(verb[0], "two-edges-clamped", *FLAGS, *verb[1:]) == 0
    assert "lumped 3×3×2 uniform" in capsys.readouterr().out


def test_unknowns_are_identified_on_springs_with_a_layer_distance(scene: Scene) -> None:
    """The slopes are those of springs with that distance, or the search would not end where it began."""
    own = {"calibration": "consistent", "layer_distance": 0.004}
    points = np.array([(x, y) for x in (0.1, 0.188) for y in (0.1, 0.188)])
    truth = sb.solve(scene.replace(material=scene.material.replace(young=50e6)), grid=3, **own)
    from comparisons.identification.measurements import Displacements

    data = Displacements(points, truth.displacement(points))
    found = sb.identify(scene, data, "young", grid=3, refine=False, **own)
    assert found.unknowns["young"].value == pytest.approx(50e6, rel=1e-6)
    assert found.settings["layer_distance"] == 0.004
    with pytest.raises(BadInput, match="k = 550 N/m given the springs do not depend on it"):
        sb.identify(scene, data, "young", grid=3, k=550.0)


def test_a_scene_s_own_springs_are_meant_where_nothing_else_is_asked(springy: Scene) -> None:
    assert resolve(springy, Lattice()).spec.calibration is None
    assert resolve(springy, Lattice(k=3.0)).spec.calibration == "uniform"
    assert resolve(springy, Lattice(calibration="auto")).spec.calibration.startswith("consistent")
    assert resolve(springy, Lattice(), own=False).spec.calibration == "consistent"
