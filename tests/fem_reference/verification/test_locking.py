"""Neither thin nor nearly incompressible sheets lock: fixed 8 × 8 meshes beside converged ones."""

import pytest
from cases import with_material

import fem_reference
from fem_reference.verification import verify
from fem_reference.verification.square_plates import deflection
from sheetbench import scenes
from sheetbench.answers.solution import Status


@pytest.mark.sweep(2)
@pytest.mark.parametrize(
    ("model", "count", "within"),
    [("shell", 7, 0.02), ("plate", 7, 0.02), pytest.param("solid", 20, 0.01, marks=pytest.mark.slow)],
)
def test_thin_to_thick_and_to_incompressible_within_2_percent(model, count, within):
    """h/a from 1e-5 to 0.2; of the solid ν to 0.4999 too, within 1 %."""
    rows = verify(f"locking-{model}").rows
    assert len({row.quantity for row in rows}) == len(rows) == count
    assert max(row.relative or 0.0 for row in rows) < within
    assert all(row.passed for row in rows)


@pytest.mark.sweep(2)
@pytest.mark.parametrize("poisson", [0.4999, 0.48])
def test_solid_within_1_percent_at_the_seeds_slenderness(poisson):
    coarse, fine = (deflection("solid", "clamped", 3 / 188, n, poisson) for n in (8, 12))
    assert coarse == pytest.approx(fine, rel=0.01)


@pytest.mark.sweep(2)
@pytest.mark.parametrize("elements", [24, 16])
def test_stretched_elements_that_bend_stay_stable(elements):
    """The soft sheet, whose lowest ω² on all meshes is 110 s⁻²; with the twist k_rs projected on bilinear
    functions too, elements of sides 10 to 20 : 1 gave its tangent a negative eigenvalue from 22 on."""
    scene = scenes.load("one-edge-clamped")
    young = scene.material.young / 10.0
    scene = with_material(scene, young=young)
    answer = fem_reference.solve(scene, model="shell", elements=elements)
    assert answer.status is Status.CONVERGED
    assert answer.message == "" and answer.settings["graded"]
    tip = answer.displacement([scene.probes["P4"]])[0]
    assert tip == pytest.approx([-0.1067945, 1.204e-5, -0.1571709], abs=5e-7)


@pytest.mark.sweep(2)
@pytest.mark.parametrize(("elements", "within"), [(8, 0.03), (16, 2e-3)])
def test_a_thin_sheet_far_from_flat_does_not_lock(elements, within):
    """h/a = 1/627, deflected by 170 h; with the membrane's rs as it stands 0.14 and 1.7e-2 off."""
    scene = scenes.load("two-edges-clamped")
    thin = {"sheet": scene.sheet.model_copy(update={"thickness": 3e-4})}
    thin["material"] = scene.material.model_copy(update={"young": 545e6})
    answer = fem_reference.solve(scene.model_copy(update=thin), model="shell", elements=elements)
    assert answer.status is Status.CONVERGED
    tip = answer.displacement([(0.188, 0.188)])[0]
    assert tip == pytest.approx([-7.540e-3, -7.540e-3, -5.0455e-2], abs=within * 5.0455e-2)
