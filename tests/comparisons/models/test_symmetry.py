"""Half and quarter sheets: the whole sheet's answer, to rounding, and when a scene has no symmetry to use."""

import numpy as np
import pytest
from cases import GRAVITY, RUBBER

from comparisons.models.symmetry import planes
from sheetbench import face as models
from sheetbench import scenes
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.scenes import (
    Clamped,
    Curved,
    EdgeLoad,
    Gravity,
    Held,
    Hinged,
    PointLoad,
    Pressure,
    Scene,
    Sheet,
    Symmetric,
)

SHEET = Sheet(length_x=0.188, length_y=0.25, thickness=0.003)


def make_scene(supports, loads=None, gravity=GRAVITY):
    return Scene(
        name="part",
        sheet=SHEET,
        material=RUBBER,
        gravity=gravity,
        support=tuple(supports),
        load=tuple(loads or ()),
    )


ALL_AROUND = make_scene(
    [Hinged(edge=edge) for edge in ("x0", "x1", "y0", "y1")],
    [
        PointLoad(at=(0.094, 0.125), force=(0.0, 0.0, 0.3)),
        PointLoad(at=(0.05, 0.125), force=(0.0, 0.0, 0.2)),
        PointLoad(at=(0.188 - 0.05, 0.125), force=(0.0, 0.0, 0.2)),
        Pressure(value=20.0),
    ],
)
BRIDGE = make_scene(
    [Clamped(edge="y0"), Clamped(edge="y1")],
    [
        EdgeLoad(edge="x0", force_per_length=(0.3, 0.0, -0.5), moment_per_length=0.02),
        EdgeLoad(edge="x1", force_per_length=(-0.3, 0.0, -0.5), moment_per_length=0.02),
    ],
)
TILTED = make_scene([Clamped(edge="x0", tilt=0.1), Clamped(edge="x1", tilt=0.1)])
ROLLED = make_scene([Curved(edge="x0", curvature=3.0), Curved(edge="x1", curvature=3.0)])
ONE_EDGE = scenes.load("one-edge-clamped")
TAPE = scenes.load("curved-edge")

PARTS = {
    "hinged all around": (ALL_AROUND, (0, 1)),
    "clamped bridge with edge loads": (make_scene(list(BRIDGE.supports), list(BRIDGE.loads)), (0,)),
    "two rods": (ROLLED, (0, 1)),
    "clamps tilted alike": (TILTED, (0, 1)),
    "one edge": (ONE_EDGE, (1,)),
    "a rod": (TAPE, (1,)),
}
SOLVES = {
    "lattice": ("lumped", {"grid": (9, 9, 2)}),
    "linear lattice": ("lumped", {"grid": (9, 9, 2), "linear": True}),
    "shell": ("shell", {"elements": (4, 4)}),
    "plate": ("plate", {"elements": (4, 4)}),
}


@pytest.mark.parametrize("solve", SOLVES)
@pytest.mark.parametrize("name", PARTS)
def test_a_part_answers_for_the_whole_to_rounding(name, solve):
    case, axes = PARTS[name]
    model, settings = SOLVES[solve]
    assert planes(case) == axes
    entire = models.solve(case, model, **settings)
    part = models.solve(case, model, symmetry=True, **settings)
    assert entire.status is part.status is Status.CONVERGED
    points = np.random.default_rng(1).uniform(0, 1, (300, 2)) * np.array(case.sheet.lengths)
    u = entire.displacement(points)
    assert np.abs(part.displacement(points) - u).max() < 1e-8 * np.abs(u).max()
    assert (
        part.unknowns < 0.65 * entire.unknowns if len(axes) == 1 else part.unknowns < 0.45 * entire.unknowns
    )
    scale = max(np.abs(force).max() for force in entire.reactions.values())
    for edge, force in entire.reactions.items():
        assert part.reactions[edge] == pytest.approx(force, abs=1e-8 * scale)
    assert sum(part.energies.values()) == pytest.approx(sum(entire.energies.values()), rel=1e-8)
    assert part.settings["symmetry"] == ["xy"[axis] for axis in axes]
    size = "grid" if model == "lumped" else "elements"
    assert part.settings[size] == entire.settings[size]


def test_the_mesh_is_that_of_the_whole_sheet():
    part = models.solve(ALL_AROUND, "shell", elements=(4, 4), symmetry=True)
    mesh = part.mesh
    assert mesh.points[:, :2].max(axis=0) == pytest.approx(SHEET.lengths)
    assert mesh.point_data["displacement"] == pytest.approx(part.displacement(mesh.points[:, :2]), abs=1e-12)
    (_, quads), *_ = mesh.cells
    assert len(quads) == 64 and quads.max() < len(mesh.points)


@pytest.mark.parametrize(
    ("case", "axes"),
    [
        (scenes.load("two-edges-clamped"), ()),
        (scenes.load("actuated-edge"), ()),
        (make_scene([Clamped(edge="x0")], gravity=Gravity(acceleration=(0.0, 1.0, -9.81))), ()),
        (make_scene([Clamped(edge="x0")], gravity=Gravity(acceleration=(5.0, 0.0, -9.81))), (1,)),
        (make_scene([Clamped(edge="x0"), Hinged(edge="x1")]), (1,)),
        (make_scene([Clamped(edge="x0")], [PointLoad(at=(0.1, 0.1), force=(0.0, 0.0, 1.0))]), ()),
        (make_scene([Clamped(edge="x0")], [PointLoad(at=(0.1, 0.125), force=(0.0, 1.0, 0.0))]), ()),
        (make_scene([Clamped(edge="x0")], [EdgeLoad(edge="x1", moment_per_length=0.1)]), ()),
        (
            make_scene(
                [Clamped(edge="x0"), Clamped(edge="x1")], [EdgeLoad(edge="x1", moment_per_length=0.1)]
            ),
            (),
        ),
        (make_scene([Held(edge="x0", components=("x", "y", "z")), Hinged(edge="x1")]), (1,)),
        (make_scene([Clamped(edge="x0", tilt=0.1)]), (1,)),
        (make_scene([Clamped(edge="x0", tilt=0.1), Clamped(edge="x1", tilt=-0.1)]), (1,)),
    ],
)
def test_planes_of_symmetry_are_those_of_supports_and_loads(case, axes):
    assert planes(case) == axes


def test_a_grid_without_a_line_of_masses_on_the_plane_is_solved_whole():
    solution = models.solve(ONE_EDGE, "lumped", grid=(5, 6, 2), symmetry=True)
    assert "symmetry" not in solution.settings
    assert "symmetry" not in models.solve(ONE_EDGE, "shell", elements=3, symmetry=True).settings


def test_the_solid_is_solved_whole():
    with pytest.raises(BadInput, match="solid: is always solved whole"):
        models.solve(ONE_EDGE, "solid", elements=2, symmetry=True)


def test_a_rod_between_two_planes_of_symmetry_is_refused():
    rod = Curved(edge="x0", curvature=1.0)
    make_scene([rod, Symmetric(edge="y1")])
    with pytest.raises(ValueError, match="moves the corner"):
        make_scene([rod, Symmetric(edge="y0"), Symmetric(edge="y1")])
