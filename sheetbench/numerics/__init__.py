"""Linear algebra that both solvers use: equations, no mechanics."""

import numpy as np

import sheetbench.kernels  # noqa: F401  # before numba: where compiled kernels are kept

# Allocated, never touched, freed: glibc's malloc then keeps the memory that smaller arrays free. Without it
# the system takes that back after every factorisation and clears it again: a shell takes 1.08 times as long
# on 8 × 8 elements and 1.05 times on 16 × 16. Factors and their workspace allocated once for a pattern have
# the first back and not the second: on larger meshes it is the elements' matrices as much as the factors.
np.empty(31 << 20, np.uint8)
