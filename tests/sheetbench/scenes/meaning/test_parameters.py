"""Parameters by name, and scenes with something replaced: values put and got again, and what is refused."""

import pytest

from sheetbench import scenes
from sheetbench.errors import BadInput
from sheetbench.scenes import Chain, Clamped, Curved, Scene, SceneError
from sheetbench.scenes.meaning.parameters import parameter, put

SCENE = scenes.load("one-edge-clamped")
CHAIN = {"edge": "x1", "segments": 4, "bending_stiffness": 0.01, "line_density": 0.05, "radius": 1e-3}
RICH = SCENE.replace(
    supports=(Curved(edge="x1", curvature=2.0),),
    actuators=(Chain(**{**CHAIN, "edge": "y0"}, curvature=1.0),),
    taper_x=(0.003, 0.0015),
    patches=[{"shape": {"circle": {"centre": (0.1, 0.1), "radius": 0.03}}, "young": 1e8, "thickness": 0.004}],
)
VALUES = {
    "young": 1e6, "poisson": -0.2, "density": 900.0, "damping_time": 1e-3, "damping_rate": 5.0,
    "thickness": 2e-3, "curvature_x1": -3.0, "curvature_y0": 4.0, "tilt_x0": 0.2, "patch1.young": 1e6,
    "patch1.thickness": 0.001,
}  # fmt: skip


@pytest.mark.parametrize("name", VALUES)
def test_what_is_put_is_got_and_nothing_else_changes(name):
    scene = RICH.replace(supports=(Clamped(edge="x0"),)) if name == "tilt_x0" else RICH
    changed = put(scene, name, VALUES[name])
    found = parameter(changed, name)
    assert found.value == VALUES[name] and found.low <= found.value <= found.high
    assert put(changed, name, parameter(scene, name).value) == scene


def test_a_pair_of_one_curvature_changes_together_and_one_of_two_is_refused():
    pair = [Chain(**CHAIN, face=face, curvature=2.0) for face in ("top", "bottom")]
    bent = put(SCENE.replace(actuators=tuple(pair)), "curvature_x1", 5.0)
    assert [chain.curvature for chain in bent.actuators] == [5.0, 5.0]
    uneven = SCENE.replace(actuators=(pair[0], pair[1].replace(curvature=1.0)))
    with pytest.raises(BadInput, match="no support or actuator of one curvature"):
        parameter(uneven, "curvature_x1")


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("mass", "not a parameter of a scene; choose from young, poisson"),
        ("tilt_y1", "edge 'y1' has no clamp"),
        ("curvature_x0", "edge 'x0' has no support or actuator of one curvature"),
        ("patch2.young", "'patch2.young': the scene has 1 patch"),
        ("patch1.poisson", "the scene has no patches 1.poisson; give a first guess there"),
        ("patch1.angel", "not a parameter of a scene"),
    ],
)
def test_what_a_scene_does_not_have_is_refused(name, said):
    for refused in (lambda: parameter(RICH, name), lambda: put(RICH, name, 1.0)):
        with pytest.raises(BadInput, match=said):
            refused()


@pytest.mark.parametrize(
    ("name", "value"), [("young", -1.0), ("poisson", 0.5), ("thickness", 1.0), ("tilt_x0", 2.0)]
)
def test_values_that_cannot_be_are_refused(name, value):
    with pytest.raises(SceneError):
        put(SCENE, name, value)


def test_a_scene_s_document_is_the_scene():
    assert Scene.model_validate(RICH.document()) == RICH
    tables = "sheet material gravity patch layer cutout support actuator obstacle load mass probes"
    assert set(RICH.document()) == {"name", "title", *tables.split()}
