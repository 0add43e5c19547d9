"""What ends a run early says its status, the place on the sheet, and what to change."""

import cases
import numpy as np
import pytest
from dynamic_cases import springs

import fem_reference
import lumped
from comparisons.comparison.branches import shape
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.surface.mesh import rectangle
from lumped.dynamics.implicit.esdirk import Esdirk
from lumped.dynamics.integrator import LatticeSamples
from lumped.dynamics.runs.observer import LatticeObserver
from lumped.dynamics.system import State
from lumped.statics import faults
from lumped.statics.solver import build_problem
from sheetbench.answers.solution import Status
from sheetbench.runs.record import width
from sheetbench.runs.run import Run, SampleChecks
from sheetbench.runs.schedule import Schedule
from sheetbench.runs.store import MemoryStore
from sheetbench.scenes import Curved, EdgeLoad
from studies.stability.limit import start, system
from studies.stability.scenes import sheet

HEAVY = sheet(0.016, 1e3)  # statics stand a load number of a thousand, a fall from the flat sheet does not


@pytest.fixture(scope="module")
def problem():
    scene = sheet(0.016, 1.0)
    return build_problem(scene, springs(scene))


def pressed(share):
    """A sheet pressed in its plane by a share of E h."""
    scene = sheet(0.016, 0.02)
    force = share * scene.material.young * scene.sheet.thickness
    return scene.replace(loads=(EdgeLoad(edge="x1", force_per_length=(-force, 0.0, 0.0)),))


def collapsed(lattice, u):
    first, second = lattice.columns()[2, 3:5, 0]
    u[second] = (lattice.positions[first] - lattice.positions[second]) * (1.0 - 1e-8)


def inverted(lattice, u):
    for column in lattice.columns()[:2, :2].reshape(4, -1):  # four neighbours' layers change places
        u[column, 2] = -2.2 * lattice.positions[column, 2]


def not_a_number(lattice, u):
    u[lattice.columns()[4, 4, 1], 2] = np.nan


@pytest.mark.parametrize(
    ("make", "status", "said"),
    [
        (collapsed, Status.INVERTED, ("collapsed to a point", "y = 0.094 m")),
        (inverted, Status.INVERTED, ("turned inside out", "x = 0 m, y = 0 m")),
        (not_a_number, Status.NON_FINITE, ("x = 0.188 m",)),
    ],
)
def test_the_first_state_with_a_fault_is_told_with_its_place(problem, make, status, said):
    rest = np.zeros_like(problem.loads.dead)
    u = rest.copy()
    make(problem.assembly.lattice, u)
    strains, fault = faults.inspect(problem.assembly, np.stack([rest, u, u]))
    assert np.array_equal(strains, [0.0]) and fault is not None and fault.status is status
    assert all(part in fault.message for part in said)
    strains, fault = faults.inspect(problem.assembly, np.stack([rest, rest]))
    assert np.array_equal(strains, np.zeros(2)) and fault is None


@pytest.mark.sweep
@pytest.mark.parametrize("share", [1.0, 5.0, 50.0])
def test_a_crushed_sheet_ends_in_a_status(share):
    scene = pressed(share)
    solution = lumped.solve(scene, springs(scene))
    assert solution.status is Status.INVERTED
    assert "load factor" in solution.message and "refine" in solution.message and "x = " in solution.message
    truth = fem_reference.solve(scene, model="shell", elements=4)
    assert truth.status in (Status.STEP_LIMIT, Status.INVERTED, Status.UNSTABLE) and truth.message
    for answer in (solution, truth):
        assert np.isfinite(answer.mesh.point_data["displacement"]).all()


@pytest.mark.parametrize("integrator", ["verlet", "generalised-alpha", "esdirk", "midpoint"])
def test_a_sheet_that_falls_too_hard_ends_in_a_status(integrator):
    calibrated = springs(HEAVY)
    period = 1.0 / lumped.modes(HEAVY, calibrated, 1).frequencies[0]
    run = lumped.simulate(HEAVY, calibrated, 2.0 * period, integrator=integrator)
    assert run.status in (Status.INVERTED, Status.DIVERGED)
    assert run.message.startswith("at ") and ("refine" in run.message or "smaller" in run.message)
    assert all(np.isfinite(u).all() for u in run.probes.values())


def test_energy_from_nowhere_is_told_with_time_and_place(problem, monkeypatch):
    scene = sheet(0.016, 1.0)
    equations = system(scene, springs(scene))
    state = start(equations, np.zeros_like(problem.loads.dead))
    v = np.zeros_like(state.v)
    v[equations.assembly.lattice.columns()[2, 4, 0], 2] = 1.0
    moving = LatticeSamples.of(State(0.25, state.u, v, state.a))
    observer = LatticeObserver(equations)
    row = np.zeros((1, width(observer.columns)))
    row[0, :3] = 0.25, 1.0, 1.0  # time, kinetic, elastic
    monkeypatch.setattr(observer, "rows", lambda samples: row.copy())

    def checked(balance):
        kept = MemoryStore({"samples": (6,), "frames": (1, 3)})
        run = Run(Esdirk(equations, 1e-3), observer, Schedule(1, 1.0), kept, (), None)
        run.watch = SampleChecks(balance, lowest=balance, largest=3.0)
        fault = run._record_samples(moving)
        return run.samples, fault

    assert checked(1.9) == (1, None)
    sound, fault = checked(1.5)
    assert sound == 0 and fault is not None and fault.status is Status.DIVERGED
    assert "0.25 s" in fault.message and "x = 0.188 m, y = 0.094 m" in fault.message
    row[0, 2] = np.inf
    sound, fault = checked(1.5)
    assert sound == 0 and fault is not None and fault.status is Status.NON_FINITE


def test_a_stagnating_integrator_stops(monkeypatch):
    monkeypatch.setattr("sheetbench.runs.run.MOST_STEPS", 3)
    scene = sheet(0.016, 1.0)
    run = lumped.simulate(scene, springs(scene), 1.0, integrator="generalised-alpha", every=0.5)
    assert run.status is Status.STEP_LIMIT and "without reaching the next sample" in run.message


def test_the_shell_knows_its_mid_surface_s_stretch_and_its_inverted_elements():
    scene = sheet(0.016, 1.0)
    shell = DiscreteShell(rectangle(scene.sheet, (2, 3)), scene)
    q = np.zeros(shell.size)
    shell.displacement(q)[:, 0] = 0.6 * shell.plan.nodes[:, 0]
    assert shell.shape(q, 1.0).stretch == pytest.approx(0.6, rel=1e-9)
    assert not shell.inverted_element(q)
    shell.displacement(q)[:, 0] = -1.5 * shell.plan.nodes[:, 0]  # a mirror image of half the length
    assert "use more elements" in shell.inverted_element(q)


LIMIT, AT_LIMIT = 0.7645, -15.1e-3  # shares of the weight, and uz at P3 [m], by CalculiX
SHARES = (0.0, 0.4, 0.65, 0.74, 0.995 * LIMIT, 1.005 * LIMIT)
P3 = [(0.15, 0.075)]


def bent(share):
    """With a share of the weight, by its density."""
    density, supports = 1200.0 * (share or 1.0), (Curved(edge="x0", curvature=-8.0),)
    weight = 9.81 if share else 0.0
    return cases.sheet(0.15, 0.15, 0.002, 1e7, 0.45, density, weight=weight, supports=supports)


@pytest.mark.parametrize("elements", [12, pytest.param(16, marks=pytest.mark.slow)])
def test_bent_first_the_shell_folds_at_the_weight_at_which_calculix_does(elements):
    """Measured: between 0.7656 and 0.7664 on 12 elements, 0.7648 and 0.7656 on 16, with −15.17 mm."""
    before, found, sags = bent(0.0), fem_reference.solve(bent(0.0), model="shell", elements=elements), []
    for share in SHARES[1:]:
        scene, last, start = bent(share), found, before
        found = fem_reference.solve(
            scene,
            model="shell",
            elements=elements,
            near=lambda at, s=start, f=last: shape(s, f.displacement, at),
        )
        assert found.status is Status.CONVERGED, found.message
        sags.append(float(found.displacement(P3)[0, 2]))
        before = scene
    *smooth, folded = sags
    assert np.diff(smooth).max() < 0.0  # ever lower, without a jump
    assert AT_LIMIT < smooth[-1] < 0.9 * AT_LIMIT
    assert folded < 2.0 * AT_LIMIT
