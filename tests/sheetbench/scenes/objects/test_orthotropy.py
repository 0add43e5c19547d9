"""Orthotropic materials: their keys, what is left out of them, and which constants cannot be."""

import numpy as np
import pytest

from sheetbench.scenes import Material, Scene, SceneError, Sheet, load
from sheetbench.scenes.meaning.composition import constants_at

FIBRES = {"kind": "orthotropic", "young_1": 5e7, "young_2": 5e6, "poisson_12": 0.3, "shear_12": 3e6}
DISC = {"circle": {"centre": (0.05, 0.05), "radius": 0.02}}
GRAVITY = {"acceleration": (0.0, 0.0, -9.81)}
ROOT = {"rectangle": {"x": (0.0, 0.05), "y": (0.0, 0.1)}}


def scene_of(*patches, **material):
    own = {**FIBRES, "density": 1e3, **material}
    sheet = Sheet(0.2, 0.1, 0.003)
    return Scene(name="fibres", sheet=sheet, material=own, patches=patches, gravity=GRAVITY)


@pytest.mark.parametrize(("material", "said"), [
    ({"poisson_12": 3.2}, r"poisson_12 = 3.2: its square must be below young_1/young_2 = 10"),
    ({"shear_12": -1.0}, r"material.shear_12 = -1.0: must be greater than 0"),
    ({"young_2": None}, r"kind = 'orthotropic': young_2 missing; it takes young_1, young_2, "),
    ({"poisson_23": 0.99}, r"poisson_23 = 0.99: with .* some strain would give energy"),
    ({"young": 1e6}, r"young = 1e\+06: of an orthotropic material .* leave young out"),
    ({"law": "neo-hookean"}, r"law = 'neo-hookean': is of isotropic rubber"),
    ({"kind": "isotropic", "young": 1e6, "poisson": 0.3}, r"young_1 = 5e\+07: is of kind = 'orthotropic'"),
])  # fmt: skip
def test_constants_that_cannot_be_are_refused(material, said):
    with pytest.raises(SceneError, match=said):
        scene_of(**material)


@pytest.mark.parametrize(
    ("material", "patch", "said"),
    [
        (FIBRES, {"young": 1e6}, "patch 1.young = 1e\\+06: young and poisson together make"),
        ({"young": 1e6, "poisson": 0.3}, {"angle": 0.3}, "patch 1.angle = 0.3: is of a material of kind"),
    ],
)
def test_patches_of_another_kind_of_material_are_refused(material, patch, said):
    with pytest.raises(SceneError, match=said):
        Scene(
            name="fibres",
            sheet=Sheet(0.2, 0.1, 0.003),
            material={**material, "density": 1e3},
            patches=[{"shape": DISC, **patch}],
        )


def test_patches_turn_fibres_or_have_none():
    scene = scene_of({"shape": ROOT, "angle": 0.5}, {"shape": DISC, "young": 1e6, "poisson": 0.25})
    (ply,) = constants_at(scene, np.array([[0.01, 0.01], [0.05, 0.05], [0.15, 0.05]])).plies
    assert ply.angle.tolist() == [0.5, 0.0, 0.0]
    assert ply.young_1.tolist() == [5e7, 1e6, 5e7] and ply.young_2.tolist() == [5e6, 1e6, 5e6]
    assert ply.shear_12.tolist() == [3e6, 4e5, 3e6] == ply.shear_23.tolist()


def test_other_constants_scale_with_young(tmp_path):
    """√(E₁ E₂) stands for E where one number is wanted, and all moduli follow it."""
    material = Material(**FIBRES, density=1e3, angle="30 deg")
    assert material.young == pytest.approx((5e7 * 5e6) ** 0.5) and material.angle == pytest.approx(np.pi / 6)
    twice = material.replace(young=2.0 * material.young)
    assert (twice.young_1, twice.shear_12, twice.poisson_12) == (1e8, 6e6, 0.3)
    assert material.replace(young_1=2e8).young == pytest.approx(2.0 * material.young)


def test_a_file_says_what_an_object_does(tmp_path):
    scene = scene_of({"shape": ROOT, "angle": 0.5}, angle=0.1, shear_23=1e6)
    scene.save(tmp_path / "fibres.toml")
    assert load(tmp_path / "fibres.toml") == scene and not scene.uniform
