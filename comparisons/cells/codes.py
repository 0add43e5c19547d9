"""A cell's coefficients as the parameters of codes that have such cells, in their own units.

A code's energy is in its documentation or source, at the version named; only its law at small strain counts.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated

from comparisons.cells.cell import HINGE_UNITS
from sheetbench.answers.table import Column


@dataclass(frozen=True)
class Parameter:
    """A parameter of a code."""

    code: str
    parameter: str
    unit: str
    value: Annotated[float, Column("value", form="#.6g")]


@dataclass(frozen=True)
class Code:
    """A code of triangles and hinges: the weight of its hinges; its parameters from our coefficients."""

    name: str
    hinge: str
    parameters: Callable[[Mapping[str, float]], Mapping[str, float]]


CODES = (
    # newton/_src/solvers/vbd/particle_vbd_kernels.py: area × (μ/2 (tr FᵀF − 2) + λ/2 (J − 1 − μ/λ)²) with
    # μ = tri_ke, λ = tri_ka, whose small strains have Lamé's λ less μ; ½ edge_ke L θ² over an edge.
    Code(
        "Newton 1.8, VBD",
        "length",
        lambda c: {
            "tri_ke": c["mu_h"],
            "tri_ka": c["lambda_h"] + c["mu_h"],
            "edge_ke": c["hinge"],
        },
    ),
    # the same with St Venant–Kirchhoff triangles, μ |G|² + λ/2 (tr G)²
    Code(
        "Newton 1.3, VBD",
        "length",
        lambda c: {"tri_ke": c["mu_h"], "tri_ka": c["lambda_h"], "edge_ke": c["hinge"]},
    ),
    # Grinspun et al., Discrete shells, SCA 2003, equation (1): k θ² L/h̄ over an edge, h̄ = (A₁ + A₂)/(3 L)
    Code("Discrete shells (Grinspun)", "height", lambda c: {"k_B": c["hinge"] / 2.0}),
)


def parameters(hinge: str, coefficients: Mapping[str, float]) -> list[Parameter]:
    """The parameters of the codes whose hinges have this weight."""
    units = {name: HINGE_UNITS[hinge] for name in ("edge_ke", "k_B")} if hinge else {}
    return [
        Parameter(code.name, name, units.get(name, "N/m"), value)
        for code in CODES
        if code.hinge == hinge
        for name, value in code.parameters(coefficients).items()
    ]
