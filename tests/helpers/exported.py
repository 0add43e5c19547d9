"""Scenes that are exported: all kinds of supports, loads, laws, cuts, fibres, obstacles, natural states."""

from pathlib import Path
from typing import Any

from cases import CLAMP, GRAVITY, OBLONG, SILICONE
from rubbers import LAWS, rubber

from sheetbench import scenes
from sheetbench.scenes import EdgeLoad, Held, Hinged, PointLoad, Pressure, Scene, Symmetric

READERS = Path(__file__).parents[2] / "comparisons" / "codes" / "scripts"
HINGES = (Hinged(edge="x0"), Hinged(edge="x1"), Held(edge="y0", components=("z",)))
HINGED = Scene("hinged", OBLONG, SILICONE, GRAVITY, HINGES)
PULL = EdgeLoad(edge="x1", force_per_length=(1.0, 0.0, 0.0))
PUSHED = (PointLoad(at=(0.2, 0.05), force=(0.0, 0.0, 0.05)), PULL)
HALF = Scene("half", OBLONG, SILICONE, None, (CLAMP, Symmetric(edge="y1")), PUSHED)
CUT = {"shape": {"rectangle": {"x": (0.09, 0.2), "y": (0.045, 0.1)}}}
ROOT = {"rectangle": {"x": (0.0, 0.02), "y": (0.0, 0.1)}}
DRAWN = HALF.replace(
    supports=[{"kind": "clamped", "where": ROOT}],
    loads=[EdgeLoad(edge="x1", force_per_length=(1.0, 0.0, 0.2))],
    cutouts=[CUT],
    patches=[{"shape": ROOT, "young": 5e6}],
)
FIBRES = {"young_1": 5e6, "young_2": 1e6, "poisson_12": 0.3, "shear_12": 4e5, "angle": 0.5}
FIBRES |= {"shear_13": 6e5, "shear_23": 2e5}
SKEW = HALF.replace(  # an oblique rim
    supports=[CLAMP],
    loads=[PointLoad(at=(0.2, 0.1), force=(0.0, 0.0, 0.02))],
    outline=[(0.0, 0.0), (0.12, 0.0), (0.2, 0.1), (0.0, 0.1)],
)
WOVEN = DRAWN.replace(material={"kind": "orthotropic", "density": 1000.0, **FIBRES}, patches=())
MOMENT = EdgeLoad(edge="x1", moment_per_length=0.02, force_per_length=(0, 0, 0))
BLOWN = Scene("blown", OBLONG, SILICONE, None, (CLAMP,), (Pressure(value=40.0), MOMENT))
NATURAL = {"strain": (0.1, 0.02, 0.03), "curvature": (5.0, -2.0, 3.0)}  # of sides not at right angles
BARRED = scenes.load("finger-on-cylinder")
BALL = scenes.Sphere(position=(0.045, 0.01, -0.02), radius=0.018)
SCENES: dict[str, tuple[Scene, dict[str, Any]]] = {
    "hinged": (HINGED, {"method": "moduli"}),
    "graded": (scenes.load("curved-edge"), {"grading": 0.5}),
    "half": (HALF, {"method": "consistent"}),
    "uniform": (scenes.load("one-edge-clamped"), {"method": "uniform"}),
    **{
        law: (HALF.replace(material=rubber(law, damping_time=1e-3)), {"method": "hyperelastic"})
        for law in LAWS
    },
    "cut": (DRAWN, {"grid": (5, 3)}),
    "woven": (WOVEN, {"grid": (5, 3)}),
    "skew": (SKEW, {"grid": (5, 3)}),
    "bimetal": (scenes.load("bimetal-strip"), {"grid": (7, 3)}),
    "muscles": (scenes.load("muscle-bands"), {"grid": (7, 3)}),
    "sheared": (scenes.load("muscle-bands").replace(patches=(), natural=NATURAL), {"grid": 4}),
    "table": (scenes.load("strip-on-table"), {"grid": (5, 3)}),
    "cylinder": (BARRED, {"grid": (7, 3)}),
    "ball": (BARRED.replace(obstacles=(BALL,)), {"grid": (5, 3)}),
    "napkin": (scenes.load("napkin-on-ball"), {"grid": 4}),  # unstable: no equilibrium in the folder
}
