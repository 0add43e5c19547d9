"""Balance: every answer's reactions carry its loads, forces and moments, in every model; and what if not."""

from dataclasses import replace
from pkgutil import resolve_name

import numpy as np
import pytest
from dynamic_cases import make_scene, springs
from numpy.testing import assert_allclose

import fem_reference
import lumped
from fem_reference.discrete.answer import solve_on
from fem_reference.surface.mesh import rectangle
from sheetbench import face as models
from sheetbench.answers.balance import dead_force
from sheetbench.answers.solution import Status
from sheetbench.scenes import Gravity, load

pytestmark = pytest.mark.smoke

SIDE = 0.188
CLAMP = {"edge": "x0", "kind": "clamped"}
LOADS = [
    {"kind": "point", "at": [0.15, 0.1], "force": [0.1, -0.2, 0.3]},
    {"kind": "edge", "edge": "x1", "force_per_length": [1.0, 0.5, -1.0], "moment_per_length": 0.05},
    {"kind": "pressure", "value": 40.0, "history": {"time": [0.0, 1.0], "factor": [1.0, -0.5]}},
]
TURNED = {
    "kind": "motion",
    "edge": "x1",
    "time": [0.0],
    "displacement": [[-0.002, 0.0, 0.01]],
    "rotation": [[0.0, 0.2, 0.1]],
}


def held(base, **more):
    """A sheet that nothing holds but the base of a chain on edge x0."""
    chain = {"edge": "x0", "base": base, "bending_stiffness": 5.0, "curvature": 2.0, **more}
    return make_scene(supports=[], actuators=[chain])


SCENES = {
    "clamped, all loads": make_scene(supports=[CLAMP], loads=LOADS),
    "tilted and held": make_scene(
        supports=[{**CLAMP, "tilt": 0.3}, {"edge": "y1", "kind": "held", "components": ["z"]}],
        loads=LOADS[:1],
    ),
    "hinged all around": make_scene(
        supports=[{"edge": e, "kind": "hinged"} for e in ("x0", "x1", "y0", "y1")], loads=LOADS
    ),
    "curved": load("curved-edge"),
    "cut by symmetry": make_scene(
        supports=[{**CLAMP, "kind": "curved", "curvature": 2.0}, {"edge": "y1", "kind": "symmetric"}],
        loads=LOADS[2:],
    ),
    "a moved edge": make_scene(supports=[CLAMP], actuators=[TURNED], loads=LOADS[:1]),
    "a chain at a held corner": make_scene(
        supports=[{"edge": "y0", "kind": "clamped"}],
        actuators=[{"edge": "x1", "face": "top", "curvature": 4.0}],
    ),
    "chains that share a corner": make_scene(
        supports=[CLAMP],
        actuators=[{"edge": "y1", "face": "top", "curvature": 4.0}, {"edge": "x1", "curvature": -2.0}],
    ),
    "unequal chains": make_scene(
        supports=[CLAMP],
        actuators=[{"face": "top", "line_density": 0.02}, {"face": "bottom", "line_density": 0.07}],
    ).replace(gravity=Gravity(acceleration=(3.0, -4.0, -8.0))),
    "held at its start": held("start", face="top"),
    "held at a joint in the middle": held("middle", plane="spatial"),
    "held at a segment in the middle": held("middle", segments=7, face="bottom"),
    "weightless": make_scene(supports=[CLAMP, {"edge": "x1", "kind": "clamped"}], gravity=False),
}
REFERENCES = ("plate", "shell", "solid")
MODELS = {
    "lattice": ("lumped", {"grid": (5, 5, 2)}),
    "graded lattice": ("lumped", {"grid": (5, 5, 2), "grading": 0.6}),
    "linear lattice": ("lumped", {"grid": (5, 5, 2), "linear": True}),
    **{name: (name, {"elements": 3 if name == "solid" else 4}) for name in REFERENCES},
}
SHARP = 1e-5  # of all forces, above which no tolerance is: rods are 10⁵ times as stiff as sheets


# the linear lattice refuses actuators
CASES = [(m, n) for m in MODELS for n in SCENES if m != "linear lattice" or not SCENES[n].actuators]


@pytest.mark.sweep(2)
@pytest.mark.parametrize(("model", "name"), CASES)
def test_forces_and_moments_are_in_balance(name, model):
    scene = SCENES[name]
    solution = models.solve(scene, MODELS[model][0], **MODELS[model][1])
    assert solution.status in (Status.CONVERGED, Status.UNSTABLE), solution.message
    balance = solution.balance
    assert balance.holds and balance.allowed <= SHARP * balance.size
    moved = {a.held_as for a in scene.actuators if a.kind == "motion" or a.base != "free"}
    assert set(solution.reactions) == {support.edge for support in scene.supports} | moved
    if not any(load.kind == "pressure" for load in scene.loads):
        carried = sum(solution.reactions.values()) + dead_force(scene)
        assert_allclose(carried, 0.0, atol=max(1e-8 * balance.size, balance.allowed))
    assert list(balance.document()) == ["force", "moment", "relative", "holds"]


def test_no_answer_out_of_balance_is_an_equilibrium():
    solution = lumped.solve(SCENES["curved"], springs(SCENES["curved"]))
    off = replace(solution.balance, force=np.array([0.0, 0.0, 1e-3]))
    found = replace(solution, balance=off)
    assert found.status is Status.DIVERGED and not found.comparable
    assert found.message.startswith("forces out of balance by 0.001 N")
    assert replace(found, model="other").message == found.message  # said once


def test_a_reaction_left_out_and_a_wrong_weight_are_found(monkeypatch):
    scene = SCENES["a moved edge"]
    monkeypatch.setattr("lumped.actuators.coupling.Coupling.reactions", lambda self, exerted: {})
    assert lumped.solve(scene, springs(scene)).status is Status.DIVERGED
    monkeypatch.undo()
    scene = SCENES["unequal chains"]
    weight = lumped.actuators.chain.BoundChain.weight
    monkeypatch.setattr("lumped.actuators.chain.BoundChain.weight", lambda self, g: 0.999 * weight(self, g))
    found = lumped.solve(scene, springs(scene))
    assert found.status is Status.DIVERGED and "out of balance" in found.message


@pytest.mark.parametrize("model", REFERENCES)
def test_a_mesh_of_any_outline_is_in_balance(model):
    """Elements that are no parallelograms, on a sheet of another shape than the scene's, under every load."""
    scene = make_scene(supports=[CLAMP], loads=[{**LOADS[0], "at": [0.05, 0.1]}, *LOADS[1:]])
    flat = rectangle(scene.sheet, (3, 2))
    x, y = flat.p
    leaning = type(flat)(np.array([x * (1.0 - 2.0 * y), y + 0.2 * x]), flat.t).with_boundaries(
        flat.boundaries
    )
    kind = resolve_name(f"fem_reference.{model}.discrete:Discrete{model.title()}")
    found = solve_on(kind, leaning, scene)
    assert found.status is Status.CONVERGED and found.balance.allowed <= SHARP * found.balance.size


def _times(factor):
    """What makes of a function one whose answer is a multiple."""
    return lambda function: lambda *arguments: np.multiply(factor, function(*arguments))


def _on_edge(weight):
    """Forces of a rod's weight, no moments."""

    def found(rods, scene):
        out = weight(rods, scene)
        out[:, rods._directors] = 0.0
        return out

    return found


OFF = _times(1.001)
LOADED, HUNG = "clamped, all loads", "unequal chains"
FAULTS = {
    "weight": ("loads.areas", OFF, LOADED),
    "force on an edge": ("loads.Line.shares", OFF, LOADED),
    "force at a point": ("loads.shares", lambda f: lambda *at: (f(*at)[0], 1.001 * f(*at)[1]), LOADED),
    "pressure": ("loads.FollowerPressure.force", OFF, LOADED),
    "moment on an edge": ("loads.FollowerMoment.force", OFF, LOADED),
    "sense of a moment": ("loads.FollowerMoment.force", _times(-1.0), LOADED),
    "weight of chains": ("Rods.weight", OFF, HUNG),
    "height of chains": ("Rods.weight", _on_edge, HUNG),
}


@pytest.mark.sweep(2)
@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("model", REFERENCES)
def test_no_reference_answers_with_a_load_that_is_not_the_scenes(monkeypatch, model, fault):
    where, wrong, case = FAULTS[fault]
    where = f"fem_reference.{'discrete.rods' if case == HUNG else 'surface'}.{where}"
    owner, name = where.rsplit(".", 1)
    monkeypatch.setattr(where, wrong(getattr(resolve_name(owner), name)))
    found = models.solve(SCENES[case], model, elements=2)
    assert found.status is Status.DIVERGED and "out of balance" in found.message


@pytest.mark.parametrize("model", REFERENCES)
def test_no_reference_leaves_a_reaction_out(monkeypatch, model):
    owner = "solid.supports.ColumnSupports" if model == "solid" else "surface.supports.Supports"
    found = models.solve(SCENES["a moved edge"], model, elements=2)
    monkeypatch.setattr(f"fem_reference.{owner}.reactions", lambda *arguments: {"x0": found.reactions["x0"]})
    assert models.solve(SCENES["a moved edge"], model, elements=2).status is Status.DIVERGED


@pytest.mark.parametrize(
    ("model", "options"),
    [
        ("plate", {"graded": False}),
        ("shell", {"graded": False}),
        ("solid", {"clamp": "full", "layers": 2}),
        ("solid", {"law": "neo-hookean", "grading": "uniform"}),
    ],
)
def test_a_reference_is_in_balance_with_every_option(model, options):
    found = models.solve(SCENES[LOADED], model, elements=2, **options)
    assert found.status is Status.CONVERGED and found.balance.allowed <= SHARP * found.balance.size


@pytest.mark.parametrize("options", [{"weights": "full"}, {"branch": "stable"}])
def test_a_lattice_is_in_balance_with_every_option(options):
    scene = SCENES["clamped, all loads"]
    assert lumped.solve(scene, springs(scene), **options).balance.holds


def test_springs_that_are_not_central_keep_no_moments_and_are_not_asked_to():
    uniform = lumped.calibrate(
        load("one-edge-clamped").sheet, load("one-edge-clamped").material, (5, 5), "uniform"
    )
    k = uniform.springs.axial
    uneven = uniform.springs.model_copy(update={"axial": {"x": k, "y": k, "z": 0.5 * k}})
    scene = load("one-edge-clamped").model_copy(update={"springs": type(uneven).model_validate(dict(uneven))})
    solution = lumped.solve(scene, lumped.given(scene, (5, 5, 2)))
    balance, weight = solution.balance, np.linalg.norm(dead_force(scene))
    assert solution.status is Status.CONVERGED and balance.holds and not balance.objective
    assert np.linalg.norm(balance.moment) > 0.01 * weight * SIDE  # 3 % of what the clamp carries
    assert "keep no moments" in solution.message


WEIGHT = 9.81 * 1678.0 * 0.188**2 * 0.003
LIFTED = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.01]]
EDGE_MOVED = {"kind": "motion", "edge": "x1", "time": [0.0, 1.0], "displacement": LIFTED}
ACTUATED = {
    "a moved edge": make_scene(supports=[CLAMP], actuators=[EDGE_MOVED]),
    "a held base": make_scene(supports=[], actuators=[{"edge": "y1", "base": "start"}]),
    "nothing": make_scene(supports=[CLAMP]),
}


@pytest.mark.parametrize("model", ["plate", "shell", "solid"])
def test_a_reference_tells_the_energy_of_rods_wherever_there_are_actuators(model):
    """None of a moved edge, some of a held base's chain; and no word of it where nothing is actuated."""
    energies = {
        name: fem_reference.solve(scene, model=model, elements=2).energies for name, scene in ACTUATED.items()
    }
    assert energies["a moved edge"]["rod"] == 0.0 < energies["a held base"]["rod"]
    assert "rod" not in energies["nothing"]


def test_a_run_writes_down_what_a_motion_takes():
    scene = make_scene(supports=[CLAMP], actuators=[EDGE_MOVED], damping_rate=50.0)
    history = lumped.simulate(scene, springs(scene), 2.0, step=5e-3, every=0.5)
    total = history.reactions["x0"] + history.reactions["x1"]
    assert_allclose(history.reactions["x1"], history.actuators["x1"][:, 0, :3], atol=1e-12)
    assert np.abs(total[-1] - [0.0, 0.0, WEIGHT]).max() < 1e-3 * WEIGHT


def test_actuators_are_named_by_their_edges_or_numbered():
    two = make_scene(actuators=[{"edge": "x1"}, {"edge": "y1"}])
    assert list(two.named_actuators()) == ["x1", "y1"]
    pair = make_scene(actuators=[{"edge": "x1"}, {"edge": "x1", "face": "top"}, {"edge": "y1"}])
    assert list(pair.named_actuators()) == ["x1.1", "x1.2", "y1.3"]
