"""Lattice and reference side by side: differences, and which exceed the reference's error bar."""
