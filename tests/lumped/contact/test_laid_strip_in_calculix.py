"""The laid strip in CalculiX: solid elements, surface to surface contact with a rigid block.

C3D8I of the strip's thickness, linear overclosure of E/1000h, frictionless, load steps of 0.02. C3D20R with
E/h, 0.1 and 0.01 of it in longer steps had their increments cut back until they stopped.
"""

import shutil
import subprocess

import pytest
from contact_cases import DENSITY, GRAVITY, THICKNESS, WEIGHT, heavy_elastica

ELEMENTS = 60


def deck(drop: float) -> str:
    """Return CalculiX's input: the strip's nodes in sections of four, the block's behind them."""
    young, half = 0.12 * DENSITY * GRAVITY / THICKNESS**2, THICKNESS / 2
    ring = ((0.0, -half), (0.1, -half), (0.1, half), (0.0, half))
    places = [(i / ELEMENTS, y, z) for i in range(ELEMENTS + 1) for y, z in ring]
    floor = -drop - half
    places += [
        (x, y, z)
        for z in (floor - 0.02, floor)
        for x, y in ((-0.1, -0.1), (1.1, -0.1), (1.1, 0.2), (-0.1, 0.2))
    ]
    first = 4 * (ELEMENTS + 1) + 1  # of the block's nodes
    strip = []
    for n in range(1, ELEMENTS + 1):
        a, b, c, d = range(4 * n - 3, 4 * n + 1)
        strip.append((n, a, a + 4, b + 4, b, d, d + 4, c + 4, c))
    lines = ["*NODE", *(f"{n}, {x:.9g}, {y:.9g}, {z:.9g}" for n, (x, y, z) in enumerate(places, 1))]
    lines += ["*ELEMENT, TYPE=C3D8I, ELSET=STRIP", *(", ".join(map(str, one)) for one in strip)]
    lines += [
        "*ELEMENT, TYPE=C3D8, ELSET=FLOOR",
        ", ".join(map(str, (ELEMENTS + 1, *range(first, first + 8)))),
    ]
    lines += ["*NSET, NSET=FIXED, GENERATE", f"{first}, {first + 7}"]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", f"{young:.9g}, 0.", "*DENSITY", f"{DENSITY}"]
    lines += [f"*SOLID SECTION, ELSET={name}, MATERIAL=M" for name in ("STRIP", "FLOOR")]
    lines += ["*SURFACE, NAME=LOWER", "STRIP, S1", "*SURFACE, NAME=UPPER", "FLOOR, S2"]
    lines += ["*SURFACE INTERACTION, NAME=PENALTY", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR"]
    lines += [f"{1e-3 * young / THICKNESS:.6g}, 1e-3"]
    lines += ["*CONTACT PAIR, INTERACTION=PENALTY, TYPE=SURFACE TO SURFACE", "LOWER, UPPER"]
    lines += ["*BOUNDARY", "1, 1, 3", "2, 1, 3", "3, 1, 3", "4, 1, 3", "FIXED, 1, 3"]
    lines += [f"{4 * n + 1}, 2, 2" for n in range(1, ELEMENTS + 1)]
    lines += ["*STEP, NLGEOM, INC=2000", "*STATIC", "0.005, 1., 1e-8, 0.02"]
    lines += ["*DLOAD", f"STRIP, GRAV, {GRAVITY}, 0., 0., -1."]
    lines += ["*NODE PRINT, NSET=FIXED, TOTALS=ONLY, FREQUENCY=9999", "RF", "*END STEP"]
    return "\n".join([*lines, ""])


@pytest.mark.nightly
@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed")
@pytest.mark.parametrize("drop", [0.05, 0.2])
def test_calculix_lays_the_strip_down(drop, tmp_path):
    (tmp_path / "strip.inp").write_text(deck(drop))
    subprocess.run(["ccx", "strip"], cwd=tmp_path, check=True, capture_output=True)
    (*_, floor) = map(float, (tmp_path / "strip.dat").read_text().split()[-3:])
    assert 1.0 - floor / WEIGHT == pytest.approx(heavy_elastica(drop)[1], rel=1e-3)
