"""The displacement of a sheet's masses as a function of PyTorch, with a derivative."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import torch

from lumped import Differentiable


class _Solved(torch.autograd.Function):
    @staticmethod
    def forward(
        ctx: Any, sheet: Differentiable, names: tuple[str, ...], *values: torch.Tensor
    ) -> torch.Tensor:
        ctx.sheet, ctx.names = sheet, names
        ctx.save_for_backward(*values)
        return torch.from_numpy(sheet.solve(_arrays(names, values)).copy())

    @staticmethod
    def backward(ctx: Any, by: torch.Tensor) -> tuple[Any, ...]:
        slopes = ctx.sheet.vjp(_arrays(ctx.names, ctx.saved_tensors), by.detach().cpu().numpy())
        return None, None, *(torch.from_numpy(slopes[name]) for name in ctx.names)


def _arrays(names: tuple[str, ...], values: tuple[torch.Tensor, ...]) -> dict[str, Any]:
    return {name: of.detach().cpu().double().numpy() for name, of in zip(names, values, strict=True)}


def solve(sheet: Differentiable, values: Mapping[str, torch.Tensor]) -> torch.Tensor:
    """Return u (n, 3) [m] of `lumped.Differentiable.solve`, double, for `backward`; values: double too."""
    return _Solved.apply(sheet, tuple(values), *values.values())  # type: ignore[no-any-return, no-untyped-call]
