"""Every integrator keeps the energy of every kind of scene in its books, and moves it as the others do."""

from functools import cache

import numpy as np
import pytest
from dynamic_cases import make_scene
from ring_down import BRANCHES

import lumped
from lumped.dynamics import INTEGRATORS
from sheetbench.answers.solution import Status
from sheetbench.scenes import Air, FactorTable, Material, Scene, Sheet, load
from sheetbench.scenes.objects.natural import Natural

ONE = "one-edge-clamped"
PULSE = {"time": [0.0, 0.015, 0.03], "factor": [0.0, 1.0, 0.0]}
RAMP = {"time": [0.0, 0.02], "factor": [0.0, 1.0]}
LOADS = [
    {"kind": "point", "at": (0.188, 0.094), "force": (0.0, 0.1, 1.0), "history": RAMP},
    {"kind": "pressure", "value": 60.0, "history": PULSE},
    {"kind": "edge", "edge": "x1", "moment_per_length": 0.1, "history": RAMP},
]
TIME = np.linspace(0.0, 0.03, 13)
RISEN = [[0.0, 0.0, z] for z in 2e-3 * (1.0 - np.cos(np.pi * TIME / 0.03))]
COURSE = {"time": [0.0, 0.011, 0.03], "displacement": [[0.0] * 3, [1e-3, 2e-3, 4e-3], [2e-3, 0.0, -1e-3]]}
TURNS = [[0.0] * 3, [0.1, 0.3, -0.1], [0.1, -0.2, 0.2]]
TURNED = {"kind": "motion", "edge": "x0", **COURSE, "rotation": TURNS}
CLAMP = {"edge": "x0", "kind": "clamped"}
PART = {"rectangle": {"x": (0.141, 0.188), "y": (0.047, 0.141)}}
BODY = {"where": PART, "mass": 0.02, "inertia": (2e-6, 2e-6, 1e-6)}


def rubber(**law):
    """A strip suddenly pulled, beyond half as long again."""
    return Scene(
        "rubber", Sheet(0.2, 0.1, 2e-3), Material(poisson=0.45, density=1e3, **law), None, [CLAMP],
        [{"kind": "edge", "edge": "x1", "force_per_length": [2400.0, 0.0, 50.0]}], probes={"P4": (0.2, 0.05)},
    )  # fmt: skip


SCENES = {
    "weight": make_scene(),
    "dampers": make_scene(damping_time=1e-3, damping_rate=5.0),
    "air": load(ONE).replace(air=Air(drag=2.0, density=300.0)),
    "branches": load(ONE).replace(relaxation=BRANCHES),
    "loads that change": make_scene(ONE, loads=LOADS),
    "weight that comes": load(ONE).replace(
        gravity={"acceleration": (0.0, 0.0, -9.81), "history": FactorTable(**RAMP)}
    ),
    "a clamp that moves": make_scene(
        ONE, gravity=False, supports=[{**CLAMP, "motion": {"time": TIME.tolist(), "displacement": RISEN}}]
    ),
    "a hinge that moves by jerks": make_scene(
        ONE,
        gravity=False,
        damping_time=1e-4,
        supports=[
            {**CLAMP, "kind": "hinged", "motion": {**COURSE, "interpolation": "linear"}},
            {"edge": "x1", "kind": "clamped"},
        ],
    ),
    "an edge that turns": make_scene(
        ONE, [TURNED], gravity=False, damping_time=1e-4, supports=[{"edge": "x1", "kind": "clamped"}]
    ),
    "a natural curvature that grows": load(ONE).replace(
        natural=Natural(curvature=(5.0, 0.0, 0.0), history=FactorTable(**RAMP)), gravity=None
    ),
    "a payload": load(ONE).replace(masses=[BODY]),
    "a chain that bends": make_scene(
        ONE, [{"curvature": {"time": [0.0, 0.01], "value": [0.0, 4.0]}, "segments": 4}], gravity=False
    ),
    "neo-hooke": rubber(law="neo-hookean", young=5e6),
    "gent, damped": rubber(law="gent", shear=1.7e6, limit=20.0, damping_time=1e-4),
    "yeoh": rubber(law="yeoh", c1=8.5e5, c2=-1e4, c3=300.0),
    "mooney, damped": rubber(law="mooney-rivlin", c1=7e5, c2=1.6e5, damping_time=1e-4),
}
STEPS = {"midpoint": 5e-4, "generalised-alpha": 2e-4}  # s; of others the usual ones
ROWS = [
    (name, integrator)
    for name in SCENES
    for integrator in INTEGRATORS
    if not (SCENES[name].actuators and integrator == "esdirk")
    if not (name == "a chain that bends" and integrator == "verlet")
]


@cache
def run(name, integrator):
    scene = SCENES[name]
    method, step = ("hyperelastic" if scene.material.law else "consistent"), STEPS.get(integrator)
    if scene.material.law:
        step = {"midpoint": 5e-5, "verlet": 2e-5}.get(integrator)
    springs = lumped.calibrate(scene.sheet, scene.material, (5, 3) if scene.material.law else 3, method)
    duration = 0.012 if scene.material.law else 0.03
    return lumped.simulate(
        scene, springs, duration, integrator=integrator, step=step, every=duration / 10, frames=0
    )


@pytest.mark.sweep(5)
@pytest.mark.parametrize(("name", "integrator"), ROWS)
def test_the_balance_holds_and_integrators_agree(name, integrator):
    """Midpoint's as its equations hold; others' to the order of their steps, esdirk's to what it may miss."""
    found = run(name, integrator)
    assert found.status is Status.CONVERGED, found.message
    largest = max(float(np.abs(energy).max()) for energy in found.energies.values())
    spread = float(np.abs(found.balance - found.balance[0]).max()) / largest
    assert spread < (1e-8 if integrator == "midpoint" else 3e-3)
    taken = np.diff(found.energies["dissipated"])
    assert taken.min() >= -1e-4 * largest
    other = run(name, "midpoint" if integrator == "generalised-alpha" else "generalised-alpha")
    moved, expected = (np.array(list(each.probes.values())) for each in (found, other))
    assert np.abs(moved - expected).max() < 0.02 * np.abs(expected).max()
