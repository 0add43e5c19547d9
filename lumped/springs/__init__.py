"""Springs and dampers, one kind a file: links, areas, strains of cells."""

import sheetbench.kernels  # noqa: F401  # before numba: where compiled kernels are kept
