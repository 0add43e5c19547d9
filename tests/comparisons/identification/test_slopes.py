"""Fits by derivatives of one solution against fits by differences, and fields over the cells."""

from dataclasses import replace

import numpy as np
import pytest
from cases import POINTS

import fem_reference
import lumped
from comparisons.identification.identification import identify
from comparisons.identification.measurements import Displacements
from comparisons.models.solve import solve
from comparisons.models.spec import Lattice
from sheetbench import scenes
from sheetbench.errors import BadInput
from sheetbench.scenes import PointLoad

SCENE, CANTILEVER = scenes.load("two-edges-clamped"), scenes.load("one-edge-clamped")
DAMPED = CANTILEVER.replace(loss_factor=0.12, frequency=3.0)


def noisy(values, seed, share):
    """With noise of a share of the largest displacement."""
    noise = np.random.default_rng(seed).normal(scale=share * np.abs(values).max(), size=values.shape)
    return values + noise


def test_derivatives_of_a_shell_spare_its_solves(monkeypatch):
    """Of four unknowns at least half, and what is found is the same."""
    scene = CANTILEVER.replace(loads=(PointLoad(at=(0.188, 0.094), force=(0.0, 0.05, 0.0)),))
    values = fem_reference.solve(scene, elements=3).displacement(POINTS)
    guess, names = scene.replace(young=5e7, poisson=0.4), ["E", "nu", "load1.force.y", "tilt_x0"]
    found, solved = [], []
    for exact in (True, False):

        def counted(model, exact=exact):
            solved[-1:] = [solved[-1] + 1]
            answer = solve(model)
            return answer if exact else replace(answer, sensitivity=None)

        monkeypatch.setattr("comparisons.identification.model.solve", counted)
        solved.append(0)
        data = Displacements(POINTS, noisy(values, 1, 1e-3))
        found.append(identify(guess, data, names, model="shell", elements=3, refine=False))
    assert found[0].converged and 2 * solved[0] <= solved[1]
    for one, other in zip(*(each.unknowns.values() for each in found), strict=True):
        assert one.value == pytest.approx(other.value, rel=1e-4)
        assert one.interval == pytest.approx(other.interval, rel=1e-3)


def test_a_field_over_the_cells_is_smoothed_until_noise_is_left(tmp_path):
    """E that rises along the diagonal by half; less noise tells more numbers, and resolves finer."""
    sheet, rng = lumped.Differentiable(SCENE), np.random.default_rng(1)
    rise = 1.0 + (np.arange(8) + np.arange(8)[:, None]) / 28.0
    u = sheet.solve({"cells.young": rise * sheet.base["cells.young"]})
    values = (sheet.at(POINTS) @ u.ravel()).reshape(-1, 3)
    told = []
    for share in (1e-3, 1e-4):
        noise = share * np.abs(values).max()
        data = Displacements(POINTS, values + noise * rng.standard_normal(values.shape))
        found = identify(SCENE, data, "material.young=field", Lattice((9, 9, 2)), uncertainty=noise)
        assert found.converged and found.chi == pytest.approx(1.0, abs=0.02)
        told.append((found.determined, -np.median(found.resolved)))
    assert told[0] < told[1]
    off = np.abs(found.values / (rise * SCENE.material.young) - 1.0)
    assert off.mean() < 0.05 < np.abs(rise / rise.mean() - 1.0).mean()
    found.save(tmp_path)
    assert (tmp_path / "identification.png").exists() and "χ²/n = 1.00" in repr(found)
    deviated = replace(data, deviation=np.full(len(POINTS), noise))
    for names, given, said in (
        ("young=field", data, "give --uncertainty"),
        ("poisson=field", deviated, "choose one of young"),
        ("young=field,density", deviated, "a field is the only unknown"),
    ):
        with pytest.raises(BadInput, match=said):
            identify(SCENE, given, names, Lattice(9))


@pytest.mark.nightly
def test_one_run_has_the_derivatives_of_a_motion(monkeypatch):
    """In a quarter of the runs of differences at most, and what is found is the same."""
    springs = lumped.calibrate(DAMPED.sheet, DAMPED.material, (4, 4))
    run = lumped.simulate(DAMPED, springs, 0.1, every=5e-3, error=1e-7)
    seen = noisy(run.probes["P4"][1:], 3, 2e-3)
    measured = Displacements(np.tile(DAMPED.probes["P4"], (20, 1)), seen, run.time[1:])
    guess, found, runs_made, simulate = DAMPED.replace(young=50e6), [], [], lumped.simulate

    def counted(*given, **options):
        runs_made[-1] += 1
        return simulate(*given, **options)

    monkeypatch.setattr(lumped, "simulate", counted)
    for by_differences in (False, True):
        if by_differences:
            monkeypatch.setattr("comparisons.identification.model.OF_SUPPORTS", ("",))
        runs_made.append(0)
        found.append(identify(guess, measured, ["young", "loss_factor"], Lattice((4, 4, 2))).unknowns)
    assert 4 * runs_made[0] <= runs_made[1]
    for one, other in zip(*(each.values() for each in found), strict=True):
        assert one.interval == pytest.approx(other.interval, rel=1e-3)
