"""The material: linear at small strains, for rubber with a law of large strains.

A law of rubber stores per volume, with the principal stretches λ_i, J = λ₁ λ₂ λ₃, I₁ = Σ λ_i²,
I₂ = Σ_{i<j} λ_i² λ_j² and x = I₁ − 3,

    W = f(x) + c₀₁ (I₂ − 3) − (2 f′(0) + 4 c₀₁) ln J + ½ Λ ln² J,   Λ = λ − 4 c₀₁ − 4 f″(0),

λ Lamé's constant: free of stress at rest, with the shear modulus μ = 2 f′(0) + 2 c₀₁ and the given Poisson's
ratio at small strains. The values of `law` are

    neo-hookean     f = ½ μ x
    mooney-rivlin   f = c1 x, c₀₁ = c2
    yeoh            f = c1 x + c2 x² + c3 x³
    gent            f = −½ shear · limit · ln(1 − x/limit)

`young` is the long-time modulus, which statics use; in motion Maxwell branches add to it
(`sheetbench.scenes.objects.relaxation`). All moduli relax alike, Poisson's ratio is constant.

Sources: Mooney (1940), Rivlin (1948), Yeoh (1990), Gent (1996); ln J as in Bonet and Wood, Nonlinear
Continuum Mechanics (2008), 6.4.
"""

from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise
from math import pi
from typing import Annotated, Any, Literal, NamedTuple, Self

import numpy as np
from pydantic import ConfigDict, Field, model_validator

from sheetbench.errors import BadInput
from sheetbench.scenes.language.units import numbers
from sheetbench.scenes.objects.orthotropy import (
    KEYS,
    MODULI,
    NEEDED,
    Fibres,
    Ply,
    impossible,
    in_own_axes,
    like_isotropic,
)
from sheetbench.scenes.objects.quantities import (
    Angle,
    Density,
    Forms,
    Modulus,
    NonNegative,
    Number,
    PoissonRatio,
    Positive,
    Real,
    Unit,
)
from sheetbench.scenes.objects.relaxation import Branches, Relaxation, constant_loss
from sheetbench.scenes.objects.stiffness import Stiffnesses

Stiffness = Annotated[Positive | Stiffnesses, Forms()]
RubberLaw = Literal["neo-hookean", "mooney-rivlin", "yeoh", "gent"]


class Energy(NamedTuple):
    """Energy of a law: f = c10 x + c20 x² + c30 x³ [Pa], or Gent's with f′(0) = c10 and a limit; c01 [Pa]."""

    c10: float
    c01: float = 0.0
    c20: float = 0.0
    c30: float = 0.0
    limit: float = 0.0

    @property
    def shear(self) -> float:
        """Return μ of small strains [Pa]."""
        return 2.0 * (self.c10 + self.c01)

    @property
    def stiffening(self) -> float:
        """Return f″(0) [Pa]."""
        return 2.0 * self.c20 + (self.c10 / self.limit if self.limit else 0.0)

    def young(self, poisson: float) -> float:
        """Return E of small strains [Pa]."""
        return 2.0 * (1.0 + poisson) * self.shear

    def volume(self, poisson: float) -> float:
        """Return Λ [Pa]."""
        return 2.0 * self.shear * poisson / (1.0 - 2.0 * poisson) - 4.0 * (self.c01 + self.stiffening)


class LawKeys(NamedTuple):
    """A law's keys in [material], and the energy as a function of their values."""

    keys: tuple[str, ...]
    energy: Callable[..., Energy]


WORDS: Mapping[str, LawKeys] = {
    "mooney-rivlin": LawKeys(("c1", "c2"), lambda c1, c2: Energy(c1, c01=c2)),
    "yeoh": LawKeys(("c1", "c2", "c3"), lambda c1, c2, c3: Energy(c1, c20=c2, c30=c3)),
    "gent": LawKeys(("shear", "limit"), lambda shear, limit: Energy(shear / 2.0, limit=limit)),
}
STRESSES = ("c1", "c2", "c3", "shear")
CONSTANTS = (*STRESSES, "limit")
UNDAMPED: Mapping[str, Any] = {
    "damping_time": 0.0, "loss_factor": None, "frequency": None, "band": None, "relaxation": (),
}  # fmt: skip
LARGEST_LOSS = 2.0  # of a loss factor: rubber in its transition


def _constants_in_schema(schema: dict[str, Any]) -> None:
    """Write the required keys of a material into a JSON Schema: for fibres, laws with constants, others."""
    needed: dict[str, Any] = {"required": ["young", "poisson", "density"]}
    for law, words in WORDS.items():
        of_law = {"properties": {"law": {"const": law}}, "required": ["law"]}
        needed = {"if": of_law, "then": {"required": [*words.keys, "poisson", "density"]}, "else": needed}
    fibres = {"properties": {"kind": {"const": "orthotropic"}}, "required": ["kind"]}
    schema.pop("required", None)
    needed = {"if": fibres, "then": {"required": ["density", *NEEDED]}, "else": needed}
    cloth = {"properties": {"kind": {"const": "stiffness"}}, "required": ["kind"]}
    stiffnesses = {"required": ["membrane", "bending", "area_density"]}
    schema["allOf"] = [{"if": cloth, "then": stiffnesses, "else": needed}]


class Material(Fibres):
    """Elasticity, density, viscous damping and relaxation of a sheet.

    Rubber has a law with its constants, a sheet with fibres the constants along and across them
    (`sheetbench.scenes.objects.orthotropy`).
    """

    model_config = ConfigDict(json_schema_extra=_constants_in_schema)

    young: Modulus
    """Young's modulus E: 1 MPa is 1.0e6; needed, but of fibres and of a law with constants, from which it
    follows. Of a material that relaxes, the long-time modulus."""
    poisson: PoissonRatio
    """Poisson's ratio ν, below 0.5: rubber and silicone are about 0.48 to 0.499; needed, but of fibres."""
    density: Density
    """Density ρ: water's is 1000."""
    damping_time: Annotated[NonNegative, Unit("s")] = 0.0
    """Stiffness-proportional damping: every spring has a damper of damping_time times its stiffness."""
    damping_rate: Annotated[NonNegative, Unit("1/s")] = 0.0
    """Mass-proportional damping: a force damping_rate · mass · velocity on every mass, against its motion."""
    law: RubberLaw | None = Field(default=None, kw_only=True)
    """Of rubber at large strains: neo-hookean (young, poisson), mooney-rivlin (c1, c2), yeoh (c1, c2, c3) or
    gent (shear, limit), each with poisson."""
    c1: Annotated[Number, Unit("Pa")] | None = Field(default=None, kw_only=True)
    """Coefficient of I1 - 3 in the energy: mooney-rivlin, yeoh."""
    c2: Annotated[Number, Unit("Pa")] | None = Field(default=None, kw_only=True)
    """Coefficient of I2 - 3: mooney-rivlin; of (I1 - 3)²: yeoh."""
    c3: Annotated[Number, Unit("Pa")] | None = Field(default=None, kw_only=True)
    """Coefficient of (I1 - 3)³: yeoh."""
    shear: Modulus | None = Field(default=None, kw_only=True)
    """Shear modulus at small strains: gent."""
    limit: Positive | None = Field(default=None, kw_only=True)
    """Limit of I1 - 3 that no load reaches: gent."""
    kind: Literal["isotropic", "orthotropic", "stiffness"] = Field(default="isotropic", kw_only=True)
    """Of an orthotropic sheet, one with fibres, the constants along axis 1 and across it are given; young and
    poisson are left out. With "stiffness" membrane, bending and area_density are given in their place."""
    membrane: Annotated[Stiffness, Unit("N/m")] | None = Field(default=None, kw_only=True)
    """Membrane stiffness, a number or { x, y, coupling, shear }: of kind = "stiffness"."""
    bending: Annotated[Stiffness, Unit("N·m")] | None = Field(default=None, kw_only=True)
    """Bending stiffness, a number or { x, y, coupling, shear }: of kind = "stiffness"."""
    area_density: Annotated[Positive, Unit("kg/m²")] | None = Field(default=None, kw_only=True)
    """Mass per area, of kind = "stiffness": 150 g/m² is 0.15."""
    young_3: Modulus | None = Field(default=None, kw_only=True)
    """Young's modulus through the thickness, for solids alone; young_2 unless given."""
    poisson_13: Number | None = Field(default=None, kw_only=True)
    """Poisson's ratio for solids: contraction through the thickness when pulled along 1; poisson_12 unless
    given."""
    poisson_23: Number | None = Field(default=None, kw_only=True)
    """Poisson's ratio for solids: contraction through the thickness when pulled along 2; poisson_12 unless
    given."""
    angle: Angle | None = Field(default=None, kw_only=True)
    """Angle of axis 1 from x towards y: 30 degrees are 0.5236 or "30 deg"; 0 unless given."""

    loss_factor: Annotated[float, Real(gt=0, le=LARGEST_LOSS)] | None = Field(default=None, kw_only=True)
    """Loss factor η = 2ζ = tan δ = 1/Q, in place of damping_time: with `frequency` one damper a spring, exact
    at that frequency alone; with `band` Maxwell branches that keep it over the band."""
    frequency: Annotated[Positive, Unit("Hz")] | None = Field(default=None, kw_only=True)
    """Frequency where one damper a spring has the loss factor: damping_time = loss_factor/(2π frequency)."""
    band: Annotated[tuple[Positive, Positive], Unit("Hz")] | None = Field(default=None, kw_only=True)
    """Band [low, high] over which two Maxwell branches a decade keep the loss factor."""
    relaxation: tuple[Relaxation, ...] = Field(default=(), kw_only=True)
    """Maxwell branches, in the order of their times: a Prony series."""

    @model_validator(mode="before")
    @classmethod
    def _young_of_constants(cls, data: Any) -> Any:
        """Add Young's modulus of small strains from a law's constants, unless given. For fibres, and for a
        material given by stiffnesses, young and poisson are mere scales."""
        if not isinstance(data, dict):
            return data
        if data.get("kind") == "stiffness":  # a scene replaces it by layers
            return {"young": 1.0, "poisson": 0.0, "density": 1.0, **data}
        if data.get("kind") == "orthotropic":
            given = numbers(data, {key: "" if key == "poisson_12" else "Pa" for key in NEEDED})
            real = given and min(given["young_1"], given["young_2"]) > 0.0
            young, poisson = like_isotropic(given) if real else (1.0, 0.0)
            return {"young": young, "poisson": poisson, **data}
        law = data.get("law")
        words = WORDS.get(law) if isinstance(law, str) else None
        if words is None or "young" in data:
            return data
        given = numbers(data, {key: "Pa" if key in STRESSES else "" for key in ("poisson", *words.keys)})
        poisson, *constants = given.values() or (0.0,)
        young = words.energy(*constants).young(poisson) if constants else 0.0
        # the fault of impossible constants is reported by `_faults`
        return {**data, "young": young if young > 0.0 else 1.0}

    def stiffness(self, key: str) -> np.ndarray:
        """Return the stiffness (3, 3) over (x, y, xy) of membrane [N/m] or bending [N·m]."""
        given = getattr(self, key)
        return (given if isinstance(given, Stiffnesses) else Stiffnesses(given, given)).form(self.poisson)

    def _faults(self) -> Iterator[object]:
        own = self.given(("membrane", "bending", "area_density"))
        if self.kind == "stiffness":
            missing = [key for key in ("membrane", "bending", "area_density") if key not in own]
            yield missing and f"kind = 'stiffness': {', '.join(missing)} missing"
            yield self.law and f"law = '{self.law}': for isotropic rubber only; leave it out"
        else:
            yield own and f"{', '.join(own)}: for kind = 'stiffness' only; give kind, or leave it out"
        keys, own = self._keys, self.given(CONSTANTS)
        for key in (key for key in own if key not in keys):
            laws = ", ".join(law for law, words in WORDS.items() if key in words.keys)
            of = f"law = '{self.law}' takes {' and '.join(keys) or 'young'}" if self.law else "law is missing"
            yield f"{key} = {own[key]:g}: {of}; leave {key} out, or choose law: {laws}"
        for key in keys:
            yield key not in own and f"law = '{self.law}': {key} is missing; it takes {', '.join(keys)}"
        if self.law is not None:
            yield from self._rubber_faults(", ".join(f"{key} = {value:g}" for key, value in own.items()))
        yield from self._fibre_faults(self.given(KEYS))
        yield from self._damping_faults()

    def _rubber_faults(self, given: str) -> Iterator[object]:
        """Yield reasons why a law is not stable at rest, or has pressure under a large enough pull."""
        energy, young = self.energy, self.energy.young(self.poisson)
        stable = f"the shear modulus at small strains is {energy.shear:g} Pa; it must be > 0"
        yield energy.shear <= 0.0 and f"{given}: {stable}"
        yield abs(self.young - young) > 1e-9 * young and (
            f"young = {self.young:g}: {given} and poisson = {self.poisson:g} make it {young:g} Pa "
            "at small strains; leave young out"
        )
        ratio = 2.0 * (energy.c01 + energy.stiffening) / energy.shear
        yield energy.volume(self.poisson) < 0.0 and (
            f"poisson = {self.poisson:g}: with law = '{self.law}' {given} it must "
            f"be {ratio / (1.0 + 2.0 * ratio):.3g} or more"
        )
        least = energy.c20**2 / (3.0 * energy.c10) if energy.c20 < 0.0 < energy.c10 else 0.0
        pushes = energy.c10 < 0.0 or energy.c30 < least or (least and energy.c30 == least)
        above = f" and c3 above {least:g} Pa" * (self.law == "yeoh")
        yield pushes and f"{given}: the stress turns negative at a large stretch; c1 must be 0 or more{above}"
        yield energy.c01 < 0.0 and (
            f"{given}: the stress turns negative, pulled both ways beyond a stretch of "
            f"{(-energy.c10 / energy.c01) ** 0.5:.3g}; c2 must be 0 or more: a rubber that stiffens has "
            "law = 'yeoh' or 'gent'"
        )

    def _fibre_faults(self, own: dict[str, float]) -> Iterator[object]:
        """Yield reasons why the given constants of fibres are impossible."""
        if self.kind != "orthotropic":
            for key, value in own.items():
                yield f"{key} = {value:g}: for kind = 'orthotropic' only; give kind, or leave it out"
            return
        yield self.law and f"law = '{self.law}': for isotropic rubber only; an orthotropic material has none"
        yield impossible(own)
        for key, value in zip(("young", "poisson"), like_isotropic(own), strict=True):
            given, needed = getattr(self, key), ", ".join(NEEDED)
            leave = f"{key} = {given:g}: an orthotropic material has {needed}; leave {key} out"
            yield abs(given - value) > 1e-9 * abs(value) and leave

    def _damping_faults(self) -> Iterator[object]:
        """Yield reasons why the damping of the material is given twice or incompletely."""
        if self.loss_factor is None:
            yield from (f"{key}: needs a loss_factor" for key in self.given(("frequency", "band")))
        else:
            for key in ("damping_time", "relaxation"):
                both = f"loss_factor and {key}: each defines the damping; give one"
                yield getattr(self, key) and both
            yield (self.frequency is None) == (self.band is None) and (
                f"loss_factor = {self.loss_factor:g}: give frequency, for one damper a spring, or "
                "band = [low, high], for Maxwell branches"
            )
        times, total = [branch.time for branch in self.relaxation], sum(one.share for one in self.relaxation)
        listed = ", ".join(f"{t:g}" for t in times)
        yield any(b <= a for a, b in pairwise(times)) and f"relaxation: times must increase, not {listed} s"
        yield total >= 1.0 and f"relaxation: shares add up to {total:g}; they must stay below 1"
        _ = self.branches  # raises for a band that is none

    @property
    def _keys(self) -> tuple[str, ...]:
        """Return the keys of the law's constants."""
        return WORDS[self.law or ""].keys if self.law in WORDS else ()

    @property
    def ply(self) -> Ply:
        """Return the single ply of a sheet that is of this material alone."""
        return Ply(-0.5, 0.5, **in_own_axes(self.given((*KEYS, "young", "poisson", "density"))))

    @property
    def dashpot_time(self) -> float:
        """Return coefficient over stiffness [s] of the damper that every spring has, 0 without dampers."""
        if self.loss_factor is not None and self.frequency is not None:
            return self.loss_factor / (2.0 * pi * self.frequency)
        return self.damping_time

    @property
    def branches(self) -> Branches:
        """Return the Maxwell branches, stiffnesses over the long-time one and times; empty without any."""
        if self.loss_factor is not None and self.band is not None:
            return constant_loss(self.loss_factor, *self.band)
        rest = 1.0 - sum(branch.share for branch in self.relaxation)
        stiffness = tuple(branch.share / rest for branch in self.relaxation)
        return Branches(stiffness, tuple(branch.time for branch in self.relaxation))

    @property
    def energy(self) -> Energy:
        """Return the energy of the law; without a law neo-Hooke's, which agrees at small strains."""
        if self.law not in WORDS:
            return Energy(self.young / (4.0 * (1.0 + self.poisson)))
        return WORDS[self.law or ""].energy(*(getattr(self, key) for key in self._keys))

    def replace(self, **values: Any) -> Self:
        """Return a copy with other values for some keys. Constants of a law or of fibres are scaled with
        another `young`, and `young` follows other constants. Raises SceneError for values that are
        impossible."""
        kinds = {self.kind, values.get("kind", self.kind)}
        scaled, derived = tuple[str, ...](), {"young"}
        if "orthotropic" in kinds:
            derived = {"young", "poisson", *(KEYS if len(kinds) == 2 else ())}
            scaled, was = (MODULI if len(kinds) == 1 else ()), self.young
        elif not self._keys or values.get("law", self.law) != self.law:
            dropped = CONSTANTS if "law" in values else ()
            return super().replace(**{key: None for key in dropped if key not in values}, **values)
        else:
            scaled, was = STRESSES, self.energy.young(values.get("poisson", self.poisson))
        if scaled and (young := values.pop("young", None)) is not None:
            values = {key: young / was * value for key, value in self.given(scaled).items()} | values
        kept = {name: getattr(self, name) for name in type(self).model_fields if name not in derived}
        return type(self)(**{**kept, **values})


def limit_note(material: Material) -> str:
    """Return a sentence on the limit of Gent's law, for an answer that prescribed motions may rule out."""
    return (
        f"prescribed motions may bring I1 - 3 to limit = {material.limit:g} of the law 'gent': move the "
        "supports less, or give a larger limit"
    )


def require_no_branches(material: Material, who: str) -> None:
    """Raise BadInput for a material with Maxwell branches, which a model or file, `who`, does not have."""
    if material.branches.times:
        key = "band" if material.band else "relaxation"
        remedy = "give a frequency in place of the band" if material.band else "give a damping_time"
        raise BadInput(f"material.{key}: {who} has no Maxwell branches: {remedy}")
