"""Explicit integration: velocity Verlet, its compiled steps at the places of a packing, and its limits."""
