"""Loads over time: what is refused, forces and tangents at a time, motion against solve_ivp."""

import numpy as np
import pytest
from dynamic_cases import make_scene, springs, system
from lattice_cases import ALL, MATERIAL, SHEET, assembly_of, dense, derivative, state
from scene_files import refusal
from scipy.integrate import solve_ivp

import lumped
from lumped.loads import Loads
from sheetbench import scenes
from sheetbench.answers.solution import Status
from sheetbench.scenes import Clamped, EdgeLoad, FactorTable, Pressure, Scene

TIP = (0.188, 0.094)
RAMP = {"time": [0.0, 0.02, 0.05], "factor": [0.0, 1.0, -0.4]}


def largest(values):
    return float(np.abs(values).max())


@pytest.mark.parametrize(
    "history, said",
    [
        ("{time = [0.0, 1.0], factor = [1.0]}", "history: 2 times but 1 in factor"),
        ("{time = [0.0, 0.0], factor = [0.0, 1.0]}", "history: times must increase"),
        ("{time = [], factor = []}", "history.time = []"),
        ("{time = [0.0]}", "history.factor: missing"),
        ('{time = [0.0], factor = ["full"]}', "history.factor 1 = 'full'"),
        ("{time = [0.0], factor = [inf]}", "history.factor 1 = inf"),
        ("{time = [0.0], factor = [1.0], value = [1.0]}", "history.value = [1.0]: unknown key"),
        ("3.0", "history = 3.0"),
    ],
)
@pytest.mark.parametrize("of", ["gravity", "load 1"])
def test_bad_histories_are_refused_in_one_line(tmp_path, history, said, of):
    text = scenes.catalogue()["one-edge-clamped"].read_text(encoding="utf-8")
    if of == "gravity":
        text = text.replace("[gravity]", f"[gravity]\nhistory = {history}")
    else:
        load = f'[[load]]\nkind = "pressure"\nvalue = 1.0\nhistory = {history}\n'
        text = text.replace("[probes]", load + "[probes]")
    assert f"{of}.{said}" in refusal(tmp_path, text)


@pytest.mark.parametrize(
    "time, factors, grid",
    [(-1.0, (2.0, 1.0), (3, 4, 2)), (0.05, (0.5, 0.0), (3, 4, 2)), (9.0, (-4.0, -1.0), (3, 3, 3))],
)
def test_forces_and_tangents_at_a_time(time, factors, grid):
    """Factors before, between and after the samples, of two histories beside loads with none."""
    first = FactorTable(time=(0.0, 0.1, 0.2), factor=(2.0, -1.0, -4.0))
    second = FactorTable(time=(0.0, 0.1), factor=(1.0, -1.0))
    assembly = assembly_of(grid, **ALL)
    u = state(assembly)

    def of(pressure, moment, **histories):
        loads = (
            Pressure(value=30.0 * pressure, history=histories.get("first")),
            EdgeLoad(
                edge="x1",
                moment_per_length=2.0 * moment,
                force_per_length=(0.0, 3.0 * moment, moment),
                history=histories.get("second"),
            ),
            EdgeLoad(edge="y0", moment_per_length=1.0, force_per_length=(0.0, 0.0, 1.0)),
        )
        return Loads(Scene("s", SHEET, MATERIAL, supports=(Clamped(edge="x0"),), loads=loads), assembly)

    changing, still = of(1.0, 1.0, first=first, second=second), of(*factors)
    assert not changing.potential and not changing.conservative
    force = changing.force(u, time)
    assert force == pytest.approx(still.force(u), rel=1e-12, abs=1e-14)
    blocks = np.zeros((assembly.pattern.blocks, 3, 3))
    changing.add_tangent(u, 0.7, blocks, time)
    numeric = -0.7 * derivative(lambda v: changing.force(v, time), u)
    assert np.allclose(dense(assembly, blocks), numeric, atol=1e-6 * largest(numeric))


def test_loads_without_a_history_are_one_constant_array():
    equations, rest = system(make_scene(loads=[{"kind": "point", "at": TIP, "force": [0.0, 0.0, 0.1]}]))
    loads = equations.problem.loads
    assert loads.potential and not equations.nonconservative
    assert loads.force(rest.u, 0.3) is loads.dead


@pytest.fixture(scope="module")
def reference():
    """The tip of a 3 × 3 × 2 cantilever under a ramped force, M ü + f_int(u) = f(t) by hand."""
    pull = {"kind": "point", "at": TIP, "force": (0.0, 0.02, 0.1), "history": RAMP}
    scene = make_scene("one-edge-clamped", gravity=False, loads=[pull])
    equations, _ = system(scene, 3)
    lattice, mass = equations.assembly.lattice, equations.lattice_mass
    free = np.flatnonzero(lattice.positions[:, 0] > 0.0)
    pulled = np.flatnonzero(np.abs(lattice.positions[:, :2] - TIP).max(axis=1) < 1e-12)
    assert len(pulled) == 2
    force = np.zeros((lattice.mass_count, 3))
    force[pulled] = np.array([0.0, 0.02, 0.1]) / 2.0

    def rate(time, y):
        u = np.zeros_like(force)
        u[free] = y[: 3 * len(free)].reshape(-1, 3)
        pull = np.interp(time, RAMP["time"], RAMP["factor"]) * force - equations.assembly.force(u)[1]
        return np.concatenate([y[3 * len(free) :], (pull[free] / mass[free, None]).ravel()])

    times, found = np.linspace(0.0, 0.08, 41), [np.zeros((1, 6 * len(free)))]
    for begin, end in ((0.0, 0.02), (0.02, 0.05), (0.05, 0.08)):  # no kink within an integration
        at = times[(times > begin + 1e-9) & (times < end + 1e-9)]
        part = solve_ivp(rate, (begin, end), found[-1][-1], "DOP853", at, rtol=1e-9, atol=1e-12)
        found.append(part.y.T)
    moved = np.concatenate(found)[:, : 3 * len(free)].reshape(len(times), -1, 3)
    tip = moved[:, np.isin(free, pulled)].mean(axis=1)
    return scene, times, tip


@pytest.mark.sweep(2)
@pytest.mark.parametrize(
    "name, step", [("verlet", None), ("generalised-alpha", None), ("esdirk", None), ("midpoint", 2e-4)]
)
def test_a_ramped_force_moves_the_cantilever_as_solve_ivp_says(reference, name, step):
    scene, times, truth = reference
    history = lumped.simulate(scene, springs(scene, 3), 0.08, integrator=name, step=step, every=0.002)
    assert history.status is Status.CONVERGED
    assert history.time == pytest.approx(times)
    assert largest(history.probes["P3"] - truth) < 1e-3 * largest(truth)  # measured below 1e-4
