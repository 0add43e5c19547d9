"""Equilibria of the lattice: Newton's method, descent, paths, buckling, and when an answer holds."""
