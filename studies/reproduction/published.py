"""Data published by Habibi et al.: inputs and displacements in SI units, printed errors, known faults.

Source: Habibi, Yang, Godage, Kang, Walker, Branson: a lumped-mass model for large-deformation continuum
surfaces. See data/README.md.
"""

import csv
from functools import cache
from importlib import resources

_SI = {"mm": 1e-3, "GPa": 1e9, "percent": 1e-2}
PROBES = ("P1", "P2", "P3", "P4")

KNOWN_FAULTS = (
    "The two bodies of the displacement tables stand swapped in the text; here symmetry distinguishes them.",
    "The unit is mm, although one header says m.",
    "Experimental uy(P4) of test 1 is printed −1.86; the symmetry of the test gives +1.86.",
    "In test 1 the published y axis points the other way than in a scene with edges x0 and y0 clamped: "
    "compare −uy.",
    "The printed percentage errors are relative to the experiment in some cells and to the model in others, "
    "whichever is larger; their mean is 4.92 %, not the 4.8 % quoted.",
    "Young's modulus was found by matching samples to the surface model itself: E and k are not independent "
    "evidence. k = 550 N/m follows from no standard formula, and the layer distance is not given.",
    "The published inputs do not determine the published displacements: converged plate theory with "
    "E = 54.5 MPa gives half of what was measured at P1 to P3 of test 1.",
)


@cache
def published_displacements() -> dict[tuple[int, str, str, str], float]:
    """Return every published displacement as printed, in metres and in the published axes, by test (1 or 2),
    source (`model` or `experiment`), component (ux, uy or uz) and probe."""
    return {
        (int(row["test"]), row["source"], row["component"], probe): float(row[probe]) * _SI[row["unit"]]
        for row in _rows("displacements.csv")
        for probe in PROBES
    }


def published_inputs() -> dict[str, float]:
    """Return every published input and figure by name, in SI units, errors as fractions (inputs.csv)."""
    return {row["quantity"]: float(row["value"]) * _SI.get(row["unit"], 1.0) for row in _rows("inputs.csv")}


def published_errors() -> dict[tuple[int, str, str], float]:
    """Return every printed error of the model as a fraction, by test, component and probe."""
    return {
        (int(row["test"]), row["component"], probe): float(row[probe]) / 100
        for row in _rows("errors_printed.csv")
        for probe in PROBES
    }


def _rows(name: str) -> list[dict[str, str]]:
    text = (resources.files("studies.reproduction") / "data" / name).read_text(encoding="utf-8")
    return list(csv.DictReader(text.splitlines()))
