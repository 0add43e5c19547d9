"""Strains beyond the model: one rule, with the last of the weight, in every model."""

import numpy as np
import pytest
from cases import OBLONG
from dynamic_cases import springs

import fem_reference
import lumped
from sheetbench.answers.solution import Status
from sheetbench.scenes import (
    Clamped,
    EdgeLoad,
    FactorTable,
    Gravity,
    Material,
    Scene,
    outside_model,
    weight_strain,
)

SOFT = Material(young=5e3, poisson=0.3, density=1000.0)


def solved(scene, model, **options):
    if model == "lumped":
        return lumped.solve(scene, springs(scene))
    return fem_reference.solve(scene, model=model, elements=4, **options)


def hanging(last):
    """ρ g a/E = 0.39 × the last factor of the weight's history."""
    history = FactorTable(time=(0.0, 1.0), factor=(1.0, last))
    gravity = Gravity(acceleration=(9.81, 0.0, 0.0), history=history)
    return Scene(name="s", sheet=OBLONG, material=SOFT, gravity=gravity, supports=(Clamped(edge="x0"),))


def test_the_weight_strain_is_that_of_the_last_factor():
    assert weight_strain(hanging(-0.5)) == pytest.approx(0.5 * 1000.0 * 9.81 * 0.2 / 5e3)
    assert weight_strain(hanging(1.0).model_copy(update={"gravity": None})) == 0.0
    assert outside_model(hanging(0.12), 0.5) == ""
    assert outside_model(hanging(0.13), 0.0, "link strain") == "ρ g a/E = 0.051, link strain 0"
    assert "stretched by 0.6" in outside_model(hanging(0.0), 0.6)


@pytest.mark.parametrize("model", ["lumped", "plate", "shell", "solid"])
def test_every_model_judges_the_weight_alike(model):
    light, heavy = solved(hanging(1e-3), model), solved(hanging(0.2), model)
    assert light.status is Status.CONVERGED
    assert heavy.status is Status.STRAIN_OUTSIDE_MODEL and "ρ g a/E = 0.0785" in heavy.message
    assert heavy.load_factor == 1.0 and heavy.comparable


@pytest.mark.parametrize("model", ["lumped", "plate", "shell", "solid"])
def test_every_model_sees_that_it_is_stretched_by_more_than_half(model):
    """ν = 0 and a pull along x: E = 1.3, so that 1 + stretch is the root of q = E h (s + 3 s²/2 + s³/2)."""
    material = Material(young=5e4, poisson=0.0, density=1000.0)
    for stretch, outside in ((0.4, False), (0.6, True)):
        pull = stretch if model == "plate" else stretch + 1.5 * stretch**2 + 0.5 * stretch**3
        force = pull * material.young * OBLONG.thickness
        if model == "lumped":
            force = stretch * material.young * OBLONG.thickness
        pull = EdgeLoad(edge="x1", force_per_length=(force, 0.0, 0.0))
        scene = Scene("s", OBLONG, material, supports=(Clamped(edge="x0"),), loads=(pull,))
        found = solved(scene, model)
        end = found.displacement(np.array([[0.2, 0.05]]))[0, 0] / 0.2
        assert end == pytest.approx(stretch, rel=0.05)
        assert found.status is (Status.STRAIN_OUTSIDE_MODEL if outside else Status.CONVERGED)


def test_a_law_for_large_strains_is_not_judged_as_a_linear_one():
    assert solved(hanging(0.2), "solid", law="neo-hookean").status is Status.CONVERGED


def made_of(young=200e9, **changed):
    """A sheet under its weight, of a stiff material unless layers or patches have their own."""
    material = {"young": young, "poisson": 0.3, "density": 1000.0}
    gravity = {"acceleration": [0.0, 0.0, -9.81]}
    sheet = {"length_x": 1.0, "length_y": 1.0, "thickness": 0.08}
    scene = {"name": "made", "sheet": sheet, "material": material, "gravity": gravity} | changed
    return Scene.model_validate(scene | {"support": [{"kind": "clamped", "edge": "x0"}]})


def test_the_weight_strain_is_that_of_the_layers_and_patches():
    """One soft sheet written in three ways, and a laminate of two plies: the mean density over the mean E."""
    soft = {"young": 1e5, "poisson": 0.3}
    alone = weight_strain(made_of(1e5))
    layers = [{"thickness": 0.08, **soft}]
    everywhere = {"rectangle": {"x": [0.0, 1.0], "y": [0.0, 1.0]}}
    assert alone == pytest.approx(9.81e-2)
    assert weight_strain(made_of(layer=layers)) == pytest.approx(alone)
    patches = [{"shape": everywhere, "young": 1e5}]
    assert weight_strain(made_of(patch=patches)) == pytest.approx(alone)
    heavy = {"thickness": 0.02, "young": 3e5, "poisson": 0.3, "density": 3000.0}
    three = weight_strain(made_of(layer=[heavy, {"thickness": 0.04, **soft}, heavy]))
    assert three == pytest.approx(2000.0 * 9.81 / 2e5)


def test_a_soft_layer_over_a_stiff_material_is_outside_the_model():
    layers = [{"thickness": 0.08, "young": 1e5, "poisson": 0.3}]
    scene = made_of(layer=layers)
    for found in (lumped.solve(scene), solved(scene, "shell")):
        assert found.status is Status.STRAIN_OUTSIDE_MODEL
