"""The displacement of a sheet's masses as a function of JAX, with its derivative (`sheetbench[jax]`)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import jax
import numpy as np

from lumped import Differentiable
from sheetbench.errors import BadInput


def solve(sheet: Differentiable, values: Mapping[str, Any]) -> jax.Array:
    """Return u (n, 3) [m] of `lumped.Differentiable.solve` for `grad`, `jit` and `vmap`, which goes through a
    batch one by one. Raises BadInput without doubles: jax.config.update("jax_enable_x64", True)."""
    if not jax.config.jax_enable_x64:  # type: ignore[attr-defined]
        raise BadInput('sheetbench.jax: doubles are needed: jax.config.update("jax_enable_x64", True)')
    like = jax.ShapeDtypeStruct(sheet.base["forces"].shape, np.dtype(float))

    def forward(values: dict[str, Any]) -> np.ndarray:  # no array of JAX stays one: it could wait for itself
        return sheet.solve({name: np.asarray(value) for name, value in values.items()})

    def backward(values: dict[str, Any], by: Any) -> dict[str, np.ndarray]:
        return sheet.vjp({name: np.asarray(value) for name, value in values.items()}, np.asarray(by))

    @jax.custom_vjp
    def solved(values: dict[str, Any]) -> jax.Array:
        return jax.pure_callback(forward, like, values, vmap_method="sequential")

    def pulled(values: dict[str, Any], by: jax.Array) -> tuple[dict[str, Any]]:
        shapes = jax.tree.map(lambda value: jax.ShapeDtypeStruct(value.shape, value.dtype), values)
        return (jax.pure_callback(backward, shapes, values, by, vmap_method="sequential"),)

    solved.defvjp(lambda values: (solved(values), values), pulled)
    return solved({name: jax.numpy.asarray(value, float) for name, value in values.items()})
