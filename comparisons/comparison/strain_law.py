"""The difference of lattice and reference that comes of their laws of strain, from the largest stretch.

Pulled one way to a stretch ε a sheet carries P = E ε (1 + c ε + …) of force per unstrained section: c = 0 in
Biot's law, 1.5 in St Venant–Kirchhoff's, below 0 in neo-Hooke's. A lattice's links are linear in their own
elongation, but diagonals turn with the stretch, area springs follow the area and strain springs Green's
strain: its c is that of its construction, and found here by pulling the lattice itself. Neo-Hookean cells
have neo-Hooke's, but for what the pulls leave uncertain, which is `PULLS`' larger one. At one force the
stretches differ by (c − c_ref) ε; a sheet loaded across, which moves by less, differs by less.
"""

from __future__ import annotations

import numpy as np

from comparisons.models.resolve import Resolved
from comparisons.models.solve import solve
from comparisons.models.spec import Lattice
from fem_reference.pulled_strip import curving, laws_of, pulled
from sheetbench.answers.solution import Solution
from sheetbench.choices import STRAIN_LAW
from sheetbench.errors import NoEquilibrium
from sheetbench.scenes import Sheet
from sheetbench.scenes.language.summary import few

UNSAID = 1e-3  # without an error bar
LEAST = 0.4  # of c − c_ref that is looked for
MOST = 5000  # masses of a lattice that is pulled
PULLS = (1e-5, 1e-2)  # P/E
RUBBER, OFF = "neo-hookean", 0.02  # the law of soft sheets that name none, and what is off


def of_lattice(lattice: Resolved[Lattice]) -> float:
    """c of a lattice on a rectangle of its scene's sides and material, pulled one way. Raises NoEquilibrium
    where it does not bear the pull."""
    scene, material = lattice.scene, lattice.scene.material
    sheet = Sheet(scene.sheet.length_x, scene.sheet.length_y, scene.sheet.thickness)
    corner, softness = np.array([sheet.lengths]), []
    for pull in PULLS:
        strip = pulled((pull * material.young * sheet.thickness, 0.0), sheet, material)
        answer = solve(lattice.on(strip.replace(springs=scene.springs))).require_stable()
        moved = answer.displacement(corner)[0, 0]
        softness.append(float(moved) / (sheet.length_x * pull))
    return (1.0 - softness[1] / softness[0]) / (softness[1] * PULLS[1])


def strain_law_note(lattice: Resolved[Lattice], solutions: tuple[Solution, ...], bar: float | None) -> str:
    """Return a sentence where the laws of lattice and reference, the first two of the solutions, differ by
    more than the reference's error bar, else nothing; bar: as a share, None where it is not known."""
    first, reference = solutions[:2]
    above = UNSAID if bar is None else max(bar, UNSAID)
    stretch = reference.stretch or 0.0
    if reference.model == "plate" or not (first.comparable and reference.comparable):
        return ""
    if LEAST * stretch <= above or first.unknowns > 3 * MOST:
        return ""
    law = str(reference.settings.get("law", STRAIN_LAW))
    try:
        own = of_lattice(lattice)
    except NoEquilibrium as failed:
        return _unknown(failed)
    material = lattice.scene.material
    off = {name: abs(own - curving(name, material)) for name in laws_of(material)}
    if off[law] <= PULLS[1] or not off[law] * stretch > above:
        return ""
    nearest = min(off, key=lambda name: off[name])
    remedy = "" if nearest == law else f" Nearest to this lattice is --law {nearest}."
    by = 100.0 * off[law] * stretch
    reach = f" {limit}" if (limit := _limit(lattice, own, stretch)) else ""
    its = nearest if off[nearest] <= PULLS[1] else "links linear in their elongation"
    return (
        f"At {few(100.0 * stretch)} % stretch the lattice's law of strain ({its}) "
        f"and the {reference.model}'s ({law}) differ by up to {few(by)} %: not an error of the grid."
        f"{remedy}{reach}"
    )


def _unknown(failed: NoEquilibrium) -> str:
    return f"The lattice's law of strain is not known: pulled one way, {failed}."


def _limit(lattice: Resolved[Lattice], own: float, stretch: float) -> str:
    material = lattice.scene.material
    law = material.law or RUBBER
    off = abs(own - curving(law, material))
    if off <= PULLS[1] or stretch <= OFF / off:
        return ""
    springs = lattice.spec.calibration or "of its own springs"
    return (
        f"Pulled one way this lattice ({springs}) is off by more than {100.0 * OFF:g} % of a rubber ({law}) "
        f"from {few(100.0 * OFF / off)} % stretch on; --calibration hyperelastic is not."
    )
