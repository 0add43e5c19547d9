"""Sheets as functions of JAX and of PyTorch, where these are installed."""

import numpy as np
import pytest

import lumped
from sheetbench.errors import BadInput

WEIGHTS = np.random.default_rng(0).standard_normal((162, 3))


def design(sheet):
    curvature = 2.0 * np.random.default_rng(1).standard_normal((8, 8, 3))
    return {"cells.young": 1.1 * sheet.base["cells.young"], "cells.curvature": curvature, "density": 1500.0}


def test_a_sheet_in_jax_has_its_derivatives_jitted_and_over_a_batch():
    jax = pytest.importorskip("jax")
    from sheetbench.jax import solve

    sheet = lumped.Differentiable("one-edge-clamped")
    if not jax.config.jax_enable_x64:
        with pytest.raises(BadInput, match="doubles"):
            solve(sheet, {})
    with jax.enable_x64(True):
        values = design(sheet)
        found = jax.jit(jax.grad(lambda v: (WEIGHTS * solve(sheet, v)).sum()))(values)
        expected = sheet.vjp(values, WEIGHTS)
        for name, value in expected.items():
            assert np.allclose(found[name], value, rtol=1e-9), name

        def lifted(density):
            return solve(sheet, {"density": density})[-1, 2]

        densities = np.array([1000.0, 1500.0])
        each = [sheet.solve({"density": density})[-1, 2] for density in densities]
        assert np.allclose(jax.vmap(lifted)(densities), each, rtol=1e-9)
        slopes = jax.vmap(jax.grad(lifted))(densities)
        assert slopes[0] < slopes[1] < 0.0  # less and less as it hangs


@pytest.mark.nightly
def test_a_sheet_in_torch_has_its_derivatives():
    torch = pytest.importorskip("torch")
    from sheetbench.torch import solve

    sheet = lumped.Differentiable("one-edge-clamped")
    values = design(sheet)
    given = {name: torch.tensor(v, dtype=torch.float64, requires_grad=True) for name, v in values.items()}
    (torch.from_numpy(WEIGHTS) * solve(sheet, given)).sum().backward()
    for name, value in sheet.vjp(values, WEIGHTS).items():
        assert np.allclose(given[name].grad.numpy(), value, rtol=1e-9), name
