"""How a material damps: what is refused, one damper by a loss factor, and branches that keep it."""

import numpy as np
import pytest
from scene_files import GOOD, written

import lumped
from sheetbench import scenes
from sheetbench.scenes import Material, Relaxation, SceneError
from sheetbench.scenes.meaning.words import in_words


def series(*branches):
    return "\n".join(f"[[material.relaxation]]\nshare = {share}\ntime = {time}" for share, time in branches)


REFUSED = {
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


@pytest.mark.parametrize("fault", REFUSED)
def test_what_no_material_does_is_refused_by_key_and_value(tmp_path, fault):
    lines, named = REFUSED[fault]
    path = written(tmp_path, GOOD.replace("density = 1678.0", f"density = 1678.0\n{lines}"))
    with pytest.raises(SceneError) as caught:
        scenes.load(path)
    assert str(caught.value).startswith(f"{path}: material")
    for part in named:
        assert part in str(caught.value)


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
    assert 1e6 * material.branches.modulus(time) == pytest.approx(series, rel=1e-12)
    storage, _ = material.branches.storage_and_loss(1e6)
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
