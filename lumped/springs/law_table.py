"""The laws of cells as rows of a table, `LAWS`, and the functions by which compiled loops call a law.

A law's constants go into the loops as a tuple of a type of the law, its tag: numba compiles a loop once for
each tag, with the functions of that tag's row for `respond`, `stiffness`, `extrapolate`, … below. A new law
is a row, its compiled functions and a tag.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numba.extending import overload

from lumped.springs import laws
from lumped.springs.laws import Constants, Four, Six, Three, times_six
from sheetbench.numerics.aliasing import load_each
from sheetbench.numerics.options import inner


class AreaAndStrains(NamedTuple):
    """Tag of `laws.area_and_strains`. constants: (c, 7) [N/m³] of every cell."""

    constants: np.ndarray


class Rubber(NamedTuple):
    """Tag of `laws.rubber`. constants: (c, 13) of every cell."""

    constants: np.ndarray


class Face(NamedTuple):
    """Tag of `face`. constants: (c, 5) of every upright face."""

    constants: np.ndarray


Tag = AreaAndStrains | Rubber | Face
T = TypeVar("T", bound=Callable[..., Any])


@inner()
def face(d: Four, g: Three, area: float, k: Constants) -> tuple[float, float, Four]:
    """Return energy W, stiffness against δg₁₂ and stress S of an upright face, which resists the shear of its
    director b against the direction of its chord a for any stretch of the chord,

        W = ½ k₄ δg₁₂²/(1 + δg₁₁/g₁₁).

    k₀ to k₃: the springs of its small strains [N/m³].
    """
    now = g[0] + d[0]
    stiff = k[4] * g[0] / now
    pull = stiff * d[2]
    energy = 0.5 * pull * d[2]
    return energy, stiff, (-energy / now, 0.0, pull, 0.0)


@inner()
def stiffness_of_face(
    d: Four, g: Three, area: float, stiff: float, share: float, k: Constants
) -> tuple[Six, Four]:
    """Return M + share (D − M) of `face`, 11 22 33 12 13 23, and zeros for s."""
    turn, part = d[2] / (g[0] + d[0]), share * stiff
    shear = k[3] + share * (stiff - k[3])
    return (part * turn * turn, 0.0, shear, 0.0, -part * turn, 0.0), (0.0, 0.0, 0.0, 0.0)


@inner()
def face_by_constants(
    d: Four, g: Three, area: float, stiff: float, k: Constants, rate: Four, out: np.ndarray
) -> None:
    """Set the derivatives of the power S·ġ by k₀ to k₄ in `out` (5,)."""
    now = g[0] + d[0]
    pull = g[0] / now * d[2]
    out[4] = pull * (rate[2] - 0.5 * d[2] / now * rate[0])


@inner()
def _itself(d: Four, g: Three, memory: Any, predicted: Four) -> Any:
    return memory, predicted


def _linear(stiffness: Callable[..., Any]) -> Callable[..., Any]:
    """Return the function `extrapolate` of a law with a given stiffness, S + D ġ."""

    @inner()
    def extrapolate(  # type: ignore[no-untyped-def]
        d: Four, g: Three, area: float, memory: Any, stress: Four, k: Constants, rate: Four
    ):
        six, more = stiffness(d, g, area, memory, 1.0, k)
        by_g = times_six(six, (rate[0], rate[1], rate[2]))
        by_s = more[0] * rate[0] + more[1] * rate[1] + more[2] * rate[2] + more[3] * rate[3]
        return (
            stress[0] + by_g[0] + more[0] * rate[3],
            stress[1] + by_g[1] + more[1] * rate[3],
            stress[2] + by_g[2] + more[2] * rate[3],
            stress[3] + by_s,
        )

    return extrapolate


@dataclass(frozen=True)
class CellLaw:
    """A law of cells. tag: of its loops; respond: (δg and s, g at rest, area, constants) → energy, memory for
    the stiffness, stress; stiffness: (δg and s, g, area, memory, share, constants) → M + share (D − M) of g,
    11 22 33 12 13 23, and of s, 14 24 34 44; extrapolate: (δg and s, g, area, memory, stress, constants, rate
    of g and s) → prediction of the linearisation; of_extrapolated: (δg and s, g, memory, prediction) → memory
    and stress; measures: 3, or 4 with s; parts: (stiffness (c, 4 or 7), other constants, area) → constants of
    each kind of `ENERGIES`, (c, n); examples: constants of a cell of 1 × 1 m for tests."""

    tag: type[Tag]
    respond: Callable[..., Any]
    stiffness: Callable[..., Any]
    by_constants: Callable[..., Any]
    extrapolate: Callable[..., Any]
    of_extrapolated: Callable[..., Any]
    measures: int
    parts: Callable[..., dict[str, np.ndarray]]
    examples: tuple[tuple[float, ...], ...]

    @property
    def count(self) -> int:
        """Number of constants of a cell."""
        return len(self.examples[0])


ENERGIES = {  # of an exported cell with the constants k1, k2, …; see the README of an export
    "area": "0.5 k1 (a/a0 - 1)^2 a0",
    "strain": "0.5 (k1 e1^2 + k2 e2^2 + k3 g^2) a0",
    "coupling": "(k1 e1 e2 + k2 e1 g + k3 e2 g) a0",
    "rubber": "W(k1 .. k6) a0 - 0.5 k7 (la - |A0|)^2 - 0.5 k8 (lb - |B0|)^2",
    "face": "0.5 k1 (A.B/|A||B0|)^2 a0",
}


def _parts_of_rubber(_stiffness: np.ndarray, others: np.ndarray, area: np.ndarray) -> dict[str, np.ndarray]:
    none = np.zeros(len(area))
    return {
        "rubber": np.column_stack([others[:, :5] / area[:, None], others[:, 5:8]]),
        "strain": np.column_stack([none, none, others[:, 8] * area]),
    }


AREA_AND_STRAINS = CellLaw(
    AreaAndStrains,
    laws.area_and_strains,
    laws.stiffness_of_area_and_strains,
    laws.area_and_strains_by_constants,
    laws.extrapolated_area_and_strains,
    laws.area_and_strains_of_extrapolated,
    3,
    lambda k, _others, _area: {"area": k[:, :1], "strain": k[:, 1:4], "coupling": k[:, 4:]},
    ((-30.0, 200.0, 150.0, 80.0, 60.0, -50.0, 40.0),),
)
RUBBER = CellLaw(
    Rubber,
    laws.rubber,
    laws.stiffness_of_rubber,
    laws.rubber_by_constants,
    _linear(laws.stiffness_of_rubber),
    _itself,
    4,
    _parts_of_rubber,
    (  # neo-hookean, mooney-rivlin, yeoh, gent
        (164.0, 132.0, 140.0, 87.0, 50.0, 0.0, 0.0, 0.0, 900.0, 0.0, 68.0, 60.0, -13.0),
        (141.0, 152.0, 160.0, 107.0, 40.0, 20.0, 0.0, 0.0, 500.0, 0.0, 68.0, 60.0, -13.0),
        (153.0, 132.0, 140.0, 87.0, 50.0, 0.0, -3.0, 5.0, 700.0, 0.0, 68.0, 60.0, -13.0),
        (158.0, 132.0, 140.0, 87.0, 50.0, 0.0, 0.0, 0.0, 700.0, 3.0, 68.0, 60.0, -13.0),
    ),
)
FACE = CellLaw(
    Face,
    face,
    stiffness_of_face,
    face_by_constants,
    _linear(stiffness_of_face),
    _itself,
    3,
    lambda _stiffness, others, area: {"face": others * area[:, None]},
    ((0.0, 0.0, 0.0, 25.0, 25.0),),
)
LAWS = (AREA_AND_STRAINS, RUBBER, FACE)
_OF = {law.tag: law for law in LAWS}


def _compiled_by_tag(call: T) -> T:
    """Register the overload of a function of a tag: compiled callers call the function of the tag's law."""
    part = call.__name__

    @overload(call, strict=False)
    def _(tag: Any, *given: Any) -> Any:
        of_law = getattr(_OF[tag.instance_class], part)
        return (lambda tag, *given: of_law(*given)) if given else (lambda tag, *given: of_law)

    return call


@_compiled_by_tag
def respond(tag: Tag, d: Four, g: Three, area: float, k: Constants) -> tuple[float, Any, Four]:
    """Return the energy [J], the memory that `stiffness` takes, and the stress S (`CellLaw.respond`)."""
    return _OF[type(tag)].respond(d, g, area, k)  # type: ignore[no-any-return]


@_compiled_by_tag
def stiffness(
    tag: Tag, d: Four, g: Three, area: float, memory: Any, share: float, k: Constants
) -> tuple[Six, Four]:
    """Return M + share (D − M), of g and of s (`CellLaw.stiffness`)."""
    return _OF[type(tag)].stiffness(d, g, area, memory, share, k)  # type: ignore[no-any-return]


@_compiled_by_tag
def by_constants(
    tag: Tag, d: Four, g: Three, area: float, memory: Any, k: Constants, rate: Four, out: np.ndarray
) -> None:
    """Set the derivatives of the power S·ġ by the constants (`CellLaw.by_constants`)."""
    _OF[type(tag)].by_constants(d, g, area, memory, k, rate, out)


@_compiled_by_tag
def extrapolate(
    tag: Tag, d: Four, g: Three, area: float, memory: Any, stress: Four, k: Constants, rate: Four
) -> Four:
    """Return the prediction of the linearisation for a rate of g and s (`CellLaw.extrapolate`)."""
    return _OF[type(tag)].extrapolate(d, g, area, memory, stress, k, rate)  # type: ignore[no-any-return]


@_compiled_by_tag
def of_extrapolated(tag: Tag, d: Four, g: Three, memory: Any, predicted: Four) -> tuple[Any, Four]:
    """Return the memory and the stress of a prediction (`CellLaw.of_extrapolated`)."""
    return _OF[type(tag)].of_extrapolated(d, g, memory, predicted)  # type: ignore[no-any-return]


@_compiled_by_tag
def measures(tag: Tag) -> int:
    """Return the number of measures, 3, or 4 with s."""
    return _OF[type(tag)].measures


@_compiled_by_tag
def count(tag: Tag) -> int:
    """Return the number of constants of a cell."""
    return _OF[type(tag)].count


def constants(tag: Tag, first: Any, stride: Any) -> Any:
    """Return a cell's constants, at the places first, first + stride, … of the tag's flat array."""
    return load_each(0, tag.constants, first, stride, _OF[type(tag)].count)


@overload(constants, strict=False)
def _constants(tag: Any, first: Any, stride: Any) -> Any:
    count = _OF[tag.instance_class].count
    return lambda tag, first, stride: load_each(0, tag.constants, first, stride, count)


@inner()
def constants_of(tag: Tag, c: int) -> Any:
    """Return the constants of cell c, row c of the tag's array."""
    return constants(tag, c * count(tag), 1)


@inner()
def mean_stress(tag: Tag, d0: Four, d1: Four, g: Three, area: float, k: Constants) -> Four:
    """Return the stress over a step from δg and s = d0 to d1 whose work is the change of energy: the stress
    in the middle, corrected along the step by the missing energy (Gonzalez 1996)."""
    middle = 0.5 * (d0[0] + d1[0]), 0.5 * (d0[1] + d1[1]), 0.5 * (d0[2] + d1[2]), 0.5 * (d0[3] + d1[3])
    s = respond(tag, middle, g, area, k)[2]
    m1, m2, m3, m4 = d1[0] - d0[0], d1[1] - d0[1], d1[2] - d0[2], d1[3] - d0[3]
    if measures(tag) == 3:
        m4 = 0.0
    length = m1 * m1 + m2 * m2 + m3 * m3 + m4 * m4
    if length <= 1e-12 * area * area:  # the missing energy is rounding
        return s
    stored = respond(tag, d1, g, area, k)[0] - respond(tag, d0, g, area, k)[0]
    left = (stored - s[0] * m1 - s[1] * m2 - s[2] * m3 - s[3] * m4) / length
    return s[0] + left * m1, s[1] + left * m2, s[2] + left * m3, s[3] + left * m4
