"""What a mesh misses of the layer along edges that let twist go: closed forms, and the plate's own error."""

import numpy as np
import pytest

import fem_reference
from fem_reference.edge_layer import NOTHING, captured, missed, missed_by
from fem_reference.uncertainty import estimate
from sheetbench import scenes
from sheetbench.scenes import Scene


def test_the_layer_is_found_by_small_elements_and_missed_by_large_ones():
    assert captured(np.full(60, 0.2)) == pytest.approx(1.0, abs=1e-5)
    for length in (100.0, 1000.0):  # the mass alone, of elements of one length
        assert captured(np.full(20, length)) == pytest.approx(6.0 * 2.0**0.5 / length, rel=15.0 / length)
    assert np.all(np.diff([captured(np.full(20, t)) for t in (0.5, 1.0, 2.0, 4.0, 8.0)]) < 0.0)


def hinged(thickness):
    return Scene.model_validate(
        {
            "name": "hinged",
            "sheet": {"length_x": 1.0, "length_y": 1.0, "thickness": thickness},
            "material": {"young": 1e9, "poisson": 0.3, "density": 1000.0},
            "gravity": {"acceleration": [0.0, 0.0, -1e-4]},
            "support": [{"kind": "hinged", "edge": edge} for edge in ("x0", "x1", "y0", "y1")],
        }
    )


@pytest.mark.sweep(4)
@pytest.mark.parametrize(("thickness", "elements"), [(0.003, 12), (0.006, 12), (0.012, 8), (0.025, 8)])
def test_hinged_plates_are_too_stiff_by_two_thirds_of_what_is_missed(thickness, elements):
    scene, middle = hinged(thickness), np.array([[0.5, 0.5]])
    truth, coarse = (
        fem_reference.solve(scene, "plate", elements=n).displacement(middle)[0, 2] for n in (32, elements)
    )
    lost = missed(scene, (elements, elements), True).stiffening
    assert 1.0 - coarse / truth == pytest.approx(0.63 * lost, rel=0.15)


def test_clamps_have_no_such_layer_and_even_meshes_miss_more():
    clamped = scenes.load("two-edges-clamped").model_copy(update={"supports": ()})
    held = Scene.model_validate(
        {**clamped.document(), "support": [{"kind": "clamped", "edge": e} for e in ("x0", "x1", "y0", "y1")]}
    )
    assert missed(held, (8, 8), True) == NOTHING
    scene = hinged(0.01)
    graded, even = (missed_by(scene, {"elements": [8, 8], "graded": g}) for g in (True, False))
    assert even.share > graded.share > 0.0
    assert graded == missed_by(scene, {"elements": 8})
    assert even == missed_by(scene, {"elements": 8, "grading": "uniform"})


def test_bricks_miss_a_layer_where_stiffness_steps():
    """CalculiX on `ray-fin` is 1.4, 1.0 and 0.7 % off the shell with 6, 8 and 12 across: first order."""
    scene, bricks = scenes.load("ray-fin"), {"elements": [24, 12], "grading": "edges"}
    plain = scene.replace(patches=())
    same = scene.replace(patches=[scene.patches[0].replace(young=scene.material.young)])
    assert missed_by(scene, bricks).share == 1.0 > missed_by(plain, bricks).share
    assert missed_by(same, bricks) == missed_by(plain, bricks)
    assert missed_by(scene, {"elements": [24, 12]}) == missed_by(plain, {"elements": [24, 12]})
    answers = [np.array([[1.0 + off]]) for off in (0.00684, 0.00959, 0.01375)]
    found = estimate(answers, [1 / 12, 1 / 8, 1 / 6], [missed_by(scene, bricks)] * 3)
    assert found.bar.item() > 0.00684  # 0.0032 at the order of meshes that miss half of the rim
