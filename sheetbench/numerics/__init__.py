"""Linear algebra that both solvers use: equations, no mechanics."""

import sheetbench.kernels  # noqa: F401  # before numba: where compiled kernels are kept
