"""Thirty lattices at rest, small: the displacements that there were, in as few factorisations.

`python tests/lumped/statics/test_thirty_scenes.py` writes thirty_scenes.json anew, for a change that is
meant to change answers. Masses of the lattices: 9 along the shorter side unless the table has others.
Displacements within 1e-9 of the largest follow from residuals of 1e-11 of the forces. Two rows are
this tracer's own: two clamps pushed 2 mm together, which the one before left flat and unstable,
and 20 mm, where the sheet snaps earlier.
"""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import lumped
from sheetbench.scenes import (
    Clamped,
    Curved,
    EdgeLoad,
    Gravity,
    Material,
    PerDirection,
    Pressure,
    Scene,
    Sheet,
    catalogue,
    load,
)

FILE = Path(__file__).with_name("thirty_scenes.json")
DIGITS = 14  # decimals of a metre
SQUARE = Sheet(length_x=0.15, length_y=0.15, thickness=0.002)
STRIP = Sheet(length_x=0.2, length_y=0.1, thickness=0.002)
FIRM = Material(young=1e7, poisson=0.45, density=1200.0)
SOFT = Material(young=5e6, poisson=0.45, density=1000.0)
DOWN = Gravity(acceleration=(0.0, 0.0, -9.81))
AT_X0 = (Clamped(edge="x0"),)
AROUND = tuple(Clamped(edge=edge) for edge in ("x0", "x1", "y0", "y1"))
FIBRES = {"young_1": 2e8, "young_2": 8e7, "poisson_12": 0.2, "shear_12": 6e6, "density": 1100.0}


def of(sheet, material, supports, *loads, gravity=None):
    at = {"corner": sheet.lengths, "middle": (0.5 * sheet.length_x, 0.4 * sheet.length_y)}
    return Scene("one", sheet, material, gravity, supports, loads, probes=at)


def softened(name, times):
    scene = load(name)
    return scene.replace(material=scene.material.replace(young=scene.material.young / times))


def curved(curvature, up=0.0):
    gravity = Gravity(acceleration=(0.0, 0.0, up)) if up else None
    return of(SQUARE, FIRM, (Curved(edge="x0", curvature=curvature),), gravity=gravity)


def pushed(by):
    motion = {"time": [0.0, 1.0], "displacement": [[0.0, 0.0, 0.0], [-by, 0.0, 0.05 * by]]}
    return of(STRIP, SOFT, (*AT_X0, Clamped(edge="x1", motion=motion)))


def pulled(sheet, material, force, moment=0.0):
    return of(sheet, material, AT_X0, EdgeLoad(edge="x1", force_per_length=force, moment_per_length=moment))


RUBBER = Material(law="neo-hookean", young=1e6, poisson=0.45, density=1000.0)
OTHERS = {
    "two edges, softened tenfold": softened("two-edges-clamped", 10.0),
    "two edges, softened 54-fold": softened("two-edges-clamped", 54.0),
    "one edge, softened tenfold": softened("one-edge-clamped", 10.0),
    "one edge, softened 54-fold": softened("one-edge-clamped", 54.0),
    **{f"curved edge, kappa {kappa}": curved(kappa) for kappa in (-8, -4, 2, 12)},
    "curved edge, kappa -8, weight": curved(-8, -9.81),
    "curved edge, kappa -8, less weight": curved(-8, -0.78 * 9.81),
    "clamps pushed 2 mm together": pushed(2e-3),
    "clamps pushed 20 mm together": pushed(20e-3),
    "clamps pulled 2 mm apart": pushed(-2e-3),
    "follower pressure": of(SQUARE, FIRM, AT_X0, Pressure(value=20.0)),
    "closed pressure": of(SQUARE, FIRM, AROUND, Pressure(value=500.0)),
    "edge moment": pulled(SQUARE, FIRM, (0.0, 0.0, 0.0), 0.2),
    "rubber, pulled": pulled(STRIP, RUBBER, (300.0, 0.0, 0.0)),
    "rubber, own weight": of(SQUARE, RUBBER, AT_X0, gravity=DOWN),
    "fibres at 45°": of(SQUARE, Material(kind="orthotropic", angle="45 deg", **FIBRES), AT_X0, gravity=DOWN),
    "pulled up": pulled(SQUARE, FIRM, (0.0, 0.0, 300.0)),
    "pulled up hard": pulled(SQUARE, FIRM, (0.0, 0.0, 3000.0)),
    "column": of(
        Sheet(length_x=0.2, length_y=0.05, thickness=0.001), Material(young=5e6, poisson=0.0, density=1100.0),
        AT_X0, EdgeLoad(edge="x1", force_per_length=(-0.0334127, 0.0, 0.002)),
    ),
}  # fmt: skip
NAMES = [*catalogue(), *OTHERS, "per-direction springs", "17 × 17"]


def solve(name):
    """The equilibrium of a scene of the table."""
    if name == "17 × 17":
        scene = load("two-edges-clamped")
        return lumped.solve(scene, lumped.calibrate(scene.sheet, scene.material, grid=17))
    if name == "per-direction springs":
        scene = load("two-edges-clamped")
        springs = lumped.calibrate(scene.sheet, scene.material, grid=9)
        k = springs.springs.diagonal
        own = springs.springs.replace(diagonal=PerDirection(x=k, y=k, z=0.5 * k))
        return lumped.solve(scene, replace(springs, springs=own))
    return lumped.solve(OTHERS.get(name, name))


def answer(name):
    """Status, factorisations, load factors of snaps and displacements of the probes [m]."""
    found = solve(name)
    scene = OTHERS.get(name) or load(name if name in catalogue() else "two-edges-clamped")
    return {
        "status": str(found.status),
        "factorisations": found.iterations,
        "load_factor": round(float(found.load_factor), 6),
        "snaps": [round(float(snap), 4) for snap in found.snaps],
        "displacement": np.asarray(found.displacement(scene.probe_points())).round(DIGITS).tolist(),
    }


BEFORE = json.loads(FILE.read_text(encoding="utf-8"))


def test_the_table_has_every_scene_of_the_catalogue():
    assert list(BEFORE) == NAMES and set(catalogue()) < BEFORE.keys()


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name", NAMES)
def test_the_answer_stays_and_costs_no_more(name):
    found, before = answer(name), BEFORE[name]
    displacement, known = np.array(found.pop("displacement")), np.array(before["displacement"])
    np.testing.assert_allclose(displacement, known, rtol=0.0, atol=1e-9 * np.abs(known).max())
    assert (found["status"], found["load_factor"]) == (before["status"], before["load_factor"])
    np.testing.assert_allclose(found["snaps"], before["snaps"], atol=0.02)
    assert found["factorisations"] <= before["factorisations"] + (name not in catalogue())


if __name__ == "__main__":
    table = {name: answer(name) for name in NAMES}
    rows = (f"{json.dumps(name, ensure_ascii=False)}: {json.dumps(row)}" for name, row in table.items())
    FILE.write_text("{" + ",\n".join(rows) + "}\n", encoding="utf-8")
