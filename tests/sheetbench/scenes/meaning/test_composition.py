"""Tapers and patches: what a sheet is made of where, and what is refused."""

import numpy as np
import pytest

from sheetbench.scenes import Scene, SceneError, Sheet
from sheetbench.scenes.meaning.composition import constants_at, mass_of, parts_between, sides_of

GRAVITY = {"acceleration": (0.0, 0.0, -9.81)}
ROOT = {"rectangle": {"x": (0.0, 0.05), "y": (0.0, 0.1)}}
DISC = {"circle": {"centre": (0.05, 0.05), "radius": 0.02}}
WEDGE = {"polygon": [(0.1, 0.0), (0.2, 0.0), (0.2, 0.1)]}


def scene_of(*patches, **taper):
    sheet = Sheet(0.2, 0.1, 0.003, **taper)
    material = {"young": 5e6, "poisson": 0.4, "density": 1000.0}
    return Scene(name="drawn", sheet=sheet, material=material, patches=patches, gravity=GRAVITY)


def test_later_patches_win_in_what_they_give():
    scene = scene_of({"shape": ROOT, "young": 5e7, "thickness": 0.004}, {"shape": DISC, "thickness": 0.006})
    at = np.array([[0.01, 0.01], [0.04, 0.05], [0.06, 0.05], [0.15, 0.05]])
    found = constants_at(scene, at)
    assert found.thickness.tolist() == [0.004, 0.006, 0.006, 0.003]
    assert found.young.tolist() == [5e7, 5e7, 5e6, 5e6]
    areas = 0.05 * 0.1, np.pi * 0.02**2
    plain = 0.2 * 0.1 - areas[0] - 0.5 * areas[1]
    assert mass_of(scene) == pytest.approx(
        1e3 * (0.004 * (areas[0] - 0.5 * areas[1]) + 0.006 * areas[1] + 0.003 * plain)
    )


def test_shares_of_a_cell_add_up_to_one():
    scene = scene_of(
        {"shape": ROOT, "young": 5e7}, {"shape": DISC, "young": 1e6}, {"shape": WEDGE, "poisson": 0.0}
    )
    x, y = np.linspace(0.0, 0.2, 8), np.linspace(0.0, 0.1, 4)
    parts = list(parts_between(scene, x, y))
    assert np.allclose(sum(part.share for part in parts), 1.0, rtol=0.0, atol=1e-12)
    wedge = sum(part.share * (part.constants.poisson == 0.0) for part in parts)
    assert wedge.sum() * (0.2 / 7) * (0.1 / 3) == pytest.approx(0.005)
    assert [side.tolist() for side in sides_of(scene)] == [[0.05], []]


def test_tapers_multiply():
    sheet = Sheet(0.2, 0.1, 0.003, taper_x=(0.003, 0.001), taper_y=(0.003, 0.006))
    assert sheet.thickness_at(np.array([0.0, 0.2, 0.2]), np.array([0.0, 0.0, 0.1])) == pytest.approx(
        [0.003, 0.001, 0.002]
    )
    assert mass_of(scene_of(taper_x=(0.003, 0.001))) == pytest.approx(1e3 * 0.2 * 0.1 * 0.002)


@pytest.mark.parametrize(("patch", "said"), [
    ({"shape": {"rectangle": {"x": (0.3, 0.4), "y": (0.0, 0.1)}}, "young": 1e6},
        "patch 1.shape: .*no part of it is on"),
    ({"shape": DISC}, "needs one of thickness, young, poisson, density, angle"),
    ({"shape": DISC, "thickness": 0.2}, r"patch 1.thickness = 0.2 m is more than"),
    ({"shape": {**ROOT, **DISC}, "young": 1e6}, "rectangle and circle: give one of"),
    ({"shape": {"rectangle": {"x": (0.05, 0.0), "y": (0.0, 0.1)}}, "young": 1e6}, r"x = \[0.05, 0\]"),
    ({"shape": {"polygon": [(0, 0), (0.1, 0.1), (0.1, 0.0), (0.0, 0.1)]}, "young": 1e6}, "sides cross"),
    ({"shape": DISC, "poisson": 0.5}, "must be less than 0.5"),
])  # fmt: skip
def test_what_is_no_patch_is_refused(patch, said):
    with pytest.raises(SceneError, match=said):
        scene_of(patch)


def test_a_taper_beside_the_thickness_is_refused():
    with pytest.raises(SceneError, match=r"taper_x = \[0.002, 0.001\] m: thickness = 0.003 m is not between"):
        Sheet(0.2, 0.1, 0.003, taper_x=(0.002, 0.001))
