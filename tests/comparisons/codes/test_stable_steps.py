"""An exported lattice moved by a loop of one's own, with the files alone: the steps and damping it says."""

import json
import runpy

import numpy as np
import pytest
from cases import calibrated
from exported import READERS, SCENES

import lumped
from comparisons.codes.lattice import export
from lumped.dynamics.explicit.stable_steps import LOOPS, limit_of
from sheetbench.scenes import load

NUMPY = runpy.run_path(str(READERS / "read_lattice.py"))
SEEDS = {"seed": "two-edges-clamped", "settling": "two-edges-settling"}
MOVED = ("settling", "graded", "mooney-rivlin", "gent", "hinged", "woven", "skew", "muscles", "uniform")


def case(name):
    """A scene and its springs."""
    if name in SEEDS:
        scene = load(SEEDS[name])
        return scene, calibrated(scene, 4, method="consistent")
    scene, settings = SCENES[name]
    return scene, calibrated(scene, **settings)


def test_stable_steps_are_the_closed_forms():
    """Undamped 2/ω; of symplectic Euler 2/ω (√(1 + ξ²) − ξ), of Verlet at c h = 4 where damping is all."""
    omega, ratio = 100.0, np.array([0.1, 0.5, 2.0, 100.0])
    for loop in LOOPS:
        assert omega * limit_of(loop, omega) == pytest.approx(2.0, rel=1e-3)
    for xi, law in zip(ratio, 2.0 * (np.sqrt(1.0 + ratio**2) - ratio), strict=True):
        for rate in (0.0, 2.0 * xi * omega, None):
            found = omega * limit_of("symplectic_euler", omega, 2.0 * xi * omega, rate)
            assert found == pytest.approx(law, rel=2e-3)
    assert omega * limit_of("velocity_verlet", omega, 400.0 * omega) == pytest.approx(0.01, rel=1e-3)


def resistance(lattice, along, u, v):
    """Force (n, 3) [N] of the dampers, as the README has it, and the drag of the masses."""
    x, dot = lattice["positions"] + u, NUMPY["dot"]
    r, c = along["link"] @ x, lattice["link_damping"][:, None]
    force = along["link"].T @ (c * dot(r, along["link"] @ v) / dot(r, r) * r)
    for kind in ("area", "strain", "coupling"):
        c, a0, (over_a, over_b) = lattice[f"{kind}_damping"], lattice[f"{kind}_rest"][:, None], along[kind]
        a, b, da, db = over_a @ x, over_b @ x, over_a @ v, over_b @ v
        if kind == "area":
            n = np.cross(a, b) / np.linalg.norm(np.cross(a, b), axis=1, keepdims=True)
            turned = c[:, None] * dot(n, np.cross(da, b) + np.cross(a, db)) / a0 * n
            force += over_a.T @ np.cross(b, turned) + over_b.T @ np.cross(turned, a)
            continue
        aa, bb, _ = np.hsplit(lattice[f"{kind}_natural"], 3)
        rates = np.hstack([dot(a, da) / aa, dot(b, db) / bb, (dot(da, b) + dot(a, db)) / a0])
        t = c * rates
        if kind == "coupling":
            t = c[:, [0, 0, 1]] * rates[:, [1, 0, 0]] + c[:, [1, 2, 2]] * rates[:, [2, 2, 1]]
        t1, t2, t3 = np.hsplit(t, 3)
        force += over_a.T @ (t1 * a0 / aa * a + t3 * b) + over_b.T @ (t2 * a0 / bb * b + t3 * a)
    return force + lattice["damping_rate"] * lattice["mass"][:, None] * v


def growth(folder, loop, share, steps):
    """How many times the first speeds the last are, from the equilibrium with speeds drawn at random."""
    lattice = dict(np.load(folder / "lattice.npz"))
    along, mass = NUMPY["differences"](lattice), lattice["mass"][:, None]
    rows = np.zeros((len(lattice["hold_axis"]), *mass.shape[:1], 3))
    for row, masses, axis in zip(rows, lattice["hold_masses"], lattice["hold_axis"], strict=True):
        np.add.at(row[:, axis], masses, 1.0 / len(masses))
    rows = rows.reshape(len(rows), -1)
    over = rows / np.repeat(mass, 3)  # M^-1 G^T, transposed
    inner = np.linalg.pinv(over @ rows.T)

    def free(motion):
        """Without what supports take."""
        return motion - (over.T @ (inner @ (rows @ motion.ravel()))).reshape(-1, 3)

    u, at = lattice["state_displacement"][-1], lattice["state_force"][-1]

    def acceleration(x, v):
        return free((at - NUMPY["gradient"](lattice, along, x)[1] - resistance(lattice, along, x, v)) / mass)

    v = free(1e-6 * np.random.default_rng(1).standard_normal(u.shape))
    first, h = np.abs(v).max(), share * float(lattice[f"{loop}_step"])
    for _ in range(steps):
        u, v = LOOPS[loop](u, v, h, acceleration)
        if not np.abs(v).max() < 1e3 * first:
            return np.inf
    return np.abs(v).max() / first


@pytest.mark.sweep(3)
@pytest.mark.parametrize("loop", LOOPS)
@pytest.mark.parametrize("name", ["seed", *MOVED, "table"])
def test_a_loop_of_ones_own_is_stable_at_the_step_that_is_said_and_not_at_more(tmp_path, name, loop):
    """With the files alone: at it, and at 1.2 times no longer; in contact a bound."""
    export(tmp_path, *case(name))
    said = json.loads((tmp_path / "motion.json").read_text())
    assert said["largest_step"][loop] == np.load(tmp_path / "lattice.npz")[f"{loop}_step"]
    assert growth(tmp_path, loop, 1.0, 200) < 20.0
    assert said["exact"] == (name != "table")
    if said["exact"]:
        assert growth(tmp_path, loop, 1.2, 200) == np.inf


def test_the_lowest_mode_is_critically_damped_at_the_rate_that_is_said(tmp_path):
    """A strip's first mode in the loop's masses, with that drag alone: λ² + c λ + ω² has one root."""
    scene, springs = case("uniform")
    export(tmp_path, scene, springs)
    said = json.loads((tmp_path / "motion.json").read_text())
    lowest = 2.0 * np.pi * lumped.modes(scene, springs, 1, springs.masses).frequencies[0]
    assert said["critical_damping_rate"] ** 2 == pytest.approx(4.0 * lowest**2)
    page = (tmp_path / "README.md").read_text(encoding="utf-8")
    assert f"{said['critical_damping_rate']:.4g} 1/s × mass" in page and "symplectic Euler" in page
