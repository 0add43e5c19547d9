"""Scenes: what is refused and how it is said, defaults, rigid motions."""

from contextlib import nullcontext
from inspect import signature

import numpy as np
import pytest
from cases import sheet
from scene_files import BAD, GOOD, refusal

from sheetbench import scenes
from sheetbench.scenes import Held, Hinged, Scene

pytestmark = pytest.mark.smoke


@pytest.mark.parametrize("fault", BAD)
def test_bad_scene_is_refused_in_one_line_naming_file_key_and_value(tmp_path, fault):
    text, named = BAD[fault]
    assert text != GOOD
    said = refusal(tmp_path, text)
    for part in named:
        assert part in said


def test_what_is_no_file_is_no_scene(tmp_path):
    with pytest.raises(scenes.SceneError, match="cannot be read"):
        scenes.load(tmp_path)
    with pytest.raises(scenes.SceneError, match=r"no-such-scene: no such file.*two-edges-clamped"):
        scenes.load("no-such-scene")


@pytest.mark.parametrize(("supports", "free"), [
    ((), [f"{kind} {axis}" for kind in ("translation along", "rotation about") for axis in "xyz"]),
    ((Hinged(edge="x0"),), ["rotation about edge x0"]),
    ((Hinged(edge="y1"),), ["rotation about edge y1"]),
    ((Hinged(edge="x0"), Hinged(edge="x1")), []),
    ((Held(edge="x1", components=("z",)),),
        ["translation along x", "translation along y", "rotation about edge x1", "rotation about z"]),
    ((Held(edge="x0", components=("x", "y")),),
        ["translation along z", "rotation about x", "rotation about y"]),
])  # fmt: skip
def test_only_motions_that_are_free_are_named(supports, free):
    """As many names as independent motions: the vibration solvers count them."""
    scene = scenes.load("one-edge-clamped").replace(supports=supports)
    assert scenes.free_rigid_motions(scene) == free
    with pytest.raises(scenes.SceneError, match=", ".join(free)) if free else nullcontext():
        scenes.require_static(scene)


def test_what_a_scene_takes_without_a_name_and_in_which_order():
    taken = [name for name, one in signature(Scene).parameters.items() if one.kind is not one.KEYWORD_ONLY]
    assert taken[:7] == ["name", "sheet", "material", "gravity", "supports", "loads", "actuators"]
    assert taken[7:] == ["springs", "dampers", "probes"]


def test_catalogue_scenes_load_and_stand_still():
    published = {"two-edges-clamped", "one-edge-clamped", "curved-edge", "curved-edge-down"}
    assert published <= set(scenes.catalogue())
    for name in scenes.catalogue():
        scene = scenes.load(name)
        assert scene.name == name
        assert scene.title
        scenes.require_static(scene)


@pytest.mark.parametrize(("held", "at"), [
    *([[(edge, "clamped")], {"P2": (0.1, far[1]), "P3": (far[0], 0.05), "P4": far}] for edge, far in
      (("x0", (0.2, 0.1)), ("x1", (0.0, 0.1)), ("y0", (0.2, 0.1)), ("y1", (0.2, 0.0)))),
    ([("x0", "clamped"), ("x1", "clamped")], {"P2": (0.1, 0.1), "P3": (0.15, 0.05), "P4": (0.15, 0.1)}),
    ([("y0", "hinged"), ("y1", "held")], {"P2": (0.1, 0.075), "P3": (0.2, 0.05), "P4": (0.2, 0.075)}),
    ([("x0", "hinged"), ("x1", "hinged"), ("y0", "hinged"), ("y1", "clamped")],
        {"P2": (0.1, 0.075), "P3": (0.15, 0.05), "P4": (0.15, 0.075)}),
    ([("x0", "symmetric"), ("x1", "clamped")], {"P2": (0.1, 0.1), "P3": (0.15, 0.05), "P4": (0.15, 0.1)}),
    ([("x0", "clamped"), ("x1", "motion")], {"P2": (0.1, 0.1), "P3": (0.15, 0.05), "P4": (0.15, 0.1)}),
])  # fmt: skip
def test_absent_probes_are_centre_mid_sides_and_far_corner_where_nothing_holds(held, at):
    more = {
        "held": {"components": ["z"]},
        "motion": {"time": [0.0, 1.0], "displacement": [[0.0, 0.0, 0.0], [0.0, 0.0, 0.01]]},
    }
    parts = [{"edge": edge, "kind": kind, **more.get(kind, {})} for edge, kind in held]
    supports, moved = ([p for p in parts if (p["kind"] == "motion") is is_one] for is_one in (False, True))
    scene = sheet(0.2, 0.1, 0.001, supports=supports, actuators=moved)
    assert list(scene.probes) == ["P1", "P2", "P3", "P4"]
    assert scene.probe_points() == pytest.approx(np.array([(0.1, 0.05), *at.values()]))
