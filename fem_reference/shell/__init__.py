"""The geometrically nonlinear Reissner–Mindlin shell."""

import sheetbench.kernels  # noqa: F401  # before numba: where compiled kernels are kept
