"""What the loops over tiles load and store, by kinds that never overlap (`sheetbench.numerics.memory`)."""

from sheetbench.numerics.memory import load, store

__all__ = ["FORCE_X", "FORCE_Y", "FORCE_Z", "GIVEN", "KEPT", "ROW", "load", "store"]

# what is only read (rest data, displacements, velocities), what springs keep of their shape, rows of a tile,
# and the three components of forces
GIVEN, KEPT, ROW, FORCE_X, FORCE_Y, FORCE_Z = range(6)
