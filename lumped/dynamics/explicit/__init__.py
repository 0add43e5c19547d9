"""Explicit integrators: compiled Verlet steps at a packing's places, their limits, projected constraints."""
