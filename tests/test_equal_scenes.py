"""Two ways of saying one thing have one answer, in every model."""

import numpy as np
import pytest
from cases import GRAVITY, OBLONG, SILICONE, sheet

from sheetbench import face
from sheetbench.answers.solution import Status
from sheetbench.scenes import (
    AreaLoad,
    Chain,
    Clamped,
    Curved,
    EdgeMotion,
    Gravity,
    Material,
    Natural,
    PointLoad,
    Scene,
    Sheet,
    Sphere,
    Temperature,
    load,
)
from sheetbench.scenes.objects.supports import Motion

FOUR = {"elements": 4}
ALL = {"lumped": {"grid": (9, 9, 2)}, "plate": FOUR, "shell": FOUR, "solid": {"elements": 2}}
PLAIN, CURVED = load("two-edges-clamped"), load("curved-edge")
TABLE = load("strip-on-table").replace(expansion=1e-4)
YOUNG, POISSON = PLAIN.material.young, PLAIN.material.poisson
SHEAR = YOUNG / (2.0 * (1.0 + POISSON))
SAME = dict(young_1=YOUNG, young_2=YOUNG, poisson_12=POISSON, shear_12=SHEAR, angle=0.3)
FIBRES = dict(young_1=54.5e6, young_2=8e6, poisson_12=0.35, shear_12=4e6, shear_13=3e6, shear_23=2e6)
SWAPPED = dict(young_1=8e6, young_2=54.5e6, poisson_12=0.35 * 8.0 / 54.5, shear_12=4e6, shear_13=2e6)
SWAPPED |= dict(shear_23=3e6, young_3=8e6, poisson_13=0.35, poisson_23=0.35)
LIFT = (0.0, 0.0, 0.004)
COURSE = {"time": (0.0, 0.5, 1.0), "displacement": ((0.0, 0.0, 0.0), (0.0, 0.01, 0.0), LIFT)}
STILL = Clamped("x0")
CUT = [  # of the sheet's own material, aligned, oblique and round, over each other
    {"shape": {"rectangle": {"x": (0.02, 0.1), "y": (0.0, 0.188)}}, "young": YOUNG},
    {"shape": {"circle": {"centre": (0.1, 0.1), "radius": 0.03}}, "thickness": 0.003},
    {"shape": {"polygon": [(0.05, 0.0), (0.188, 0.188), (0.0, 0.188)]}, "poisson": 0.48, "density": 1678.0},
]
SHEETS = ("lumped", "plate", "shell")
AROUND = [(0.0, 0.0), (0.188, 0.0), (0.188, 0.188), (0.0, 0.188)]
AT_TIP = {"at": (0.2, 0.05), "mass": 5e-3}
PART = {"rectangle": {"x": (0.15, 0.2), "y": (0.0, 0.1)}}
PULL = -9.81 * 5e-3
ROD = dict(edge="x1", segments=8, bending_stiffness=0.2, line_density=0.05, radius=1.5e-3)


def with_fibres(**constants):
    return PLAIN.replace(material=Material(kind="orthotropic", density=1678.0, **constants))


def moved(edge, supports=(), **course):
    motion = EdgeMotion(kind="motion", edge=edge, **{"time": (0.0,), **course})
    return Scene("moved", OBLONG, SILICONE, GRAVITY, supports, actuators=(motion,))


def held(*supports):
    return Scene("held", OBLONG, SILICONE, GRAVITY, supports)


def laden(**more):
    return sheet(0.2, 0.1, 0.005, 2e8, weight=9.81, **more)


def rods(*chains, **more):
    return load("one-edge-clamped").replace(actuators=[Chain(**{**ROD, **one}) for one in chains], **more)


def loaded(at_once):
    """Weight and every kind of load, each by a factor of its own: at once, or the last of a history."""

    def part(factor, name, value, **more):
        if at_once:
            return {name: np.multiply(value, factor).tolist(), **more}
        return {name: value, "history": {"time": (0.0, 0.1, 0.3), "factor": (7.0, -3.0, factor)}, **more}

    loads = (
        part(-0.8, "force", (0.0, 0.02, 0.05), kind="point", at=(0.15, 0.06)),
        part(2.0, "force_per_length", (0.1, 0.0, 0.1), kind="edge", edge="x1"),
        part(-2.0, "moment_per_length", 5e-3, kind="edge", edge="y1"),
        part(0.5, "value", 8.0, kind="pressure"),
    )
    return laden(loads=loads, gravity=part(0.3, "acceleration", (0.0, 0.0, -9.81)))


TWICE = {"bending_stiffness": 0.4, "line_density": 0.1}
TOP, BOTTOM = {"face": "top", "curvature": 6.0}, {"face": "bottom", "curvature": 2.0}
MEETING = ({"edge": "y1", "curvature": 3.0, "face": "top"}, {"curvature": -4.0, "segments": 5})
LIFTED = {"kind": "motion", "edge": "x1", "time": (0.0,), "displacement": ((0.0, 0.0, 0.01),)}
CORNER = [Chain(**{**ROD, "edge": "y0", "curvature": 2.0, "bending_stiffness": 0.02}), LIFTED]
STIFF = {"edge": "x0", "bending_stiffness": 1e3, "line_density": 1e-6, "base": "middle"}
HISTORY = {"time": (0.0, 1.0), "factor": (0.0, 0.5)}
PAIRS = {  # two scenes, models, and how far apart their answers may be
    "a clamp that moves, an edge that is moved": (
        held(STILL, Clamped("x1", motion=Motion(**COURSE))), moved("x1", (STILL,), **COURSE), ALL, 1e-7),
    "a clamp that is tilted, an edge that is turned": (
        held(Clamped("y1", tilt=0.3)), moved("y1", rotation=((0.3, 0.0, 0.0),)), ALL, 1e-7),
    "a payload, the force of its weight": (
        laden(masses=[{"at": (0.17, 0.013), "mass": 5e-3}]),
        laden(loads=[PointLoad(at=(0.17, 0.013), force=(0.0, 0.0, PULL))]), ALL, 1e-9),
    "a payload that is spread, a load on its part": (
        laden(masses=[{"where": PART, "mass": 5e-3}]),
        laden(loads=[AreaLoad(force_per_area=(0.0, 0.0, PULL / (0.05 * 0.1)), where=PART)]), ALL, 1e-9),
    "a payload as gravity grows, by half of it": (
        laden(masses=[AT_TIP], gravity=Gravity((0.0, 0.0, -9.81), history=HISTORY)),
        laden(masses=[AT_TIP], gravity=Gravity((0.0, 0.0, -4.905))), ALL, 1e-9),
    "the last factors of histories, loads by them": (loaded(at_once=False), loaded(at_once=True), ALL, 1e-9),
    "the last factor of gravity, on a rod too": (
        rods(TOP, gravity=Gravity((0.0, 0.0, -9.81), history=HISTORY)),
        rods(TOP, gravity=Gravity((0.0, 0.0, -4.905))), ("lumped", "shell"), 1e-9),
    "patches of the sheet's own material": (
        PLAIN.replace(patches=CUT[:1]), PLAIN.replace(patches=CUT), ALL, 1e-8),
    "fibres of isotropic constants": (PLAIN, with_fibres(**SAME), ALL, 1e-8),
    "fibres turned by a right angle": (
        with_fibres(**FIBRES, angle=np.pi / 2), with_fibres(**SWAPPED), ALL, 1e-8),
    "layers of one material": (
        with_fibres(**FIBRES, angle=0.4),
        with_fibres(**FIBRES, angle=0.4).replace(layers=[{"thickness": 1e-3}] * 3), SHEETS, 1e-8),
    "a natural state of zero over a table": (
        TABLE, TABLE.replace(natural=Natural(), temperature=Temperature()), ("lumped", "shell"), 1e-7),
    "an outline that is the rectangle": (
        PLAIN, PLAIN.replace(outline=AROUND), ("lumped",), 1e-9),
    "chains that meet, in either order": (rods(*MEETING), rods(*MEETING[::-1]), ("lumped", "shell"), 1e-6),
    "a chain and an edge that is moved, in either order": (
        load("one-edge-clamped").replace(actuators=CORNER),
        load("one-edge-clamped").replace(actuators=CORNER[::-1]), ALL, 1e-6),
    "a pair of rods, one on their mean axis": (
        rods(TOP, BOTTOM), rods({**TWICE, "curvature": 4.0}), ("shell",), 1e-6),
    "a stiff rod that is held, a bent edge": (
        rods({**STIFF, "curvature": 4.0}, supports=()), CURVED, ("plate", "shell"), 1e-3),
}  # fmt: skip


@pytest.mark.sweep
@pytest.mark.parametrize(
    ("name", "model"), [(name, model) for name, (*_, models, _) in PAIRS.items() for model in models]
)
def test_two_ways_of_saying_it_have_one_answer(name, model):
    """Displacements, and the forces of all supports together."""
    one, other, _, within = PAIRS[name]
    found, expected = (face.solve(scene, model, **ALL[model]) for scene in (one, other))
    assert found.status is expected.status is Status.CONVERGED, (found.message, expected.message)
    moved, u = (each.displacement(one.probe_points()) for each in (found, expected))
    np.testing.assert_allclose(moved, u, atol=within * np.abs(u).max())
    forces, known = (sum(each.reactions.values()) for each in (found, expected))
    np.testing.assert_allclose(forces, known, atol=max(within, 1e-6) * np.abs(known).max())


@pytest.mark.parametrize("model", ["lumped", "shell"])
def test_an_obstacle_out_of_reach_changes_nothing(model):
    """The path with soft contact led the lattice to another equilibrium, 1.3 % away; places between nodes
    were read on the surface that would touch, 0.3 to 8 % away on such meshes."""
    curved = Curved(edge="x0", curvature=-8.468620433950493)
    fall = Gravity(acceleration=(3.0, 2.0, -9.0))
    size = dict(length_x=0.07749275717740531, length_y=0.14518474657231492, thickness=0.0009480868980575017)
    soft = Material(young=521266.37305123813, poisson=0.49, density=1000.0)
    bare = Scene("bent", Sheet(**size), soft, fall, (curved,))
    far = bare.replace(obstacles=(Sphere(position=(0.0, 0.0, -50.0), radius=1.0),))
    options = {"grid": (5, 5, 2)} if model == "lumped" else {"elements": 2}
    beside, alone = (face.solve(scene, model, **options) for scene in (far, bare))
    places = np.array([[0.37, 0.21], [0.71, 0.83]]) * bare.sheet.lengths
    np.testing.assert_array_equal(*(one.mesh.point_data["displacement"] for one in (beside, alone)))
    np.testing.assert_array_equal(*(one.displacement(places) for one in (beside, alone)))
