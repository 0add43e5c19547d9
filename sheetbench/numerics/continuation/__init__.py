"""Paths of equilibria: load steps, Newton's method, snaps, stability; of any structure, lattice or elements."""
