"""Validated numbers and the frozen base of every scene object. All quantities are in SI units."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, Strict

Number = Annotated[float, Strict(), Field(allow_inf_nan=False)]
Positive = Annotated[Number, Field(gt=0)]
NonNegative = Annotated[Number, Field(ge=0)]
Vector3 = tuple[Number, Number, Number]
PlanPoint = tuple[Number, Number]


class Frozen(BaseModel):
    """Base of the scene objects: immutable, and unknown keys are refused."""

    model_config = ConfigDict(frozen=True, extra="forbid", populate_by_name=True)
