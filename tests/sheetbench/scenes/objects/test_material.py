"""Rubber in a scene: laws, the small strains that their constants mean, and what is refused."""

import numpy as np
import pytest
from rubbers import LAWS, rubber, stored
from scene_files import GOOD, SPRINGS, refusal

import lumped
from sheetbench import scenes
from sheetbench.scenes import Material, Relaxation, Scene, SceneError, Sheet
from sheetbench.scenes.meaning.composition import constants_at
from sheetbench.scenes.meaning.words import in_words


@pytest.mark.parametrize("law", LAWS)
def test_young_and_poisson_are_those_of_the_energy_at_small_strains(law):
    material, h = rubber(law, 0.4), 1e-3
    steps = h * np.eye(3)

    def second(i, j):
        signs = [(1, 1), (1, -1), (-1, 1), (-1, -1)]
        return sum(a * b * stored(material, 1.0 + a * steps[i] + b * steps[j]) for a, b in signs) / (
            4 * h * h
        )

    lame, both = second(0, 1), second(0, 0)
    shear = 0.5 * (both - lame)
    # a central difference: h² of the fourth derivatives, here up to 30 times the second ones
    assert lame / (2.0 * (lame + shear)) == pytest.approx(0.4, rel=1e-4)
    assert 2.0 * shear * 1.4 == pytest.approx(material.young, rel=1e-4)


@pytest.mark.parametrize("law", LAWS)
def test_constants_follow_young_and_young_follows_constants(law):
    stiffer = rubber(law).replace(young=2e6)
    assert stiffer.young == pytest.approx(2e6, rel=1e-12)
    assert stiffer.energy.c20 / stiffer.energy.c10 == pytest.approx(
        rubber(law).energy.c20 / rubber(law).energy.c10
    )
    assert stiffer.limit == rubber(law).limit
    for key, value in LAWS[law].items():
        assert getattr(rubber(law).replace(**{key: 2.0 * value}), key) == 2.0 * value
    assert rubber(law).replace(law="neo-hookean").energy.c20 == 0.0


REFUSED = {
    "material: c1 = 1: law is missing": {"young": 1e6, "c1": 1.0},
    "material: c1 = 1: law = 'gent' takes shear and limit": {"law": "gent", **LAWS["gent"], "c1": 1.0},
    "material: law = 'yeoh': c3 is missing": {"law": "yeoh", "c1": 1.0, "c2": 1.0},
    "make it 952000 Pa at small strains; leave young out": {
        "law": "mooney-rivlin", **LAWS["mooney-rivlin"], "young": 1e6},
    "poisson = 0.4: with law = 'gent' shear = 340000, limit = 0.1 it must be 0.476 or more": {
        "law": "gent", "shear": 3.4e5, "limit": 0.1},
    "the shear modulus at small strains is -20000 Pa": {"law": "mooney-rivlin", "c1": 1e4, "c2": -2e4},
    "c2 = -20000: the stress turns negative, pulled both ways beyond a stretch of 2.24; c2 must be 0": {
        "law": "mooney-rivlin", "c1": 1e5, "c2": -2e4},
    "c3 above 333.333 Pa": {"law": "yeoh", "c1": 1e5, "c2": -1e4, "c3": 300.0},
    "material.limit = -1.0: must be greater than 0": {"law": "gent", "shear": 3.4e5, "limit": -1.0},
    "material.law = 'ogden'": {"law": "ogden", "young": 1e6},
    "material.law": {"law": [1], "young": 1e6},
    "material.c10: laws of rubber are": {"young": 1e6, "c10": 1.0},
    "springs: of a material with law = 'gent' they are calibrated; leave one out": {
        "law": "gent", **LAWS["gent"], "springs": SPRINGS},
}  # fmt: skip


@pytest.mark.parametrize("said", REFUSED)
def test_constants_that_make_no_rubber_are_refused_with_file_key_and_value(said, tmp_path):
    material = {"poisson": 0.4, "density": 1000.0, **REFUSED[said]}
    springs = material.pop("springs", "")
    lines = [f"{key} = {value!r}" for key, value in material.items()]
    before = "[sheet]\nlength_x = 0.1\nlength_y = 0.1\nthickness = 0.001\n"
    assert said in refusal(
        tmp_path, f'name = "a"\n{before}[material]\n' + "\n".join([*lines, springs]) + "\n"
    )


FIBRES = {"kind": "orthotropic", "young_1": 5e7, "young_2": 5e6, "poisson_12": 0.3, "shear_12": 3e6}
DISC = {"circle": {"centre": (0.05, 0.05), "radius": 0.02}}
GRAVITY = {"acceleration": (0.0, 0.0, -9.81)}
ROOT = {"rectangle": {"x": (0.0, 0.05), "y": (0.0, 0.1)}}


def scene_of(*patches, **material):
    own = {**FIBRES, "density": 1e3, **material}
    sheet = Sheet(0.2, 0.1, 0.003)
    return Scene(name="fibres", sheet=sheet, material=own, patches=patches, gravity=GRAVITY)


ISOTROPIC = {**dict.fromkeys(FIBRES), "kind": "isotropic", "young": 1e6, "poisson": 0.3}


@pytest.mark.parametrize(("material", "patches", "said"), [
    ({"poisson_12": 3.2}, (), r"poisson_12 = 3.2: its square must be below young_1/young_2 = 10"),
    ({"shear_12": -1.0}, (), r"material.shear_12 = -1.0: must be greater than 0"),
    ({"young_2": None}, (), r"kind = 'orthotropic': young_2 missing; it takes young_1, young_2, "),
    ({"poisson_23": 0.99}, (), r"poisson_23 = 0.99: with .* some strain would give energy"),
    ({"young": 1e6}, (), r"young = 1e\+06: an orthotropic material has .* leave young out"),
    ({"law": "neo-hookean"}, (), r"law = 'neo-hookean': for isotropic rubber"),
    ({"kind": "isotropic", "young": 1e6, "poisson": 0.3}, (), r"_1 = 5e\+07: for kind = 'orthotropic'"),
    ({}, [{"shape": DISC, "young": 1e6}], "patch 1.young = 1e\\+06: young and poisson together make"),
    (ISOTROPIC, [{"shape": DISC, "angle": 0.3}], "patch 1.angle = 0.3: for a material of kind"),
])  # fmt: skip
def test_constants_that_cannot_be_are_refused(material, patches, said):
    with pytest.raises(SceneError, match=said):
        scene_of(*patches, **material)


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


def series(*branches):
    return "\n".join(f"[[material.relaxation]]\nshare = {share}\ntime = {time}" for share, time in branches)


DAMPERS_REFUSED = {
    "shares of 1": (series((0.6, 0.1), (0.4, 0.2)), ["shares add up to 1"]),
    "a share of 1.2": (series((1.2, 0.1)), ["material.relaxation 1.share = 1.2", "less than 1"]),
    "no time": (series((0.1, 0.0)), ["material.relaxation 1.time = 0", "greater than 0"]),
    "times that fall": (series((0.1, 0.2), (0.1, 0.1)), ["times must increase", "0.2, 0.1 s"]),
    "two dampers": ("loss_factor = 0.1\nfrequency = 5.0\ndamping_time = 0.01", ["and damping_time"]),
    "a loss factor alone": ("loss_factor = 0.1", ["loss_factor = 0.1", "frequency", "band"]),
    "a frequency alone": ("frequency = 5.0", ["frequency", "loss_factor"]),
    "a band backwards": ("loss_factor = 0.1\nband = [20.0, 1.0]", ["band = [20, 1] Hz", "higher"]),
    "too wide a band": ("loss_factor = 0.1\nband = [1.0, 1e8]", ["8 decades", "6 at most"]),
    "too lossy a band": ("loss_factor = 2.0\nband = [1.0, 10.0]", ["band = [1, 10] Hz", "2 branches"]),
}


@pytest.mark.parametrize("fault", DAMPERS_REFUSED)
def test_what_no_material_does_is_refused_by_key_and_value(tmp_path, fault):
    lines, named = DAMPERS_REFUSED[fault]
    said = refusal(tmp_path, GOOD.replace("density = 1678.0", f"density = 1678.0\n{lines}"))
    assert said.startswith("material") and all(part in said for part in named)


@pytest.mark.parametrize("loss_factor", [0.02, 0.12, 0.5])
@pytest.mark.parametrize("band", [(4.0, 6.0), (1.0, 20.0), (0.001, 1000.0)])
def test_branches_keep_a_loss_factor_over_a_band(loss_factor, band):
    """Two a decade: within 10 % where the branches are not the ones that were fitted at."""
    branches = Material(1e6, 0.48, 1100.0, loss_factor=loss_factor, band=band).branches
    assert len(branches.times) == max(2, np.ceil(2 * np.log10(band[1] / band[0]) - 1e-9))
    storage, loss = branches.storage_and_loss(np.geomspace(*band, 777))
    assert loss / storage == pytest.approx(loss_factor, rel=0.1)


def test_one_damper_has_the_loss_factor_at_its_frequency():
    material = Material(1e6, 0.48, 1100.0, loss_factor=0.12, frequency=5.0)
    assert 2.0 * np.pi * 5.0 * material.dashpot_time == pytest.approx(0.12)


def test_a_relaxing_modulus_is_its_prony_series():
    """E(t) by the shares of E₀ = E∞/(1 − Σ g); its transform ω∫E sin ωt is E'."""
    material = Material(1e6, 0.48, 1e3, relaxation=(Relaxation(0.2, 0.05), Relaxation(0.3, 1.0)))
    time = np.array([0.0, 0.1, 50.0])
    series = 2e6 * (1.0 - 0.2 * (1.0 - np.exp(-time / 0.05)) - 0.3 * (1.0 - np.exp(-time)))
    branches = material.branches
    relaxing = np.exp(-np.divide.outer(time, branches.times)) @ branches.stiffness
    assert 1e6 * (1.0 + relaxing) == pytest.approx(series, rel=1e-12)
    storage, _ = branches.storage_and_loss(1e6)
    assert storage == pytest.approx(2.0, rel=1e-6)


def test_a_scene_with_branches_is_kept_in_files_and_solved_at_rest(tmp_path):
    scene = scenes.load("one-edge-clamped")
    relaxing = scene.replace(relaxation=(Relaxation(0.2, 0.05), Relaxation(0.3, 1.0)))
    relaxing.save(tmp_path / "kept.toml")
    assert scenes.load(tmp_path / "kept.toml") == relaxing
    springs = lumped.calibrate(scene.sheet, relaxing.material, (4, 4))
    assert springs.springs == lumped.calibrate(scene.sheet, scene.material, (4, 4)).springs
    (said,) = (text for part, text in in_words(relaxing) if part == "material")
    assert "54.5 MPa" in said and "109 MPa at once" in said


def test_what_has_no_branches_refuses_them_by_name():
    scene = scenes.load("one-edge-clamped").replace(loss_factor=0.1, band=(1.0, 20.0))
    with pytest.raises(scenes.BadInput, match=r"material\.band: a linear system.*frequency"):
        lumped.linearise(scene, lumped.calibrate(scene.sheet, scene.material, (3, 3)))
