"""The published inputs held against one another: what follows from the others, and what does not.

D = E h³/12(1 − ν²), I = l h³/12, l = a/(n − 1). A lattice of equal springs bends along its axes like a plate
of k lz² (`lumped.calibration.textbook`), so that a layer distance √(D/k) is what the published k asks for.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

import lumped
from comparisons.reproduction.answers import bending_stiffness, matched_layer_distance
from comparisons.reproduction.published import scene
from sheetbench.answers.table import NUMBER, PERCENT, Column, Unit, unit
from sheetbench.scenes.habibi import published_inputs
from studies.reproduction.printed_errors import cells, means

SAME = 0.005  # of a printed figure: what its two digits leave open


@dataclass(frozen=True)
class Check:
    """A printed figure beside what follows from the others, in the unit (SI), and from what; printed is None
    where none is given."""

    what: Annotated[str, Column("figure")]
    unit: str
    printed: Annotated[float | None, NUMBER(".4g")]
    computed: Annotated[float, NUMBER(".4g", "others give")]
    follows: Annotated[str, Column("by")]

    @property
    def shown_unit(self) -> Annotated[Unit, Column("unit")]:
        """The unit as people read it."""
        shown = {"": NUMBER, "kg": Unit("kg", "g", 1e3)}
        return PERCENT if self.what.startswith("mean") else shown.get(self.unit) or unit(self.unit)

    @property
    def agrees(self) -> bool | None:
        """Whether the two are the same to the printed digits; None where there is none to be the same as."""
        return None if self.printed is None else abs(self.computed - self.printed) <= SAME * abs(self.printed)


def checks() -> list[Check]:
    """Every check."""
    given = published_inputs()
    masses = given["masses_per_side"] ** 2 * given["layers"]
    weighs = given["density"] * given["side"] ** 2 * given["thickness"]
    spacing = given["side"] / (given["masses_per_side"] - 1.0)
    rigidity, membrane = bending_stiffness(), given["young"] * given["thickness"]
    inertia = given["thickness"] ** 3 * spacing / 12.0
    k = given["k"]
    stiffnesses = {
        "E h": membrane,
        "12 E I/l³": 12.0 * given["young"] * inertia / spacing**3,
        "3 E I/l³": 3.0 * given["young"] * inertia / spacing**3,
        "D/l²": rigidity / spacing**2,
        "2 D/l²": 2.0 * rigidity / spacing**2,
    }
    return [
        Check("mass of a point", "kg", given["mass"], weighs / masses, "ρ a² h over the masses"),
        Check("equations", "", given["equations"], 3.0 * masses, "three a mass"),
        *_links(),
        Check("mean of the errors", "", given["mean_error"], means(cells())["printed"], "its cells"),
        *(Check("k", "N/m", k, value, formula) for formula, value in stiffnesses.items()),
        Check("layer distance", "m", None, matched_layer_distance(), "√(D/k)"),
    ]


def _links() -> list[Check]:
    """Links of a mass in the interior, on an edge and at a corner, counted on a lattice of that grid."""
    given, scene_of_test = published_inputs(), scene(1)
    side, layers = int(given["masses_per_side"]), int(given["layers"])
    grid = (side, side, layers)
    springs = lumped.calibrate(scene_of_test.sheet, scene_of_test.material, grid=grid, method="uniform")
    lattice = lumped.build_problem(scene_of_test, springs).assembly.lattice
    ends = np.concatenate([family.nodes.ravel() for family in lattice.links])
    counts = np.bincount(ends)
    middle = side // 2
    places = {"interior": (middle, middle), "edge": (middle, 0), "corner": (0, 0)}
    return [
        Check(
            f"links, {name}",
            "",
            given[f"links_{name}"],
            float(counts[lattice.number(*map(np.array, (*at, 0)))]),
            "counted on the grid",
        )
        for name, at in places.items()
    ]
