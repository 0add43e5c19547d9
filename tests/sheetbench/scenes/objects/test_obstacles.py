"""The scene language of obstacles: gaps of the flat sheet, refusals, words."""

import pytest
from contact_cases import THICKNESS, laid_strip

from sheetbench.errors import BadInput
from sheetbench.scenes import Box, Cylinder, Motion, Plane, Scene, SceneError, Sphere, load
from sheetbench.scenes.meaning.distances import nearest, scale_distance
from sheetbench.scenes.meaning.parameters import parameter, put
from sheetbench.scenes.meaning.words import in_words

GAPS = {
    "below": (Plane(position=(0, 0, -0.05)), 0.05),
    "tilted": (Plane(position=(0, 0, -0.5), normal=(1, 0, 1)), 0.5 / 2**0.5),
    "beside": (Sphere(position=(1.3, 0.05, -0.4), radius=0.2), 0.3),
    "under": (Sphere(position=(0.4, 0.05, -0.4), radius=0.2), 0.2),
    "across": (Cylinder(position=(0.4, 7.0, -0.2), axis=(0, 2, 0), radius=0.1), 0.1),
    "along": (Cylinder(position=(3.0, 0.4, -0.4), axis=(1, 0, 0), radius=0.1), 0.4),
    "on a face": (Box(position=(0.4, 0.05, -0.4), size=(0.2, 0.1, 0.4), radius=0.02), 0.2),
    "on a corner": (
        Box(position=(1.3, 0.4, -0.4), size=(0.4, 0.4, 0.4), radius=0.1),
        (0.2**2 + 0.2**2 + 0.3**2) ** 0.5 - 0.1,
    ),
    "lifted": (
        Plane(position=(0, 0, -0.2), motion=Motion(time=(0, 1), displacement=((0, 0, 0.1), (0, 0, 0.15)))),
        0.1,
    ),
}


@pytest.mark.parametrize("name", GAPS)
def test_gap_of_the_flat_sheet(name):
    obstacle, gap = GAPS[name]
    assert nearest(laid_strip(0.1), obstacle)[0] == pytest.approx(gap - THICKNESS / 2, abs=1e-9)


def test_what_no_obstacle_can_be():
    with pytest.raises(SceneError, match=r"obstacle 1.position: the flat sheet begins 10 mm inside it"):
        laid_strip(-0.01)
    press = Motion(time=(0.0, 1.0), displacement=((0.0, 0.0, 0.0), (0.0, 0.0, 0.06)))
    with pytest.raises(SceneError, match="edge x0, which is held, is 10 mm inside it"):
        laid_strip(0.1, obstacles=(Plane(position=(0.0, 0.0, -0.0525), motion=press),))
    with pytest.raises(SceneError, match="needs a direction"):
        Plane(position=(0, 0, -1), normal=(0, 0, 0))
    with pytest.raises(SceneError, match="cone"):
        laid_strip(0.1).replace(obstacles=({"kind": "cone", "position": (0, 0, -1)},))
    with pytest.raises(SceneError, match=r"radius: 0\.06 is more than half a side"):
        Box(position=(0, 0, -1), size=(1.0, 0.1, 1.0), radius=0.06)
    with pytest.raises(SceneError, match=r"begins 202\.5 mm inside it"):
        laid_strip(0.1, obstacles=(Box(position=(0.5, 0.05, 0.1), size=(1, 1, 0.6), radius=0.05),))


def test_written_and_read_again(tmp_path):
    scene = laid_strip(0.1, obstacles=tuple(obstacle for obstacle, _ in GAPS.values()))
    scene.save(tmp_path / "scene.toml")
    assert "[[obstacle]]" in (tmp_path / "scene.toml").read_text()
    assert load(tmp_path / "scene.toml") == scene
    assert Scene.model_validate(scene.document()) == scene
    assert "47.5 mm from the flat sheet" in dict(in_words(scene))["obstacle 1"]


def test_parameters_and_distances_of_an_obstacle():
    scene = laid_strip(0.1, obstacles=(Sphere(position=(0.4, 0.05, -0.4), radius=0.2, friction=0.1),))
    assert parameter(scene, "obstacle1.radius").value == 0.2
    moved = put(put(scene, "obstacle1.x", -0.1), "obstacle1.friction", 0.3).obstacles[0]
    assert (moved.position, moved.friction) == ((-0.1, 0.05, -0.4), 0.3)
    for unknown in ("obstacle2.x", "obstacle1.axis"):
        with pytest.raises(BadInput, match=unknown):
            put(scene, unknown, 1.0)
    for obstacle, gap in GAPS.values():
        twice = scale_distance(scene, obstacle, 2.0)
        assert nearest(scene, twice)[0] == pytest.approx(2.0 * (gap - THICKNESS / 2), abs=1e-8)
