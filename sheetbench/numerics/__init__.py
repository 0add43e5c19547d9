"""Linear algebra that both solvers use: equations, no mechanics."""

import numpy as np

import sheetbench.kernels  # noqa: F401  # before numba: where compiled kernels are kept

# Allocated, never touched, freed: glibc's malloc then keeps the memory that smaller arrays free. Without it
# the system takes that back after every factorisation and clears it again, a tenth of a small solve's time.
np.empty(31 << 20, np.uint8)
