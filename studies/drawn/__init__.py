"""Lattice against shell on sheets with outlines, holes, fibres and shapes that hold or load them."""
