"""Points that are held: three of them carry a free sheet, in every model."""

import numpy as np
import pytest
from cases import sheet

import fem_reference
import lumped
from sheetbench.errors import BadInput, SceneError
from sheetbench.scenes import Point, free_rigid_motions
from sheetbench.scenes.objects.natural import Natural

THREE = (
    Point(at=(0.05, 0.05)),
    Point(at=(0.15, 0.05), components=("y", "z")),
    Point(at=(0.1, 0.15), components=("z",)),
)


def scene(supports=THREE, weight=0.02, natural=None):
    return sheet(0.2, 0.2, 0.002, weight=weight, supports=supports, natural=natural)


def solved(of, model):
    if model == "lumped":
        return lumped.solve(of, lumped.calibrate(of.sheet, of.material, (9, 9, 2)))
    return fem_reference.solve(of, model=model, elements=4)


@pytest.mark.parametrize("model", ["lumped", "plate", "shell", "solid"])
def test_three_points_carry_the_weight_as_statics_say(model):
    """Moments about the first two: the third carries half."""
    found = solved(scene(), model)
    assert found.succeeded and not free_rigid_motions(scene())
    whole = 1e3 * 0.2 * 0.2 * 0.002 * 0.02
    shares = [found.reactions[f"support {n}"][2] / whole for n in (1, 2, 3)]
    np.testing.assert_allclose(shares, [0.25, 0.25, 0.5], rtol=1e-4)
    held = found.displacement([[0.05, 0.05], [0.15, 0.05], [0.1, 0.15]])
    assert np.abs(held[:, 2]).max() < 1e-7 and np.abs(held[0]).max() < 1e-7  # solid: the mean is held


def test_all_models_agree_on_a_sheet_that_curls_on_three_points():
    of = scene(weight=0.0, natural=Natural(curvature=(0.04, 0.04, 0.0)))
    shell = solved(of, "shell").displacement([[0.2, 0.2]])[0]
    for model in ("lumped", "plate", "solid"):
        assert (
            np.abs(solved(of, model).displacement([[0.2, 0.2]])[0] - shell).max() < 0.02 * np.abs(shell).max()
        )


def test_what_is_missing_or_nowhere_is_said():
    two = scene(THREE[:2])
    assert any("rotation" in motion for motion in free_rigid_motions(two))
    with pytest.raises(SceneError, match="nothing stops"):
        solved(two, "shell")
    with pytest.raises(BadInput, match=r"at = \[0.05, 0.05\]: no mass"):
        lumped.solve(scene(), lumped.calibrate(scene().sheet, scene().material, (8, 8, 2)))
    with pytest.raises(SceneError, match="off the sheet"):
        scene((Point(at=(0.3, 0.1)), *THREE[1:]))
